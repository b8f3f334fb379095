//! Tessellations have no holes, whatever the depths: told from their faces and positions alone.

use crate::common::random::{Random, random_creased_mesh, random_mesh};
use ash_subdiv::dice::{Camera, Depth, DiceOptions, Place, Tessellation};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, MeshData, View, shape};
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Whether a place is on a boundary of the mesh.
fn is_on_boundary(topology: &Topology, place: &Place) -> bool {
    let corners: Vec<u32> = topology.mesh().face_corners(place.face).map(|h| h as u32).collect();
    let n = corners.len();
    let sides = match place.sub {
        -1 => vec![(place.v == 0.0, 0), (place.u == 1.0, 1), (place.v == 1.0, 2), (place.u == 0.0, 3)],
        k => vec![(place.v == 0.0, k as usize), (place.u == 0.0, (k as usize + n - 1) % n)],
    };
    let sides: Vec<u32> = sides.into_iter().filter(|(on, _)| *on).map(|(_, k)| corners[k]).collect();
    let ends_there = |vertex: u32| {
        let ends = (0..topology.mesh().corner_count() as u32).filter(|&h| topology.twin(h).is_none());
        ends.flat_map(|h| [h, topology.next(h)]).any(|h| topology.mesh_vertex(h) == vertex)
    };
    match *sides.as_slice() {
        [a, b] => {
            let vertex = if topology.next(a) == b { b } else { a };
            ends_there(topology.mesh_vertex(vertex))
        }
        [side] => topology.twin(side).is_none(),
        _ => false,
    }
}

/// What is wrong with a tessellation.
pub fn fault(mesh: &ControlMesh, tessellation: &Tessellation<f64>) -> Option<String> {
    let topology = Topology::new(mesh);
    let positions = tessellation.positions();
    let mut numbers = HashMap::new();
    let welded: Vec<usize> = positions
        .iter()
        .map(|p| {
            let number = numbers.len();
            *numbers.entry(p.map(f64::to_bits)).or_insert(number)
        })
        .collect();
    let quads = tessellation.quads().iter().map(|face| face.to_vec());
    let faces: Vec<Vec<u32>> = quads.chain(tessellation.triangles().iter().map(|face| face.to_vec())).collect();
    let mut edges = HashMap::new();
    for face in &faces {
        for (i, &from) in face.iter().enumerate() {
            let to = face[(i + 1) % face.len()];
            let edge = (welded[from as usize], welded[to as usize]);
            if edge.0 == edge.1 {
                return Some(format!("{face:?} has a vertex twice"));
            }
            if edges.insert(edge, from).is_some() {
                return Some(format!("edge {from}-{to} is used twice in one direction"));
            }
        }
    }
    let places = tessellation.places();
    let mut count = 0;
    for (&(from, to), &vertex) in &edges {
        let is_twin = edges.contains_key(&(to, from));
        count += if is_twin && to < from { 0 } else { 1 };
        if !is_twin && !is_on_boundary(&topology, &places[vertex as usize]) {
            return Some(format!("an edge at {:?} has one face", places[vertex as usize]));
        }
    }
    let used: HashSet<u32> = faces.iter().flatten().map(|&vertex| tessellation.plan().position_of(vertex)).collect();
    let characteristic = |vertices: usize, edges: usize, faces: usize| (vertices + faces) as i64 - edges as i64;
    let expected = characteristic(topology.vertex_count(), mesh.edge_count(), mesh.face_count());
    if characteristic(used.len(), count, faces.len()) != expected {
        return Some(format!("{} vertices, {count} edges, {} faces: not as in the mesh", used.len(), faces.len()));
    }
    flat_face(tessellation, &faces)
}

/// A face without area, or a vertex of several that is not where they meet.
fn flat_face(tessellation: &Tessellation<f64>, faces: &[Vec<u32>]) -> Option<String> {
    let at = |vertex: u32| DVec3::from(tessellation.positions()[vertex as usize]);
    for face in faces {
        let area: DVec3 =
            (2..face.len()).map(|i| (at(face[i - 1]) - at(face[0])).cross(at(face[i]) - at(face[0]))).sum();
        let longest = face.iter().map(|&v| at(v).distance(at(face[0]))).fold(0.0, f64::max);
        if area.length() < 1e-9 * longest * longest {
            return Some(format!("{face:?} has no area"));
        }
    }
    (0..tessellation.positions().len() as u32)
        .find(|&vertex| at(vertex) != at(tessellation.plan().position_of(vertex)))
        .map(|vertex| format!("copy {vertex} is not where it should be"))
}

