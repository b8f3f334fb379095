//! What every evaluation on a uniform grid has: the vertices of the tessellation stages, and along edges the same bits.

use crate::common;
use crate::common::edges::{bits, edge_parameters, shared_edges};
use crate::common::stage::{Stage, begin, read_vertices};
use ash_subdiv::capture::{CaptureDraw, Captured, CapturedVertex, Which};
use ash_subdiv::renderer::{Evaluation, Factor, ModelTables};
use ash_subdiv::table::{Patch, grid_parameters};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{Construction, ControlMesh, Fallback, ModelOptions, Options, Scheme, shape};
use glam::Vec3;
use std::collections::{BTreeSet, HashMap};

type Vertex = [f32; 6];

/// Every evaluation on a uniform grid with every construction that it goes with.
pub fn ways(scheme: Scheme) -> impl Iterator<Item = ModelOptions> {
    let others = [Evaluation::Tessellation, Evaluation::Subdivision];
    let on_uniform_grids = Evaluation::ALL.into_iter().filter(move |evaluation| !others.contains(evaluation));
    let pairs =
        on_uniform_grids.flat_map(|evaluation| evaluation.constructions().iter().map(move |&c| (evaluation, c)));
    let fallback = Fallback::Gregory;
    pairs.map(move |(evaluation, construction)| ModelOptions {
        scheme,
        fallback,
        construction,
        evaluation,
        ..ModelOptions::default()
    })
}

/// The same through the tessellation stages, with the patches in the same order: the stencil table has its own.
fn tessellated(options: &ModelOptions) -> ModelOptions {
    let construction = match options.evaluation {
        Evaluation::GeometryTwoPass => Construction::Stencil,
        _ => options.construction,
    };
    ModelOptions { construction, evaluation: Evaluation::Tessellation, ..options.clone() }
}

/// Each patch on its uniform grid, in the order of [`grid_parameters`], as the device evaluates it.
fn uniform_grids(stage: &Stage, mesh: &ControlMesh, options: &ModelOptions, segments: u32) -> Vec<Vec<Vertex>> {
    if options.evaluation == Evaluation::Compute {
        return kept_uniform_grids(stage, mesh, options, segments, None);
    }
    let captured = Captured::new(&stage.headless, mesh, options).expect("a model");
    let count = |kind| grid_parameters(kind, segments + 1).len();
    let patches = captured.tables().plan().patches();
    let mut uniform_grids: Vec<Vec<Option<Vertex>>> =
        patches.iter().map(|patch| vec![None; count(patch.kind)]).collect();
    for vertex in captured.vertices(segments as f32).expect("a capture") {
        let patch = vertex.patch as usize;
        let place = &mut uniform_grids[patch][number(patches[patch].kind, vertex.coordinate, segments)];
        let ([x, y, z], [i, j, k]) = (vertex.position, vertex.normal);
        let value = [x, y, z, i, j, k];
        // A vertex may be evaluated several times.
        assert!(place.is_none_or(|before| before.map(f32::to_bits) == value.map(f32::to_bits)), "{vertex:?} {place:?}");
        *place = Some(value);
    }
    let all = |uniform_grid: Vec<Option<Vertex>>| uniform_grid.into_iter().map(|v| v.expect("every vertex")).collect();
    uniform_grids.into_iter().map(all).collect()
}

/// The number of the vertex of a uniform grid that is nearest to a coordinate.
fn number(kind: PatchKind, coordinate: [f32; 3], segments: u32) -> usize {
    let [u, v, w] = coordinate.map(|x| (x * segments as f32).round() as usize);
    let n = segments as usize;
    if kind.is_triangular() { (n - u) * (n - u + 1) / 2 + w } else { v * (n + 1) + u }
}

