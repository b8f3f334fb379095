//! Leaves of adaptive subdivision beside each other, and plans of random meshes with everything.

use crate::adaptive::{Distance, Planned, distance, positions};
use crate::common::random::{Random, random_mesh};
use ash_subdiv::adaptive::{AdaptiveError, AdaptiveOptions, Leaf, LeafKind, Plan, Sums};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{BoundaryRule, Corner, Crease, CreaseMethod, TriangleRule};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{ControlMesh, MeshData, MeshError, Scheme, grid_torus, shape};
use glam::{DVec2, DVec3};

/// A random mesh, some of whose edges and vertices have random sharpness.
fn sharp_mesh(seed: u64) -> ControlMesh {
    let mesh = random_mesh(seed);
    let mut random = Random::new(seed ^ 0xada9);
    let (mut creases, mut corners) = (Vec::new(), Vec::new());
    let sharpness = |random: &mut Random| [10.0, 0.5, 1.0, 1.7, 3.0, 3.0][random.below(6)];
    let often = [4, 12, 40][random.below(3)];
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        for k in 0..vertices.len() {
            if random.below(often) == 0 {
                let vertices = [vertices[k], vertices[(k + 1) % vertices.len()]];
                creases.push(Crease { vertices, sharpness: sharpness(&mut random) });
            }
            if random.below(3 * often) == 0 {
                corners.push(Corner { vertex: vertices[k], sharpness: sharpness(&mut random) });
            }
        }
    }
    let holes = (0..mesh.face_count() as u32).filter(|_| random.below(20) == 0).collect();
    let boundary = [BoundaryRule::EdgeAndCorner, BoundaryRule::EdgeOnly, BoundaryRule::None][random.below(3)];
    let crease_method = [CreaseMethod::Uniform, CreaseMethod::Chaikin][random.below(2)];
    let triangle_rule = [TriangleRule::CatmullClark, TriangleRule::Smooth][random.below(2)];
    let data = MeshData { creases, corners, holes, boundary, crease_method, triangle_rule, ..mesh.into_data() };
    ControlMesh::new(data).expect("edges of the mesh")
}

/// Points of a root: a face or a part of one.
struct Roots<'p> {
    topology: Topology,
    planned: &'p Planned,
}

impl<'p> Roots<'p> {
    fn new(planned: &'p Planned) -> Self {
        Self { topology: Topology::new(&planned.mesh), planned }
    }

    /// The point at t along the edge of a half-edge, as a root and its parameters, `inset` away from the edge.
    fn on_edge(&self, half_edge: u32, t: f64, inset: f64) -> Option<(u32, DVec2)> {
        let face = self.topology.face(half_edge);
        let mesh = &self.planned.mesh;
        let k = half_edge - mesh.face_corners(face).start as u32;
        let roots = &self.planned.plan.face_roots;
        let first = roots[face as usize];
        let size = mesh.face(face).len() as u32;
        if first == roots[face as usize + 1] {
            return None;
        }
        Some(match size {
            4 => (first, [[t, inset], [1.0 - inset, t], [1.0 - t, 1.0 - inset], [inset, 1.0 - t]][k as usize].into()),
            _ if t < 0.5 => (first + k, DVec2::new(2.0 * t, inset)),
            _ => (first + (k + 1) % size, DVec2::new(inset, 2.0 - 2.0 * t)),
        })
    }

    /// The point at t along the edge of a root, seen from the other side.
    fn across(&self, root: u32, edge: u32, t: f64, inset: f64) -> Option<(u32, DVec2)> {
        let of = self.planned.plan.roots[root as usize];
        let corners = self.planned.mesh.face_corners(of.face);
        let (start, size) = (corners.start as u32, corners.len() as u32);
        let half_edge = |k: u32, t: f64| {
            let twin = self.topology.twin(start + k % size)?;
            self.on_edge(twin, 1.0 - t, inset)
        };
        let first = root - of.part;
        match (of.level, edge) {
            (0, _) => half_edge(edge, t),
            (_, 0) => half_edge(of.part, 0.5 * t),
            (_, 3) => half_edge(of.part + size - 1, 0.5 + 0.5 * t),
            // Edges run counter-clockwise: to the centre, and away from it.
            (_, 1) => Some((first + (of.part + 1) % size, DVec2::new(t, 1.0 - inset))),
            _ => Some((first + (of.part + size - 1) % size, DVec2::new(1.0 - inset, 1.0 - t))),
        }
    }