pub fn random_depth(random: &mut Random, mesh: &ControlMesh) -> Depth {
    match random.below(4) {
        0 => {
            let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
            let target = low + (high - low) * 0.5;
            let away = random.vector().as_vec3().normalize_or(glam::Vec3::X) * (high - low).length() * 1.2;
            let view =
                View::perspective((target + away).into(), target.into(), [0.1, 1.0, 0.2], 0.8, 1.0, [0.01, 100.0]);
            let view_projection = view.view_projection.map(|column| column.map(f64::from));
            let camera = Camera { view_projection, size: [100.0, 100.0] };
            Depth::Pixels { pixels: 2.0 + 10.0 * random.signed().abs(), camera }
        }
        1 => Depth::EdgeLength(mesh.diagonal() * (0.02 + 0.2 * random.signed().abs())),
        // Most shallow, some deep.
        _ => Depth::Each(
            (0..mesh.corner_count()).map(|_| 1 + random.below(7).min(random.below(7))).map(|d| d as u32).collect(),
        ),
    }
}

fn check_random(seeds: std::ops::Range<u64>) {
    for seed in seeds {
        let mut random = Random::new(seed);
        let mesh = match random.below(4) {
            0 => random_mesh(seed),
            1 => random_creased_mesh(seed),
            _ => shape(["cube", "tetrahedron", "fan", "strip"][random.below(4)]).unwrap(),
        };
        let depth = random_depth(&mut random, &mesh);
        let options = DiceOptions { depth, max_step: [1, 1, 2, 10][random.below(4)], max_depth: 4 };
        let tessellation = Tessellation::new(&Topology::new(&mesh), &options).unwrap();
        let fault = fault(&mesh, &tessellation);
        assert!(fault.is_none(), "seed {seed}: {options:?}: {}", fault.unwrap());
    }
}

#[test]
fn random_depths_leave_no_hole() {
    check_random(0..200);
}

#[test]
#[ignore = "takes minutes: cargo test --test cpu -- --ignored many_random_depths"]
fn many_random_depths_leave_no_hole() {
    check_random(200..10_200);
}

#[test]
fn creases_and_seams_leave_no_hole() {
    for name in ["machine-part", "creature-mixed", "valences", "cloth"] {
        let mesh = shape(name).unwrap();
        let depth = Depth::Each((0..mesh.corner_count() as u32).map(|facet| 1 + facet * 5 % 7 / 3).collect());
        let options = DiceOptions { depth, ..DiceOptions::default() };
        let tessellation = Tessellation::new(&Topology::new(&mesh), &options).unwrap();
        assert!(!tessellation.triangles().is_empty(), "{name}");
        assert_eq!(fault(&mesh, &tessellation), None, "{name}");
    }
}

#[test]
fn displacement_opens_no_crack() {
    for name in ["machine-part", "creature"] {
        let mesh = shape(name).unwrap();
        let mut tessellation = Tessellation::new(&Topology::new(&mesh), &DiceOptions::fixed(2)).unwrap();
        let before = tessellation.positions().to_vec();
        let diagonal = mesh.diagonal();
        tessellation.displace(|[u, v]| 0.002 * diagonal * f64::from((9.0 * u).sin() * (7.0 * v).cos())).unwrap();
        assert_ne!(before, tessellation.positions(), "{name}");
        assert_eq!(fault(&mesh, &tessellation), None, "{name}");
        assert!(tessellation.normals().iter().all(|&n| (DVec3::from(n).length() - 1.0).abs() < 1e-9), "{name}");
        tessellation.update(&mesh.data().positions).unwrap();
        assert_eq!(before, tessellation.positions(), "{name}");
    }
    let bare = MeshData { texcoords: None, ..shape("cube").unwrap().into_data() };
    let topology = Topology::new(&ControlMesh::new(bare).unwrap());
    let mut bare = Tessellation::<f64>::new(&topology, &DiceOptions::fixed(1)).unwrap();
    let error = bare.displace(|_| 1.0).unwrap_err();
    assert_eq!(error.to_string(), "the mesh has no texture coordinates, by which a height map is read: add some");
}

