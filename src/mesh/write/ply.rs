//! PLY, binary: a vertex for each normal and texture coordinate.

use super::{Pieces, for_each_face};
use crate::mesh::obj::from_top;
use std::io::{self, Write};

/// Writes a mesh as binary PLY (little endian).
///
/// # Errors
/// Errors of `out`.
pub fn write_ply(mesh: &dyn Pieces, out: &mut dyn Write) -> io::Result<()> {
    let [vertices, _] = mesh.vertex_counts();
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {vertices}")?;
    let texcoords: &[&str] = if mesh.has_texcoords() { &["s", "t"] } else { &[] };
    for name in ["x", "y", "z", "nx", "ny", "nz"].iter().chain(texcoords) {
        writeln!(out, "property float {name}")?;
    }
    let faces: usize = mesh.face_counts().into_iter().sum();
    writeln!(out, "element face {faces}\nproperty list uchar uint vertex_indices\nend_header")?;
    mesh.vertices(&mut |piece| {
        for (i, (position, normal)) in piece.positions.iter().zip(piece.normals).enumerate() {
            out.write_all(bytemuck::bytes_of(&position.map(little)))?;
            out.write_all(bytemuck::bytes_of(&normal.map(little)))?;
            if let Some(texcoords) = piece.texcoords {
                // In PLY v runs up from the bottom of the image.
                let [u, v] = texcoords[i];
                out.write_all(bytemuck::bytes_of(&[u, from_top(v.into()) as f32].map(little)))?;
            }
        }
        Ok(())
    })?;
    for_each_face(mesh, |face| {
        out.write_all(&[face.len() as u8])?;
        face.iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))
    })
}

fn little(x: f32) -> [u8; 4] {
    x.to_le_bytes()
}