/// The same from the vertices that compute keeps.
fn kept_uniform_grids(
    stage: &Stage,
    mesh: &ControlMesh,
    options: &ModelOptions,
    segments: u32,
    edge_factors: Option<&[f32]>,
) -> Vec<Vec<Vertex>> {
    let mut renderer = stage.renderer(&Options::default());
    let model = renderer.add_model(mesh, options).expect("a model");
    renderer.set_segments(model, segments).expect("segments");
    let frame = begin(&mut renderer);
    if let Some(factors) = edge_factors {
        renderer.set_edge_factors(model, frame, factors).expect("factors");
    }
    stage.prepare(&mut renderer, frame);
    let words = read_vertices(&stage.headless, &renderer, model);
    let mut vertices = words.chunks_exact(6).map(|v| [v[0], v[1], v[2], v[3], v[4], v[5]]);
    let patches = renderer.tables(model).unwrap().plan().patches();
    let uniform_grids: Vec<Vec<Vertex>> = patches
        .iter()
        .map(|patch| vertices.by_ref().take(grid_parameters(patch.kind, segments + 1).len()).collect())
        .collect();
    assert!(vertices.next().is_none() && uniform_grids.len() == patches.len());
    uniform_grids
}

fn position(vertex: &Vertex) -> Vec3 {
    Vec3::new(vertex[0], vertex[1], vertex[2])
}

fn normal(vertex: &Vertex) -> Vec3 {
    Vec3::new(vertex[3], vertex[4], vertex[5])
}

/// Where a vertex lies, by numbers of segments: the tessellator's parameters are rounded.
fn place(patch: u32, [u, v]: [f64; 2], segments: u32) -> (u32, [u32; 2]) {
    (patch, [u, v].map(|x| (x * f64::from(segments)).round() as u32))
}

/// On an edge of a triangle.
fn on_edge(vertex: &CapturedVertex) -> bool {
    vertex.coordinate.contains(&0.0)
}

#[test]
fn vertices_are_those_of_the_tessellation_stages() {
    let stage = Stage::new();
    let shapes = [
        ("creature-mixed", &[6][..], &Scheme::ALL[..]),
        ("cube", &[1, 13, 31], &Scheme::ALL),
        ("fan", &[1, 13, 31], &[Scheme::Gregory]),
        ("cloth", &[6], &[Scheme::Gregory]),
        ("pentagons", &[6, 13], &[Scheme::Pm]),
    ];
    let mut all: Vec<_> = Scheme::ALL.into_iter().flat_map(ways).collect();
    // Ways beside the same patches of the tessellation stages after each other and shapes last, so that they can use the same pipelines.
    all.sort_by_key(|options| (options.scheme as u32, tessellated(options).construction as u32));
    for options in all {
        let scheme = options.scheme;
        for (name, counts, _) in shapes.iter().filter(|(_, _, schemes)| schemes.contains(&scheme)) {
            let mesh = if *name == "pentagons" { common::pentagons() } else { shape(name).expect("built in") };
            let captured = Captured::new(&stage.headless, &mesh, &tessellated(&options)).expect("a model");
            for &segments in *counts {
                let vertices = captured.vertices(segments as f32).expect("a capture");
                let grids = captured.grid(segments + 1).expect("a capture");
                let uniform_grids = uniform_grids(&stage, &mesh, &options, segments);
                let what = format!("{name} {scheme:?} {:?} {segments}", options.evaluation);
                compare(captured.tables().plan().patches(), segments, &uniform_grids, &vertices, &what);
                for (uniform_grid, grid) in uniform_grids.iter().zip(&grids) {
                    for (vertex, sample) in uniform_grid.iter().zip(grid) {
                        let off = (position(vertex) - Vec3::from(sample.position)).length();
                        let turn = (normal(vertex) - Vec3::from(sample.normal)).length();
                        // The grid's parameters are not rounded to 16 bits.
                        assert!(off < 5e-5 && turn < 1e-3, "{what}: {off} {turn} {sample:?}");
                    }
                }
            }
        }
    }
    stage.finish();
}

