//! The surface as the renderer draws it.

use super::drawable::{Drawable, Frame, Lane, Pass, Setup, timed};
use super::{BenchError, Contestant, Motion, published};
use crate::measure::statistics::Summary;
use crate::renderer::{
    Cull, DrawItem, Error, Evaluation, Factor, MemoryUsage, ModelId, ModelOptions, ModelTables, Options, Renderer,
    Style, TableBytes, Target, VisibleItems, subdivision_level,
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
    control_point_bytes: u64,
    patches: u64,
    evaluation: Evaluation,
    cull: Cull,
    /// Whether compute looks for what can be seen.
    culls_by_compute: bool,
    /// What is drawn of the next pass.
    visible: Option<VisibleItems>,
}

impl Surface {
    pub(super) fn new(lane: Lane, contestant: Contestant) -> Result<Self, BenchError> {
        let Lane { headless, target, subject, cull, passes, .. } = lane;
        let model_options = contestant.model_options(lane);
        let ModelOptions { scheme, evaluation, .. } = model_options;
        let as_published = contestant.path.is_published_acc();
        let (tables, tables_ms) = median_of(|| timed(|| ModelTables::new(&subject.mesh, &model_options)))?;
        // In the order of `Pass::ALL`.
        let styles =
            [false, true].map(|rasterizer_discard| Style { cull, rasterizer_discard, ..Style::default() }).to_vec();
        let evaluations = vec![evaluation];
        let culls_by_compute = contestant.culls_by_compute();
        let shaders = if as_published { published::shaders() } else { Vec::new() };
        let options = Options {
            frames_in_flight: 1,
            views_per_frame: passes,
            styles,
            evaluations,
            shaders,
            visible_lists: culls_by_compute,
            ..Options::default()
        };
        let render_target = Target::dynamic(target.color, target.depth, target.samples);
        let positions = subject.mesh.positions_f32();
        let prepare = |renderer: &mut Renderer| {
            // SAFETY: the command buffer is being recorded, outside rendering.
            headless.try_submit(|cmd| unsafe { renderer.cmd_prepare(cmd, 0) })
        };
        let add = |renderer: &mut Renderer, tables| {
            timed(|| {
                let model = renderer.add_tables(tables, &positions, &model_options)?;
                prepare(renderer)?;
                Ok::<_, Error>(model)
            })
        };
        let first = tables.clone();
        let ((mut renderer, model), pipelines) = timed(|| {
            // SAFETY: no handles of ours are given; every submission is waited for, so the renderer is dropped when idle.
            let mut renderer = unsafe { Renderer::new(headless.context(), &render_target, &options)? };
            let (model, _) = add(&mut renderer, first)?;
            Ok::<_, Error>((renderer, model))
        })?;
        // Others of the kind, now that the pipelines are there.
        let ((), upload) = median_of(|| {
            let (other, time) = add(&mut renderer, tables.clone())?;
            renderer.remove_model(other)?;
            // Its memory is freed here, and not in what is timed next.
            prepare(&mut renderer)?;
            Ok::<_, Error>(((), time))
        })?;
        let bytes = tables.bytes();
        let patch_bytes = |kind| match kind {
            PatchKind::IrregularQuad if as_published => published::QUAD_BYTES,
            _ => 12 * scheme.points(kind) as u64,
        };
        let patches = tables.plan().patches().len() as u64;
        let bytes_of = |kind| u64::from(tables.patch_count(kind)) * patch_bytes(kind);
        let control_point_bytes = match evaluation {
            Evaluation::Tessellation => PatchKind::ALL.map(bytes_of).iter().sum(),
            _ => 0,
        };
        let setup = Setup { tables: tables_ms, upload, pipelines, ..Setup::default() };
        Ok(Self {
            renderer,
            model,
            setup,
            bytes,
            control_point_bytes,
            patches,
            evaluation,
            cull: contestant.cull,
            culls_by_compute,
            visible: None,
        })
    }

    fn items(&self, frame: &Frame) -> Vec<DrawItem> {
        let style = usize::from(frame.pass == Pass::Geometry);
        let item = DrawItem { style, cull: self.cull, ..DrawItem::new(self.model, frame.factor) };
        frame.instances.iter().map(|&transform| DrawItem { transform, ..item }).collect()
    }
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
        unsafe { self.renderer.cmd_prepare(cmd, 0)? };
        Ok(())
    }

    unsafe fn cmd_begin_pass(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        if self.culls_by_compute {
            let items = self.items(frame);
            // SAFETY: as the caller promises.
            self.visible = Some(unsafe { self.renderer.cmd_cull(cmd, 0, frame.view, &items)? });
        }
        Ok(())
    }

    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError> {
        // SAFETY: as the caller promises.
        unsafe {
            match &self.visible {
                Some(visible) => self.renderer.cmd_draw_visible(cmd, 0, visible)?,
                None => self.renderer.cmd_draw(cmd, 0, frame.view, &self.items(frame))?,
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
        let all = self.bytes();
        let of = |name| all.iter().find(|(of, _)| *of == name).map_or(0, |(_, bytes)| *bytes);
        let [points, frames, vertices] = ["control_points", "frames", "vertices"].map(of);
        let drawn = of("indices") + of("lists");
        let tables = all.iter().map(|(_, bytes)| bytes).sum::<u64>() - points - frames - vertices - drawn;
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
