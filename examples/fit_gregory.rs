//! Fits the numbers of `patch::fitted::Fit` to limit surfaces and prints them:
//!
//! ```sh
//! cargo run --release --example fit_gregory
//! ```
//!
//! Training set: random meshes of triangles and quads, closed and open, as they are and refined once and shaken. Gauss-Newton
//! from Gregory's own patches. What the result is worth elsewhere, `subdiv error` tells.

use ash_subdiv::limit::{LimitSurface, refine};
use ash_subdiv::patch::fitted::{Fit, fitted_frame, fitted_transversal};
use ash_subdiv::patch::gregory::gregory_points;
use ash_subdiv::patch::{PatchCorner, RingValues, Scheme};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{ControlMesh, MeshData, MeshError};
use glam::DVec3;
use random::{Random, random_mesh};
use rayon::prelude::*;

#[allow(dead_code, reason = "tests use the rest")]
#[path = "../tests/common/random.rs"]
mod random;

/// Numbers of a [`Fit`].
const N: usize = 6;
/// Random meshes, each of which is used in two ways.
const SEEDS: std::ops::Range<u64> = 0..96;
/// Samples along each side of a quad.
const SAMPLES: u32 = 6;
/// How far refined meshes are shaken, in lengths of the shortest edge at a vertex.
const SHAKE: f64 = 0.4;

fn main() -> Result<(), MeshError> {
    let meshes = training_set()?;
    let fit = fit(&meshes);
    println!("{fit:.3?}");
    for (name, what) in ["normals", "distances"].into_iter().zip(0..) {
        let square: f64 = meshes.iter().map(|mesh| errors(mesh, &fit)[what] / mesh.before[what]).sum();
        let ratio = (square / meshes.len() as f64).sqrt();
        println!("{name}: {ratio:.3} of Gregory's, root mean square over {} meshes", meshes.len());
    }
    Ok(())
}

/// A mesh of the training set: its irregular patches.
pub struct Training {
    patches: Vec<Patch>,
    /// [`errors`] of Gregory's patches.
    before: [f64; 2],
}

struct Patch {
    kind: PatchKind,
    /// Rings of the corners, with the edge of each that is the corner's plus edge.
    corners: Vec<(RingValues<DVec3>, usize)>,
    targets: Vec<Target>,
}

/// A point of the limit surface.
struct Target {
    /// Of the patch.
    parameters: [f64; 2],
    position: DVec3,
    normal: DVec3,
    /// That it stands for.
    area: f64,
}

/// The meshes to fit to.
pub fn training_set() -> Result<Vec<Training>, MeshError> {
    let mut meshes = Vec::new();
    for seed in SEEDS {
        let mesh = random_mesh(seed);
        let fine = refine(&Topology::new(&mesh))?.mesh;
        meshes.push(mesh);
        meshes.push(shaken(&fine, &mut Random::new(seed))?);
    }
    let trained = meshes.iter().map(Training::new).collect::<Result<Vec<_>, _>>()?;
    // Some have regular patches only.
    Ok(trained.into_iter().filter(|mesh| !mesh.patches.is_empty()).collect())
}

fn shaken(mesh: &ControlMesh, random: &mut Random) -> Result<ControlMesh, MeshError> {
    let mut shortest = vec![f64::INFINITY; mesh.vertex_count()];
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        for (&a, &b) in vertices.iter().zip(vertices.iter().cycle().skip(1)) {
            let length = mesh.position(a).distance(mesh.position(b));
            for vertex in [a, b] {
                shortest[vertex as usize] = shortest[vertex as usize].min(length);
            }
        }
    }
    let mut data = MeshData { texcoords: None, normals: None, ..mesh.data().clone() };
    for (position, length) in data.positions.iter_mut().zip(shortest) {
        *position = (DVec3::from(*position) + SHAKE * length * random.vector()).to_array();
    }
    ControlMesh::new(data)
}

impl Training {
    fn new(mesh: &ControlMesh) -> Result<Self, MeshError> {
        let topology = Topology::new(mesh);
        let limit = LimitSurface::new(mesh)?;
        let patch = |face: u32| {
            let kind = topology.patch_kind(face).filter(|&kind| kind != PatchKind::Regular)?;
            let corner = |h: usize| {
                let place = topology.place(h as u32);
                let ring = &topology.rings()[place.ring as usize];
                (RingValues::new(&topology, ring, |v| mesh.position(v)), place.index as usize)
            };
            let corners = mesh.face_corners(face).map(corner).collect();
            Some(Patch { kind, corners, targets: targets(&limit, face, kind) })
        };
        let faces = (0..mesh.face_count() as u32).into_par_iter();
        let mut training = Self { patches: faces.filter_map(patch).collect(), before: [0.0; 2] };
        training.before = errors(&training, &of_numbers([0.0; N]));
        Ok(training)
    }
}

/// The limit surface over a face at the middles of cells of equal size.
fn targets(limit: &LimitSurface, face: u32, kind: PatchKind) -> Vec<Target> {
    let (parts, side) = if kind == PatchKind::Triangle { (0..3, SAMPLES / 2) } else { (-1..0, SAMPLES) };
    let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
    let cells = || (0..side).flat_map(|j| (0..side).map(move |i| (i, j)));
    let target = |(part, (i, j)): (i32, (u32, u32))| {
        let (u, v) = (middle(i), middle(j));
        let sample = limit.evaluate(face, part, u, v);
        let area = sample.du.cross(sample.dv).length() / f64::from(side * side);
        Target { parameters: of_patch(part, u, v), position: sample.position, normal: sample.normal, area }
    };
    parts.flat_map(|part| cells().map(move |cell| (part, cell))).map(target).collect()
}

