//! Factors, culling and what lies along edges, as the shaders compute them, against their twins in `ash_subdiv::tessellate`.
#![cfg(all(feature = "measure", feature = "png"))]

use crate::common;
use crate::seams::{TESSELLATION, compiled, evaluations, with_texcoords};
use ash_subdiv::capture::{CaptureDraw, Captured, Which};
use ash_subdiv::headless::{Texels, Texture};
use ash_subdiv::measure::watertight::random_factors;
use ash_subdiv::patch::RingValues;
use ash_subdiv::renderer::{Cull, Factor};
use ash_subdiv::table::{Patch, PatchPlan, SharedTable, prepare_patches};
use ash_subdiv::tessellator::{
    FramedRing, MeasuredDraw, PatchFactors, SharedSample, SharingCorner, share, share_corner,
};
use ash_subdiv::topology::{PatchKind, Topology};
use ash_subdiv::{Construction, ControlMesh, Fallback, ModelOptions, Scheme, View, shape};
use glam::{Vec2, Vec3};

const SIDE: u32 = 256;

fn views(mesh: &ControlMesh) -> [View; 4] {
    let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
    let (middle, radius) = ((low + high) / 2.0, (high - low).length() / 2.0);
    let perspective = |from: Vec3, target: Vec3, fov_y, near| {
        let planes = [near * radius, 9.0 * radius];
        View::perspective((middle + from * radius).into(), target.into(), [0.0, 1.0, 0.0], fov_y, 1.0, planes)
            .sized(SIDE, SIDE)
    };
    let framing = |towards, side| View::framing(mesh.bounds(), towards, 1.0).sized(side, side);
    [
        framing([-0.6, 0.5, 1.0], SIDE),
        framing([1.0, 0.2, -0.3], 40),
        // Much of the mesh is beside the picture; is behind the eye.
        perspective(Vec3::new(0.8, 0.6, 2.0), middle + 0.5 * (high - middle), 0.25, 0.1),
        perspective(Vec3::new(0.3, 0.2, 0.5), high, 0.7, 0.05),
    ]
}

fn measured(draw: &CaptureDraw) -> MeasuredDraw {
    let View { view_projection, eye, viewport, .. } = &draw.view;
    MeasuredDraw { cull: draw.cull, ..MeasuredDraw::new(view_projection, *eye, *viewport, draw.factor) }
}

/// The control points of each corner, in the order in which shaders keep them.
fn owned(patch: &Patch, points: &[[f32; 3]]) -> Vec<Vec<Vec3>> {
    let at = |k| patch.scheme.corner_slots(patch.kind, k).into_iter().map(|slot| points[slot].into()).collect();
    (0..patch.kind.corners()).map(at).collect()
}

/// The factors of every patch by the twin, from the control points that the GPU has.
fn twins(captured: &Captured, points: &[Vec<[f32; 3]>], draw: &CaptureDraw) -> Vec<PatchFactors> {
    let edges = captured.tables().edges().expect("asked for");
    let measured = measured(draw);
    let mut first = 0;
    let patches = captured.tables().plan().patches().iter().zip(points);
    patches
        .map(|(patch, points)| {
            let corners = first..first + patch.kind.corners();
            first = corners.end;
            let factor = |&edge: &u32| draw.edge_factors.get(edge as usize).copied().unwrap_or_default();
            let of_corners: Vec<f32> = edges.of_corners[corners].iter().map(factor).collect();
            measured.patch_factors(&owned(patch, points), &of_corners)
        })
        .collect()
}

