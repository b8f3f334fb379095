use crate::mesh::{ControlMesh, FaceVarying, MAX_CORNERS, MeshData, MeshError};
use glam::DVec3;

/// Repeats a mesh on a grid, with its tags and attributes, centred where the mesh is.
///
/// `copies` counts along x, y and z; neighbours lie `spacing` times the size of the mesh's bounds apart (1: the bounds
/// touch). The copies are separate components: copy by copy, x fastest, vertices, faces and corners follow one another
/// in the mesh's own order.
///
/// # Errors
/// [`MeshError::Empty`] for no copies, [`MeshError::TooLarge`] for more than fit into a mesh, and
/// [`MeshError::NotFinite`] if `spacing` is not finite.
pub fn replicate(mesh: &ControlMesh, copies: [u32; 3], spacing: f64) -> Result<ControlMesh, MeshError> {
    let data = mesh.data();
    let count = copies.iter().fold(1usize, |product, &n| product.saturating_mul(n as usize));
    let max = MAX_CORNERS;
    // Before anything is allocated: `copies` may come from a command line.
    let corners = count.saturating_mul(mesh.corner_count());
    if corners > max {
        return Err(MeshError::TooLarge { what: "face corners", count: corners, max });
    }
    let [low, high] = mesh.bounds();
    let step = (high - low) * spacing;
    let middle = DVec3::from(copies.map(|n| f64::from(n) - 1.0)) / 2.0;

    let mut out = MeshData {
        positions: Vec::with_capacity(count * data.positions.len()),
        face_sizes: data.face_sizes.repeat(count),
        face_vertices: Vec::with_capacity(corners),
        texcoords: data.texcoords.as_ref().map(|attribute| replicate_attribute(attribute, count)),
        normals: data.normals.as_ref().map(|attribute| replicate_attribute(attribute, count)),
        creases: data.creases.repeat(count),
        corners: data.corners.repeat(count),
        holes: data.holes.repeat(count),
        edits: std::iter::repeat_n(&data.edits, count).flatten().cloned().collect(),
        ..*data
    };
    let mut place = 0;
    for z in 0..copies[2] {
        for y in 0..copies[1] {
            for x in 0..copies[0] {
                let offset = (DVec3::new(x.into(), y.into(), z.into()) - middle) * step;
                let vertex = out.positions.len() as u32;
                out.positions.extend(data.positions.iter().map(|&p| (DVec3::from(p) + offset).to_array()));
                out.face_vertices.extend(data.face_vertices.iter().map(|v| v + vertex));
                let tags = |len: usize| place * len..(place + 1) * len;
                for crease in &mut out.creases[tags(data.creases.len())] {
                    crease.vertices = crease.vertices.map(|v| v + vertex);
                }
                out.corners[tags(data.corners.len())].iter_mut().for_each(|corner| corner.vertex += vertex);
                let face = (place * data.face_sizes.len()) as u32;
                out.holes[tags(data.holes.len())].iter_mut().for_each(|hole| *hole += face);
                out.edits[tags(data.edits.len())].iter_mut().for_each(|edit| edit.face += face);
                place += 1;
            }
        }
    }
    ControlMesh::new(out)
}

/// Each copy has values of its own, so that copies do not hang together in the attribute.
fn replicate_attribute<T: Copy>(attribute: &FaceVarying<T>, count: usize) -> FaceVarying<T> {
    let len = attribute.values.len();
    let indices = (0..count).flat_map(|copy| attribute.indices.iter().map(move |i| i + (copy * len) as u32));
    FaceVarying { values: attribute.values.repeat(count), indices: indices.collect() }
}
