//! Animations, against matrices that are multiplied here: no code is shared with what is tested.

mod broken;
mod interpolation;
mod skins;

use super::*;
use crate::mesh::{Animated, Animations};

/// A matrix, row by row.
type Matrix = [[f64; 4]; 4];

fn times(a: Matrix, b: Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..4).map(|k| a[i][k] * b[k][j]).sum()))
}

fn apply(m: Matrix, p: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|k| m[i][k] * p[k]).sum::<f64>() + m[i][3])
}

fn translation([x, y, z]: [f64; 3]) -> Matrix {
    [[1., 0., 0., x], [0., 1., 0., y], [0., 0., 1., z], [0., 0., 0., 1.]]
}

fn scale([x, y, z]: [f64; 3]) -> Matrix {
    [[x, 0., 0., 0.], [0., y, 0., 0.], [0., 0., z, 0.], [0., 0., 0., 1.]]
}

/// By Rodrigues' formula, about an axis of length one.
fn turn([x, y, z]: [f64; 3], angle: f64) -> Matrix {
    let (s, c) = angle.sin_cos();
    let k = 1.0 - c;
    [
        [c + x * x * k, x * y * k - z * s, x * z * k + y * s, 0.],
        [y * x * k + z * s, c + y * y * k, y * z * k - x * s, 0.],
        [z * x * k - y * s, z * y * k + x * s, c + z * z * k, 0.],
        [0., 0., 0., 1.],
    ]
}

/// By a quaternion of a file, which is a unit only to single precision.
fn turn_by(q: [f32; 4]) -> Matrix {
    let [x, y, z, w] = q.map(f64::from);
    let length = (x * x + y * y + z * z).sqrt();
    turn([x / length, y / length, z / length], 2.0 * length.atan2(w))
}

/// As a file has it.
fn quaternion([x, y, z]: [f64; 3], angle: f64) -> [f32; 4] {
    let (s, c) = (angle / 2.0).sin_cos();
    [x * s, y * s, z * s, c].map(|x| x as f32)
}

const AXIS: [f64; 3] = [2. / 3., -1. / 3., 2. / 3.];

fn sum(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

impl File {
    fn animated(self) -> Animated {
        self.try_animated().unwrap_or_else(|error| panic!("{error}"))
    }

    fn try_animated(self) -> Result<Animated, MeshError> {
        ControlMesh::from_gltf_bytes_animated(&self.glb(), &GltfOptions::default(), None)
    }

    /// A sampler of animation 0 and a channel that moves `path` of `node` with it.
    fn channel(&mut self, node: usize, path: &str, times: &[f32], output: usize, interpolation: &str) {
        let input: Vec<[f32; 1]> = times.iter().map(|&time| [time]).collect();
        let input = self.floats(&input);
        if self.json.get("animations").is_none() {
            self.json["animations"] = json!([{ "channels": [], "samplers": [] }]);
        }
        let animation = &mut self.json["animations"][0];
        let samplers = animation["samplers"].as_array_mut().unwrap();
        samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        let sampler = samplers.len() - 1;
        let channel = json!({ "sampler": sampler, "target": { "node": node, "path": path } });
        animation["channels"].as_array_mut().unwrap().push(channel);
    }

    /// Sixteen numbers an element, from rows.
    fn matrices(&mut self, matrices: &[Matrix]) -> usize {
        let by_columns = |m: &Matrix| (0..16).map(|i| m[i % 4][i / 4] as f32).collect::<Vec<_>>();
        let bytes: Vec<u8> = matrices.iter().flat_map(by_columns).flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, matrices.len(), "MAT4", 5126)
    }
}

fn positions(animated: &Animated, seconds: f64) -> Vec<[f64; 3]> {
    let mut positions = vec![[0.0; 3]; animated.mesh.vertex_count()];
    animated.animations.positions_f64(0, seconds, &mut positions).unwrap();
    // The two precisions are of the same numbers.
    let mut single = vec![[0.0f32; 3]; positions.len()];
    animated.animations.positions(0, seconds, &mut single).unwrap();
    assert_eq!(single, positions.iter().map(|p| p.map(|x| x as f32)).collect::<Vec<_>>());
    // And what a shader makes of what it is given.
    let given = animated.animations.skinning(0, seconds).unwrap();
    let largest = single.as_flattened().iter().fold(1.0f32, |largest, x| largest.max(x.abs()));
    let of_vertices = animated.animations.influences();
    assert!(given.positions.len() == single.len() && of_vertices.len() == single.len());
    for ((rest, of), expected) in given.positions.iter().zip(of_vertices).zip(&single) {
        let rest = glam::Vec3::from(*rest);
        let skin = |moved, &(matrix, weight): &(u32, f32)| {
            moved + weight * glam::Mat4::from_cols_array_2d(&given.matrices[matrix as usize]).transform_point3(rest)
        };
        let moved = if of.is_empty() { rest } else { of.iter().fold(glam::Vec3::ZERO, skin) };
        assert!(moved.distance((*expected).into()) < 5e-6 * largest, "{moved} {expected:?}");
    }
    positions
}

#[track_caller]
fn assert_near(found: &[[f64; 3]], expected: &[[f64; 3]], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (vertex, (a, b)) in found.iter().zip(expected).enumerate() {
        let distance = (0..3).map(|i| (a[i] - b[i]).abs()).fold(0.0, f64::max);
        assert!(distance <= tolerance, "vertex {vertex}: {a:?}, not {b:?}");
    }
}

/// The square at node 0, in a scene.
fn square_at_node() -> File {
    let mut file = File::square();
    file.json["nodes"] = json!([{ "mesh": 0 }]);
    file.json["scenes"] = json!([{ "nodes": [0] }]);
    file
}
