//! Hierarchical edits: the limit surface against meshes that are refined and changed by hand.

use crate::common::random::Random;
use crate::limit_surface::everything;
use ash_subdiv::limit::{LimitSurface, refine};
use ash_subdiv::mesh::{Change, Crease, CreaseMethod, Edit, SHARPNESS_INFINITE};
use ash_subdiv::patch::Scheme;
use ash_subdiv::table::{CpuSurface, Notice, prepare};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, MeshData, shape};
use glam::DVec3;

/// A face of a refined mesh, and where corner 0 of a path's face is among its corners.
#[derive(Debug, Clone, Copy)]
pub struct Found {
    face: u32,
    first: u32,
}

impl Found {
    pub fn vertex(self, mesh: &ControlMesh, corner: u32) -> u32 {
        mesh.face(self.face)[((self.first + corner) % 4) as usize]
    }
}

/// Refines a mesh and follows a path: a child of a quad has its corner k at corner k of the parent, of any other face its corner 0.
pub fn follow(mesh: &ControlMesh, face: u32, children: &[u32]) -> (ControlMesh, Found) {
    let (mut mesh, mut found) = (mesh.clone(), Found { face, first: 0 });
    for &child in children {
        let corners = mesh.face_corners(found.face);
        let size = corners.len() as u32;
        let face = corners.start as u32 + (found.first + child) % size;
        found = Found { face, first: if size == 4 { (4 - child) % 4 } else { 0 } };
        mesh = refine(&Topology::new(&mesh)).unwrap().mesh;
    }
    (mesh, found)
}

pub fn with(mesh: &ControlMesh, edits: Vec<Edit>) -> ControlMesh {
    ControlMesh::new(MeshData { edits, ..mesh.data().clone() }).unwrap()
}

/// The greatest distance between the limit surfaces of an edited mesh and of one that is refined so often, over the diagonal.
fn distance(edited: &ControlMesh, refined: &ControlMesh, levels: u32) -> f64 {
    let (a, b) = (LimitSurface::new(edited).unwrap(), LimitSurface::new(refined).unwrap());
    let mut most = 0.0f64;
    for face in 0..edited.face_count() as u32 {
        for sub in a.subs(face) {
            for (u, v) in [(0.0, 0.0), (0.25, 0.5), (0.3, 0.9), (0.61, 0.17), (1.0, 1.0), (0.9, 0.0)] {
                let (mut at, mut first, mut uv) = (face, 0, [u, v]);
                for level in 0..levels {
                    let corners = at as usize * 4;
                    let (child, start) = match (level, sub) {
                        (0, 0..) => {
                            at = edited.face_corners(face).start as u32 + sub as u32;
                            continue;
                        }
                        (0, _) => (0, edited.face_corners(face).start as u32),
                        _ => (0, corners as u32),
                    };
                    let k = match (uv[0] < 0.5, uv[1] < 0.5) {
                        (true, true) => child,
                        (false, true) => 1,
                        (false, false) => 2,
                        (true, false) => 3,
                    };
                    at = start + (first + k) % 4;
                    first = (4 - k) % 4;
                    uv = uv.map(|t| if t < 0.5 { 2.0 * t } else { 2.0 * t - 1.0 });
                }
                // The refined face's own u and v begin at its corner 0.
                let [u2, v2] = uv;
                let [u2, v2] = match first {
                    0 => [u2, v2],
                    // Corner 0 of the path is corner 1, 2, 3 of the face.
                    1 => [1.0 - v2, u2],
                    2 => [1.0 - u2, 1.0 - v2],
                    _ => [v2, 1.0 - u2],
                };
                let (p, q) = (a.evaluate(face, sub, u, v), b.evaluate(at, -1, u2, v2));
                most = most.max(p.position.distance(q.position) / edited.diagonal());
            }
        }
    }
    most
}

/// A path to a face at some level, at random.
pub fn random_path(random: &mut Random, mesh: &ControlMesh, level: usize) -> (u32, Vec<u32>) {
    let face = random.below(mesh.face_count()) as u32;
    let size = mesh.face(face).len();
    (face, (0..level).map(|i| random.below(if i == 0 { size } else { 4 }) as u32).collect())
}

