//! The surface as the renderer draws it.

use super::drawable::{Drawable, Frame, Lane, Pass, Setup, timed};
use super::{BenchError, Contestant, Motion, Path, published};
use crate::headless::Headless;
use crate::measure::statistics::Summary;
use crate::renderer::{
    self, Cull, DrawItem, Error, Evaluation, Factor, MemoryUsage, ModelId, ModelOptions, ModelTables, Options,
    Renderer, Style, TableBytes, Target, VisibleItems, subdivision_level,
};
use crate::topology::PatchKind;
use ash::vk;

/// Tables are built and uploaded as often as fits into this many milliseconds each, and at least once; the median counts.
const SETUP_MS: f64 = 300.0;
const SETUP_TIMES: usize = 7;

pub(super) struct Surface {
    renderer: Renderer,
    model: ModelId,
    setup: Setup,
    bytes: Vec<TableBytes>,
    /// Control points that are cached, and the frames they are made of.
    cached: [u64; 2],
    control_point_bytes: u64,
    patches: u64,
    evaluation: Evaluation,
    cull: Cull,
    /// Whether compute looks for what can be seen.
    culls_by_compute: bool,
    /// The frame that is being recorded.
    begun: Option<renderer::Frame>,
    /// Visible list of the next pass.
    visible: Option<VisibleItems>,
}

/// The renderer's options for a contestant; styles are in the order of [`Pass::ALL`].
fn renderer_options(lane: Lane, contestant: Contestant, evaluation: Evaluation) -> Options {
    let style = |rasterizer_discard| Style { cull: lane.cull, rasterizer_discard, ..Style::default() };
    let is_published = contestant.path.is_published_acc();
    Options {
        frames_in_flight: 1,
        views_per_frame: lane.passes,
        styles: [false, true].map(style).to_vec(),
        evaluations: vec![evaluation],
        shaders: if is_published { published::shaders() } else { Vec::new() },
        visible_lists: contestant.culls_by_compute(),
        ..Options::default()
    }
}

/// Models of one mesh, added one after the other.
struct Uploads<'a> {
    headless: &'a Headless,
    positions: Vec<[f32; 3]>,
    options: &'a ModelOptions,
}

impl Uploads<'_> {
    fn prepare(&self, renderer: &mut Renderer) -> Result<(), Error> {
        // SAFETY: the command buffer is being recorded, outside rendering.
        self.headless.try_submit(|cmd| unsafe {
            let frame = renderer.begin_frame();
            renderer.cmd_prepare(cmd, frame)
        })
    }

    /// The model, and the milliseconds until it can be drawn.
    fn add(&self, renderer: &mut Renderer, tables: ModelTables) -> Result<(ModelId, f64), Error> {
        timed(|| {
            let model = renderer.add_tables(tables, &self.positions, self.options)?;
            self.prepare(renderer)?;
            Ok(model)
        })
    }
}

impl Surface {
    pub(super) fn new(lane: Lane, contestant: Contestant) -> Result<Self, BenchError> {
        let Lane { headless, target, subject, .. } = lane;
        let model_options = contestant.model_options(lane);
        let evaluation = model_options.evaluation;
        let (tables, tables_ms) = median_of(|| timed(|| ModelTables::new(&subject.mesh, &model_options)))?;
        let options = renderer_options(lane, contestant, evaluation);
        let render_target = Target::dynamic(target.color, target.depth, target.samples);
        let uploads = Uploads { headless, positions: subject.mesh.positions_f32(), options: &model_options };
        let first = tables.clone();
        let ((mut renderer, model), pipelines) = timed(|| {
            // SAFETY: no handles of ours are given; every submission is waited for, so the renderer is dropped when idle.
            let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
            let (model, _) = uploads.add(&mut renderer, first)?;
            Ok::<_, Error>((renderer, model))
        })?;
        // Others of the kind, now that the pipelines are there.
        let ((), upload) = median_of(|| {
            let (other, time) = uploads.add(&mut renderer, tables.clone())?;
            renderer.remove_model(other)?;
            // Its memory is freed here, and not in what is timed next.
            uploads.prepare(&mut renderer)?;
            Ok::<_, Error>(((), time))
        })?;
        Ok(Self {
            renderer,
            model,
            setup: Setup { tables: tables_ms, upload, pipelines, ..Setup::default() },
            bytes: tables.bytes(),
            cached: tables.kept_bytes(),
            control_point_bytes: match evaluation {
                Evaluation::Tessellation => passed_on(&tables, contestant.path),
                _ => 0,
            },
            patches: tables.plan().patches().len() as u64,
            evaluation,
            cull: contestant.cull,
            culls_by_compute: contestant.culls_by_compute(),
            begun: None,
            visible: None,
        })
    }

