//! GLB: polygons as fans of triangles that FB_ngon_encoding tells apart.

use super::corners_of;
use super::split::Split;
use crate::mesh::ControlMesh;
use crate::mesh::write::glb::{ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, Head, UNSIGNED_INT};
use serde_json::json;
use std::io::{self, Write};

/// Writes positions, texture coordinates, normals and faces. Tags have no place.
///
/// # Errors
/// Errors of `out`, and [`io::ErrorKind::FileTooLarge`] where the file would have 4 GiB or more.
pub fn write_glb(mesh: &ControlMesh, out: &mut dyn Write) -> io::Result<()> {
    let split = Split::new(mesh);
    let positions: Vec<[f32; 3]> = split.positions.iter().map(|position| position.map(|x| x as f32)).collect();
    let indices = triangles(mesh, &split.vertices);
    let texcoords = split.texcoords.unwrap_or_default();
    let normals = split.normals.unwrap_or_default();
    let parts: [(&str, &str, &[f32]); 3] = [
        ("POSITION", "VEC3", positions.as_flattened()),
        ("TEXCOORD_0", "VEC2", texcoords.as_flattened()),
        ("NORMAL", "VEC3", normals.as_flattened()),
    ];
    let (mut views, mut accessors, mut attributes) = (Vec::new(), Vec::new(), serde_json::Map::new());
    let mut length = 0;
    for (name, kind, numbers) in parts.into_iter().filter(|(.., numbers)| !numbers.is_empty()) {
        let bytes = 4 * numbers.len();
        views.push(json!({ "buffer": 0, "byteOffset": length, "byteLength": bytes, "target": ARRAY_BUFFER }));
        length += bytes;
        let number = accessors.len();
        accessors.push(json!({ "bufferView": number, "componentType": FLOAT, "count": positions.len(), "type": kind }));
        attributes.insert(name.to_owned(), number.into());
    }
    let [low, high] = bounds(&positions);
    (accessors[0]["min"], accessors[0]["max"]) = (json!(low), json!(high));
    let (bytes, number) = (4 * indices.len(), accessors.len());
    views.push(json!({ "buffer": 0, "byteOffset": length, "byteLength": bytes, "target": ELEMENT_ARRAY_BUFFER }));
    length += bytes;
    accessors
        .push(json!({ "bufferView": number, "componentType": UNSIGNED_INT, "count": indices.len(), "type": "SCALAR" }));
    let primitive =
        json!({ "attributes": attributes, "indices": number, "mode": 4, "extensions": { "FB_ngon_encoding": {} } });
    Head { primitive, extensions: &["FB_ngon_encoding"], views, accessors, length }.write(out)?;
    let numbers = parts.iter().flat_map(|(.., numbers)| numbers.iter());
    numbers.into_iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
    indices.iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))
}

/// The fans of all polygons. Each begins at another vertex than the one before, so that it is known where it ends.
fn triangles(mesh: &ControlMesh, vertices: &[u32]) -> Vec<u32> {
    let mut indices = Vec::with_capacity(3 * vertices.len());
    let (mut rest, mut last) = (vertices, None);
    for face in corners_of(mesh) {
        let (own, tail) = rest.split_at(face.len());
        rest = tail;
        let start = usize::from(last == Some(own[0]));
        let corner = |k: usize| own[(start + k) % own.len()];
        last = Some(corner(0));
        for k in 1..own.len() - 1 {
            indices.extend([corner(0), corner(k), corner(k + 1)]);
        }
    }
    indices
}

fn bounds(positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let fold = |start: f32, of: fn(f32, f32) -> f32| {
        positions.iter().fold([start; 3], |bound, p| std::array::from_fn(|axis| of(bound[axis], p[axis])))
    };
    [fold(f32::INFINITY, f32::min), fold(f32::NEG_INFINITY, f32::max)]
}
