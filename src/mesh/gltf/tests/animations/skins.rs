//! Skins and morph targets, on vertices that readers join and repairs part.

use super::*;
use crate::mesh::RepairOptions;

const JOINTS: usize = 10;

/// Numbers that look random, from -1 to 1.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // As a file can have it.
        f64::from(((self.0 >> 33) as f64 / f64::from(1u32 << 30) - 1.0) as f32)
    }

    fn vector(&mut self) -> [f64; 3] {
        [self.next(), self.next(), self.next()]
    }
}

/// Two by two quads.
fn grid() -> File {
    let positions: Vec<[f32; 3]> =
        (0..9u8).map(|v| [f32::from(v % 3), f32::from(v / 3), 0.25 * f32::from(v)]).collect();
    let quads = [0u16, 1, 3, 4].map(|v| [v, v + 1, v + 4, v, v + 4, v + 3]);
    let mut file = File::new(&positions, quads.as_flattened());
    file.primitive_mut()["extensions"] = json!({ NGONS: {} });
    file
}

/// What a file says about a vertex: joints and weights.
type Bound = Vec<Vec<(usize, f64)>>;

/// Binds each vertex of the grid to some joints, in sets of four.
fn bind(file: &mut File, numbers: &mut Numbers, influences: usize) -> Bound {
    let bound: Bound = (0..9)
        .map(|vertex| {
            let weights: Vec<f64> = (0..influences).map(|_| f64::from((numbers.next() + 1.1) as f32)).collect();
            weights.into_iter().enumerate().map(|(k, weight)| ((3 * vertex + k) % JOINTS, weight)).collect()
        })
        .collect();
    let set = |k: usize, vertex: usize| -> [(usize, f64); 4] {
        std::array::from_fn(|i| bound[vertex].get(4 * k + i).copied().unwrap_or((0, 0.0)))
    };
    for k in 0..influences.div_ceil(4) {
        // Scaled by the reader: every vertex's weights by their sum.
        let bytes: Vec<u8> =
            (0..9).flat_map(|v| set(k, v)).flat_map(|(joint, _)| (joint as u16).to_le_bytes()).collect();
        let joints = file.accessor(&bytes, 9, "VEC4", 5123);
        let weights: Vec<[f32; 4]> = (0..9).map(|v| set(k, v).map(|(_, weight)| weight as f32)).collect();
        let weights = file.floats(&weights);
        file.primitive_mut()["attributes"][format!("JOINTS_{k}")] = json!(joints);
        file.primitive_mut()["attributes"][format!("WEIGHTS_{k}")] = json!(weights);
    }
    bound
}

/// A chain of joints from node 1 on under a node that is moved too; each turns about its own axis. Gives their global transforms at
/// the end, and the inverse bind matrices.
fn skeleton(file: &mut File, numbers: &mut Numbers) -> (Vec<Matrix>, Vec<Matrix>) {
    // The skinned node's own transform is not to count.
    file.json["nodes"] = json!([{ "mesh": 0, "skin": 0, "translation": [5, 6, 7], "scale": [2, 2, 2] }]);
    let above = numbers.vector();
    let node = JOINTS + 1;
    let (mut global, mut globals, mut binds) = (translation(above), Vec::new(), Vec::new());
    for joint in 0..JOINTS {
        let (place, angle) = (numbers.vector(), numbers.next());
        let children = if joint + 1 < JOINTS { vec![joint + 2] } else { Vec::new() };
        file.push("nodes", json!({ "translation": place, "children": children }));
        let end = quaternion(AXIS, angle);
        let output = file.floats(&[quaternion(AXIS, 0.0), end]);
        file.channel(joint + 1, "rotation", &[0.0, 1.0], output, "LINEAR");
        global = times(global, times(translation(place), turn_by(end)));
        globals.push(global);
        binds.push(times(translation(numbers.vector()), scale([1.0, 2.0, 0.5])));
    }
    file.push("nodes", json!({ "translation": above, "children": [1] }));
    file.json["scenes"] = json!([{ "nodes": [0, node] }]);
    let matrices = file.matrices(&binds);
    let joints: Vec<usize> = (1..=JOINTS).collect();
    file.json["skins"] = json!([{ "joints": joints, "inverseBindMatrices": matrices }]);
    (globals, binds)
}

fn skinned(position: [f64; 3], bound: &[(usize, f64)], globals: &[Matrix], binds: &[Matrix]) -> [f64; 3] {
    let total: f64 = bound.iter().map(|(_, weight)| weight).sum();
    bound.iter().fold([0.0; 3], |moved, &(joint, weight)| {
        sum(moved, weight / total, apply(times(globals[joint], binds[joint]), position))
    })
}

