//! What is done with any bytes. Nothing may panic, run for long or use up memory; what is mended must be a mesh.

#![allow(dead_code, reason = "each target uses one")]

use ash_subdiv::mesh::{Change, Corner, Crease, Edit, FaceVarying, MeshError, ObjOptions, RepairOptions, Repairs};
use ash_subdiv::{ControlMesh, MeshData};

const TOLERANCES: [Option<f64>; 3] = [None, Some(0.0), Some(0.01)];

pub fn obj(bytes: &[u8]) {
    for drop_isolated in [false, true] {
        let _ = ControlMesh::from_obj_bytes(bytes, &ObjOptions { drop_isolated });
    }
    for weld in TOLERANCES {
        check(ControlMesh::from_obj_bytes_repaired(bytes, &RepairOptions { weld }));
    }
}

pub fn ply(bytes: &[u8]) {
    let _ = ControlMesh::from_ply_bytes(bytes);
    for weld in TOLERANCES {
        check(ControlMesh::from_ply_bytes_repaired(bytes, &RepairOptions { weld }));
    }
}

pub fn gltf(bytes: &[u8]) {
    use ash_subdiv::mesh::GltfOptions;
    let named = GltfOptions { mesh: Some("node".into()), quads: true, ..GltfOptions::default() };
    for options in [GltfOptions::default(), named] {
        let _ = ControlMesh::from_gltf_bytes(bytes, &options);
        check(ControlMesh::from_gltf_bytes_repaired(bytes, &options, &RepairOptions::default()));
        let animated = ControlMesh::from_gltf_bytes_animated(bytes, &options, Some(&RepairOptions::default()));
        if let Ok(animated) = animated {
            check_mesh(&animated.mesh);
            for animation in 0..animated.animations.len() {
                let _ = animated.animations.skinning(animation, 0.5);
                let mut positions = vec![[0.0; 3]; animated.mesh.vertex_count()];
                let _ = animated.animations.positions(animation, 0.5, &mut positions);
            }
        }
    }
}

pub fn picture(bytes: &[u8]) {
    use ash_subdiv::headless::Texels;
    for vectors in [false, true] {
        if let Ok(texels) = Texels::decode_up_to(bytes, vectors, 1 << 20) {
            assert_eq!(texels.values.len(), (texels.width * texels.height * texels.channels) as usize);
            assert!(texels.values.iter().all(|value| value.is_finite()));
        }
    }
}

/// Arrays out of bytes.
pub fn mesh(bytes: &[u8]) {
    let data = arrays(&mut Numbers { rest: bytes });
    let _ = ControlMesh::new(data.clone());
    for weld in TOLERANCES {
        check(ControlMesh::repaired(data.clone(), &RepairOptions { weld }));
    }
}

/// What can be mended is.
fn check(repaired: Result<(ControlMesh, Repairs), MeshError>) {
    match repaired {
        Ok((mesh, repairs)) => {
            let _: Vec<u32> = (0..mesh.vertex_count() as u32).map(|vertex| repairs.given_vertex(vertex)).collect();
            let _: Vec<u32> = (0..mesh.face_count() as u32).map(|face| repairs.given_face(face)).collect();
            check_mesh(&mesh);
        }
        Err(error) => assert!(is_beyond_repair(&error), "{error}"),
    }
}

fn is_beyond_repair(error: &MeshError) -> bool {
    match error {
        MeshError::AtLine { error, .. } | MeshError::InFile { error, .. } => is_beyond_repair(error),
        MeshError::Empty { .. }
        | MeshError::NotFinite { .. }
        | MeshError::IndexOutOfRange { .. }
        | MeshError::CornerCount { .. }
        | MeshError::BadEdit { .. }
        | MeshError::TooLarge { .. }
        | MeshError::BeyondLimit { .. }
        | MeshError::Syntax { .. }
        | MeshError::Format { .. }
        | MeshError::UnknownMesh { .. } => true,
        _ => false,
    }
}

