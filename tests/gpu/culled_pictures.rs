//! Culled patches are not missed in any picture.
#![cfg(feature = "png")]

use crate::adaptive::{SIDE, close_view, view};
use crate::common;
use ash::vk;
use ash_subdiv::adaptive::AdaptiveOptions;
use ash_subdiv::capture::{CaptureDraw, Captured};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc, Texels, Texture};
use ash_subdiv::mesh::MeshData;
use ash_subdiv::renderer::Cull;
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Error, ModelOptions, Options, Renderer, Style, Target, View, shape,
};
use glam::{Mat4, Vec3};

fn back_style() -> Style {
    Style { cull: vk::CullModeFlags::BACK, ..Style::default() }
}

/// How many pixels change in each view when patches are left out of a model with this transform, and how much of all vertices is
/// left out.
fn missed(
    (headless, target): (&Headless, &Offscreen),
    renderer: &mut Renderer,
    (mesh, options): (&ControlMesh, &ModelOptions),
    views: &[View],
    cull: Cull,
    transform: Mat4,
) -> (Vec<usize>, f64) {
    let model = renderer.add_model(mesh, options).expect("a model");
    let transform = transform.to_cols_array_2d();
    let all = DrawItem { transform, displacement: [0.1, 0.0], ..DrawItem::new(model, 6.0) };
    let mut picture = |view: &View, cull: Cull| {
        let item = DrawItem { cull, ..all };
        // SAFETY: outside rendering, then inside; every submission is waited for.
        let frame = unsafe { renderer.begin_frame() };
        // SAFETY: likewise.
        let counted = headless.counted(|cmd| unsafe {
            renderer.cmd_prepare(cmd, frame)?;
            target.cmd_begin(cmd, [0.0; 4]);
            renderer.cmd_draw(cmd, frame, view, &[item])?;
            target.cmd_end(cmd);
            Ok::<_, Error>(())
        });
        let vertices = counted.expect("counts").evaluation_invocations;
        // SAFETY: inside.
        let draw = target.draw(headless, [0.0; 4], |cmd| unsafe { renderer.cmd_draw(cmd, frame, view, &[item]) });
        (draw.expect("a picture"), vertices as f64)
    };
    let (mut drawn, mut whole) = (0.0, 0.0);
    let pixels = |view: &View| {
        let [(all, of_all), (culled, of_culled)] = [Cull::NONE, cull].map(|cull| picture(view, cull));
        (drawn, whole) = (drawn + of_culled, whole + of_all);
        all.chunks(4).zip(culled.chunks(4)).filter(|(a, b)| a != b).count()
    };
    let pixels = views.iter().map(pixels).collect();
    renderer.remove_model(model).expect("it is there");
    (pixels, 1.0 - drawn / whole)
}

/// A picture, and a renderer of one style for it.
fn pictures(headless: &Headless, style: Style) -> (Offscreen, Renderer) {
    let desc = OffscreenDesc::new(SIDE, SIDE);
    let options = Options { styles: vec![style], ..Options::default() };
    let target = Target::dynamic(desc.color, desc.depth, desc.samples);
    // SAFETY: every submission is waited for.
    let renderer = unsafe { Renderer::new(headless.context(), &target, &options) }.expect("a renderer");
    (Offscreen::new(headless, &desc).expect("a target"), renderer)
}

#[test]
fn what_is_left_out_is_not_missed() {
    let headless = common::headless();
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    let texture = Texture::new(&headless, "scales", &texels).expect("a texture");
    for name in ["creature", "machine-part", "valences"] {
        let mesh = shape(name).expect("built in");
        let views = [view(&mesh, [-0.6, 0.5, 1.0]), view(&mesh, [0.2, -1.0, 0.1]), close_view(&mesh)];
        for displaced in [None, Some(&texture)] {
            let (target, mut renderer) = pictures(&headless, back_style());
            // SAFETY: the texture outlives the renderer.
            let displacement = displaced.map(|texture| unsafe { renderer.add_displacement(texture.into()) });
            let model = (&mesh, &ModelOptions { displacement, ..ModelOptions::default() });
            let (missed, _) = missed((&headless, &target), &mut renderer, model, &views, Cull::ALL, Mat4::IDENTITY);
            assert_eq!(missed, [0; 3], "{name} displaced {}", displaced.is_some());
        }
        let captured = Captured::new(&headless, &mesh, &ModelOptions::default()).expect("a model");
        let count = |view, cull| {
            let factors = captured.factors(&CaptureDraw { view, cull, ..CaptureDraw::new(6.0) }).expect("a capture");
            (factors.iter().filter(|f| f.culled).count(), factors.len())
        };
        // Not all that could be left out is, but much.
        let (back, all) = count(view(&mesh, [-0.6, 0.5, 1.0]), Cull { back: true, ..Cull::NONE });
        assert!(10 * back > all, "{name}: {back} of {all}");
        let (outside, all) = count(close_view(&mesh), Cull { frustum: true, ..Cull::NONE });
        assert!(5 * outside > all, "{name}: {outside} of {all}");
    }
    drop(texture);
    headless.finish_silent();
}