/// Asserts that uniform grids have the positions of what was tessellated, to the bit.
fn compare(
    patches: &[Patch],
    segments: u32,
    uniform_grids: &[Vec<Vertex>],
    tessellated: &[CapturedVertex],
    what: &str,
) {
    let at: HashMap<_, &CapturedVertex> = tessellated
        .iter()
        .filter(|v| patches[v.patch as usize].kind.is_triangular() <= on_edge(v))
        .map(|v| (place(v.patch, [v.coordinate[0], v.coordinate[1]].map(f64::from), segments), v))
        .collect();
    for (i, (patch, uniform_grid)) in patches.iter().zip(uniform_grids).enumerate() {
        for (uv, vertex) in grid_parameters(patch.kind, segments + 1).into_iter().zip(uniform_grid) {
            let w = 1.0 - uv[0] - uv[1];
            let edge = uv[0] == 0.0 || uv[1] == 0.0 || w.abs() < 0.5 / f64::from(segments);
            // Within triangles the tessellator has vertices elsewhere.
            if patch.kind.is_triangular() && !edge {
                continue;
            }
            let other = at[&place(i as u32, uv, segments)];
            assert_eq!(bits(position(vertex)), bits(other.position), "{what} {uv:?} {other:?}");
            let turn = (normal(vertex) - Vec3::from(other.normal)).length();
            assert!(turn < 1e-5, "{what} {uv:?}: {turn}");
        }
    }
}

/// Normals that patches share, along edges and inside, are those of the tessellation stages to the bit.
#[test]
fn shared_normals_are_those_of_the_tessellation_stages() {
    let stage = Stage::new();
    for (name, segments) in [("creature-mixed", 6), ("machine-part", 13), ("cloth", 5)] {
        let mesh = shape(name).expect("built in");
        let shared = ways(Scheme::Gregory).filter(|way| way.evaluation.shares(way.construction));
        let shared: Vec<_> = shared.map(|way| ModelOptions { shared_normals: true, ..way }).collect();
        assert_eq!(shared.len(), 3);
        // In two stages, which keep nothing between draws.
        let options = ModelOptions { shared_normals: true, ..ModelOptions::default() };
        let captured = Captured::new(&stage.headless, &mesh, &options).expect("a model");
        for options in shared {
            let patches = captured.tables().plan().patches();
            let at: HashMap<_, CapturedVertex> = captured
                .vertices(segments as f32)
                .expect("a capture")
                .into_iter()
                .map(|v| (place(v.patch, [v.coordinate[0], v.coordinate[1]].map(f64::from), segments), v))
                .collect();
            let mut compared = 0;
            for (i, uniform_grid) in uniform_grids(&stage, &mesh, &options, segments).into_iter().enumerate() {
                for (uv, vertex) in grid_parameters(patches[i].kind, segments + 1).into_iter().zip(&uniform_grid) {
                    // Within triangles the tessellator has vertices elsewhere.
                    let Some(other) = at.get(&place(i as u32, uv, segments)) else { continue };
                    if patches[i].kind.is_triangular() && !on_edge(other) {
                        continue;
                    }
                    assert_eq!(bits(normal(vertex)), bits(other.normal), "{name} {:?} {other:?}", options.evaluation);
                    compared += 1;
                }
            }
            assert!(compared > 20 * patches.len(), "{compared}");
        }
    }
    stage.finish();
}

#[test]
fn patches_meet_to_the_bit() {
    let stage = Stage::new();
    for name in ["creature-mixed", "machine-part", "cloth", "valences"] {
        let mesh = shape(name).expect("built in");
        let topology = Topology::new(&mesh);
        for (segments, options) in [2, 7, 19].into_iter().flat_map(|n| ways(Scheme::Gregory).map(move |way| (n, way))) {
            let uniform_grids = uniform_grids(&stage, &mesh, &options, segments);
            let tables = ModelTables::new(&mesh, &options).expect("tables");
            let patches = tables.plan().patches();
            let of_face: HashMap<u32, usize> = patches.iter().enumerate().map(|(i, p)| (p.face, i)).collect();
            for edge in shared_edges(&topology) {
                let [a, mut b] = edge.sides.map(|(face, k)| {
                    let patch = of_face[&face];
                    let kind = patches[patch].kind;
                    let parameters = grid_parameters(kind, segments + 1);
                    let along = (0..=segments).map(|i| edge_parameters(kind, k, f64::from(i) / f64::from(segments)));
                    let at = |uv: [f64; 2]| {
                        let near = |other: &[f64; 2]| (0..2).all(|i| (uv[i] - other[i]).abs() < 1e-9);
                        bits(position(
                            &uniform_grids[patch][parameters.iter().position(near).expect("on the uniform grid")],
                        ))
                    };
                    along.map(at).collect::<Vec<_>>()
                });
                b.reverse();
                assert_eq!(a, b, "{name} {:?} {segments} {:?}", options.evaluation, edge.sides);
            }
        }
    }
    stage.finish();
}

