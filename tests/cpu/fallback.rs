//! Meshes of which a scheme draws a part and Gregory patches the rest: who draws what, and how they join.

use crate::common;
use crate::common::edges::{SharedEdge, edge_parameters, shared_edges};
use crate::common::random::{random_creased_mesh, random_mesh};
use ash_subdiv::patch::{Row, Sample};
use ash_subdiv::table::{CpuSurface, Notice, Patch, TableOptions};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{ControlMesh, Fallback, Scheme, shape, shapes};
use glam::DVec3;

const OTHERS: [Scheme; 3] = [Scheme::Acc, Scheme::Pm, Scheme::CPatch];

/// Every built-in shape, and random meshes with boundaries, creases, triangles and all valences.
fn meshes() -> Vec<(String, ControlMesh)> {
    let built_in = shapes().iter().map(|info| (info.name.to_owned(), shape(info.name).expect("built in")));
    let random = (0..20).map(|seed| (format!("random {seed}"), random_mesh(seed)));
    let creased = (0..20).map(|seed| (format!("random creased {seed}"), random_creased_mesh(seed)));
    built_in.chain(random).chain(creased).collect()
}

struct Mixed {
    surface: CpuSurface,
    points: Vec<Vec<DVec3>>,
    /// The number of the patch of each face, if it has one.
    of_face: Vec<Option<usize>>,
}

impl Mixed {
    fn new(mesh: &ControlMesh, scheme: Scheme) -> Self {
        let surface = CpuSurface::with_options(
            mesh,
            &TableOptions { scheme, fallback: Fallback::Gregory, ..TableOptions::default() },
        )
        .expect("small");
        let mut of_face = vec![None; surface.prepared().mesh().face_count()];
        surface.plan().patches().iter().enumerate().for_each(|(i, patch)| of_face[patch.face as usize] = Some(i));
        Self { points: surface.control_points(|p| p), of_face, surface }
    }

    fn mesh(&self) -> &ControlMesh {
        self.surface.prepared().mesh()
    }

    /// The patches on both sides, with the number of the edge in each.
    fn sides(&self, edge: &SharedEdge) -> Option<[(usize, usize); 2]> {
        let [a, b] = edge.sides.map(|(face, k)| self.of_face[face as usize].map(|patch| (patch, k)));
        Some([a?, b?])
    }

    fn patch(&self, patch: usize) -> Patch {
        self.surface.plan().patches()[patch]
    }

    fn at(&self, (patch, k): (usize, usize), t: f64) -> Sample<DVec3> {
        let Patch { kind, scheme, .. } = self.patch(patch);
        let [u, v] = edge_parameters(kind, k, t);
        scheme.evaluate(kind, &self.points[patch], u, v)
    }
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    a.cross(b).length().atan2(a.dot(b))
}

/// The faces that fall back are those that the scheme has no patch for, and no others.
#[test]
fn only_faces_without_patches_fall_back() {
    let mut fallen = 0;
    for (name, mesh) in meshes() {
        for scheme in Scheme::ALL {
            let mixed = Mixed::new(&mesh, scheme);
            let topology = Topology::new(mixed.mesh());
            for patch in mixed.surface.plan().patches() {
                let defined = scheme.check(&topology, patch.face).is_ok();
                let drawn_by = if defined { scheme } else { Scheme::Gregory };
                assert_eq!(patch.scheme, drawn_by, "{name}: face {}", patch.face);
            }
            let faces = mixed.surface.plan().fallen_back().count();
            fallen += faces;
            let told = mixed.surface.notices().into_iter().find_map(|notice| match notice {
                Notice::FellBack { faces, .. } => Some(faces),
                _ => None,
            });
            assert_eq!(told.unwrap_or(0), faces, "{name}");
            // Hexagons are refused or refined, and then none is left.
            if mixed.surface.prepared().steps.is_empty() {
                assert!(CpuSurface::new(&mesh, scheme, 0).is_ok() == (faces == 0), "{name} {scheme:?}");
            }
        }
    }
    assert!(fallen > 1000, "{fallen}");
}

/// Edges of two patches: positions are one curve, whichever schemes meet. Between patches of one scheme there is one
/// normal, as without fallback; between those of two schemes at the corners, and all along where both rings are regular.
///
/// Measured: 2.2e-16 of the diagonal, 5.9e-13 rad.
#[test]
fn patches_join_where_some_fall_back() {
    let (seams, smooth) = check_joins(meshes());
    assert!(seams > 2000 && smooth > 200, "{seams} {smooth}");
}

/// How many edges there are between two schemes: all, and those whose rings are regular at both ends.
fn check_joins(meshes: Vec<(String, ControlMesh)>) -> (usize, usize) {
    let (mut seams, mut smooth_seams, mut worst, mut tilt) = (0, 0, 0.0, 0.0);
    for (name, mesh) in meshes {
        for scheme in OTHERS {
            let mixed = Mixed::new(&mesh, scheme);
            let topology = Topology::new(mixed.mesh());
            let diagonal = mixed.mesh().diagonal();
            for edge in shared_edges(&topology) {
                let Some(sides) = mixed.sides(&edge) else { continue };
                let patches = sides.map(|(patch, _)| mixed.patch(patch));
                let same = patches[0].scheme == patches[1].scheme;
                let regular = |(face, k): (u32, usize)| {
                    let corners = mixed.mesh().face_corners(face);
                    let ring = |k: usize| topology.place((corners.start + k % corners.len()) as u32).ring as usize;
                    [ring(k), ring(k + 1)].into_iter().all(|ring| topology.rings()[ring].is_regular())
                };
                let one_normal = edge.smooth && (same || regular(edge.sides[0]));
                seams += usize::from(!same);
                smooth_seams += usize::from(!same && one_normal);
                for t in [0.0, 0.03, 0.2, 0.5, 0.7, 1.0] {
                    let [a, b] = [mixed.at(sides[0], t), mixed.at(sides[1], 1.0 - t)];
                    let gap = (a.position - b.position).length() / diagonal;
                    worst = f64::max(worst, gap);
                    assert!(gap < 1e-12, "{name} {scheme:?} {patches:?} at {t}: {gap:e} of the diagonal apart");
                    let corner = t == 0.0 || t == 1.0;
                    if edge.smooth && (one_normal || corner) && a.normal != DVec3::ZERO && b.normal != DVec3::ZERO {
                        let angle = angle(a.normal, b.normal);
                        tilt = f64::max(tilt, angle);
                        assert!(angle < 1e-7, "{name} {scheme:?} {patches:?} at {t}: {angle:e} rad");
                    }
                }
            }
        }
    }
    println!("{worst:e} of the diagonal, {tilt:e} rad");
    (seams, smooth_seams)
}

