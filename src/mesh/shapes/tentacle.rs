//! A tentacle that waves, curls and swallows: a skin of four influences a vertex, and morph targets.

use super::with_atlas;
use crate::mesh::animation::{
    Animations, Binding, Clip, Influence, Interpolation, Keys, Node, Part, Path, Placement, Rig, Skin, Track,
};
use crate::mesh::{Animated, ControlMesh, MeshData, MeshError, Repairs};
use glam::{DMat4, DQuat, DVec3};
use std::f64::consts::TAU;

const RINGS: u32 = 17;
/// Vertices of a ring: the border of a square of two by two quads.
const RING: [[f64; 2]; 8] = [[1., 0.], [1., 1.], [0., 1.], [-1., 1.], [-1., 0.], [-1., -1.], [0., -1.], [1., -1.]];
const LOW: f64 = -1.5;
const HEIGHT: f64 = 3.0;
const JOINTS: u32 = 7;
/// Bulges, one a morph target.
const BULGES: u32 = 4;

/// The control mesh.
pub(super) fn mesh() -> Result<ControlMesh, MeshError> {
    let ring = |ring: u32| {
        let along = f64::from(ring) / f64::from(RINGS - 1);
        // A foot, and a tip.
        let radius = 0.03 + 0.33 * (1.0 - along) + 0.25 * (-12.0 * along).exp();
        RING.map(|[x, z]| [radius * x / x.hypot(z), LOW + HEIGHT * along, -radius * z / x.hypot(z)])
    };
    let mut data = MeshData { positions: (0..RINGS).flat_map(ring).collect(), ..MeshData::default() };
    let count = RING.len() as u32;
    for first in (0..RINGS - 1).map(|ring| ring * count) {
        let quad = |k: u32| [first + k, first + (k + 1) % count, first + count + (k + 1) % count, first + count + k];
        data.face_vertices.extend((0..count).flat_map(quad));
    }
    for (first, up) in [(0, false), ((RINGS - 1) * count, true)] {
        let centre = data.positions.len() as u32;
        data.positions.push([0.0, data.positions[first as usize][1], 0.0]);
        for k in (0..count).step_by(2) {
            let mut quad = [centre, first + k, first + (k + 1) % count, first + (k + 2) % count];
            if !up {
                quad[1..].reverse();
            }
            data.face_vertices.extend(quad);
        }
    }
    data.face_sizes = vec![4; data.face_vertices.len() / 4];
    with_atlas(data)
}

/// The control mesh and its animations.
pub(super) fn animated() -> Result<Animated, MeshError> {
    let mesh = mesh()?;
    let nodes: Vec<Node> = (0..=JOINTS).map(node).collect();
    let joints: Vec<u32> = (0..JOINTS).collect();
    let inverse_binds = joints.iter().map(|&joint| DMat4::from_translation(-joint_position(joint))).collect();
    let rig = Rig { order: (0..=JOINTS).collect(), nodes, skins: vec![Skin { joints, inverse_binds }] };
    let animations =
        Animations { rig, clips: vec![wave(), curl(), swallow()], binding: binding(&mesh), notes: Vec::new() };
    Ok(Animated { mesh, repairs: Repairs::default(), animations })
}

fn joint_position(joint: u32) -> DVec3 {
    DVec3::Y * (LOW + HEIGHT * f64::from(joint) / f64::from(JOINTS - 1))
}

/// The joints from the foot to the tip, then the node that has the mesh.
fn node(number: u32) -> Node {
    let parent = number.checked_sub(1).filter(|_| number < JOINTS);
    let translation = match parent {
        None if number == 0 => joint_position(0),
        None => DVec3::ZERO,
        Some(parent) => joint_position(number) - joint_position(parent),
    };
    let weights = if number == JOINTS { vec![0.0; BULGES as usize] } else { Vec::new() };
    Node { parent, rest: Placement::Parts { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE }, weights }
}

fn binding(mesh: &ControlMesh) -> Binding {
    let mut binding = Binding::default();
    let targets = vec![Vec::new(); BULGES as usize];
    binding.add_part(Part { node: Some(JOINTS), skin: Some(0), targets });
    for vertex in 0..mesh.vertex_count() as u32 {
        let position = mesh.position(vertex);
        let along = (position.y - LOW) / HEIGHT;
        for bulge in 0..BULGES {
            let middle = (f64::from(bulge) + 0.5) / f64::from(BULGES);
            let swell = 0.2 * (-(7.0 * (along - middle)).powi(2)).exp();
            let outwards = position.with_y(0.0).normalize_or_zero();
            binding.part_mut(0).targets[bulge as usize].push((vertex, swell * outwards));
        }
        binding.add_vertex(0, position, &influences(along));
    }
    binding
}

/// Weights of a uniform cubic B-spline with the joints as its knots.
fn influences(along: f64) -> [Influence; 4] {
    let place = along * f64::from(JOINTS - 1);
    let before = place.floor().min(f64::from(JOINTS - 2));
    let t = place - before;
    let u = 1.0 - t;
    let weights = [u * u * u, 4.0 - 6.0 * t * t + 3.0 * t * t * t, 4.0 - 6.0 * u * u + 3.0 * u * u * u, t * t * t];
    std::array::from_fn(|k| {
        let joint = (before as i32 + k as i32 - 1).clamp(0, JOINTS as i32 - 1);
        Influence { joint: joint as u32, weight: weights[k] / 6.0 }
    })
}

/// Rotations of all joints at evenly spaced times, in degrees about x and z.
fn rotations(name: &str, seconds: f64, steps: u32, degrees: impl Fn(u32, f64) -> [f64; 2]) -> Clip {
    let track = |node: u32| {
        let part = |step: u32| f64::from(step) / f64::from(steps);
        let rotation = |step: u32| {
            let [x, z] = degrees(node, part(step)).map(f64::to_radians);
            (DQuat::from_rotation_z(z) * DQuat::from_rotation_x(x)).to_array()
        };
        let times = (0..=steps).map(|step| seconds * part(step)).collect();
        let keys = Keys::new(Interpolation::Linear, times, (0..=steps).flat_map(rotation).collect(), 4);
        keys.map(|keys| Track { node, path: Path::Rotation, keys })
    };
    Clip { name: Some(name.into()), tracks: (0..JOINTS).filter_map(track).collect() }
}

fn wave() -> Clip {
    rotations("wave", 2.0, 16, |joint, part| {
        let swing = |phase: f64| (TAU * (part - phase - f64::from(joint) / 8.0)).sin();
        [8.0 * swing(0.25), 18.0 * swing(0.0)]
    })
}

fn curl() -> Clip {
    rotations("curl", 2.0, 16, |joint, part| {
        let amount = (1.0 - (TAU * part).cos()) / 2.0;
        [0.0, -amount * (10.0 + 8.0 * f64::from(joint))]
    })
}

/// The bulges rise and fall one after the other.
fn swallow() -> Clip {
    let steps = BULGES + 1;
    let times = (0..=steps).map(|step| f64::from(step) * 0.4).collect();
    let risen = |step: u32| (0..BULGES).map(move |bulge| f64::from(u8::from(bulge + 1 == step)));
    // Without speed at the keys.
    let values = (0..=steps).flat_map(|step| {
        let still = std::iter::repeat_n(0.0, BULGES as usize);
        still.clone().chain(risen(step)).chain(still)
    });
    let keys = Keys::new(Interpolation::CubicSpline, times, values.collect(), BULGES as usize);
    let track = keys.map(|keys| Track { node: JOINTS, path: Path::Weights, keys });
    Clip { name: Some("swallow".into()), tracks: track.into_iter().collect() }
}