/// The bits of the vertices on each side of each patch. Sides of a piece of a pentagon that are inside the face are left out.
fn side_points(patches: &[Patch], vertices: impl Iterator<Item = (u32, [f64; 2], [f32; 3])>) -> Vec<[Points; 4]> {
    let mut sides = vec![<[Points; 4]>::default(); patches.len()];
    for (patch, [u, v], position) in vertices {
        let on = match patches[patch as usize].kind {
            PatchKind::Pentagon => [u + v == 1.0, false, false, false],
            PatchKind::Triangle => [u + v == 1.0, u == 0.0, v == 0.0, false],
            _ => [v == 0.0, u == 1.0, v == 1.0, u == 0.0],
        };
        for (side, _) in sides[patch as usize].iter_mut().zip(on).filter(|(_, on)| *on) {
            side.insert(bits(position));
        }
    }
    sides
}

type Points = BTreeSet<[u32; 3]>;

#[test]
fn edges_have_the_segments_of_their_own_factors() {
    let stage = Stage::new();
    for (name, scheme) in [("creature-mixed", Scheme::Gregory), ("creature", Scheme::Acc), ("pentagons", Scheme::Pm)] {
        let mesh = if name == "pentagons" { common::pentagons() } else { shape(name).expect("built in") };
        for options in ways(scheme) {
            let options = ModelOptions { edge_factors: true, ..options };
            let captured = Captured::new(&stage.headless, &mesh, &tessellated(&options)).expect("a model");
            let patches = captured.tables().plan().patches();
            // From below 1 up to 13, and some between whole numbers.
            let count = captured.tables().edges().expect("edges").vertices.len();
            let edge_factors: Vec<f32> = (0..count).map(|i| ((29 * i) % 40) as f32 / 3.0).collect();
            let draw = CaptureDraw { edge_factors: edge_factors.clone(), ..CaptureDraw::new(Factor::Edges(1.0)) };
            let capture = |captured: &Captured| {
                let vertices = captured.vertices_of(&draw, Which::All).expect("a capture").into_iter();
                let [u, v] = [0, 1];
                side_points(
                    patches,
                    vertices.map(|x| (x.patch, [u, v].map(|i| f64::from(x.coordinate[i])), x.position)),
                )
            };
            let expected = capture(&captured);
            let points = if options.evaluation == Evaluation::Compute {
                let uniform_grids = kept_uniform_grids(&stage, &mesh, &options, 13, Some(&edge_factors));
                let at = |(patch, uniform_grid): (usize, Vec<Vertex>)| {
                    let parameters = grid_parameters(patches[patch].kind, 14).into_iter();
                    // Exactly on the edge opposite the last corner.
                    let exact = |[u, v]: [f64; 2]| if (u + v - 1.0).abs() < 1e-9 { [u, 1.0 - u] } else { [u, v] };
                    let triangular = patches[patch].kind.is_triangular();
                    let vertices = parameters.zip(uniform_grid).map(move |(uv, [x, y, z, ..])| {
                        (patch as u32, if triangular { exact(uv) } else { uv }, [x, y, z])
                    });
                    vertices.collect::<Vec<_>>()
                };
                side_points(patches, uniform_grids.into_iter().enumerate().flat_map(at))
            } else {
                capture(&Captured::new(&stage.headless, &mesh, &options).expect("a model"))
            };
            for (patch, (points, expected)) in points.iter().zip(&expected).enumerate() {
                let what = format!("{name} {:?} {:?} patch {patch}", options.evaluation, options.construction);
                assert_eq!(points, expected, "{what} {:?}", patches[patch]);
            }
            assert!(
                expected.iter().flatten().any(|side| side.len() == 2)
                    && expected.iter().flatten().any(|s| s.len() == 14)
            );
        }
    }
    stage.finish();
}