#[test]
fn what_makes_no_sense_is_refused() {
    let topology = Topology::new(&shape("cube").unwrap());
    let refuse = |options: DiceOptions| Tessellation::<f32>::size_of(&topology, &options).unwrap_err().to_string();
    let of = |depth| DiceOptions { depth, ..DiceOptions::default() };
    let bad_depth =
        |depth| format!("depth {depth}: a mesh is subdivided once at least, and 10 times at most: choose 1 to 10");
    assert_eq!(refuse(DiceOptions::fixed(0)), bad_depth(0));
    assert_eq!(refuse(DiceOptions { max_depth: 11, ..of(Depth::EdgeLength(1.0)) }), bad_depth(11));
    assert_eq!(refuse(of(Depth::Tolerance(0.0))), "tolerance 0: give a number above zero");
    assert_eq!(refuse(of(Depth::EdgeLength(f64::NAN))), "edge length NaN: give a number above zero");
    let few = "depths are given for 3 facets, but the mesh has 24, one a face corner";
    assert_eq!(refuse(of(Depth::Each(vec![1; 3]))), few);
    let mut tessellation = Tessellation::<f32>::new(&topology, &DiceOptions::fixed(1)).unwrap();
    let error = tessellation.update(&[[0.0; 3]; 7]).unwrap_err();
    assert_eq!(error.to_string(), "control positions are given for 7 vertices, but there are 8");
    let sizes = tessellation.plan().sizes();
    assert_eq!([sizes.vertices, sizes.positions, sizes.quads, sizes.triangles], [26, 26, 24, 0]);
}

/// In a plane, where a vertex on an edge of others would be seen.
#[test]
fn no_vertex_is_on_an_edge_of_others() {
    let at = |i: u32, j: u32| 4 * j + i;
    let faces =
        (0..9).map(|k| (k % 3, k / 3)).flat_map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    let mesh = ControlMesh::new(MeshData {
        positions: (0..16).map(|i| [f64::from(i % 4), f64::from(i / 4), 0.0]).collect(),
        face_sizes: vec![4; 9],
        face_vertices: faces.collect(),
        ..MeshData::default()
    })
    .unwrap();
    for seed in 0..6 {
        let mut random = Random::new(seed);
        let depth = Depth::Each((0..36).map(|_| 1 + random.below(4) as u32).collect());
        let options = DiceOptions { depth, max_step: [1, 10][seed as usize % 2], ..DiceOptions::default() };
        let tessellation = Tessellation::<f64>::new(&Topology::new(&mesh), &options).unwrap();
        let quads = tessellation.quads().iter().map(|face| face.to_vec());
        let faces = quads.chain(tessellation.triangles().iter().map(|face| face.to_vec()));
        let edges: HashSet<[u32; 2]> = faces
            .flat_map(|face| (0..face.len()).map(move |i| [face[i], face[(i + 1) % face.len()]]))
            .map(|[a, b]| [a.min(b), a.max(b)])
            .collect();
        let places: Vec<DVec3> = tessellation.positions().iter().map(|&p| p.into()).collect();
        for [a, b] in edges {
            let (from, along) = (places[a as usize], places[b as usize] - places[a as usize]);
            let between = places.iter().filter(|&&p| {
                let t = (p - from).dot(along) / along.length_squared();
                (1e-6..1.0 - 1e-6).contains(&t) && (p - from - t * along).length() < 1e-9
            });
            assert_eq!(between.count(), 0, "seed {seed}: on the edge {a}-{b}");
        }
    }
}

/// What is asked for by hand is what is made: an edge has the depth of its deeper side.
#[test]
fn coarse_facets_beside_fine_ones_are_stitched_with_triangles() {
    let topology = Topology::new(&shape("cube").unwrap());
    let mut depths = vec![1; 24];
    depths[0] = 3;
    let options = DiceOptions { depth: Depth::Each(depths), max_step: 10, ..DiceOptions::default() };
    let tessellation = Tessellation::<f32>::new(&topology, &options).unwrap();
    // One facet of 4 x 4, four neighbours with an edge in four pieces each: five triangles; the others as they were.
    assert_eq!((tessellation.quads().len(), tessellation.triangles().len()), (16 + 19, 4 * 5));
    assert_eq!(tessellation.plan().depth_histogram(), [0, 23, 0, 1]);
    // Without more of a step than one, the four neighbours are halved once more; only they meet the deeper one.
    let DiceOptions { depth, .. } = options;
    let graded = Tessellation::<f32>::new(&topology, &DiceOptions { depth, ..DiceOptions::default() }).unwrap();
    assert_eq!(graded.plan().depth_histogram(), [0, 19, 4, 1]);
}