/// What rings have in common, as the docs of the module say. Where they differ, seams would be open without a common frame.
#[test]
fn corner_and_edge_points_of_schemes_differ_where_the_docs_say() {
    use ash_subdiv::patch::{RingShape, RingValues};
    use ash_subdiv::topology::RingKind;
    let ring = |triangles: Vec<bool>, kind, open| {
        let shape = RingShape { kind, open, triangles, fallback: false };
        let rows = |first: usize, count: usize| (first..first + count).map(|i| Row::unit(i as u32)).collect();
        let (edges, faces) = (shape.edges(), shape.faces());
        RingValues { shape, centre: Row::unit(0), edges: rows(1, edges), diagonals: rows(1 + edges, faces) }
    };
    // Whether corner points and edge points agree with Gregory's.
    let agree = |ring: &RingValues<Row>, scheme: Scheme| {
        let [ours, gregory] = [scheme, Scheme::Gregory].map(|scheme| scheme.frame(ring));
        let close = |a: &Row, b: &Row| (0..64).all(|i| (a.weight(i) - b.weight(i)).abs() < 1e-12);
        let edges = |frame| (0..ring.shape.edges()).map(|j| ring.edge_point(frame, j)).collect::<Vec<_>>();
        let same_edges = edges(&ours).iter().zip(&edges(&gregory)).all(|(a, b)| close(a, b));
        (close(&ours.p, &gregory.p), same_edges)
    };
    let smooth = |triangles| ring(triangles, RingKind::Smooth, false);
    for scheme in [Scheme::Acc, Scheme::Pm] {
        assert_eq!(agree(&smooth(vec![false; 4]), scheme), (true, true), "{scheme:?}");
        for n in [3, 5, 6, 9] {
            assert_eq!(agree(&smooth(vec![false; n]), scheme), (true, false), "{scheme:?} {n}");
        }
    }
    let mixed = smooth(vec![true, false, true, true, false]);
    assert_eq!((agree(&mixed, Scheme::Acc), agree(&mixed, Scheme::Pm)), ((true, false), (false, false)));
    for faces in 1..5 {
        let crease = ring(vec![false; faces], RingKind::Crease, true);
        assert_eq!(agree(&crease, Scheme::Acc), (true, true), "{faces}");
    }
    // With the ring marked, all schemes have Gregory's.
    let mut marked = mixed;
    marked.shape.fallback = true;
    assert_eq!((agree(&marked, Scheme::Acc), agree(&marked, Scheme::Pm)), ((true, true), (true, true)));
}

/// The meshes of the reference vectors, whole and with some faces made triangles so that they fall back.
#[test]
fn meshes_of_the_vectors_join() {
    let (seams, _) = check_joins(meshes_of_vectors());
    assert!(seams > 250, "{seams} edges between two schemes");
}

fn meshes_of_vectors() -> Vec<(String, ControlMesh)> {
    use ash_subdiv::MeshData;
    let mut meshes = Vec::new();
    for (name, vector) in common::vectors() {
        let Some(positions) = vector.get("positions") else { continue };
        let rows: Vec<Vec<u32>> = serde_json::from_value(vector["faces"].clone()).expect("faces");
        for every in [usize::MAX, 7, 3] {
            // Every so many faces a quad is cut in two.
            let mut faces = Vec::new();
            for (i, face) in rows.iter().enumerate() {
                match face[..] {
                    [a, b, c, d] if (i + 1) % every == 0 => faces.extend([vec![a, b, c], vec![a, c, d]]),
                    _ => faces.push(face.clone()),
                }
            }
            let data = MeshData {
                positions: serde_json::from_value(positions.clone()).expect("positions"),
                face_sizes: faces.iter().map(|face| face.len() as u32).collect(),
                face_vertices: faces.concat(),
                ..MeshData::default()
            };
            meshes.push((format!("{name} {every}"), ControlMesh::new(data).expect("manifold")));
        }
    }
    meshes
}

/// A regular face is the same patch in all schemes, among whatever falls back.
#[test]
fn regular_faces_stay_exact() {
    for name in ["machine-part", "creature-mixed", "cloth"] {
        let mesh = shape(name).expect("built in");
        let gregory = Mixed::new(&mesh, Scheme::Gregory);
        for scheme in OTHERS {
            let mixed = Mixed::new(&mesh, scheme);
            let regular = gregory.surface.plan().range(PatchKind::Regular);
            assert_eq!(mixed.surface.plan().range(PatchKind::Regular), regular);
            for i in regular {
                for (a, b) in mixed.points[i].iter().zip(&gregory.points[i]) {
                    assert!(a.distance(*b) < 1e-13, "{name} {scheme:?}: patch {i}");
                }
            }
        }
    }
}
