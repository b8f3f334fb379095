//! OBJ: every position once, whatever normals and texture coordinates it has.

use super::{Pieces, for_each_face};
use crate::mesh::obj::from_top;
use std::io::{self, Write};

/// Writes a mesh as OBJ.
///
/// # Errors
/// Errors of `out`.
pub fn write_obj(mesh: &dyn Pieces, out: &mut dyn Write) -> io::Result<()> {
    let [_, mut left] = mesh.vertex_counts();
    mesh.vertices(&mut |piece| {
        let own = piece.positions.len().min(left);
        left -= own;
        piece.positions[..own].iter().try_for_each(|[x, y, z]| writeln!(out, "v {x} {y} {z}"))
    })?;
    let has_texcoords = mesh.has_texcoords();
    if has_texcoords {
        mesh.vertices(&mut |piece| {
            let texcoords = piece.texcoords.unwrap_or_default();
            texcoords.iter().try_for_each(|[u, v]| writeln!(out, "vt {u} {}", from_top(f64::from(*v))))
        })?;
    }
    mesh.vertices(&mut |piece| piece.normals.iter().try_for_each(|[x, y, z]| writeln!(out, "vn {x} {y} {z}")))?;
    for_each_face(mesh, |face| {
        write!(out, "f")?;
        for &vertex in face {
            let (position, own) = (mesh.position_of(vertex) + 1, vertex + 1);
            match has_texcoords {
                true => write!(out, " {position}/{own}/{own}")?,
                false => write!(out, " {position}//{own}")?,
            }
        }
        writeln!(out)
    })
}
