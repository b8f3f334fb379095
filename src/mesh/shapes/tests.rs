use super::*;
use crate::mesh::{NO_TWIN, SHARPNESS_INFINITE};
use glam::DVec3;
use std::collections::{BTreeSet, HashMap, HashSet};

fn get(name: &str) -> ControlMesh {
    shape(name).unwrap()
}

/// Edges and faces at every vertex.
fn valences(mesh: &ControlMesh) -> Vec<(u32, u32)> {
    let mut valences = vec![(0, 0); mesh.vertex_count()];
    for face in 0..mesh.face_count() as u32 {
        let vertices = mesh.face(face);
        for (k, half_edge) in mesh.face_corners(face).enumerate() {
            valences[vertices[k] as usize].1 += 1;
            let twin = mesh.twins()[half_edge];
            if twin == NO_TWIN || half_edge < twin as usize {
                valences[vertices[k] as usize].0 += 1;
                valences[vertices[(k + 1) % vertices.len()] as usize].0 += 1;
            }
        }
    }
    valences
}

/// The part of the faces that are no quads or have an interior vertex of a valence other than 4.
fn irregular_share(mesh: &ControlMesh) -> f64 {
    let valences = valences(mesh);
    let odd = |&v: &u32| valences[v as usize].0 == valences[v as usize].1 && valences[v as usize].0 != 4;
    let irregular = |&f: &u32| mesh.face(f).len() != 4 || mesh.face(f).iter().any(odd);
    (0..mesh.face_count() as u32).filter(irregular).count() as f64 / mesh.face_count() as f64
}

fn volume(mesh: &ControlMesh) -> f64 {
    let fan = |f: u32| {
        let p: Vec<DVec3> = mesh.face(f).iter().map(|&v| mesh.position(v)).collect();
        (1..p.len() - 1).map(|i| p[0].dot(p[i].cross(p[i + 1])) / 6.0).sum::<f64>()
    };
    (0..mesh.face_count() as u32).map(fan).sum()
}

fn euler(mesh: &ControlMesh) -> i64 {
    mesh.vertex_count() as i64 - mesh.edge_count() as i64 + mesh.face_count() as i64
}

#[test]
fn every_shape_is_made_the_same_each_time() {
    for info in shapes() {
        assert_eq!(get(info.name), get(info.name), "{}", info.name);
        assert!(!info.summary.is_empty());
    }
}

#[test]
fn shapes_lie_around_the_origin() {
    for info in shapes() {
        let [low, high] = get(info.name).bounds();
        let name = info.name;
        assert!((2.0..=4.0).contains(&(high - low).max_element()), "{name}: {low} {high}");
        assert!(((low + high) / 2.0).length() < 0.6, "{name}: {low} {high}");
    }
}

#[test]
fn unknown_names_list_the_known_ones() {
    let message = shape("teapot").unwrap_err().to_string();
    assert!(message.starts_with("there is no shape named \"teapot\": choose one of creature, "), "{message}");
    assert!(shapes().iter().all(|info| message.contains(info.name)));
}

#[test]
fn closed_shapes_are_closed_and_face_outward() {
    // Vertices - edges + faces: two less two a handle.
    let closed = [
        ("creature", 2),
        ("creature-mixed", 2),
        ("machine-part", -10),
        ("polygons", 2),
        ("valences", 2),
        ("tentacle", 2),
        ("torus", 0),
        ("cube", 2),
        ("tetrahedron", 2),
    ];
    for (name, characteristic) in closed {
        let mesh = get(name);
        assert_eq!(mesh.boundary_edge_count(), 0, "{name}");
        assert_eq!(euler(&mesh), characteristic, "{name}");
        assert!(volume(&mesh) > 0.5, "{name}: {}", volume(&mesh));
        assert!(valences(&mesh).iter().all(|&(edges, faces)| edges == faces && edges >= 3), "{name}");
    }
}

