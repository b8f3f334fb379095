//! Hierarchical edits in tessellations, against the limit surface.

use crate::common::{self, random::Random};
use crate::dice::errors;
use crate::dice_closed::{fault, random_depth};
use crate::dice_tolerance::measure;
use crate::edits::{follow, meshes, random_edits, random_path, with};
use ash_subdiv::dice::{Depth, DiceOptions, Place, Tessellation};
use ash_subdiv::limit::LimitSurface;
use ash_subdiv::mesh::{Change, Crease, CreaseMethod, Edit, ReadOptions, read};
use ash_subdiv::topology::Topology;
use ash_subdiv::{ControlMesh, MeshData, grid_torus, shape};
use glam::{DQuat, DVec3};
use rayon::prelude::*;
use std::collections::HashSet;

#[test]
fn a_vertex_that_is_set_to_where_it_is_changes_nothing() {
    for (name, mesh) in meshes() {
        let mut random = Random::new(3);
        let (face, children) = random_path(&mut random, &mesh, 2);
        let (fine, found) = follow(&mesh, face, &children);
        let edits = (0..4u32).flat_map(|corner| {
            let position = fine.data().positions[found.vertex(&fine, corner) as usize];
            [Change::Position { corner, position }, Change::FrameOffset { corner, offset: [0.0; 3] }]
        });
        let edits = edits.map(|change| Edit { face, children: children.clone(), change }).collect();
        let edited = with(&mesh, edits);
        let tessellate =
            |mesh: &ControlMesh| Tessellation::<f64>::new(&Topology::new(mesh), &DiceOptions::fixed(3)).unwrap();
        let (a, b) = (tessellate(&edited), tessellate(&mesh));
        assert_eq!((a.quads(), a.triangles()), (b.quads(), b.triangles()), "{name}");
        for (p, q) in a.positions().iter().zip(b.positions()) {
            let error = DVec3::from(*p).distance((*q).into()) / mesh.diagonal();
            assert!(error < 2e-15, "{name}: {error}");
        }
    }
}

#[test]
fn tessellations_have_the_edits_of_the_limit_surface() {
    for (name, mesh) in meshes() {
        for seed in 0..2 {
            let mut random = Random::new(seed);
            let edited = with(&mesh, random_edits(&mut random, &mesh, 5));
            let topology = Topology::new(&edited);
            let depths = (0..mesh.corner_count()).map(|facet| [1, 3, 2, 4][facet * 7 % 11 % 4]).collect();
            let options = DiceOptions { depth: Depth::Each(depths), max_step: 3, ..DiceOptions::default() };
            let mut tessellation = Tessellation::<f64>::new(&topology, &options).unwrap();
            let found = errors(&edited, &tessellation);
            assert!(found.position < 1e-12 && found.normal < 1e-6, "{name}: {seed}: {found:?}");

            let moved: Vec<[f64; 3]> = mesh
                .data()
                .positions
                .iter()
                .map(|&p| (DVec3::from(p) + 0.02 * mesh.diagonal() * random.vector()).into())
                .collect();
            tessellation.update(&moved).unwrap();
            let mesh = ControlMesh::new(MeshData { positions: moved, ..edited.data().clone() }).unwrap();
            let found = errors(&mesh, &tessellation);
            assert!(found.position < 1e-12 && found.normal < 1e-6, "{name}: {seed}: moved: {found:?}");
        }
    }
}

/// Chaikin's rule hands sharpness on along creases.
#[test]
fn sharpness_reaches_along_creases() {
    let data = MeshData { crease_method: CreaseMethod::Chaikin, ..grid_torus(12, 8) };
    let mut random = Random::new(2);
    let edges = data.face_vertices.chunks_exact(4).flat_map(|face| [[face[0], face[1]], [face[1], face[2]]]);
    // In the second kind weak creases are fully sharp for what is at both of their ends, the far one too.
    for kinds in [[0.0, 0.3, 1.2, 2.1, 4.5], [0.3, 0.3, 0.7, 6.0, 6.0]] {
        let crease = |vertices| Crease { vertices, sharpness: kinds[random.below(5)] };
        let creases: Vec<Crease> = edges.clone().map(crease).collect();
        let mesh = ControlMesh::new(MeshData { creases, ..data.clone() }).unwrap();
        sharpness_reaches_along(&mesh);
    }
}