    fn begun(&self) -> Result<renderer::Frame, Error> {
        self.begun.ok_or(Error::FrameNotPrepared)
    }

    fn items(&self, frame: &Frame) -> Vec<DrawItem> {
        let style = usize::from(frame.pass == Pass::Geometry);
        let factor = if self.evaluation.needs_segments() { Factor::Segments } else { frame.factor.into() };
        let item = DrawItem { style, cull: self.cull, ..DrawItem::new(self.model, factor) };
        frame.instances.iter().map(|&transform| DrawItem { transform, ..item }).collect()
    }
}

/// Bytes of the control points of all patches, as the control stage passes them on.
fn passed_on(tables: &ModelTables, path: Path) -> u64 {
    let of_patch = |kind| match kind {
        PatchKind::IrregularQuad if path.is_published_acc() => published::QUAD_BYTES,
        _ => 12 * tables.plan().scheme().points(kind) as u64,
    };
    PatchKind::ALL.map(|kind| u64::from(tables.patch_count(kind)) * of_patch(kind)).iter().sum()
}

/// The last of what some work gives, with the median of the times that it tells.
fn median_of<R, E>(mut work: impl FnMut() -> Result<(R, f64), E>) -> Result<(R, f64), E> {
    let mut times = Vec::new();
    loop {
        let (done, time) = work()?;
        times.push(time);
        if times.len() == SETUP_TIMES || times.iter().sum::<f64>() + time > SETUP_MS {
            return Ok((done, Summary::of(&times).map_or(0.0, |summary| summary.median)));
        }
    }
}

impl Drawable for Surface {
    fn set_factor(&mut self, factor: f32) -> Result<(), BenchError> {
        match self.evaluation {
            Evaluation::Subdivision => _ = subdivision_level(self.model, Factor::Uniform(factor))?,
            evaluation if evaluation.needs_segments() => {
                self.renderer.set_segments(self.model, factor.ceil() as u32)?;
            }
            _ => {}
        }
        Ok(())
    }

    unsafe fn cmd_prepare(&mut self, cmd: vk::CommandBuffer, motion: Motion) -> Result<(), BenchError> {
        if motion == Motion::Moving {
            self.renderer.forget_control_points(self.model)?;
        }
        // SAFETY: as the caller promises.
        unsafe {
            let begun = self.renderer.begin_frame();
            self.begun = Some(begun);
            self.renderer.cmd_prepare(cmd, begun)?;
        }
        Ok(())
    }

    unsafe fn cmd_begin_pass(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        if self.culls_by_compute {
            let items = self.items(frame);
            // SAFETY: as the caller promises.
            self.visible = Some(unsafe { self.renderer.cmd_cull(cmd, self.begun()?, frame.view, &items)? });
        }
        Ok(())
    }

    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        let begun = self.begun()?;
        // SAFETY: as the caller promises.
        unsafe {
            match &self.visible {
                Some(visible) => self.renderer.cmd_draw_visible(cmd, begun, visible)?,
                None => self.renderer.cmd_draw(cmd, begun, frame.view, &self.items(frame))?,
            }
        }
        Ok(())
    }

    fn setup(&self) -> Setup {
        self.setup
    }

    fn bytes(&self) -> Vec<TableBytes> {
        let MemoryUsage { vertices, indices, lists, .. } = self.renderer.memory_usage();
        let besides = [("vertices", vertices), ("indices", indices), ("lists", lists)]
            .into_iter()
            .filter(|(_, bytes)| *bytes > 0);
        self.bytes.iter().copied().chain(besides).collect()
    }

    fn moved_bytes(&self, motion: Motion) -> [u64; 2] {
        let [points, frames] = self.cached;
        let MemoryUsage { vertices, indices, lists, .. } = self.renderer.memory_usage();
        let drawn = indices + lists;
        let tables = self.bytes.iter().map(|(_, bytes)| bytes).sum::<u64>() - points - frames;
        if points == 0 {
            // Compute makes the control points of all patches, too, to look which can be seen.
            let times = if self.culls_by_compute { 2 } else { 1 };
            return [0, times * tables + drawn];
        }
        // Frames are written, and read again for the points.
        let makes_points = tables + 2 * frames + points;
        let [once, each] = match self.evaluation {
            Evaluation::Compute => [makes_points + points + vertices, vertices + drawn],
            _ => [makes_points, points + drawn],
        };
        [if motion == Motion::Moving { once } else { 0 }, each]
    }

    fn patches(&self) -> Option<u64> {
        Some(self.patches)
    }

    fn control_point_bytes(&self) -> u64 {
        self.control_point_bytes
    }
}