#[test]
fn every_vertex_has_one_fan_of_faces() {
    for info in shapes() {
        let fans_in_one = |&(edges, faces): &(u32, u32)| edges == faces || edges == faces + 1;
        assert!(valences(&get(info.name)).iter().all(fans_in_one), "{}", info.name);
    }
}

#[test]
fn no_face_folds_back_on_itself() {
    for info in shapes() {
        let mesh = get(info.name);
        for face in 0..mesh.face_count() as u32 {
            let p: Vec<DVec3> = mesh.face(face).iter().map(|&v| mesh.position(v)).collect();
            let n = p.len();
            let area: DVec3 = (0..n).map(|i| p[i].cross(p[(i + 1) % n])).sum();
            assert!(area.length() > 1e-5, "{} face {face}", info.name);
        }
    }
}

#[test]
fn texture_coordinates_are_in_the_unit_square() {
    let with = ["creature", "creature-mixed", "machine-part", "valences", "cloth", "torus", "strip", "single-quad"];
    for name in with {
        let texcoords = get(name).into_data().texcoords.expect(name);
        assert!(texcoords.values.iter().flatten().all(|x| (0.0..=1.0).contains(x)), "{name}");
        let used: HashSet<_> = texcoords.indices.iter().collect();
        assert_eq!(used.len(), texcoords.values.len(), "{name}: values nothing uses");
    }
}

#[test]
fn the_atlas_does_not_overlap_and_has_seams() {
    for name in ["creature", "machine-part", "valences"] {
        let mesh = get(name);
        let texcoords = mesh.data().texcoords.as_ref().unwrap();
        let corner = |c: usize| texcoords.values[texcoords.indices[c] as usize];
        // Every face is a square of one size, so faces overlap only if their middles are nearer than a side.
        let side = corner(0)[0] - corner(1)[0];
        let side = side.abs().max((corner(0)[1] - corner(1)[1]).abs());
        let mut cells = HashMap::<[i32; 2], Vec<[f32; 2]>>::new();
        for face in 0..mesh.face_count() {
            let p = [0, 1, 2, 3].map(|k| corner(4 * face + k));
            let area = (p[2][0] - p[0][0]) * (p[3][1] - p[1][1]) - (p[3][0] - p[1][0]) * (p[2][1] - p[0][1]);
            assert!((area / (2.0 * side * side) - 1.0).abs() < 1e-3, "{name} face {face}: turned over or no square");
            let middle = [0, 1].map(|k| (p[0][k] + p[2][k]) / 2.0);
            let [x, y] = middle.map(|m| (m / side) as i32);
            for near in (-1..=1).flat_map(|i| (-1..=1).map(move |j| [x + i, y + j])) {
                for other in cells.get(&near).into_iter().flatten() {
                    let apart = (middle[0] - other[0]).abs().max((middle[1] - other[1]).abs());
                    assert!(apart > 0.99 * side, "{name} face {face}");
                }
            }
            cells.entry([x, y]).or_default().push(middle);
        }
        assert!(texcoords.values.len() > mesh.vertex_count(), "{name}: a closed mesh needs seams");
        assert!(texcoords.values.len() < 2 * mesh.vertex_count(), "{name}: neighbours are torn apart");
    }
}

#[test]
fn creature_is_all_quad_and_half_irregular() {
    let mesh = get("creature");
    assert!((1200..=1500).contains(&mesh.face_count()), "{}", mesh.face_count());
    assert!(mesh.data().face_sizes.iter().all(|&size| size == 4));
    assert!((0.4..=0.6).contains(&irregular_share(&mesh)), "{}", irregular_share(&mesh));
    let found: BTreeSet<_> = valences(&mesh).iter().map(|v| v.0).collect();
    assert!(found.is_superset(&BTreeSet::from([3, 4, 5, 6])), "{found:?}");
}