/// A view of what is around a point, from a direction.
fn narrow_view(mesh: &ControlMesh, target: Vec3, towards: [f32; 3]) -> View {
    let size = mesh.diagonal() as f32;
    let eye = target + size * Vec3::from(towards);
    let view = View::perspective(eye.into(), target.into(), [0.0, 1.0, 0.0], 0.1, 1.0, [0.5 * size, 1.05 * size]);
    view.sized(SIDE, SIDE)
}

/// A disc with a vertex of 16 faces, and a vertex beside that one high above: the end caps around it go below the disc.
fn spike() -> ControlMesh {
    let n = 16;
    let ring = |radius: f64, i: u32| {
        let (sine, cosine) = (std::f64::consts::PI * f64::from(i) / f64::from(n)).sin_cos();
        [radius * cosine, if radius == 1.0 && i == 0 { 4.0 } else { 0.0 }, -radius * sine]
    };
    let rings = [1.0, 2.0].into_iter().flat_map(|radius| (0..2 * n).map(move |i| ring(radius, i)));
    let next = |i: u32| (i + 1) % (2 * n);
    let inner = (0..n).flat_map(|i| [0, 1 + 2 * i, 2 + 2 * i, 1 + next(2 * i + 1)]);
    let outer = (0..2 * n).flat_map(|i| [1 + i, 1 + 2 * n + i, 1 + 2 * n + next(i), 1 + next(i)]);
    let data = MeshData {
        positions: std::iter::once([0.0; 3]).chain(rings).collect(),
        face_sizes: vec![4; 3 * n as usize],
        face_vertices: inner.chain(outer).collect(),
        ..MeshData::default()
    };
    ControlMesh::new(data).expect("a mesh")
}

/// Faces that are refined, some with wedges and some with creases that end caps round, culled by the boxes around them.
#[test]
fn refined_faces_that_are_culled_are_not_missed() {
    let headless = common::headless();
    let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
    let texture = Texture::new(&headless, "scales", &texels).expect("a texture");
    let depth = |depth| Some(AdaptiveOptions { depth, ..AdaptiveOptions::default() });
    let cases = [
        ("creature", depth(3), Construction::TwoStage),
        ("creature-mixed", depth(1), Construction::Cached),
        ("machine-part", depth(0), Construction::Stencil),
        ("machine-part", depth(2), Construction::TwoStage),
        ("polygons", depth(2), Construction::TwoStage),
        ("spike", depth(0), Construction::TwoStage),
    ];
    for (name, adaptive, construction) in cases {
        let mesh = if name == "spike" { spike() } else { shape(name).expect("built in") };
        let options = ModelOptions { adaptive, construction, ..ModelOptions::default() };
        let views = [view(&mesh, [-0.6, 0.5, 1.0]), view(&mesh, [0.2, -1.0, 0.1]), close_view(&mesh)];
        // So far away that some faces are smaller than a pixel.
        let [low, high] = mesh.bounds().map(|corner| corner.as_vec3());
        let (middle, size) = ((low + high) / 2.0, (high - low).length());
        let eye = middle + Vec3::new(20.0 * size, 3.0 * size, 0.0);
        let far = View::perspective(eye.into(), middle.into(), [0.0, 1.0, 0.0], 1.0, 1.0, [size, 40.0 * size]);
        let views = [views[0], views[1], views[2], far.sized(SIDE, SIDE)];
        for displaced in [None, mesh.data().texcoords.as_ref().map(|_| &texture)] {
            let (target, mut renderer) = pictures(&headless, Style::default());
            // SAFETY: the texture outlives the renderer.
            let displacement = displaced.map(|texture| unsafe { renderer.add_displacement(texture.into()) });
            let model = (&mesh, &ModelOptions { displacement, ..options.clone() });
            let (missed, share) = missed((&headless, &target), &mut renderer, model, &views, Cull::ALL, Mat4::IDENTITY);
            assert_eq!(missed, [0; 4], "{name} displaced {}", displaced.is_some());
            println!("{name}: {share} of the vertices are culled");
            assert!(share > 0.05, "{name}: {share}");
        }
        // Of faces that a view shows a part of, refined ones are culled much like others, and no vertex of them is in the view.
        let captured = Captured::new(&headless, &mesh, &options).expect("a model");
        let patches = captured.tables().plan().patches();
        let vertices = captured.vertices(9.0).expect("a capture");
        let [mut culled, mut all] = [[0usize; 2]; 2];
        let narrow = around(40)
            .enumerate()
            .map(|(i, towards)| narrow_view(&mesh, vertices[vertices.len() * i / 40].position.into(), towards));
        // All that is below zero, seen from below.
        let size = mesh.diagonal() as f32;
        let below = [0.0, -size, 0.0];
        let below =
            View::perspective(below, [0.0; 3], [0.0, 0.0, 1.0], 1.5, 1.0, [0.1, 0.999 * size]).sized(SIDE, SIDE);
        for (i, view) in narrow.chain([below]).enumerate() {
            let cull = Cull { frustum: true, ..Cull::NONE };
            let factors = captured.factors(&CaptureDraw { view, cull, ..CaptureDraw::new(6.0) }).expect("a capture");
            for (patch, factors) in patches.iter().zip(&factors) {
                all[usize::from(patch.refined)] += 1;
                culled[usize::from(patch.refined)] += usize::from(factors.culled);
            }
            let to_clip = Mat4::from_cols_array_2d(&view.view_projection);
            for vertex in vertices.iter().filter(|vertex| factors[vertex.patch as usize].culled) {
                let at = to_clip * Vec3::from(vertex.position).extend(1.0);
                let inside = (at.w - at.x.abs()).min(at.w - at.y.abs()).min(at.w - at.z).min(at.z);
                assert!(inside < 1e-5 * at.w.abs(), "{name} {i}: {vertex:?} is {inside} within the view");
            }
        }
        let share = [0, 1].map(|of| culled[of] as f64 / all[of].max(1) as f64);
        println!("{name}: {share:?} of other faces, of refined ones");
        assert!(share[1] > 0.2, "{name}: {share:?}");
    }
    drop(texture);
    headless.finish_silent();
}