fn sharpness_reaches_along(mesh: &ControlMesh) {
    for (face, children, edge) in [(30, &[1, 0][..], 0), (3, &[1, 1], 0), (55, &[0, 0], 3), (77, &[0, 1, 1], 0)] {
        let edit = Edit { face, children: children.to_vec(), change: Change::EdgeSharpness { edge, sharpness: 8.0 } };
        let edited = with(mesh, vec![edit]);
        let tessellation = Tessellation::<f64>::new(&Topology::new(&edited), &DiceOptions::fixed(3)).unwrap();
        let surface = LimitSurface::new(&edited).unwrap();
        let of_vertex = |(place, &position): (&Place, &[f64; 3])| {
            let limit = surface.evaluate(place.face, place.sub, place.u.into(), place.v.into()).position;
            limit.distance(position.into()) / mesh.diagonal()
        };
        let places = tessellation.places();
        let error = places.par_iter().zip(tessellation.positions()).map(of_vertex).reduce(|| 0.0, f64::max);
        // Sharpness is of single precision, and summed in another order in other parts of the mesh.
        assert!(error < 1e-9, "{children:?} {edge}: {error}");
    }
}

#[test]
fn edits_are_local() {
    let mesh = shape("creature").unwrap();
    let edit =
        Edit { face: 100, children: vec![1, 2, 3], change: Change::Offset { corner: 2, offset: [0.0, 0.0, 0.1] } };
    let edited = with(&mesh, vec![edit]);
    let tessellate =
        |mesh: &ControlMesh| Tessellation::<f64>::new(&Topology::new(mesh), &DiceOptions::fixed(4)).unwrap();
    let (a, b) = (tessellate(&edited), tessellate(&mesh));
    let moved = a.positions().iter().zip(b.positions()).filter(|(p, q)| p != q).count();
    let far =
        a.positions().iter().zip(b.positions()).filter(|(p, q)| DVec3::from(**p).distance((**q).into()) > 1e-9).count();
    // Two rings of faces at level 3 around the vertex, of two segments a side each: 7 x 7 points within.
    assert_eq!(far, 49);
    assert!(moved < 2000, "{moved}");
}

/// On a plane, frames are the axes; they turn with the mesh.
#[test]
fn offsets_in_tangent_frames_follow_the_surface() {
    // Parallelograms, in which u and v run as along edges.
    let at = |i: u32, j: u32| 6 * j + i;
    let places = (0..36).map(|i| [f64::from(i % 6) + 0.3 * f64::from(i / 6), f64::from(i / 6), 0.0]);
    let faces =
        (0..25).map(|i| (i % 5, i / 5)).flat_map(|(i, j)| [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
    let (positions, face_vertices) = (places.collect(), faces.collect());
    let mesh = ControlMesh::new(MeshData { positions, face_sizes: vec![4; 25], face_vertices, ..MeshData::default() })
        .unwrap();
    let offset = [0.01, 0.02, 0.05];
    let face = mesh.face_count() as u32 / 2;
    let [a, b, _, d] = [0, 1, 2, 3].map(|k| mesh.position(mesh.face(face)[k]));
    let (u, v) = ((b - a).normalize(), (d - a).normalize());
    for (child, corner, second) in [(0, 1, None), (1, 2, None), (2, 3, Some(1)), (3, 0, Some(2)), (1, 0, Some(3))] {
        let children: Vec<u32> = std::iter::once(child).chain(second).collect();
        let edited = |change| with(&mesh, vec![Edit { face, children: children.clone(), change }]);
        let in_frame = edited(Change::FrameOffset { corner, offset });
        let in_space = offset[0] * u + offset[1] * v + offset[2] * u.cross(v).normalize();
        let in_space = edited(Change::Offset { corner, offset: in_space.into() });
        let options = DiceOptions::fixed(3);
        let of = |mesh: &ControlMesh| Tessellation::<f64>::new(&Topology::new(mesh), &options).unwrap();
        let (a, b) = (of(&in_frame), of(&in_space));
        for (p, q) in a.positions().iter().zip(b.positions()) {
            assert!(
                DVec3::from(*p).distance((*q).into()) < 1e-12 * mesh.diagonal(),
                "{children:?} {corner}: {p:?} {q:?}"
            );
        }
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 3.0).normalize(), 1.2);
        let turned: Vec<[f64; 3]> = mesh.data().positions.iter().map(|&p| (turn * DVec3::from(p)).into()).collect();
        let mut c = of(&in_frame);
        c.update(&turned).unwrap();
        for (p, q) in a.positions().iter().zip(c.positions()) {
            let error = (turn * DVec3::from(*p)).distance((*q).into()) / mesh.diagonal();
            assert!(error < 1e-12, "{children:?} {corner}: {error}");
        }
    }
}

