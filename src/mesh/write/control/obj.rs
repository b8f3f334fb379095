//! OBJ, with OpenSubdiv's tags.

use crate::mesh::{BoundaryRule, ControlMesh, CreaseMethod, FaceVaryingRule, MeshData, TriangleRule};
use std::io::{self, Write};

/// Writes positions, texture coordinates, normals, faces and tags. Edits have no place.
///
/// # Errors
/// Errors of `out`.
pub fn write_obj(mesh: &ControlMesh, out: &mut dyn Write) -> io::Result<()> {
    let data = mesh.data();
    for [x, y, z] in &data.positions {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [u, v] in data.texcoords.iter().flat_map(|t| &t.values) {
        // In OBJ v runs up from the bottom of the image.
        writeln!(out, "vt {u} {}", 1.0 - f64::from(*v))?;
    }
    for [x, y, z] in data.normals.iter().flat_map(|n| &n.values) {
        writeln!(out, "vn {x} {y} {z}")?;
    }
    for face in 0..mesh.face_count() as u32 {
        write!(out, "f")?;
        for h in mesh.face_corners(face) {
            let vertex = data.face_vertices[h] + 1;
            let texcoord = data.texcoords.as_ref().map(|t| t.indices[h] + 1);
            let normal = data.normals.as_ref().map(|n| n.indices[h] + 1);
            match (texcoord, normal) {
                (None, None) => write!(out, " {vertex}")?,
                (Some(t), None) => write!(out, " {vertex}/{t}")?,
                (None, Some(n)) => write!(out, " {vertex}//{n}")?,
                (Some(t), Some(n)) => write!(out, " {vertex}/{t}/{n}")?,
            }
        }
        writeln!(out)?;
    }
    write_tags(out, data)
}

fn write_tags(out: &mut dyn Write, data: &MeshData) -> io::Result<()> {
    for crease in &data.creases {
        let [a, b] = crease.vertices;
        writeln!(out, "t crease 2/1/0 {a} {b} {}", crease.sharpness)?;
    }
    for corner in &data.corners {
        writeln!(out, "t corner 1/1/0 {} {}", corner.vertex, corner.sharpness)?;
    }
    for hole in &data.holes {
        writeln!(out, "t hole 1/0/0 {hole}")?;
    }
    let boundary = match data.boundary {
        BoundaryRule::None => 0,
        BoundaryRule::EdgeAndCorner => 1,
        BoundaryRule::EdgeOnly => 2,
    };
    writeln!(out, "t interpolateboundary 1/0/0 {boundary}")?;
    if data.crease_method == CreaseMethod::Chaikin {
        writeln!(out, "t creasemethod 0/0/1 chaikin")?;
    }
    if data.triangle_rule == TriangleRule::Smooth {
        writeln!(out, "t smoothtriangles 0/0/1 smooth")?;
    }
    let rule = match data.face_varying_rule {
        FaceVaryingRule::None => 0,
        FaceVaryingRule::CornersOnly => 1,
        FaceVaryingRule::CornersPlus1 => 2,
        FaceVaryingRule::CornersPlus2 => 3,
        FaceVaryingRule::Boundaries => 4,
        FaceVaryingRule::All => 5,
    };
    writeln!(out, "t facevaryinginterpolateboundary 1/0/0 {rule}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{ObjOptions, shape, shapes};

    #[test]
    fn shapes_are_read_back_as_they_were() {
        for info in shapes() {
            let mesh = shape(info.name).unwrap();
            let mut text = Vec::new();
            write_obj(&mesh, &mut text).unwrap();
            let read = ControlMesh::from_obj_bytes(&text, &ObjOptions::default()).unwrap();
            assert!(read == mesh, "{}", info.name);
        }
    }
}