/// All around, evenly and in no line with any axis: of the n-th of `n` on a spiral from pole to pole.
fn around(n: usize) -> impl Iterator<Item = [f32; 3]> {
    (0..n).map(move |i| {
        let height = 1.0 - (2.0 * i as f32 + 1.0) / n as f32;
        let (sine, cosine) = (2.4 * i as f32 + 0.3).sin_cos();
        let across = (1.0 - height * height).sqrt();
        [across * cosine, height, across * sine]
    })
}

#[test]
fn what_faces_away_is_left_out() {
    let back = Cull { back: true, ..Cull::NONE };
    let turned = Mat4::from_scale_rotation_translation(
        Vec3::new(-0.7, 1.2, 0.9),
        glam::Quat::from_rotation_y(0.5),
        Vec3::new(0.1, -0.05, 0.0),
    );
    let headless = common::headless();
    // At most a third of the creature's patches face away as a whole. Half of the mixed one's are triangles, which stay.
    let meshes = [("creature", 0.25), ("creature-mixed", 0.1), ("torus", 0.25), ("cube", 0.0)];
    let meshes = meshes.map(|(name, least)| {
        let mesh = shape(name).expect("built in");
        let views: Vec<View> = around(12).map(|towards| view(&mesh, towards)).collect();
        (name, least, mesh, views)
    });
    // What a style leaves out, in a mirror, too; and what is hidden, if it leaves out nothing.
    let (clockwise, both) = (vk::FrontFace::CLOCKWISE, Style::default());
    let front = Style { cull: vk::CullModeFlags::FRONT, ..both.clone() };
    for style in [back_style(), Style { front_face: clockwise, ..back_style() }, front, both] {
        // All meshes use its pipelines.
        let (target, mut renderer) = pictures(&headless, style.clone());
        let mirrored = |view: &View| {
            let mirror = Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)) * Mat4::from_cols_array_2d(&view.view_projection);
            View { view_projection: mirror.to_cols_array_2d(), mirrored: true, ..*view }
        };
        for (name, least, mesh, views) in &meshes {
            let views_of_both = [views.clone(), views[..3].iter().map(mirrored).collect()];
            let model = (mesh, &ModelOptions::default());
            for transform in [Mat4::IDENTITY, turned] {
                for views in &views_of_both {
                    let (missed, share) = missed((&headless, &target), &mut renderer, model, views, back, transform);
                    let what = format!("{name}, {transform}, {style:?}, mirrored {}", views[0].mirrored);
                    assert_eq!(missed, vec![0; views.len()], "{what}");
                    assert!(share >= 0.8 * least, "{what}: {share}");
                }
            }
        }
    }
    for (name, least, mesh, views) in &meshes {
        let captured = Captured::new(&headless, mesh, &ModelOptions::default()).expect("a model");
        let vertices = captured.vertices(6.0).expect("a capture");
        let (mut left_out, mut all) = (0, 0);
        for &view in views {
            let draw = CaptureDraw { view, cull: back, ..CaptureDraw::new(6.0) };
            let culled: Vec<bool> = captured.factors(&draw).expect("a capture").iter().map(|f| f.culled).collect();
            left_out += culled.iter().filter(|&&culled| culled).count();
            all += culled.len();
            for v in vertices.iter().filter(|v| culled[v.patch as usize]) {
                let to_eye = (Vec3::from(view.eye) - Vec3::from(v.position)).normalize();
                assert!(Vec3::from(v.normal).dot(to_eye) < 1e-4, "{name}: {v:?} faces the eye");
            }
        }
        assert!(left_out as f64 >= least * all as f64, "{name}: {left_out} of {all}");
    }
    headless.finish_silent();
}
