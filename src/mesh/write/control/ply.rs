//! PLY: binary, positions in double precision.

use super::corners_of;
use super::split::Split;
use crate::mesh::ControlMesh;
use std::io::{self, Write};

/// Writes positions, texture coordinates, normals and faces. Tags have no place.
///
/// # Errors
/// Errors of `out`.
pub fn write_ply(mesh: &ControlMesh, out: &mut dyn Write) -> io::Result<()> {
    let split = Split::new(mesh);
    writeln!(out, "ply\nformat binary_little_endian 1.0\nelement vertex {}", split.positions.len())?;
    ["x", "y", "z"].iter().try_for_each(|name| writeln!(out, "property double {name}"))?;
    let texcoords: &[&str] = if split.texcoords.is_some() { &["s", "t"] } else { &[] };
    let normals: &[&str] = if split.normals.is_some() { &["nx", "ny", "nz"] } else { &[] };
    texcoords.iter().chain(normals).try_for_each(|name| writeln!(out, "property float {name}"))?;
    writeln!(out, "element face {}\nproperty list uint uint vertex_indices\nend_header", mesh.face_count())?;
    for (vertex, position) in split.positions.iter().enumerate() {
        position.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        if let Some(texcoords) = &split.texcoords {
            // In PLY v runs up from the bottom of the image.
            let [u, v] = texcoords[vertex];
            out.write_all(&u.to_le_bytes())?;
            out.write_all(&((1.0 - f64::from(v)) as f32).to_le_bytes())?;
        }
        if let Some(normals) = &split.normals {
            normals[vertex].iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
        }
    }
    let mut vertices = split.vertices.as_slice();
    for face in corners_of(mesh) {
        let (own, rest) = vertices.split_at(face.len());
        vertices = rest;
        out.write_all(&(own.len() as u32).to_le_bytes())?;
        own.iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))?;
    }
    Ok(())
}
