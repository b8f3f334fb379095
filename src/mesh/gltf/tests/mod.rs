//! Small files made here: geometry as one wants it, then broken in one place at a time.

mod animations;
mod broken;
mod geometry;
mod scenes;

use super::*;
use serde_json::{Value, json};

const TRIANGLES: u32 = 4;

/// The JSON of a file, and its one buffer.
struct File {
    json: Value,
    buffer: Vec<u8>,
}

impl File {
    /// No meshes yet, and no scenes.
    fn empty() -> Self {
        let lists = json!({ "asset": { "version": "2.0" }, "bufferViews": [], "accessors": [], "meshes": [] });
        Self { json: lists, buffer: Vec::new() }
    }

    /// A mesh of one primitive.
    fn new(positions: &[[f32; 3]], indices: &[u16]) -> Self {
        let mut file = Self::empty();
        let primitive = file.primitive(positions, indices);
        file.push("meshes", json!({ "primitives": [primitive] }));
        file
    }

    /// Two triangles of a unit square as FB_ngon_encoding has them.
    fn square() -> Self {
        let mut file = Self::new(&SQUARE, &[0, 1, 2, 0, 2, 3]);
        file.primitive_mut()["extensions"] = json!({ NGONS: {} });
        file
    }

    fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.json[list].as_array_mut().expect("a list");
        list.push(value);
        list.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.buffer.len();
        self.buffer.extend_from_slice(bytes);
        // Offsets must be multiples of the component size, of four at most.
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0xaa);
        self.push("bufferViews", json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }))
    }

    fn accessor(&mut self, bytes: &[u8], count: usize, kind: &str, component: u32) -> usize {
        let view = self.view(bytes);
        self.push("accessors", json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }))
    }

    fn floats<const N: usize>(&mut self, elements: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = elements.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, elements.len(), ["SCALAR", "VEC2", "VEC3", "VEC4"][N - 1], 5126)
    }

    fn shorts(&mut self, elements: &[u16]) -> usize {
        let bytes: Vec<u8> = elements.iter().flat_map(|x| x.to_le_bytes()).collect();
        self.accessor(&bytes, elements.len(), "SCALAR", 5123)
    }

    fn primitive(&mut self, positions: &[[f32; 3]], indices: &[u16]) -> Value {
        let position = self.floats(positions);
        let indices = self.shorts(indices);
        json!({ "attributes": { "POSITION": position }, "indices": indices, "mode": TRIANGLES })
    }

    /// The first primitive of the first mesh.
    fn primitive_mut(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    fn json_bytes(&self) -> Vec<u8> {
        let mut json = serde_json::to_vec(&self.json).expect("JSON");
        json.resize(json.len().next_multiple_of(4), b' ');
        json
    }

    fn glb(mut self) -> Vec<u8> {
        if self.json.get("buffers").is_none() {
            self.json["buffers"] = json!([{ "byteLength": self.buffer.len() }]);
        }
        glb(&[(b"JSON", &self.json_bytes()), (b"BIN\0", &self.buffer)])
    }

    fn read(self) -> MeshData {
        self.try_read(None).unwrap_or_else(|error| panic!("{error}"))
    }

    fn try_read(self, mesh: Option<&str>) -> Result<MeshData, MeshError> {
        let options = GltfOptions { mesh: mesh.map(str::to_owned), ..GltfOptions::default() };
        ControlMesh::from_gltf_bytes(&self.glb(), &options).map(ControlMesh::into_data)
    }

    #[track_caller]
    fn assert_error(self, expected: &str) {
        assert_eq!(self.try_read(None).unwrap_err().to_string(), expected);
    }
}

const SQUARE: [[f32; 3]; 4] = [[0., 0., 0.], [1., 0., 0.], [1., 1., 0.], [0., 1., 0.]];

/// A GLB of these chunks.
fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
    let length = 12 + chunks.iter().map(|(_, bytes)| 8 + bytes.len()).sum::<usize>();
    let mut glb = b"glTF\x02\0\0\0".to_vec();
    glb.extend((length as u32).to_le_bytes());
    for (kind, bytes) in chunks {
        glb.extend((bytes.len() as u32).to_le_bytes());
        glb.extend(*kind);
        glb.extend(*bytes);
    }
    glb
}
