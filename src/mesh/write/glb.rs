//! GLB: glTF 2.0 in one file. It has triangles only.

use super::Pieces;
use serde_json::{Value, json};
use std::io::{self, Write};

pub(super) const FLOAT: u32 = 5126;
pub(super) const UNSIGNED_INT: u32 = 5125;
pub(super) const ARRAY_BUFFER: u32 = 34962;
pub(super) const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// Head of a GLB file with one mesh: everything before the numbers.
pub(super) struct Head<'h> {
    pub primitive: Value,
    pub extensions: &'h [&'h str],
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
    /// Bytes of the numbers.
    pub length: usize,
}

impl Head<'_> {
    /// Writes everything that stands before the numbers.
    pub(super) fn write(self, out: &mut dyn Write) -> io::Result<()> {
        let Self { primitive, extensions, views, accessors, length } = self;
        let mut root = json!({
            "asset": { "version": "2.0", "generator": concat!("ash-subdiv ", env!("CARGO_PKG_VERSION")) },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": [{ "mesh": 0 }],
            "meshes": [{ "primitives": [primitive] }],
            "buffers": [{ "byteLength": length }],
            "bufferViews": views,
            "accessors": accessors,
        });
        if !extensions.is_empty() {
            root["extensionsUsed"] = json!(extensions);
        }
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
        out.write_all(b"BIN\0")
    }
}

/// Writes the vertices and triangles of a mesh as GLB. Quads are not looked at: glTF has none.
///
/// # Errors
/// Errors of `out`, and [`io::ErrorKind::FileTooLarge`] where the file would have 4 GiB or more.
pub fn write_glb(mesh: &dyn Pieces, out: &mut dyn Write) -> io::Result<()> {
    let ([vertices, _], [_, triangles]) = (mesh.vertex_counts(), mesh.face_counts());
    let texcoords = if mesh.has_texcoords() { vertices } else { 0 };
    let parts: [(&str, &str, usize, usize); 4] = [
        ("POSITION", "VEC3", vertices, 12),
        ("NORMAL", "VEC3", vertices, 12),
        ("TEXCOORD_0", "VEC2", texcoords, 8),
        ("", "SCALAR", 3 * triangles, 4),
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
            let [low, high] = bounds(mesh)?;
            (accessor["min"], accessor["max"]) = (json!(low), json!(high));
        }
        if !name.is_empty() {
            attributes.insert(name.into(), accessors.len().into());
        }
        accessors.push(accessor);
        length += bytes;
    }
    let primitive = json!({ "attributes": attributes, "indices": accessors.len() - 1, "mode": 4 });
    Head { primitive, extensions: &[], views, accessors, length }.write(out)?;
    let mut write = |numbers: &[f32]| numbers.iter().try_for_each(|x| out.write_all(&x.to_le_bytes()));
    mesh.vertices(&mut |piece| write(piece.positions.as_flattened()))?;
    mesh.vertices(&mut |piece| write(piece.normals.as_flattened()))?;
    if mesh.has_texcoords() {
        mesh.vertices(&mut |piece| write(piece.texcoords.unwrap_or_default().as_flattened()))?;
    }
    mesh.triangles(&mut |piece| piece.as_flattened().iter().try_for_each(|vertex| out.write_all(&vertex.to_le_bytes())))
}

fn bounds(mesh: &dyn Pieces) -> io::Result<[[f32; 3]; 2]> {
    let mut bounds = [[f32::INFINITY; 3], [f32::NEG_INFINITY; 3]];
    mesh.vertices(&mut |piece| {
        for p in piece.positions {
            bounds[0] = std::array::from_fn(|axis| bounds[0][axis].min(p[axis]));
            bounds[1] = std::array::from_fn(|axis| bounds[1][axis].max(p[axis]));
        }
        Ok(())
    })?;
    Ok(bounds)
}