#[test]
fn creature_is_symmetrical() {
    let mesh = get("creature");
    let bits = |p: [f64; 3]| p.map(|x| (x + 0.0).to_bits());
    let places: HashSet<_> = mesh.data().positions.iter().map(|&p| bits(p)).collect();
    assert_eq!(places.len(), mesh.vertex_count());
    assert!(mesh.data().positions.iter().all(|&[x, y, z]| places.contains(&bits([-x, y, z]))));
}

#[test]
fn a_third_of_the_mixed_creature_is_split() {
    let (quads, mixed) = (get("creature"), get("creature-mixed"));
    let split = mixed.data().face_sizes.iter().filter(|&&size| size == 3).count() / 2;
    let share = split as f64 / quads.face_count() as f64;
    assert!((0.28..0.38).contains(&share), "{share}");
    assert_eq!(mixed.face_count(), quads.face_count() + split);
    assert_eq!(mixed.data().positions, quads.data().positions);
}

#[test]
fn cloth_has_boundary_vertices_of_one_two_and_three_faces() {
    let mesh = get("cloth");
    let boundary = valences(&mesh).into_iter().filter(|v| v.0 != v.1);
    assert_eq!(boundary.map(|v| v.1).collect::<BTreeSet<_>>(), BTreeSet::from([1, 2, 3]));
    assert_eq!(euler(&mesh), 0, "a disc with one hole");
}

#[test]
fn valences_has_each_from_3_to_12() {
    let mesh = get("valences");
    let found: BTreeSet<_> = valences(&mesh).iter().map(|v| v.0).collect();
    assert_eq!(found, (3..=12).collect());
    assert!(mesh.data().face_sizes.iter().all(|&size| size == 4));
}

#[test]
fn polygons_has_triangles_quads_pentagons_and_hexagons() {
    let mesh = get("polygons");
    let count = |n| mesh.data().face_sizes.iter().filter(|&&size| size == n).count();
    assert_eq!([3, 4, 5, 6].map(count), [60, 90, 12, 20]);
    assert_eq!(mesh.face_count(), 182);
}

#[test]
fn machine_part_has_sharp_and_semi_sharp_creases_and_corners() {
    let mesh = get("machine-part");
    assert!(mesh.data().face_sizes.iter().all(|&size| size == 4));
    let count = |sharpness: f32| mesh.data().creases.iter().filter(|c| c.sharpness == sharpness).count();
    // The hub's face has two rims of 30 edges; each of five bosses has two of 10.
    assert_eq!(count(2.0), 60);
    assert_eq!(count(1.5), 100);
    assert_eq!(count(SHARPNESS_INFINITE) + 160, mesh.data().creases.len());
    assert!(count(SHARPNESS_INFINITE) > 200);
    assert_eq!(mesh.data().corners.len(), 10, "two a rib");
}

#[test]
fn small_open_shapes() {
    let faces = |name| get(name).face_count();
    assert_eq!(["strip", "fan", "single-quad"].map(faces), [8, 9, 1]);
    for name in ["strip", "fan", "single-quad"] {
        assert_eq!(euler(&get(name)), 1, "{name} is a disc");
    }
    assert_eq!(valences(&get("fan"))[0], (9, 9));
}

#[test]
fn grid_torus_is_regular() {
    let mesh = ControlMesh::new(grid_torus(5, 3)).unwrap();
    assert_eq!((mesh.vertex_count(), mesh.face_count()), (15, 15));
    assert_eq!(irregular_share(&mesh), 0.0);
    assert!(volume(&mesh) > 0.0);
}

