//! Recording: the host's work for a frame of many models.

use super::drawable::timed;
use super::scene::Scene;
use super::{Bench, BenchError, Camera, Contestant, Subject};
use crate::named::named;
use crate::renderer::{DrawItem, Factor, ModelId, ModelTables, Options, Renderer, Style, Target};

named! {
    /// Models of a frame.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
    #[non_exhaustive]
    pub enum Crowd {
        /// One model, drawn many times.
        Instances = "instances",
        /// Models with tables and buffers of their own, at rest.
        Models = "models",
        /// Models with tables and buffers of their own, whose vertices move.
        Moving = "moving",
    }
}

impl Crowd {}

/// Recording times of a crowd on the host's clock, frame by frame, in milliseconds.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Recording {
    /// Models that are recorded.
    pub crowd: Crowd,
    /// [`Renderer::cmd_prepare`], and [`Renderer::cmd_cull`] where compute culls patches.
    pub prepare: Vec<f64>,
    /// [`Renderer::cmd_draw`], or [`Renderer::cmd_draw_visible`] then.
    pub draw: Vec<f64>,
}

impl Bench<'_> {
    /// Records frames of `models` models. Only the first frame of each crowd is submitted. At factor 1 and without
    /// rasterization: how finely they are drawn makes no difference to the host.
    ///
    /// # Errors
    /// [`BenchError::NotRecorded`] for paths that the renderer does not draw; [`BenchError::BadOption`] without models; what
    /// else keeps models from being made and drawn.
    pub fn recording(
        &self,
        subject: &Subject,
        contestant: Contestant,
        models: u32,
    ) -> Result<Vec<Recording>, BenchError> {
        if models == 0 {
            return Err(BenchError::BadOption { what: "models", given: models, least: 1 });
        }
        if !contestant.path.is_recorded() {
            return Err(BenchError::NotRecorded { path: contestant.path.name() });
        }
        let lane = self.lane(subject);
        let model_options = contestant.model_options(lane);
        let target = self.geometry_target().desc();
        let target = Target::dynamic(target.color, target.depth, target.samples);
        let styles = vec![Style { rasterizer_discard: true, ..Style::default() }];
        let evaluations = vec![model_options.evaluation];
        let visible_lists = contestant.culls_by_compute();
        let options = Options {
            frames_in_flight: 1,
            views_per_frame: 1,
            styles,
            evaluations,
            visible_lists,
            ..Options::default()
        };
        // SAFETY: no handles of ours are given; every submission is waited for, so the renderer is dropped when idle.
        let mut renderer = unsafe { Renderer::new(lane.headless.context(), &target, &options)? };
        let tables = ModelTables::new(&subject.mesh, &model_options)?;
        let positions = subject.mesh.positions_f32();
        let add = |renderer: &mut Renderer| -> Result<ModelId, BenchError> {
            let id = renderer.add_tables(tables.clone(), &positions, &model_options)?;
            if model_options.evaluation.needs_segments() {
                renderer.set_segments(id, 1)?;
            }
            Ok(id)
        };
        let needs_segments = model_options.evaluation.needs_segments();
        let factor = if needs_segments { Factor::Segments } else { Factor::Uniform(1.0) };
        let item = |model| DrawItem { cull: contestant.cull, ..DrawItem::new(model, factor) };
        let first = add(&mut renderer)?;
        let mut items = vec![item(first); models as usize];
        let mut recordings = vec![self.record_frames(&mut renderer, subject, contestant, &items, Crowd::Instances)?];
        for other in &mut items[1..] {
            *other = item(add(&mut renderer)?);
        }
        for crowd in [Crowd::Models, Crowd::Moving] {
            recordings.push(self.record_frames(&mut renderer, subject, contestant, &items, crowd)?);
        }
        Ok(recordings)
    }

    fn record_frames(
        &self,
        renderer: &mut Renderer,
        subject: &Subject,
        contestant: Contestant,
        items: &[DrawItem],
        crowd: Crowd,
    ) -> Result<Recording, BenchError> {
        let scene = Scene::new(subject, self.options(), Camera::Fit);
        let frame = scene.frame(1.0, super::drawable::Pass::Geometry);
        let positions = subject.mesh.positions_f32();
        let target = self.geometry_target();
        let mut recording = Recording { crowd, prepare: Vec::new(), draw: Vec::new() };
        // Tables are copied.
        // SAFETY: recorded outside rendering; the submission is waited for.
        self.headless().try_submit(|cmd| unsafe {
            let begun = renderer.begin_frame();
            renderer.cmd_prepare(cmd, begun)
        })?;
        let before = self.options().warm_up;
        for round in 0..before + self.options().frames {
            // SAFETY: the device is done with what was submitted; the frame before is lost.
            let begun = unsafe { renderer.begin_frame() };
            if crowd == Crowd::Moving {
                for item in items {
                    renderer.set_positions(item.model, begun, &positions)?;
                }
            }
            // SAFETY: recorded outside rendering, then inside of rendering that fits.
            self.headless().record(|cmd| unsafe {
                let (visible, prepare) = timed(|| {
                    renderer.cmd_prepare(cmd, begun)?;
                    contestant.culls_by_compute().then(|| renderer.cmd_cull(cmd, begun, frame.view, items)).transpose()
                })?;
                target.cmd_begin(cmd, [0.0; 4]);
                let ((), draw) = timed(|| match &visible {
                    Some(visible) => renderer.cmd_draw_visible(cmd, begun, visible),
                    None => renderer.cmd_draw(cmd, begun, frame.view, items),
                })?;
                target.cmd_end(cmd);
                if round >= before {
                    recording.prepare.push(prepare);
                    recording.draw.push(draw);
                }
                Ok::<_, BenchError>(())
            })?;
            renderer.frame_lost(begun)?;
        }
        Ok(recording)
    }
}