    /// The leaf beyond the point at t along an edge of a leaf, and the parameters there.
    fn beyond(&self, leaf: &Leaf, edge: u32, t: f64) -> Option<(u32, f64, f64)> {
        const INSET: f64 = 1e-9;
        let plan = &self.planned.plan;
        let side = f64::from(1 << (leaf.level - plan.roots[leaf.root as usize].level));
        let within = |inset: f64| {
            let s = [[t, -inset], [1.0 + inset, t], [1.0 - t, 1.0 + inset], [-inset, 1.0 - t]][edge as usize];
            (DVec2::new(f64::from(leaf.u), f64::from(leaf.v)) + DVec2::from(s)) / side
        };
        let outside = within(INSET * side);
        let at = |exact: (u32, DVec2), beyond: (u32, DVec2)| {
            let (number, ..) = plan.locate(beyond.0, beyond.1.x, beyond.1.y);
            let other = &plan.leaves[number as usize];
            let side = f64::from(1 << (other.level - plan.roots[other.root as usize].level));
            let local = exact.1 * side - DVec2::new(f64::from(other.u), f64::from(other.v));
            (number, local.x.clamp(0.0, 1.0), local.y.clamp(0.0, 1.0))
        };
        if outside.cmpge(DVec2::ZERO).all() && outside.cmple(DVec2::ONE).all() {
            return Some(at((leaf.root, within(0.0)), (leaf.root, outside)));
        }
        let DVec2 { x, y } = within(0.0);
        let t = [x, y, 1.0 - x, 1.0 - y][edge as usize];
        Some(at(self.across(leaf.root, edge, t, 0.0)?, self.across(leaf.root, edge, t, INSET)?))
    }
}

/// Compares each leaf with those beside it; gives how many were compared.
fn check_neighbours(planned: &Planned, what: &str) -> usize {
    let Planned { mesh, plan, points, .. } = planned;
    let roots = Roots::new(planned);
    let mut compared = 0;
    let has_caps_of_level_0 = plan.options.depth == 0;
    for (number, leaf) in (0..).zip(&plan.leaves) {
        for edge in 0..4 {
            let mut finer = false;
            for t in [0.25, 0.75, 0.5] {
                let Some((other, u, v)) = roots.beyond(leaf, edge, t) else { continue };
                let beside = &plan.leaves[other as usize];
                finer |= beside.level > leaf.level;
                let levels = (leaf.level, beside.level);
                assert!(has_caps_of_level_0 || levels.0.abs_diff(levels.1) <= 1, "{what}: {leaf:?} {edge} {beside:?}");
                let is_exact = |leaf: &Leaf| leaf.kind != LeafKind::Cap;
                if levels.0 == levels.1 || is_exact(leaf) && is_exact(beside) {
                    let [s, r] = [[t, 0.0], [1.0, t], [1.0 - t, 1.0], [0.0, 1.0 - t]][edge as usize];
                    let ours = plan.evaluate_leaf(number, s, r, points).position;
                    let theirs = plan.evaluate_leaf(other, u, v, points).position;
                    let error = (ours - theirs).length() / mesh.diagonal();
                    // What an end cap draws of finite sharpness, its exact neighbour draws otherwise.
                    let is_sharp = is_exact(leaf) != is_exact(beside) && !mesh.data().creases.is_empty();
                    assert!(error < 1e-12 || is_sharp, "{what}: {error:e} {leaf:?} {edge} {beside:?}");
                    compared += usize::from(!is_sharp);
                }
            }
            assert_eq!(leaf.transition >> edge & 1 == 1, finer, "{what}: {leaf:?} {edge}");
        }
    }
    compared
}

