//! PLY, binary: a vertex for each normal and texture coordinate.

use super::Polygons;
use crate::mesh::obj::from_top;
use std::io::{self, Write};

/// Writes a mesh as binary PLY (little endian).
///
/// # Errors
/// Those of `out`.
pub fn write_ply(mesh: &Polygons, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", mesh.positions.len())?;
    let texcoords: &[&str] = if mesh.texcoords.is_some() { &["s", "t"] } else { &[] };
    for name in ["x", "y", "z", "nx", "ny", "nz"].iter().chain(texcoords) {
        writeln!(out, "property float {name}")?;
    }
    let faces = mesh.quads.len() + mesh.triangles.len();
    writeln!(out, "element face {faces}\nproperty list uchar uint vertex_indices\nend_header")?;
    for (i, (position, normal)) in mesh.positions.iter().zip(mesh.normals).enumerate() {
        out.write_all(bytemuck::bytes_of(&position.map(little)))?;
        out.write_all(bytemuck::bytes_of(&normal.map(little)))?;
        if let Some(texcoords) = mesh.texcoords {
            // In PLY v runs up from the bottom of the image.
            let [u, v] = texcoords[i];
            out.write_all(bytemuck::bytes_of(&[u, from_top(v.into()) as f32].map(little)))?;
        }
    }
    for face in mesh.faces() {
        out.write_all(&[face.len() as u8])?;
        face.iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))?;
    }
    Ok(())
}

fn little(x: f32) -> [u8; 4] {
    x.to_le_bytes()
}