pub fn meshes() -> Vec<(&'static str, ControlMesh)> {
    let mut meshes: Vec<_> =
        ["cube", "tetrahedron", "machine-part", "cloth", "fan"].map(|name| (name, shape(name).unwrap())).into();
    meshes.push(("everything", everything(CreaseMethod::Uniform)));
    meshes.push(("everything by Chaikin", everything(CreaseMethod::Chaikin)));
    meshes
}

#[test]
fn offsets_are_those_of_the_refined_mesh() {
    for (name, mesh) in meshes() {
        let mut random = Random::new(7);
        for level in [1, 2, 1, 2] {
            let (face, children) = random_path(&mut random, &mesh, level);
            let (fine, found) = follow(&mesh, face, &children);
            let corner = random.below(4) as u32;
            let vertex = found.vertex(&fine, corner) as usize;
            let offset = random.vector() * 0.1 * mesh.diagonal();
            let place = DVec3::from(fine.data().positions[vertex]) + offset;
            let mut data = fine.into_data();
            data.positions[vertex] = place.into();
            let by_hand = ControlMesh::new(data).unwrap();
            for change in
                [Change::Offset { corner, offset: offset.into() }, Change::Position { corner, position: place.into() }]
            {
                let edited = with(&mesh, vec![Edit { face, children: children.clone(), change }]);
                let error = distance(&edited, &by_hand, level as u32);
                assert!(error < 1e-14, "{name}: {:?}: {error}", edited.data().edits);
                assert!(distance(&mesh, &by_hand, level as u32) > 1e-4, "{name}: the edit can be seen");
            }
        }
    }
}

#[test]
fn sharpness_is_that_of_the_refined_mesh() {
    for (name, mesh) in meshes() {
        let mut random = Random::new(11);
        for sharpness in [0.0, 0.6, 2.5, SHARPNESS_INFINITE] {
            let (face, children) = random_path(&mut random, &mesh, 1);
            let (fine, found) = follow(&mesh, face, &children);
            let at = random.below(4) as u32;
            let [from, to] = [at, at + 1].map(|corner| found.vertex(&fine, corner));
            let edit = |change| with(&mesh, vec![Edit { face, children: children.clone(), change }]);

            let mut data = fine.clone().into_data();
            data.creases.push(Crease { vertices: [from, to], sharpness });
            let error =
                distance(&edit(Change::EdgeSharpness { edge: at, sharpness }), &ControlMesh::new(data).unwrap(), 1);
            assert!(error < 1e-14, "{name}: edge {at} of {face} {children:?}: {error}");

            let mut data = fine.clone().into_data();
            data.corners.push(ash_subdiv::mesh::Corner { vertex: from, sharpness });
            let edited = edit(Change::CornerSharpness { corner: at, sharpness });
            let error = distance(&edited, &ControlMesh::new(data).unwrap(), 1);
            assert!(error < 1e-14, "{name}: corner {at} of {face} {children:?}: {error}");
        }
    }
}

/// Edits of all kinds but holes, at levels 1 to 3.
pub fn random_edits(random: &mut Random, mesh: &ControlMesh, count: usize) -> Vec<Edit> {
    let size = mesh.diagonal();
    let edit = |_| {
        let level = 1 + random.below(3);
        let (face, children) = random_path(random, mesh, level);
        let at = random.below(4) as u32;
        let offset = random.vector() * 0.04 * size / f64::from(1 << level);
        let sharpness = [0.0, 0.7, 2.0, 3.5][random.below(4)];
        let change = match random.below(5) {
            0 => Change::FrameOffset { corner: at, offset: offset.into() },
            1 => Change::CornerSharpness { corner: at, sharpness },
            2 => Change::EdgeSharpness { edge: at, sharpness },
            _ => Change::Offset { corner: at, offset: offset.into() },
        };
        Edit { face, children, change }
    };
    (0..count).map(edit).collect()
}