#[test]
fn leaves_meet_those_beside_them() {
    for name in ["creature", "creature-mixed", "machine-part", "polygons", "valences", "cloth", "fan"] {
        for depth in [0, 1, 2, 4] {
            let planned = Planned::at_depth(&shape(name).unwrap(), depth);
            let compared = check_neighbours(&planned, name);
            assert!(compared > planned.plan.leaves.len(), "{name} at depth {depth}: {compared}");
        }
    }
}

#[test]
fn random_meshes_are_exact_wherever_leaves_are() {
    let mut kinds = [0; 3];
    for seed in 0..150 {
        let mesh = sharp_mesh(seed);
        let surface = LimitSurface::new(&mesh).unwrap();
        let depth = (seed % 4) as u32;
        let planned = Planned::at_depth(&mesh, depth);
        let Distance { exact, slope, .. } = distance(&planned, &surface);
        // Chaikin's rule, in f32, rounds what is left of a sharpness that does not change.
        let rounding = if mesh.data().crease_method == CreaseMethod::Chaikin { 1e-8 } else { 1e-12 };
        assert!(exact < rounding && slope < 1e3 * rounding, "seed {seed} at depth {depth}: {exact:e} {slope:e}");
        check_neighbours(&planned, &format!("seed {seed} at depth {depth}"));
        check_rows(&planned.plan, &mesh);
        for leaf in &planned.plan.leaves {
            kinds[match leaf.kind {
                LeafKind::Regular => 0,
                LeafKind::SingleCrease { .. } => 1,
                LeafKind::Cap => 2,
            }] += 1;
        }
    }
    println!("{kinds:?}");
    assert!(kinds.iter().all(|&count| count > 100), "{kinds:?}");
}

/// Rows add up to one and read lower vertices only, those of a level one level above; each vertex is read; composed rows make
/// the same points.
fn check_rows(plan: &Plan, mesh: &ControlMesh) {
    let mut read = vec![false; plan.vertex_count()];
    let mut mark = |vertex: u32| read[vertex as usize] = true;
    plan.grids.iter().for_each(|&vertex| mark(vertex));
    plan.cap_points.clone().for_each(&mut mark);
    plan.rows.vertices.iter().for_each(|&vertex| mark(vertex));
    assert!(read[plan.control_vertices as usize..].iter().all(|&read| read), "each vertex is read");
    let mut end = plan.control_vertices;
    let mut below = 0..plan.control_vertices;
    for range in plan.steps() {
        assert_eq!(range.start, end);
        end = range.end;
        let is_level = range.end <= plan.ghosts.start;
        for vertex in range.clone() {
            let sum: f64 = plan.row(vertex).map(|(_, weight)| weight).sum();
            assert!((sum - 1.0).abs() < 1e-13, "{sum}");
            let is_readable = |v: u32| match is_level {
                true => below.contains(&v) || plan.centres.contains(&v),
                false => v < range.start && !plan.ghosts.contains(&v),
            };
            assert!(plan.row(vertex).all(|(v, _)| is_readable(v as u32)));
        }
        if range != plan.centres {
            below = range;
        }
    }
    assert_eq!(end as usize, plan.vertex_count());
    let positions = positions(mesh);
    let points = plan.points(&positions);
    let composed: Vec<DVec3> = plan.composed().apply(&positions);
    for (point, composed) in points[positions.len()..].iter().zip(composed) {
        assert!((*point - composed).length() < 1e-13 * mesh.diagonal());
    }
}