/// To the bit: all that they are made of is `precise`.
#[test]
fn factors_are_those_of_the_twin() {
    let headless = common::headless();
    let cases = [("creature-mixed", Scheme::Gregory), ("creature-mixed", Scheme::Acc), ("fan", Scheme::GregoryFitted)];
    let shapes = cases.map(|(name, scheme)| (name, shape(name).expect("built in"), scheme));
    let mut compared = 0;
    for (name, mesh, scheme) in shapes.into_iter().chain([("pentagons", common::pentagons(), Scheme::Pm)]) {
        let fallback = Fallback::Gregory;
        let options = ModelOptions { edge_factors: true, scheme, fallback, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let points = captured.control_points().expect("a capture");
        let edges = captured.tables().edges().expect("asked for").vertices.len();
        for factor in [Factor::Uniform(5.3), Factor::Pixels(3.0), Factor::Curvature(0.2), Factor::Edges(1.3)] {
            for view in views(&mesh) {
                let edge_factors = random_factors(edges, 20.0, 7);
                let draw = CaptureDraw { view, edge_factors, ..CaptureDraw::new(factor) };
                let gpu = captured.factors(&draw).expect("a capture");
                for ((patch, gpu), twin) in
                    captured.tables().plan().patches().iter().zip(&gpu).zip(twins(&captured, &points, &draw))
                {
                    // Of a pentagon four are captured.
                    let corners = patch.kind.corners().min(4);
                    let bits = |factors: &[f32]| factors.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
                    let what = || format!("{name} {scheme:?} {factor:?} {patch:?}: {gpu:?}, the twin {twin:?}");
                    assert_eq!(bits(&gpu.asked[..corners]), bits(&twin.asked[..corners]), "{}", what());
                    assert_eq!(bits(&gpu.inner), bits(&twin.inner), "{}", what());
                    assert!(!gpu.culled && !twin.culled, "{}", what());
                    compared += corners;
                }
            }
        }
    }
    assert!(compared > 20_000, "{compared}");
    headless.finish_silent();
}

/// Culling is not `precise`: where a sum is rounded otherwise, a patch at the brink may go either way. One of 500 may.
#[test]
fn patches_are_culled_as_by_the_twin() {
    let headless = common::headless();
    let (frustum, back, small) = (true, true, true);
    let ways = [Cull { frustum, ..Cull::NONE }, Cull { back, ..Cull::NONE }, Cull { small, ..Cull::NONE }];
    for (name, scheme) in [("creature-mixed", Scheme::Gregory), ("torus", Scheme::Gregory), ("creature", Scheme::Acc)] {
        let mesh = shape(name).expect("built in");
        let options = ModelOptions { edge_factors: true, scheme, ..ModelOptions::default() };
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let points = captured.control_points().expect("a capture");
        for cull in ways {
            let (mut culled, mut patches, mut differ, mut some) = (0, 0, 0, 0);
            for view in views(&mesh) {
                let draw = CaptureDraw { view, cull, ..CaptureDraw::new(Factor::Pixels(6.0)) };
                let gpu = captured.factors(&draw).expect("a capture");
                let of_view = gpu.iter().filter(|gpu| gpu.culled).count();
                for (gpu, twin) in gpu.iter().zip(twins(&captured, &points, &draw)) {
                    differ += usize::from(gpu.culled != twin.culled);
                    patches += 1;
                }
                culled += of_view;
                some += usize::from(of_view > 0 && of_view < gpu.len());
            }
            println!("{name} {cull:?}: {culled} of {patches} culled, in {some} views some, {differ} otherwise");
            // The torus has no patches that are small.
            assert!(some > 0 || (name == "torus" && cull.small), "{name} {cull:?}: {culled} of {patches}");
            assert!(500 * differ <= patches, "{name} {cull:?}: {differ} of {patches}");
        }
    }
    headless.finish_silent();
}

/// The corners of every patch with what they share, by the twins.
fn sharing_corners(mesh: &ControlMesh, plan: &PatchPlan, texels: f32, draw: &CaptureDraw) -> Vec<SharingCorner> {
    let topology = Topology::new(mesh);
    let position = |v: u32| mesh.position(v).as_vec3();
    let ring = |ring| FramedRing::new(plan.scheme(), RingValues::new(&topology, ring, position));
    let rings: Vec<FramedRing> = topology.rings().iter().map(ring).collect();
    let (prepared, _) = prepare_patches(mesh, plan.scheme(), Fallback::default(), 0).expect("patches");
    let table = SharedTable::with_texcoords(&topology, &prepared.edges(plan), plan).expect("texture coordinates");
    let own_texcoords = plan.texcoords(&topology).expect("texture coordinates");
    let measured = measured(draw);
    let corners = plan.patches().iter().flat_map(|patch| {
        let corners = mesh.face_corners(patch.face);
        let n = corners.len();
        (0..n).map(move |k| (corners.start + (patch.first() as usize + k) % n) as u32)
    });
    corners
        .zip(&table.corners)
        .zip(table.texcoords.iter().zip(own_texcoords))
        .map(|((h, shared), (&shared_texcoord, texcoord))| {
            let place = topology.place(h);
            let with = share_corner(plan.scheme(), *shared, place.ring, true, |ring| &rings[ring as usize]);
            let FramedRing { ring, frame } = &rings[place.ring as usize];
            let index = place.index as usize;
            let vector = |j: usize| ring.edge_vector(frame, j % ring.shape.edges());
            let owner = &rings[shared[0] as usize].frame;
            SharingCorner {
                with,
                is_sharp: !topology.is_within_rings(h),
                owned: [frame.p, vector(index), vector(index + 1)],
                texcoord,
                shared_texcoord,
                lod: measured.corner_lod(shared_texcoord.scale[0], texels, [owner.p, owner.a, owner.b]),
            }
        })
        .collect()
}

/// What the captured vertices of patches have in the place of positions, with a displacement of the tests' own.
fn compare_shared(
    name: &str,
    captured: &Captured,
    corners: &[SharingCorner],
    draw: &CaptureDraw,
    check: impl Fn(Vec3, Vec3, SharedSample) -> bool,
) {
    let patches = captured.tables().plan().patches();
    let points = captured.control_points().expect("a capture");
    let first_corner = |sum: &mut usize, patch: &Patch| {
        *sum += patch.kind.corners();
        Some(*sum - patch.kind.corners())
    };
    let first_corners: Vec<usize> = patches.iter().scan(0, first_corner).collect();
    let vertices = captured.vertices_of(draw, Which::OnEdges).expect("a capture");
    assert!(vertices.len() > 5000, "{name}: {}", vertices.len());
    for vertex in &vertices {
        let (patch, first) = (&patches[vertex.patch as usize], first_corners[vertex.patch as usize]);
        let points: Vec<Vec3> = points[vertex.patch as usize].iter().map(|&p| p.into()).collect();
        let at = Vec3::from(vertex.coordinate);
        let own = patch.scheme.evaluate(patch.kind, &points, at.x, at.y);
        let at = if patch.kind == PatchKind::Triangle { at } else { at.truncate().extend(0.0) };
        let twin = share(own, at, &corners[first..first + patch.kind.corners()]);
        let good = check(vertex.position.into(), vertex.normal.into(), twin);
        assert!(good, "{name} {patch:?}: {vertex:?}, the twin {twin:?}");
    }
}

/// Control points of the twin are summed in another order: normals to 2e-3, levels of the map to 1e-3.
#[test]
fn what_lies_along_edges_is_that_of_the_twin() {
    let headless = common::headless();
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    let texture = Texture::new(&headless, "scales", &texels).expect("a texture");
    for name in ["creature-mixed", "machine-part"] {
        let mesh = with_texcoords(shape(name).expect("built in"));
        let draw = CaptureDraw { view: views(&mesh)[0], ..CaptureDraw::new(Factor::Pixels(6.0)) };
        let options = ModelOptions { construction: Construction::TwoStage, ..ModelOptions::default() };
        for folder in ["own_lookup", "own_direction"] {
            let folder_of = format!("tests/glsl/{folder}");
            let shaders = evaluations(TESSELLATION, Some("-DDISPLACED")).into_iter();
            let shaders = shaders.map(|id| (id, compiled(id, &["OWN_DISPLACE"], &[&folder_of]))).collect();
            // SAFETY: the texture outlives what is captured.
            let captured = unsafe { Captured::displaced(&headless, &mesh, &options, (&texture).into()) };
            let captured = captured.expect("a model").with_shaders(shaders);
            let corners =
                sharing_corners(&mesh, captured.tables().plan(), texels.width.max(texels.height) as f32, &draw);
            compare_shared(name, &captured, &corners, &draw, |position, normal, twin| {
                let lookup = Vec2::new(position.x, position.y).distance(twin.texcoord) < 1e-5
                    && (position.z - twin.lod).abs() < 1e-3;
                let direction = position.distance(twin.direction) < 2e-3;
                let seen = if folder == "own_lookup" { lookup } else { direction };
                seen && normal.distance(twin.normal) < 2e-3
            });
        }
    }
    drop(texture);
    headless.finish_silent();
}
