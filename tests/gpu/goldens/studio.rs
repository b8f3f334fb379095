//! How pictures are drawn for goldens.

use super::{EXTENT, Layer, Picture, SIDE, close_up, extraordinary_vertex, ridges, semi_sharp, sharpness};
use crate::common;
use crate::common::passes::{Moment, PassTarget};
use ash::vk;
use ash_subdiv::glam::Vec3;
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc, Texels, Texture};
use ash_subdiv::renderer::{Cull, Factor};
use ash_subdiv::{
    Construction, ControlMesh, DrawItem, Fallback, ModelOptions, Options, Renderer, Style, Target, View, shape,
};
use std::collections::HashMap;

/// Draws pictures one after another: those that differ in their models alone by one renderer, as most of the time goes into pipelines.
pub(super) struct Studio<'h> {
    headless: &'h Headless,
    renderers: HashMap<String, Renderer>,
}

impl<'h> Studio<'h> {
    pub(super) fn new(headless: &'h Headless) -> Self {
        Self { headless, renderers: HashMap::new() }
    }

    pub(super) fn draw(&mut self, picture: &Picture, construction: Construction) -> Vec<u8> {
        let Picture { samples, format, evaluation, .. } = *picture;
        let desc = OffscreenDesc { samples, color: format, ..OffscreenDesc::new(SIDE, SIDE) };
        let styles: Vec<Style> = picture.layers.iter().map(|layer| layer.style.clone()).collect();
        let key = format!("{samples:?} {format:?} {evaluation:?} {styles:?}");
        let options = Options { styles, evaluations: vec![evaluation], ..Options::default() };
        let target = Target::dynamic(desc.color, desc.depth, desc.samples);
        let headless = self.headless;
        let new = || {
            // SAFETY: every submission is waited for.
            unsafe { Renderer::new(headless.context(), &target, &options) }.expect("a renderer")
        };
        let record = |renderer: &mut Renderer, texture: Option<&Texture>| {
            draw_with(renderer, picture, construction, texture, |record| {
                let target = Offscreen::new(headless, &desc).expect("a target");
                headless.try_submit(|cmd| record(cmd, Moment::Before)).expect("prepared");
                target.draw(headless, picture.clear, |cmd| record(cmd, Moment::Inside)).expect("a picture")
            })
        };
        if picture.displacement.is_none() {
            return record(self.renderers.entry(key).or_insert_with(new), None);
        }
        let texels = Texels::open("assets/scales.png", false).expect("the built-in height map");
        let texture = Texture::new(headless, "scales", &texels.tiled(4)).expect("a texture");
        // Its own, to be gone before the texture is.
        record(&mut new(), Some(&texture))
    }
}

/// In a render pass.
pub(super) fn draw_in_pass(headless: &Headless, picture: &Picture) -> Vec<u8> {
    let styles = picture.layers.iter().map(|layer| layer.style.clone()).collect();
    let options = Options { styles, ..Options::default() };
    let pass = PassTarget::new(headless, EXTENT);
    // SAFETY: the render pass outlives the renderer, and every submission is waited for.
    let mut renderer = unsafe { Renderer::new(headless.context(), &pass.target(), &options) }.expect("a renderer");
    draw_with(&mut renderer, picture, Construction::TwoStage, None, |record| pass.draw(picture.clear, record))
}

fn mesh_of(picture: &Picture) -> ControlMesh {
    match picture.shape {
        "pentagons" => common::pentagons(),
        "semi-sharp" => semi_sharp(),
        "ridges" => ridges(),
        "sharpness" => sharpness(),
        name => shape(name).expect("built in"),
    }
}

fn view_of(picture: &Picture, mesh: &ControlMesh) -> View {
    let towards = [-0.6, 0.5, 1.0];
    let view = match picture.around {
        None => View::framing(mesh.bounds(), towards, 1.0),
        Some(half) => close_up(extraordinary_vertex(mesh).as_vec3(), Vec3::from(towards).normalize(), half),
    };
    let view = view.sized(SIDE, SIDE);
    match picture.culled {
        true => View::framing(mesh.bounds(), [0.9, 0.3, -0.7], 1.0).measured_from(&view),
        false => view,
    }
}

type Record<'r> = &'r mut dyn FnMut(vk::CommandBuffer, Moment) -> Result<(), ash_subdiv::Error>;

/// A frame of the picture alone, with what `submit` makes of its commands.
fn draw_with(
    renderer: &mut Renderer,
    picture: &Picture,
    construction: Construction,
    texture: Option<&Texture>,
    submit: impl FnOnce(Record) -> Vec<u8>,
) -> Vec<u8> {
    let mesh = mesh_of(picture);
    let view = view_of(picture, &mesh);
    // SAFETY: the texture outlives the renderer.
    let displacement = texture.map(|texture| unsafe { renderer.add_displacement(texture.into()) });
    let Picture { scheme, spacing, mut factor, evaluation, adaptive, .. } = *picture;
    let model_options = ModelOptions {
        construction,
        fallback: Fallback::Gregory,
        scheme,
        spacing,
        displacement,
        evaluation,
        adaptive,
        ..ModelOptions::default()
    };
    let model = renderer.add_model(&mesh, &model_options).expect("a model");
    if evaluation.needs_segments() {
        renderer.set_segments(model, factor.value() as u32).expect("segments");
        factor = Factor::Segments;
    }
    let [low, high] = mesh.bounds();
    let scale = picture.displacement.unwrap_or(0.0) * (high - low).length() as f32;
    let item = |(style, layer): (usize, &Layer)| DrawItem {
        style,
        colors: layer.colors,
        displacement: [scale, 0.0],
        cull: if picture.culled { Cull { small: false, ..Cull::ALL } } else { Cull::NONE },
        ..DrawItem::new(model, factor)
    };
    let items: Vec<_> = picture.layers.iter().enumerate().map(item).collect();
    // SAFETY: the frames before were waited for.
    let frame = unsafe { renderer.begin_frame() };
    let pixels = submit(&mut |cmd, moment| match moment {
        // SAFETY: outside rendering, and inside what the renderer was made for.
        Moment::Before => unsafe { renderer.cmd_prepare(cmd, frame) },
        Moment::Inside => unsafe { renderer.cmd_draw(cmd, frame, &view, &items) },
    });
    renderer.remove_model(model).expect("a model");
    pixels
}