#[test]
fn skins_of_one_four_eight_and_nine_influences() {
    for influences in [1, 4, 8, 9] {
        let (mut file, mut numbers) = (grid(), Numbers(influences as u64));
        let bound = bind(&mut file, &mut numbers, influences);
        let (globals, binds) = skeleton(&mut file, &mut numbers);
        let animated = file.animated();
        let rest = &animated.mesh.data().positions;
        let expected: Vec<_> = (0..9).map(|v| skinned(rest[v], &bound[grid_vertex(v)], &globals, &binds)).collect();
        assert_near(&positions(&animated, 1.0), &expected, 1e-12);
        assert!(animated.animations.notes()[0].ends_with("that do not add up to one: they are scaled"));
        assert_eq!(animated.animations.influences().iter().map(Vec::len).max(), Some(influences));
    }
}

/// The vertex of the file that a vertex of the mesh is: faces name them in this order.
fn grid_vertex(vertex: usize) -> usize {
    [0, 1, 4, 3, 2, 5, 7, 6, 8][vertex]
}

#[test]
fn morph_targets_come_before_skins() {
    let (mut file, mut numbers) = (grid(), Numbers(7));
    let bound = bind(&mut file, &mut numbers, 4);
    let (globals, binds) = skeleton(&mut file, &mut numbers);
    let offsets: Vec<Vec<[f64; 3]>> = (0..2).map(|_| (0..9).map(|_| numbers.vector()).collect()).collect();
    let accessors = [0, 1].map(|t| file.floats(&offsets[t].iter().map(|o| o.map(|x| x as f32)).collect::<Vec<_>>()));
    // A third that moves vertex 4 only: sparse, over nothing.
    let (index, value) = (file.view(&4u16.to_le_bytes()), file.view(&[0u8; 12]));
    let sparse = json!({
        "count": 1,
        "indices": { "bufferView": index, "componentType": 5123 },
        "values": { "bufferView": value },
    });
    let third = file.push("accessors", json!({ "componentType": 5126, "count": 9, "type": "VEC3", "sparse": sparse }));
    let start = file.json["bufferViews"][value]["byteOffset"].as_u64().unwrap() as usize;
    file.buffer[start..start + 4].copy_from_slice(&8f32.to_le_bytes());
    let targets = [accessors[0], accessors[1], third].map(|accessor| json!({ "POSITION": accessor }));
    file.primitive_mut()["targets"] = json!(targets);
    // From (0, 1, 0.5) to (1, -1, 0.5), and halfway there at the end.
    let output = file.floats(&[[0.0f32], [1.0], [0.5], [1.0], [-1.0], [0.5]]);
    file.channel(0, "weights", &[0.5, 1.5], output, "LINEAR");
    let animated = file.animated();
    let rest = animated.mesh.data().positions.clone();
    let expected: Vec<_> = (0..9)
        .map(|v| {
            let of = grid_vertex(v);
            let morphed = sum(rest[v], 0.5, offsets[0][of]);
            let morphed = sum(morphed, 0.0, offsets[1][of]);
            let morphed = sum(morphed, 0.5, if of == 4 { [8., 0., 0.] } else { [0.0; 3] });
            skinned(morphed, &bound[of], &globals, &binds)
        })
        .collect();
    assert_near(&positions(&animated, 1.0), &expected, 1e-12);
}

#[test]
fn weights_of_morph_targets_are_the_nodes_or_else_the_meshs_or_else_zero() {
    let moved = |of_mesh: Value, of_node: Value| {
        let mut file = square_at_node();
        let offsets = file.floats(&[[0.0f32, 0.0, 1.0]; 4]);
        file.primitive_mut()["targets"] = json!([{ "POSITION": offsets }, { "NORMAL": offsets }]);
        file.json["meshes"][0]["weights"] = of_mesh;
        file.json["nodes"][0]["weights"] = of_node;
        let output = file.floats(&[[3.0f32, 0.0, 0.0]]);
        file.channel(0, "translation", &[0.0], output, "STEP");
        let animated = file.animated();
        positions(&animated, 0.0)[0]
    };
    assert_eq!(moved(Value::Null, Value::Null), [3., 0., 0.]);
    assert_eq!(moved(json!([0.5, 9]), Value::Null), [3., 0., 0.5]);
    assert_eq!(moved(json!([0.5, 9]), json!([2, 9])), [3., 0., 2.]);
}

/// Triangles of which vertex v of the file rises by v + 1.
fn rising(positions: &[[f32; 3]], triangles: &[u16]) -> Animated {
    let mut file = File::new(positions, triangles);
    file.json["nodes"] = json!([{ "mesh": 0 }]);
    file.json["scenes"] = json!([{ "nodes": [0] }]);
    let offsets: Vec<[f32; 3]> = (0..positions.len()).map(|v| [0.0, 0.0, v as f32 + 1.0]).collect();
    let offsets = file.floats(&offsets);
    file.primitive_mut()["targets"] = json!([{ "POSITION": offsets }]);
    let output = file.floats(&[[1.0f32]]);
    file.channel(0, "weights", &[0.0], output, "STEP");
    let (options, repair) = (GltfOptions::default(), RepairOptions::default());
    ControlMesh::from_gltf_bytes_animated(&file.glb(), &options, Some(&repair)).unwrap()
}

const CORNERS: [[f32; 3]; 5] = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., -1., 0.], [-1., 0., 0.]];

