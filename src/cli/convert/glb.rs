//! A control mesh as GLB, polygons as fans of triangles that FB_ngon_encoding tells apart.

use super::corners_of;
use super::split::Split;
use ash_subdiv::ControlMesh;
use serde_json::json;
use std::io::{self, Write};

const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

pub(super) fn write(out: &mut impl Write, mesh: &ControlMesh) -> io::Result<()> {
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
    let root = json!({
        "asset": { "version": "2.0", "generator": concat!("ash-subdiv ", env!("CARGO_PKG_VERSION")) },
        "extensionsUsed": ["FB_ngon_encoding"],
        "scene": 0,
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [primitive] }],
        "buffers": [{ "byteLength": length }],
        "bufferViews": views,
        "accessors": accessors,
    });
    write_chunks(out, &root, length, &parts.map(|(.., numbers)| numbers), &indices)
}

fn write_chunks(
    out: &mut impl Write,
    root: &serde_json::Value,
    length: usize,
    numbers: &[&[f32]],
    indices: &[u32],
) -> io::Result<()> {
    let mut text = serde_json::to_vec(root)?;
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
    numbers.iter().copied().flatten().try_for_each(|x| out.write_all(&x.to_le_bytes()))?;
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