#[test]
fn holes_are_the_faces_that_are_named() {
    let mesh = shape("cube").unwrap();
    let hole = |children: &[u32]| Edit { face: 2, children: children.to_vec(), change: Change::Hole };
    for (children, depth, left) in [
        (&[1][..], 3, 6 * 64 - 16),
        (&[1, 3][..], 3, 6 * 64 - 4),
        (&[1, 3, 0][..], 3, 6 * 64 - 1),
        (&[1, 3][..], 4, 6 * 256 - 16),
    ] {
        let edited = with(&mesh, vec![hole(children)]);
        let of =
            |mesh: &ControlMesh| Tessellation::<f64>::new(&Topology::new(mesh), &DiceOptions::fixed(depth)).unwrap();
        let (with_hole, whole) = (of(&edited), of(&mesh));
        assert_eq!(with_hole.quads().len(), left, "{children:?}");
        // Every face that is left lies outside what is named, in u and v of the face.
        let [mut at, mut size] = [[0.0, 0.0], [0.5, 0.5]];
        for &child in children {
            let [i, j] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]][child as usize];
            at = [at[0] + i * size[0], at[1] + j * size[1]];
            size = size.map(|s| s / 2.0);
        }
        let size = 2.0 * size[0];
        let surface = LimitSurface::new(&mesh).unwrap();
        let middle = surface.evaluate(2, -1, at[0] + size / 2.0, at[1] + size / 2.0).position;
        let nearest = |tessellation: &Tessellation<f64>| {
            let middle_of = |quad: &[u32; 4]| {
                quad.iter().map(|&v| DVec3::from(tessellation.positions()[v as usize])).sum::<DVec3>() / 4.0
            };
            tessellation.quads().iter().map(|quad| middle_of(quad).distance(middle)).fold(f64::INFINITY, f64::min)
        };
        let edges: HashSet<[u32; 2]> =
            with_hole.quads().iter().flat_map(|q| (0..4).map(|k| [q[k], q[(k + 1) % 4]])).collect();
        let open = edges.iter().filter(|[a, b]| !edges.contains(&[*b, *a])).count();
        assert_eq!(open, 4 << (depth as usize - children.len()), "{children:?}");
        let cell = 2.0 / f64::from(1 << depth);
        assert!(nearest(&whole) < cell && nearest(&with_hole) > 0.3 * size, "{children:?}: {}", nearest(&with_hole));
    }
    // Coarser facets become as fine as their holes.
    let edited = with(&mesh, vec![hole(&[1, 3, 0])]);
    let coarse = Tessellation::<f64>::new(&Topology::new(&edited), &DiceOptions::fixed(1)).unwrap();
    assert_eq!(coarse.plan().depth_histogram(), [0, 19, 4, 1]);
    assert_eq!(coarse.quads().len() + coarse.triangles().len(), {
        let whole = Tessellation::<f64>::new(
            &Topology::new(&mesh),
            &DiceOptions {
                depth: Depth::Each({
                    let mut depths = vec![1; 24];
                    depths[9] = 3;
                    depths
                }),
                ..DiceOptions::default()
            },
        )
        .unwrap();
        assert_eq!(whole.plan().depth_histogram(), [0, 19, 4, 1]);
        whole.quads().len() + whole.triangles().len() - 1
    });
}