#[test]
fn chaikins_creases_leave_no_leaves_two_levels_apart() {
    // A crease once round a torus, sharper at one edge.
    let mut data = grid_torus(12, 6);
    let topology = Topology::new(&ControlMesh::new(data.clone()).unwrap());
    let straight_on = |&h: &u32| Some(topology.next(topology.twin(topology.next(h))?));
    let crease: Vec<u32> = std::iter::successors(Some(0), straight_on).skip(1).take_while(|&h| h != 0).collect();
    assert!(crease.len() >= 5);
    let sharpness = |i: usize| if i == 0 { 4.5 } else { 3.0 };
    let edge = |h: u32| [topology.mesh_vertex(h), topology.mesh_vertex(topology.next(h))];
    let tag = |(i, h): (usize, u32)| Crease { vertices: edge(h), sharpness: sharpness(i) };
    data.creases = std::iter::once(0).chain(crease).enumerate().map(tag).collect();
    data.crease_method = CreaseMethod::Chaikin;
    let mesh = ControlMesh::new(data).unwrap();
    let surface = LimitSurface::new(&mesh).unwrap();
    for depth in 0..6 {
        let planned = Planned::at_depth(&mesh, depth);
        check_neighbours(&planned, &format!("depth {depth}"));
        let Distance { exact, .. } = distance(&planned, &surface);
        assert!(exact < 1e-8, "{exact:e}");
    }
}

#[test]
fn composed_sums_are_of_control_vertices() {
    for (name, depth) in [("creature", 3), ("polygons", 1), ("machine-part", 4), ("valences", 2)] {
        let mesh = shape(name).expect("built in");
        let options = AdaptiveOptions { depth, ..AdaptiveOptions::default() };
        let [levels, composed] = [Sums::Levels, Sums::Composed]
            .map(|sums| Planned::new(&mesh, Scheme::Gregory, &AdaptiveOptions { sums, ..options }));
        assert!(levels.plan.steps().count() > composed.plan.steps().count());
        let control = composed.plan.control_vertices;
        for vertex in control..composed.plan.vertex_count() as u32 {
            let row = || composed.plan.row(vertex);
            assert!(
                row().all(|(v, _)| v < control as usize) && (row().map(|(_, w)| w).sum::<f64>() - 1.0).abs() < 1e-12
            );
        }
        // All else is the same.
        assert_eq!((&levels.plan.leaves, &levels.plan.grids), (&composed.plan.leaves, &composed.plan.grids), "{name}");
        assert_eq!(levels.points.len(), composed.points.len());
        for (a, b) in levels.points.iter().zip(&composed.points) {
            assert!((*a - *b).length() < 1e-13 * mesh.diagonal(), "{name}");
        }
    }
}

/// Two polygons of n corners, and quads between them.
fn drum(n: u32) -> ControlMesh {
    let ring = |z: f64| (0..n).map(move |i| (std::f64::consts::TAU * f64::from(i) / f64::from(n), z));
    let quad = |i: u32| [i, (i + 1) % n, n + (i + 1) % n, n + i];
    ControlMesh::new(MeshData {
        positions: ring(0.0).chain(ring(1.0)).map(|(angle, z)| [angle.cos(), angle.sin(), z]).collect(),
        face_sizes: [n, n].into_iter().chain((0..n).map(|_| 4)).collect(),
        face_vertices: (0..n).rev().chain(n..2 * n).chain((0..n).flat_map(quad)).collect(),
        ..MeshData::default()
    })
    .unwrap()
}

#[test]
fn polygons_of_many_corners_cost_what_their_corners_do() {
    for depth in [0, 1, 3] {
        let terms = |n| Planned::at_depth(&drum(n), depth).plan.rows.vertices.len() as f64 / f64::from(n);
        let (few, many) = (terms(50), terms(400));
        assert!(many < 1.05 * few, "{few} terms a corner of 50, {many} of 400");
    }
    let mesh = drum(24);
    let planned = Planned::at_depth(&mesh, 4);
    check_rows(&planned.plan, &mesh);
    check_neighbours(&planned, "drum");
    let Distance { exact, lift, .. } = distance(&planned, &LimitSurface::new(&mesh).unwrap());
    assert!(exact < 1e-12 && lift < 1e-3, "{exact:e} {lift:e}");
}