/// Half-edges go together, and the mesh is one again.
fn check_mesh(mesh: &ControlMesh) {
    let next = |h: usize| {
        let face = mesh.face_offsets().partition_point(|&offset| offset as usize <= h) - 1;
        let corners = mesh.face_corners(face as u32);
        if h + 1 == corners.end { corners.start } else { h + 1 }
    };
    let vertices = &mesh.data().face_vertices;
    for (h, &twin) in mesh.twins().iter().enumerate().filter(|(_, twin)| **twin != u32::MAX) {
        assert_eq!(mesh.twins()[twin as usize] as usize, h);
        assert_eq!([vertices[h], vertices[next(h)]], [vertices[next(twin as usize)], vertices[twin as usize]]);
    }
    let again = ControlMesh::new(mesh.data().clone()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(again.twins(), mesh.twins());
}

/// Numbers out of bytes; zeros at their end.
struct Numbers<'b> {
    rest: &'b [u8],
}

impl Numbers<'_> {
    fn byte(&mut self) -> u8 {
        let Some((&byte, rest)) = self.rest.split_first() else { return 0 };
        self.rest = rest;
        byte
    }

    /// Mostly below `count`, and now and then anything.
    fn index(&mut self, count: usize) -> u32 {
        match self.byte() {
            255 => u32::from_le_bytes(std::array::from_fn(|_| self.byte())),
            254 => count as u32,
            byte => u32::from(byte) % (count as u32).max(1),
        }
    }

    fn float(&mut self) -> f64 {
        const ODD: [f64; 8] = [f64::NAN, f64::INFINITY, -1e39, 3.4e38, 1e-310, -0.0, 1e30, -1.0];
        match self.byte() {
            byte @ 248.. => ODD[usize::from(byte - 248)],
            byte => f64::from(byte % 8),
        }
    }
}

fn arrays(numbers: &mut Numbers) -> MeshData {
    let vertices = usize::from(numbers.byte() % 16);
    let faces = usize::from(numbers.byte() % 24);
    let tags = numbers.byte();
    let mut data = MeshData {
        positions: (0..vertices).map(|_| std::array::from_fn(|_| numbers.float())).collect(),
        ..MeshData::default()
    };
    for _ in 0..faces {
        let size = u32::from(numbers.byte() % 7);
        data.face_sizes.push(size);
        data.face_vertices.extend((0..size).map(|_| numbers.index(vertices)));
    }
    let corners = data.face_vertices.len();
    if tags & 1 != 0 {
        let values: Vec<[f32; 2]> = (0..numbers.byte() % 8).map(|_| [numbers.float() as f32, 0.5]).collect();
        let indices = (0..corners).map(|_| numbers.index(values.len())).collect();
        data.texcoords = Some(FaceVarying { values, indices });
    }
    if tags & 2 != 0 {
        data.creases = (0..numbers.byte() % 8)
            .map(|_| Crease {
                vertices: [numbers.index(vertices), numbers.index(vertices)],
                sharpness: numbers.float() as f32,
            })
            .collect();
        data.corners = (0..numbers.byte() % 8)
            .map(|_| Corner { vertex: numbers.index(vertices), sharpness: numbers.float() as f32 })
            .collect();
    }
    if tags & 4 != 0 {
        data.holes = (0..numbers.byte() % 4).map(|_| numbers.index(faces)).collect();
    }
    if tags & 8 != 0 {
        data.edits = (0..numbers.byte() % 4).map(|_| edit(numbers, faces)).collect();
    }
    // Arrays that do not go together.
    if tags == 255 {
        data.face_vertices.pop();
    }
    data
}

fn edit(numbers: &mut Numbers, faces: usize) -> Edit {
    let face = numbers.index(faces);
    let children = (0..numbers.byte() % 4).map(|_| numbers.index(4)).collect();
    let place: [f64; 3] = std::array::from_fn(|_| numbers.float());
    let change = match numbers.byte() % 6 {
        0 => Change::Offset { corner: numbers.index(4), offset: place },
        1 => Change::Position { corner: numbers.index(4), position: place },
        2 => Change::FrameOffset { corner: numbers.index(4), offset: place },
        3 => Change::CornerSharpness { corner: numbers.index(4), sharpness: place[0] as f32 },
        4 => Change::EdgeSharpness { edge: numbers.index(4), sharpness: place[0] as f32 },
        _ => Change::Hole,
    };
    Edit { face, children, change }
}