#[test]
fn edited_tessellations_are_closed() {
    for seed in 0..40 {
        let mut random = Random::new(seed);
        let mesh = shape(["cube", "tetrahedron", "fan", "machine-part"][random.below(4)]).unwrap();
        let edited = with(&mesh, random_edits(&mut random, &mesh, 4));
        let depth = random_depth(&mut random, &edited);
        let options = DiceOptions { depth, max_step: [1, 1, 2, 10][random.below(4)], max_depth: 4 };
        let tessellation = Tessellation::new(&Topology::new(&edited), &options).unwrap();
        let fault = fault(&edited, &tessellation);
        assert!(fault.is_none(), "seed {seed}: {options:?}: {}", fault.unwrap());
    }
}

#[test]
fn edited_tessellations_keep_the_tolerance() {
    let mesh = shape("cube").unwrap();
    let offset = |children: &[u32], corner, z| Edit {
        face: 1,
        children: children.to_vec(),
        change: Change::Offset { corner, offset: [0.0, 0.1, z] },
    };
    let edited = with(&mesh, vec![offset(&[1, 2], 3, 0.2), offset(&[3, 0, 1], 1, 0.1)]);
    let tolerance = 3e-3 * mesh.diagonal();
    for depth in [Depth::Tolerance(tolerance), Depth::Fixed(1), Depth::Fixed(2), Depth::Fixed(3)] {
        let options = DiceOptions { depth, ..DiceOptions::default() };
        let tessellation = Tessellation::new(&Topology::new(&edited), &options).unwrap();
        let bound = tessellation.plan().error_bound().unwrap();
        let found = measure(&edited, &tessellation);
        println!("{options:?}: {found:e} <= {bound:e}");
        assert!(found <= bound, "{options:?}: {found} <= {bound}");
        assert!(options.depth != Depth::Tolerance(tolerance) || bound <= tolerance, "{bound} <= {tolerance}");
    }
}

#[test]
#[cfg_attr(not(shared), ignore = "needs ../shared")]
fn files_with_edits_are_tessellated() {
    for (number, count, level) in [(0, 12, 3), (1, 8, 1), (2, 8, 1), (3, 12, 1), (4, 5, 2)] {
        let path = common::shared().join(format!("meshes/catmark_square_hedit{number}.obj"));
        let mesh = read(path, &ReadOptions::default()).unwrap();
        assert_eq!((mesh.data().edits.len(), mesh.edit_level()), (count, level), "{number}");
        let tessellation = Tessellation::<f64>::new(&Topology::new(&mesh), &DiceOptions::fixed(4)).unwrap();
        let found = errors(&mesh, &tessellation);
        // Normals on edges that edits make sharp are those of one side.
        assert!(found.position < 1e-12, "{number}: {found:?}");
        let high = tessellation.positions().iter().map(|p| p[2]).fold(0.0, f64::max);
        assert!(high > 0.4, "{number}: {high}");
        assert_eq!(tessellation.quads().len(), 9 * 256 - if number == 4 { 16 } else { 0 }, "{number}");
    }
}

/// Facets are as deep as the edges at the levels of their edits ask for.
#[test]
fn lengths_see_edits() {
    let mesh = shape("cube").unwrap();
    let far = Change::Offset { corner: 2, offset: [0.0, 0.0, 3.0] };
    let edited = with(&mesh, vec![Edit { face: 1, children: vec![0, 2, 1], change: far }]);
    let deepest = |mesh: &ControlMesh| {
        let options = DiceOptions { depth: Depth::EdgeLength(0.3), ..DiceOptions::default() };
        let tessellation = Tessellation::<f64>::new(&Topology::new(mesh), &options).unwrap();
        tessellation.plan().depth_histogram().len() - 1
    };
    // Edges of a quarter at level 3, then three long: 3 / 2^4 < 0.3.
    assert_eq!((deepest(&mesh), deepest(&edited)), (3, 7));
}