#[test]
fn what_the_reader_joins_follows_its_first_vertex() {
    // Two triangles at one edge, each with vertices of its own; vertex 2 is in neither.
    let [a, b, c, d, unused] = CORNERS;
    let animated = rising(&[a, b, unused, c, b, a, d], &[0, 1, 3, 4, 5, 6]);
    let rest = &animated.mesh.data().positions;
    assert_eq!(*rest, [a, b, c, d].map(|p| p.map(f64::from)));
    let heights: Vec<f64> = positions(&animated, 0.0).iter().map(|p| p[2]).collect();
    assert_eq!(heights, [1., 2., 4., 7.]);
}

#[test]
fn what_repair_parts_follows_what_it_was() {
    // Three triangles at the edge from 0 to 1.
    let animated = rising(&CORNERS, &[0, 1, 2, 1, 0, 3, 0, 1, 4]);
    let rest = &animated.mesh.data().positions;
    assert!(rest.len() > 5, "the edge is parted");
    for (before, after) in rest.iter().zip(positions(&animated, 0.0)) {
        let was = CORNERS.iter().position(|corner| corner.map(f64::from) == *before).unwrap();
        assert_eq!(after[2], was as f64 + 1.0, "{before:?}");
    }
}

/// The square with one joint that rises by one, and these weights at every vertex.
fn one_joint(weights: [f32; 4], joints: [u8; 4]) -> File {
    let mut file = square_at_node();
    let joints = file.accessor(&[joints; 4].concat(), 4, "VEC4", 5121);
    let weights = file.floats(&[weights; 4]);
    file.primitive_mut()["attributes"]["JOINTS_0"] = json!(joints);
    file.primitive_mut()["attributes"]["WEIGHTS_0"] = json!(weights);
    file.json["nodes"] = json!([{ "mesh": 0, "skin": 0 }, {}]);
    file.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    file.json["skins"] = json!([{ "joints": [1] }]);
    let output = file.floats(&[[0.0f32, 0.0, 0.0], [0.0, 0.0, 1.0]]);
    file.channel(1, "translation", &[0.0, 1.0], output, "LINEAR");
    file
}

#[test]
fn one_joint_without_matrices_and_weights_that_are_odd() {
    let rise = |file: File| {
        let animated = file.animated();
        (positions(&animated, 0.5)[0], animated.animations.notes().to_vec())
    };
    assert_eq!(rise(one_joint([1., 0., 0., 0.], [0; 4])), ([0., 0., 0.5], vec![]));
    // Joints without weight may be any.
    assert_eq!(rise(one_joint([1., 0., 0., 0.], [0, 9, 9, 9])), ([0., 0., 0.5], vec![]));
    let (place, notes) = rise(one_joint([0.5, 0.25, 0., 0.], [0; 4]));
    assert_eq!(place, [0., 0., 0.5]);
    assert_eq!(notes, ["4 vertices have weights of joints that do not add up to one: they are scaled"]);
    let (place, notes) = rise(one_joint([0.; 4], [0; 4]));
    assert_eq!(place, [0., 0., 0.5]);
    assert_eq!(notes, ["4 vertices have joints without weight: the first is followed"]);
    // Bytes of which 255 are one.
    let mut file = one_joint([1., 0., 0., 0.], [0; 4]);
    let weights = file.accessor(&[255, 0, 0, 0].repeat(4), 4, "VEC4", 5121);
    file.json["accessors"][weights]["normalized"] = json!(true);
    file.primitive_mut()["attributes"]["WEIGHTS_0"] = json!(weights);
    assert_eq!(rise(file), ([0., 0., 0.5], vec![]));
    // A skin, but no joints at the vertices: they stay where they are read.
    let mut file = one_joint([1., 0., 0., 0.], [0; 4]);
    file.primitive_mut()["attributes"].as_object_mut().unwrap().retain(|name, _| name == "POSITION");
    assert_eq!(rise(file), ([0., 0., 0.], vec![]));
}

/// Two nodes with the same mesh, each moved on its own.
#[test]
fn nodes_have_matrices_of_their_own() {
    let mut file = grid();
    file.json["nodes"] = json!([{ "mesh": 0 }, { "mesh": 0, "translation": [0, 0, 9] }]);
    file.json["scenes"] = json!([{ "nodes": [0, 1] }]);
    for (node, end) in [[7.0f32, 0.0, 0.0], [0.0, 20.0, 0.0]].iter().enumerate() {
        let output = file.floats(&[[0.0; 3], *end]);
        file.channel(node, "translation", &[0.0, 1.0], output, "LINEAR");
    }
    let animated = file.animated();
    let [rest, moved] = [0.0, 1.0].map(|seconds| positions(&animated, seconds));
    assert_eq!(moved.len(), 18);
    let ways = rest.iter().zip(&moved).map(|(a, b)| [b[0] - a[0], b[1] - a[1], b[2] - a[2]]);
    let of_both = [[7.0, 0.0, 0.0], [0.0, 20.0, 0.0]].map(|way| ways.clone().filter(|w| *w == way).count());
    assert_eq!(of_both, [9, 9]);
}
