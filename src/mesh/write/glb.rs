//! GLB: glTF 2.0 in one file. It has triangles only.

use super::Polygons;
use serde_json::json;
use std::io::{self, Write};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Writes the vertices of a mesh as GLB, with these triangles. Quads are not looked at: glTF has none.
///
/// # Errors
/// Those of `out`, and [`io::ErrorKind::FileTooLarge`] where the file would have 4 GiB or more.
pub fn write_glb(mesh: &Polygons, triangles: &[[u32; 3]], out: &mut dyn Write) -> io::Result<()> {
    let texcoords = mesh.texcoords.unwrap_or_default();
    let parts: [(&str, &str, usize, usize); 4] = [
        ("POSITION", "VEC3", mesh.positions.len(), 12),
        ("NORMAL", "VEC3", mesh.normals.len(), 12),
        ("TEXCOORD_0", "VEC2", texcoords.len(), 8),
        ("", "SCALAR", 3 * triangles.len(), 4),
    ];
    let (mut views, mut accessors, mut attributes) = (Vec::new(), Vec::new(), serde_json::Map::new());
    let mut length = 0;
    for (name, kind, count, size) in parts.into_iter().filter(|(_, _, count, _)| *count > 0) {
        let (target, component) =
            if name.is_empty() { (ELEMENT_ARRAY_BUFFER, UNSIGNED_INT) } else { (ARRAY_BUFFER, FLOAT) };
        let bytes = count * size;
        views.push(json!({ "buffer": 0, "byteOffset": length, "byteLength": bytes, "target": target }));
        let mut accessor =
            json!({ "bufferView": accessors.len(), "componentType": component, "count": count, "type": kind });
        if name == "POSITION" {
            let [low, high] = bounds(mesh.positions);
            (accessor["min"], accessor["max"]) = (json!(low), json!(high));
        }
        if !name.is_empty() {
            attributes.insert(name.into(), accessors.len().into());
        }
        accessors.push(accessor);
        length += bytes;
    }
    let primitive = json!({ "attributes": attributes, "indices": accessors.len() - 1, "mode": 4 });
    let root = json!({
        "asset": { "version": "2.0", "generator": concat!("ash-subdiv ", env!("CARGO_PKG_VERSION")) },
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [primitive] }],
        "buffers": [{ "byteLength": length }],
        "bufferViews": views,
        "accessors": accessors,
    });
    let mut text = serde_json::to_vec(&root)?;
    text.resize(text.len().next_multiple_of(4), b' ');
    let too_large =
        |_| io::Error::new(io::ErrorKind::FileTooLarge, "a GLB file has less than 4 GiB: choose PLY or OBJ");
    let whole = u32::try_from(12 + 8 + text.len() + 8 + length).map_err(too_large)?;
    out.write_all(b"glTF")?;
    [2, whole, text.len() as u32].iter().try_for_each(|word: &u32| out.write_all(&word.to_le_bytes()))?;
    out.write_all(b"JSON")?;
    out.write_all(&text)?;
    out.write_all(&(length as u32).to_le_bytes())?;
    out.write_all(b"BIN\0")?;
    for numbers in [mesh.positions.as_flattened(), mesh.normals.as_flattened(), texcoords.as_flattened()] {
        numbers.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
    }
    triangles.as_flattened().iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes()))
}

fn bounds(positions: &[[f32; 3]]) -> [[f32; 3]; 2] {
    let fold = |start: f32, of: fn(f32, f32) -> f32| {
        positions.iter().fold([start; 3], |bound, p| std::array::from_fn(|axis| of(bound[axis], p[axis])))
    };
    [fold(f32::INFINITY, f32::min), fold(f32::NEG_INFINITY, f32::max)]
}
