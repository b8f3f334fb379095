//! Checks of the parts of a mesh.

use super::{FaceVarying, MeshData, MeshError};

/// The most vertices, and face corners, of a mesh: ring tables have up to three entries a face corner, counted in u32, where
/// the top bit of an index is a flag.
pub(crate) const MAX_CORNERS: usize = 1 << 30;

/// Checks everything but neighbours and tags; gives the face offsets.
pub(super) fn check(data: &MeshData) -> Result<Vec<u32>, MeshError> {
    let count = data.positions.len();
    if count == 0 {
        return Err(MeshError::Empty { what: "vertices" });
    }
    if data.face_sizes.is_empty() {
        return Err(MeshError::Empty { what: "faces" });
    }
    check_size(data)?;
    let mut face_offsets = Vec::with_capacity(data.face_sizes.len() + 1);
    let mut corners = 0usize;
    face_offsets.push(0);
    for (face, &size) in data.face_sizes.iter().enumerate() {
        if size < 3 {
            return Err(MeshError::FaceTooSmall { face: face as u32, size: size as usize });
        }
        corners += size as usize;
        face_offsets.push(corners as u32);
    }
    if corners != data.face_vertices.len() {
        return Err(MeshError::CornerCount { what: "vertices", given: data.face_vertices.len(), corners });
    }
    // As the GPU sees them.
    if let Some(vertex) = data.positions.iter().position(|p| p.iter().any(|&x| !(x as f32).is_finite())) {
        return Err(MeshError::NotFinite { vertex: vertex as u32, position: data.positions[vertex] });
    }
    // Which face used a vertex last: finds repeated vertices in linear time whatever the size of a face.
    let mut last_face = vec![u32::MAX; count];
    for (face, range) in face_offsets.windows(2).enumerate() {
        let face = face as u32;
        for &vertex in &data.face_vertices[range[0] as usize..range[1] as usize] {
            let last = last_face.get_mut(vertex as usize).ok_or(MeshError::IndexOutOfRange { face, vertex, count })?;
            if std::mem::replace(last, face) == face {
                return Err(MeshError::RepeatedVertex { face, vertex });
            }
        }
    }
    if let Some(vertex) = last_face.iter().position(|&face| face == u32::MAX) {
        return Err(MeshError::IsolatedVertex { vertex: vertex as u32 });
    }
    check_face_varying("texture coordinate", data.texcoords.as_ref(), corners)?;
    check_face_varying("normal", data.normals.as_ref(), corners)?;
    Ok(face_offsets)
}

/// Checks what no repair can do without: that there are vertices and faces, and that the arrays go together.
pub(super) fn check_sound(data: &MeshData) -> Result<(), MeshError> {
    let count = data.positions.len();
    for (what, is_empty) in [("vertices", count == 0), ("faces", data.face_sizes.is_empty())] {
        if is_empty {
            return Err(MeshError::Empty { what });
        }
    }
    check_size(data)?;
    let corners = data.face_sizes.iter().map(|&size| u64::from(size)).sum::<u64>() as usize;
    let texcoords = data.texcoords.as_ref().map(|texcoords| texcoords.indices.len());
    let normals = data.normals.as_ref().map(|normals| normals.indices.len());
    for (what, given) in
        [("vertices", Some(data.face_vertices.len())), ("texture coordinate", texcoords), ("normal", normals)]
    {
        if let Some(given) = given.filter(|&given| given != corners) {
            return Err(MeshError::CornerCount { what, given, corners });
        }
    }
    if let Some(corner) = data.face_vertices.iter().position(|&vertex| vertex as usize >= count) {
        let vertex = data.face_vertices[corner];
        let mut ends = data.face_sizes.iter().scan(0, |end, &size| {
            *end += size as usize;
            Some(*end)
        });
        let face = ends.position(|end| corner < end).unwrap_or_default() as u32;
        return Err(MeshError::IndexOutOfRange { face, vertex, count });
    }
    Ok(())
}

/// Checks that vertices and face corners can be counted.
pub(super) fn check_size(data: &MeshData) -> Result<(), MeshError> {
    let max = MAX_CORNERS;
    for (what, count) in [
        ("vertices", data.positions.len()),
        ("faces", data.face_sizes.len()),
        ("face corners", data.face_vertices.len()),
    ] {
        if count > max {
            return Err(MeshError::TooLarge { what, count, max });
        }
    }
    Ok(())
}

fn check_face_varying<const N: usize>(
    what: &'static str,
    data: Option<&FaceVarying<[f32; N]>>,
    corners: usize,
) -> Result<(), MeshError> {
    let Some(FaceVarying { values, indices }) = data else { return Ok(()) };
    if indices.len() != corners {
        return Err(MeshError::CornerCount { what, given: indices.len(), corners });
    }
    if let Some(corner) = indices.iter().position(|&i| i as usize >= values.len()) {
        return Err(MeshError::CornerIndex { what, corner, index: indices[corner], count: values.len() });
    }
    if let Some(index) = values.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        return Err(MeshError::AttributeNotFinite { what, index });
    }
    Ok(())
}

/// Checks that corners and holes name what is there, and the sharpness of corners.
pub(super) fn check_tags(data: &MeshData) -> Result<(), MeshError> {
    for (index, corner) in data.corners.iter().enumerate() {
        if corner.vertex as usize >= data.positions.len() {
            let count = data.positions.len();
            return Err(MeshError::NoSuchVertex { corner: index, vertex: corner.vertex, count });
        }
        check_sharpness("corner", index, corner.sharpness)?;
    }
    for &face in &data.holes {
        if face as usize >= data.face_sizes.len() {
            return Err(MeshError::NoSuchFace { face, count: data.face_sizes.len() });
        }
    }
    Ok(())
}

/// Checks that a sharpness is a number from 0 up.
pub(super) fn check_sharpness(what: &'static str, index: usize, sharpness: f32) -> Result<(), MeshError> {
    // Not `sharpness < 0.0`: NaN is bad too.
    if sharpness >= 0.0 { Ok(()) } else { Err(MeshError::BadSharpness { what, index, sharpness }) }
}