/// Parameters of a patch at those of a part of the limit surface: a triangle's are bilinear between corner, middles of
/// edges and centre, as `measure::surface_errors` has them.
fn of_patch(part: i32, u: f64, v: f64) -> [f64; 2] {
    if part < 0 {
        return [u, v];
    }
    let centre = u * v / 3.0;
    let (next, before) = (0.5 * u * (1.0 - v) + centre, 0.5 * (1.0 - u) * v + centre);
    let mut barycentric = [1.0 - next - before, next, before];
    barycentric.rotate_right(part as usize);
    [barycentric[0], barycentric[1]]
}

fn of_numbers([a, b, c, d, e, f]: [f64; N]) -> Fit {
    Fit { tangent: [a, b, c], lift: [d, e], triangle: f }
}

/// For each target: the difference of the normals, and the distance along the limit's normal. To first order that is the
/// distance between the surfaces, however they are parametrised.
fn residuals(patch: &Patch, fit: &Fit) -> Vec<(DVec3, f64)> {
    let frames: Vec<_> = patch.corners.iter().map(|(ring, _)| fitted_frame(ring, fit)).collect();
    let corners = patch.corners.iter().zip(&frames);
    let corners: Vec<_> = corners.map(|((ring, index), frame)| PatchCorner { ring, frame, index: *index }).collect();
    let points = gregory_points(&corners, |corner, j| fitted_transversal(corner.ring, corner.frame, j, fit));
    let residual = |target: &Target| {
        let [u, v] = target.parameters;
        let sample = Scheme::GregoryFitted.evaluate(patch.kind, &points, u, v);
        let weight = target.area.sqrt();
        let distance = (sample.position - target.position).dot(target.normal);
        (weight * (sample.normal - target.normal), weight * distance)
    };
    patch.targets.iter().map(residual).collect()
}

/// Sums of squares of both kinds of residuals.
fn errors(mesh: &Training, fit: &Fit) -> [f64; 2] {
    let of_patch = |patch: &Patch| {
        let add = |sum: [f64; 2], r: (DVec3, f64)| [sum[0] + r.0.length_squared(), sum[1] + r.1 * r.1];
        residuals(patch, fit).into_iter().fold([0.0; 2], add)
    };
    // Summed in order, whatever the threads.
    let of_patches: Vec<_> = mesh.patches.par_iter().map(of_patch).collect();
    of_patches.into_iter().fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// The least sum, over all meshes, of both errors over Gregory's.
pub fn fit(meshes: &[Training]) -> Fit {
    let mut numbers = [0.0; N];
    for _ in 0..5 {
        let mut normal_equations = ([[0.0; N]; N], [0.0; N]);
        for mesh in meshes {
            let terms: Vec<_> = mesh.patches.par_iter().map(|patch| step_terms(patch, numbers, mesh.before)).collect();
            for (matrix, right) in terms {
                for i in 0..N {
                    normal_equations.1[i] += right[i];
                    (0..N).for_each(|j| normal_equations.0[i][j] += matrix[i][j]);
                }
            }
        }
        let step = solve(normal_equations.0, normal_equations.1);
        (0..N).for_each(|i| numbers[i] -= step[i]);
    }
    of_numbers(numbers)
}

/// What a patch adds to the normal equations of a step.
fn step_terms(patch: &Patch, numbers: [f64; N], before: [f64; 2]) -> ([[f64; N]; N], [f64; N]) {
    const DIFFERENCE: f64 = 1e-5;
    let here = residuals(patch, &of_numbers(numbers));
    let derivatives: [Vec<(DVec3, f64)>; N] = std::array::from_fn(|i| {
        let mut moved = numbers;
        moved[i] += DIFFERENCE;
        let there = residuals(patch, &of_numbers(moved));
        here.iter().zip(there).map(|(a, b)| ((b.0 - a.0) / DIFFERENCE, (b.1 - a.1) / DIFFERENCE)).collect()
    });
    let product = |a: &[(DVec3, f64)], b: &[(DVec3, f64)]| -> f64 {
        a.iter().zip(b).map(|(a, b)| a.0.dot(b.0) / before[0] + a.1 * b.1 / before[1]).sum()
    };
    let row = |i: usize| std::array::from_fn(|j| product(&derivatives[i], &derivatives[j]));
    (std::array::from_fn(row), std::array::from_fn(|i| product(&derivatives[i], &here)))
}

/// Solves a system with a positive definite matrix.
fn solve(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    for i in 0..N {
        for below in i + 1..N {
            let factor = matrix[below][i] / matrix[i][i];
            (i..N).for_each(|j| matrix[below][j] -= factor * matrix[i][j]);
            right[below] -= factor * right[i];
        }
    }
    for i in (0..N).rev() {
        let known: f64 = (i + 1..N).map(|j| matrix[i][j] * right[j]).sum();
        right[i] = (right[i] - known) / matrix[i][i];
    }
    right
}