#[test]
fn edits_that_name_what_is_not_there_are_refused() {
    let mesh = shape("tetrahedron").unwrap();
    let refuse = |face: u32, children: &[u32], change: Change| {
        let edits = vec![Edit { face, children: children.to_vec(), change }];
        ControlMesh::new(MeshData { edits, ..mesh.data().clone() }).unwrap_err().to_string()
    };
    let offset = |corner| Change::Offset { corner, offset: [0.0; 3] };
    assert_eq!(refuse(4, &[], Change::Hole), "edit 0: level 0: it names face 4, but the mesh has 4 faces");
    let child = "there is no child 3: the face has 3 (0 to 2)";
    assert_eq!(refuse(1, &[3], Change::Hole), format!("edit 0: level 1: {child}"));
    let child = "there is no child 4: the face has 4 (0 to 3)";
    assert_eq!(refuse(1, &[0, 3, 4], Change::Hole), format!("edit 0: level 3: {child}"));
    assert_eq!(refuse(1, &[], offset(3)), "edit 0: level 0: there is no corner 3: the face has 3 (0 to 2)");
    assert_eq!(refuse(1, &[2], offset(4)), "edit 0: level 1: there is no corner 4: the face has 4 (0 to 3)");
    let edge = Change::EdgeSharpness { edge: 4, sharpness: 1.0 };
    assert_eq!(refuse(1, &[2], edge), "edit 0: level 1: there is no edge 4: the face has 4 (0 to 3)");
    assert_eq!(refuse(0, &[0; 11], Change::Hole), "edit 0: it is at level 11, but edits go down to level 10");
    let frame = Change::FrameOffset { corner: 0, offset: [0.0; 3] };
    let at_once = "an offset in the tangent frame is at level 1 or finer: name a child, or move the vertex";
    assert_eq!(refuse(0, &[], frame), format!("edit 0: {at_once}"));
    let blunt = Change::CornerSharpness { corner: 0, sharpness: -1.0 };
    let sharpness = "sharpness -1: sharpness is a number from 0 up (10 and more is infinitely sharp)";
    assert_eq!(refuse(0, &[1], blunt), format!("edit 0: {sharpness}"));
    let nowhere = Change::Position { corner: 0, position: [0.0, f64::NAN, 1.5] };
    let finite = "(0, NaN, 1.5) is no place: give finite numbers of at most 3.4e38";
    assert_eq!(refuse(0, &[1], nowhere), format!("edit 0: {finite}"));
}

/// Edits at level 0 are made at once.
#[test]
fn the_control_mesh_can_be_edited() {
    let mesh = shape("cube").unwrap();
    let edit = |change| Edit { face: 3, children: Vec::new(), change };
    let edited = with(
        &mesh,
        vec![
            edit(Change::Offset { corner: 1, offset: [0.5, 0.0, 0.0] }),
            edit(Change::CornerSharpness { corner: 3, sharpness: 2.0 }),
            edit(Change::EdgeSharpness { edge: 3, sharpness: 1.5 }),
            edit(Change::Hole),
        ],
    );
    let face = mesh.face(3);
    assert_eq!(edited.position(face[1]), mesh.position(face[1]) + DVec3::new(0.5, 0.0, 0.0));
    assert_eq!(edited.vertex_sharpness(face[3]), 2.0);
    assert_eq!(edited.sharpness(mesh.face_corners(3).start as u32 + 3), 1.5);
    assert_eq!((&edited.data().holes, edited.data().edits.len(), edited.edit_level()), (&vec![3], 0, 0));
}

/// What draws patches has the mesh refined, and keeps the edits when vertices move.
#[test]
fn prepared_meshes_have_their_edits() {
    let mesh = shape("machine-part").unwrap();
    let mut random = Random::new(5);
    let edited = with(&mesh, random_edits(&mut random, &mesh, 6));
    let prepared = prepare(&edited, 0).unwrap();
    assert_eq!((prepared.steps.len(), prepared.mesh().edit_level()), (edited.edit_level(), 0));
    let moved: Vec<[f64; 3]> =
        mesh.data().positions.iter().map(|&p| (DVec3::from(p) * 1.1 + 0.1 * random.vector()).into()).collect();
    let moved = ControlMesh::new(MeshData { positions: moved, ..edited.data().clone() }).unwrap();
    let again = prepare(&moved, 0).unwrap();
    for (mesh, expected) in [(&edited, prepared.mesh()), (&moved, again.mesh())] {
        let control: Vec<DVec3> = mesh.data().positions.iter().map(|&p| p.into()).collect();
        let refined = prepared.steps.iter().fold(control, |vertices, step| step.apply(&vertices));
        let expected: Vec<DVec3> = expected.data().positions.iter().map(|&p| p.into()).collect();
        assert_eq!(refined, expected);
    }
    let surface = CpuSurface::new(&edited, Scheme::Gregory, 0).unwrap();
    let notice = Notice::RefinedEdits { count: 6, level: edited.edit_level() };
    assert!(surface.notices().contains(&notice), "{:?}", surface.notices());
}
