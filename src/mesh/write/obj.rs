//! OBJ: every position once, whatever normals and texture coordinates it has.

use super::Polygons;
use crate::mesh::obj::from_top;
use std::io::{self, Write};

/// Writes a mesh as OBJ.
///
/// # Errors
/// Those of `out`.
pub fn write_obj(mesh: &Polygons, out: &mut dyn Write) -> io::Result<()> {
    for [x, y, z] in &mesh.positions[..mesh.copies.0 as usize] {
        writeln!(out, "v {x} {y} {z}")?;
    }
    for [u, v] in mesh.texcoords.unwrap_or_default() {
        writeln!(out, "vt {u} {}", from_top(f64::from(*v)))?;
    }
    for [x, y, z] in mesh.normals {
        writeln!(out, "vn {x} {y} {z}")?;
    }
    for face in mesh.faces() {
        write!(out, "f")?;
        for &vertex in face {
            let (position, own) = (mesh.position_of(vertex) + 1, vertex + 1);
            match mesh.texcoords {
                Some(_) => write!(out, " {position}/{own}/{own}")?,
                None => write!(out, " {position}//{own}")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}
