//! The device's work for a picture.

use super::super::displacement::texture;
use super::super::error::CliError;
use super::super::paint::{Painting, PaintingSet};
use super::args::STRIPES;
use super::diced::Diced;
use super::{RenderArgs, StatisticsOut};
use ash::vk;
use ash_subdiv::capture::{CaptureDraw, Captured, CapturedFactors};
use ash_subdiv::headless::{Headless, Offscreen, OffscreenDesc, Texels, Texture};
use ash_subdiv::renderer::{Cull, Evaluation, Factor, ModelId, ModelTables};
use ash_subdiv::{Construction, ControlMesh, DrawItem, ModelOptions, Options, Renderer, Target, View};

/// Size, view and maps of a picture.
pub(super) struct Picture<'p> {
    /// In pixels, without the legend.
    pub size: [u32; 2],
    pub samples: u32,
    pub view: View,
    pub painting: Option<&'p Painting>,
    pub texels: Option<&'p Texels>,
}

impl RenderArgs {
    /// Statistics of the factors of the picture; none where the device cannot count, or nothing was asked for.
    pub(super) fn statistics(
        &self,
        headless: &Headless,
        picture: &Picture,
        mesh: &ControlMesh,
        options: &ModelOptions,
    ) -> Result<Option<StatisticsOut>, CliError> {
        let (factor, cull) = (self.factor.factor(), self.factor.cull.cull());
        let asked = cull != Cull::NONE || !matches!(factor, Factor::Uniform(_));
        if !asked || !headless.context().features().vertex_stores {
            return Ok(None);
        }
        let displacement = self.displacement.amount(mesh);
        // Other evaluations cull the same.
        let options = &ModelOptions { evaluation: Evaluation::Tessellation, ..options.clone() };
        let draw = CaptureDraw { view: picture.view, cull, displacement, ..CaptureDraw::new(factor) };
        let texture = picture.texels.map(|texels| texture(headless, texels)).transpose()?;
        let captured = match &texture {
            // SAFETY: the texture is ready to be read, and outlives what is captured.
            Some(texture) => unsafe { Captured::displaced(headless, mesh, options, texture.into())? },
            None => Captured::new(headless, mesh, options)?,
        };
        let factors = captured.factors(&draw)?;
        let max = headless.properties().max_tessellation_level as f32;
        let asked = |f: &CapturedFactors| f.asked.into_iter().fold(0.0, f32::max);
        let culled = factors.iter().filter(|f| f.culled).count();
        let largest = factors.iter().filter(|f| !f.culled).map(asked).fold(1.0, f32::max);
        Ok(Some(StatisticsOut {
            patches_drawn: factors.len() - culled,
            patches_culled: culled,
            largest_factor: largest.min(max),
            factors_clamped: factors.iter().any(|f| asked(f) > max),
        }))
    }

    fn renderer_options(&self, model: &ModelOptions, painting: Option<&PaintingSet>, visible_lists: bool) -> Options {
        Options {
            styles: self.shading.styles(self.displacement.is_given()),
            texcoords: painting.is_some(),
            evaluations: vec![model.evaluation],
            visible_lists,
            set_layouts: painting.iter().map(|painting| painting.layout.raw()).collect(),
            ..Options::default()
        }
    }
}

impl RenderArgs {
    /// The background, as the picture's format has it.
    pub(super) fn clear_colour(&self) -> [f32; 4] {
        match self.shading.format() {
            vk::Format::R8G8B8A8_SRGB => self.background.linear(),
            _ => self.background.0.map(|byte| f32::from(byte) / 255.0),
        }
    }
}

/// What draws a mesh, frame by frame.
pub(super) enum Drawing<'h> {
    /// The renderer.
    Patches(Patched<'h>),
    /// The device, but with vertices of the CPU.
    Triangles(Diced<'h>),
}

impl Drawing<'_> {
    /// Draws a picture, with the control vertices at these positions if they moved: rows from the top, four bytes RGBA a pixel.
    pub(super) fn draw(&mut self, view: &View, positions: Option<&[[f32; 3]]>) -> Result<Vec<u8>, CliError> {
        match self {
            Self::Patches(patches) => patches.draw(view, positions),
            Self::Triangles(triangles) => triangles.draw(view, positions),
        }
    }
}