#[test]
fn replicate_repeats_everything() {
    let mut data = shape("machine-part").unwrap().into_data();
    data.holes = vec![1, 5];
    let mesh = ControlMesh::new(data).unwrap();
    let copies = replicate(&mesh, [2, 1, 3], 1.25).unwrap();
    let (one, all) = (mesh.data(), copies.data());
    assert_eq!(copies.face_count(), 6 * mesh.face_count());
    assert_eq!(euler(&copies), 6 * euler(&mesh));
    assert_eq!((all.creases.len(), all.corners.len()), (6 * one.creases.len(), 6 * one.corners.len()));
    let faces = mesh.face_count() as u32;
    assert_eq!(all.holes, (0..6).flat_map(|k| [1 + k * faces, 5 + k * faces]).collect::<Vec<_>>());
    // The last copy: tags and texture coordinates name its own vertices and values.
    let vertices = 5 * mesh.vertex_count() as u32;
    assert_eq!(all.creases[5 * one.creases.len()].vertices, one.creases[0].vertices.map(|v| v + vertices));
    assert_eq!(all.corners[5 * one.corners.len()].vertex, one.corners[0].vertex + vertices);
    let (one_uv, all_uv) = (one.texcoords.as_ref().unwrap(), all.texcoords.as_ref().unwrap());
    assert_eq!(all_uv.values.len(), 6 * one_uv.values.len());
    assert_eq!(all_uv.indices[5 * mesh.corner_count()], one_uv.indices[0] + 5 * one_uv.values.len() as u32);
    let step = copies.position(mesh.vertex_count() as u32) - copies.position(0);
    let [low, high] = mesh.bounds();
    assert!((step - DVec3::X * 1.25 * (high.x - low.x)).length() < 1e-12);
}

#[test]
fn replicate_refuses_nothing_too_much_and_nonsense() {
    let cube = get("cube");
    assert!(matches!(replicate(&cube, [0, 1, 1], 1.0), Err(MeshError::Empty { .. })));
    assert!(matches!(replicate(&cube, [u32::MAX; 3], 1.0), Err(MeshError::TooLarge { .. })));
    assert!(matches!(replicate(&cube, [2, 1, 1], f64::NAN), Err(MeshError::NotFinite { .. })));
}

#[test]
fn the_tentacle_bends_curls_and_swallows() {
    let Animated { mesh, animations, .. } = animated_shape("tentacle").unwrap();
    let rest = mesh.data().positions.clone();
    let at = |name: &str, seconds: f64| {
        let mut positions = vec![[0.0; 3]; rest.len()];
        animations.positions_f64(animations.find(name).unwrap(), seconds, &mut positions).unwrap();
        positions.into_iter().map(DVec3::from).collect::<Vec<_>>()
    };
    let farthest = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    let still: Vec<DVec3> = rest.iter().map(|&p| p.into()).collect();
    for name in ["wave", "curl", "swallow"] {
        assert!(farthest(&at(name, 0.0), &at(name, 2.0)) < 1e-12, "{name} goes on where it began");
        assert!(farthest(&at(name, 1.3), &still) > 0.1, "{name} moves");
    }
    for name in ["curl", "swallow"] {
        assert!(farthest(&at(name, 0.0), &still) < 1e-12, "{name} begins at rest");
    }
    // Joint j turns by 10 + 8 j degrees about z: the tip has turned by all, but for the blend towards the joints before it.
    let curled = at("curl", 1.0);
    let tip = |p: &[DVec3]| {
        let ring = &p[16 * 8..17 * 8];
        (ring[2] - ring[0]).cross(ring[4] - ring[2]).normalize()
    };
    let turned = (0..7).map(|joint| -10.0 - 8.0 * f64::from(joint)).sum::<f64>().to_radians();
    assert!(tip(&still).distance(-DVec3::Y) < 1e-9 || tip(&still).distance(DVec3::Y) < 1e-9);
    let expected = glam::DQuat::from_rotation_z(turned) * tip(&still);
    assert!(tip(&curled).angle_between(expected) < 20f64.to_radians(), "{} {expected}", tip(&curled));
    // Bulges rise around the axis, at heights that stay.
    let swollen = at("swallow", 0.4);
    assert!(swollen.iter().zip(&still).all(|(a, b)| (a.y - b.y).abs() < 1e-12));
    assert!(swollen.iter().zip(&still).all(|(a, b)| a.with_y(0.0).length() >= b.with_y(0.0).length() - 1e-12));
}