#[test]
fn at_depth_0_caps_are_the_schemes_own_patches() {
    for scheme in [Scheme::Gregory, Scheme::GregoryFitted] {
        let mesh = shape("creature-mixed").unwrap();
        let planned = Planned::new(&mesh, scheme, &AdaptiveOptions::default());
        let topology = Topology::new(&mesh);
        let caps = planned.plan.leaves.iter().filter(|leaf| leaf.kind == LeafKind::Cap && leaf.level == 0);
        assert!(caps.clone().count() > 100);
        for cap in caps {
            let theirs =
                scheme.control_points(&topology, cap.face, PatchKind::IrregularQuad, |vertex| mesh.position(vertex));
            let ours = &planned.points[cap.points as usize..][..20];
            assert!(ours.iter().zip(theirs).all(|(a, b)| (*a - b).length() < 1e-14 * mesh.diagonal()));
        }
    }
}

#[test]
fn sharp_features_may_go_deeper() {
    let mesh = sharp_mesh(11);
    let deepest = |depth, sharp_depth| {
        let options = AdaptiveOptions { depth, sharp_depth, ..AdaptiveOptions::default() };
        let plan = Plan::new(&Topology::new(&mesh), Scheme::Gregory, &options).unwrap();
        plan.leaves.iter().map(|leaf| leaf.level).max()
    };
    assert_eq!([deepest(1, None), deepest(1, Some(4)), deepest(4, Some(1))], [Some(1), Some(4), Some(4)]);
    let smooth = shape("creature").unwrap();
    let plan = |sharp_depth| {
        let options = AdaptiveOptions { depth: 2, sharp_depth, ..AdaptiveOptions::default() };
        Plan::new(&Topology::new(&smooth), Scheme::Gregory, &options).unwrap().leaves
    };
    assert_eq!(plan(Some(9)), plan(None));
}

#[test]
fn bad_options_are_refused() {
    let topology = Topology::new(&shape("cube").unwrap());
    let error = |scheme, options| Plan::new(&topology, scheme, &options).unwrap_err();
    let deep = error(Scheme::Gregory, AdaptiveOptions { depth: 11, ..AdaptiveOptions::default() });
    assert_eq!(deep.to_string(), "depth 11: adaptive subdivision goes 10 levels deep at most");
    let deep = error(Scheme::Gregory, AdaptiveOptions { sharp_depth: Some(40), ..AdaptiveOptions::default() });
    assert_eq!(deep.to_string(), "depth of sharp features 40: adaptive subdivision goes 10 levels deep at most");
    let scheme = error(Scheme::Pm, AdaptiveOptions::default());
    assert_eq!(scheme, AdaptiveError::NoCaps { scheme: Scheme::Pm });
    assert_eq!(scheme.to_string(), "scheme pm: end caps are patches of gregory or gregory-fitted");
    // A mesh has no other sharpness than numbers from 0 up.
    let mut data = shape("cube").unwrap().into_data();
    data.creases = vec![Crease { vertices: [data.face_vertices[0], data.face_vertices[1]], sharpness: f32::NAN }];
    assert!(matches!(ControlMesh::new(data), Err(MeshError::BadSharpness { .. })));
}

#[test]
fn the_greatest_depth_is_exact_too() {
    let mesh = shape("machine-part").unwrap();
    let planned = Planned::at_depth(&mesh, 10);
    let counts = planned.plan.counts();
    // Each level has as many leaves as the one before.
    assert_eq!((counts.len(), counts[..10].iter().map(|level| level.caps).sum::<usize>()), (11, 0));
    assert!(counts[4..10].iter().all(|level| level.regular == counts[4].regular) && counts[10].caps > 0);
    let Distance { exact, slope, lift, .. } = distance(&planned, &LimitSurface::new(&mesh).unwrap());
    println!("{exact:e} {slope:e} {lift:e}");
    assert!(exact < 1e-12 && slope < 1e-8 && lift < 1e-5, "{exact:e} {slope:e} {lift:e}");
}