/// What draws a mesh as patches.
pub(super) struct Patched<'h> {
    headless: &'h Headless,
    target: Offscreen,
    renderer: Renderer,
    model: ModelId,
    draws: Vec<DrawItem>,
    /// Whether patches are culled by lists.
    culls: bool,
    background: [f32; 4],
    // After the renderer, which reads them.
    painting: Option<PaintingSet>,
    _texture: Option<Texture>,
}

impl<'h> Patched<'h> {
    pub(super) fn new(
        args: &RenderArgs,
        headless: &'h Headless,
        picture: &Picture,
        tables: ModelTables,
        mesh: &ControlMesh,
        model_options: &ModelOptions,
    ) -> Result<Self, CliError> {
        let samples = vk::SampleCountFlags::from_raw(picture.samples);
        let [width, height] = picture.size;
        let desc = OffscreenDesc { samples, color: args.shading.format(), ..OffscreenDesc::new(width, height) };
        let target = Offscreen::new(headless, &desc)?;
        let texture = picture.texels.map(|texels| texture(headless, texels)).transpose()?;
        let painting = picture.painting.map(|painting| PaintingSet::new(headless.context(), painting)).transpose()?;
        let culls = args.factor.cull.cull() != Cull::NONE && model_options.construction == Construction::Cached;
        let options = args.renderer_options(model_options, painting.as_ref(), culls);
        let render_target = Target::dynamic(desc.color, desc.depth, desc.samples);
        // SAFETY: the layout outlives the renderer, whose shaders fit it; every submission is waited for, so the renderer
        // is dropped when idle.
        let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
        if let Some(texture) = &texture {
            // SAFETY: the texture is ready to be read, and outlives the renderer.
            unsafe { renderer.add_displacement(texture.into()) };
        }
        let model = renderer.add_tables(tables, &mesh.positions_f32(), model_options)?;
        let mut factor = args.factor.factor();
        if model_options.evaluation.needs_segments() {
            renderer.set_segments(model, factor.value().ceil() as u32)?;
            factor = Factor::Segments;
        }
        let item = DrawItem {
            cull: args.factor.cull.cull(),
            displacement: args.displacement.amount(mesh),
            words: [args.stripes.unwrap_or(STRIPES), 0, 0, 0],
            ..DrawItem::new(model, factor)
        };
        let background = args.clear_colour();
        let draws = args.shading.draws(item);
        Ok(Self { headless, target, renderer, model, draws, culls, background, painting, _texture: texture })
    }

    fn draw(&mut self, view: &View, positions: Option<&[[f32; 3]]>) -> Result<Vec<u8>, CliError> {
        let Self { headless, target, renderer, draws, painting, .. } = self;
        // SAFETY: every submission before was waited for.
        let frame = unsafe { renderer.begin_frame() };
        if let Some(positions) = positions {
            renderer.set_positions(self.model, frame, positions)?;
        }
        // SAFETY: the command buffer is being recorded, outside rendering.
        let visible = headless.try_submit(|cmd| unsafe {
            renderer.cmd_prepare(cmd, frame)?;
            self.culls.then(|| renderer.cmd_cull(cmd, frame, view, draws)).transpose()
        })?;
        let record = |cmd| {
            // SAFETY: inside rendering that fits the target, after the frame was prepared; the set outlives the submission.
            unsafe {
                painting.iter().for_each(|painting| painting.cmd_bind(headless, cmd, renderer));
                match &visible {
                    Some(visible) => renderer.cmd_draw_visible(cmd, frame, visible),
                    None => renderer.cmd_draw(cmd, frame, view, draws),
                }
            }
        };
        Ok(target.draw(headless, self.background, record)?)
    }
}
