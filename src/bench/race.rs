//! Everything that is raced on one mesh, drawn in turns.

use super::cpu::Cpu;
use super::drawable::{Drawable, Frame, Lane, Pass, VERTEX_BYTES};
use super::floors::{Bilinear, VertexBuffer, device_buffer};
use super::scene::Scene;
use super::surface::Surface;
use super::{BenchError, BenchOptions, Contestant, Motion, Path, Row, Series, Setup, Subject, Traffic};
use crate::headless::{Headless, Offscreen, OffscreenDesc, Statistics};
use crate::measure::statistics::{Estimate, FEWEST, paired_difference};
use ash::vk;
use std::time::Duration;

/// Reports of a race while it runs.
#[derive(Debug)]
pub enum Event {
    /// Further frames that are done, or need not be drawn, of those that [`Bench::frames`] counts.
    Frames(u64),
    /// A contestant does not run, at this factor or at all: why.
    LeftOut(Contestant, Option<f32>, BenchError),
    /// All of one factor: for each camera the contestants, each in their order.
    Rows(Vec<Row>),
}

/// Races on one device.
pub struct Bench<'h> {
    headless: &'h Headless,
    options: BenchOptions,
    /// In the order of [`Pass::ALL`].
    targets: [Offscreen; 2],
}

/// A contestant that runs.
struct Runner<'a> {
    contestant: Contestant,
    drawable: Box<dyn Drawable + 'a>,
    first_frame: f64,
    construction: Option<Estimate>,
}

impl<'h> Bench<'h> {
    /// Makes what is drawn into.
    ///
    /// # Errors
    /// [`BenchError::BadOption`]; sizes that the device does not have, no memory.
    pub fn new(headless: &'h Headless, options: BenchOptions) -> Result<Self, BenchError> {
        let least = [
            ("BenchOptions::frames", options.frames, FEWEST as u32),
            ("BenchOptions::instances", options.instances, 1),
            ("BenchOptions::passes", options.passes, 1),
            ("BenchOptions::cameras", options.cameras.len() as u32, 1),
        ];
        if let Some(&(what, given, least)) = least.iter().find(|(_, given, least)| given < least) {
            return Err(BenchError::BadOption { what, given, least });
        }
        let [width, height] = options.size;
        let targets = [
            Offscreen::new(headless, &OffscreenDesc::new(width, height))?,
            Offscreen::new(headless, &OffscreenDesc::new(16, 16))?,
        ];
        // The first submissions of a device take longer than those after them.
        device_buffer(headless, "warm-up", vk::BufferUsageFlags::STORAGE_BUFFER, &[0u32])?;
        for target in &targets {
            // SAFETY: the command buffer is being recorded, outside rendering.
            headless.submit(|cmd| unsafe {
                target.cmd_begin(cmd, [0.0; 4]);
                target.cmd_end(cmd);
            })?;
        }
        Ok(Self { headless, options, targets })
    }

    /// Options of the measurement.
    pub fn options(&self) -> &BenchOptions {
        &self.options
    }

    /// Frames that a race of `contestants` draws.
    pub fn frames(&self, contestants: usize) -> u64 {
        let drawn = self.options.cameras.len() as u64 * 2 * self.options.factors.len() as u64;
        contestants as u64 * self.rounds() * (u64::from(self.options.motion == Motion::Moving) + drawn)
    }

    /// Frames that each contestant draws of a kind, with those that do not count.
    fn rounds(&self) -> u64 {
        u64::from(self.options.frames + self.options.warm_up)
    }

    /// Races on one mesh, factor by factor.
    ///
    /// # Errors
    /// Failed Vulkan calls. A contestant that has no patches for the mesh, or takes more memory than there is, is left
    /// out, and `report` is given the reason.
    pub fn race(
        &self,
        subject: &Subject,
        contestants: &[Contestant],
        mut report: impl FnMut(Event),
    ) -> Result<(), BenchError> {
        let lane = self.lane(subject);
        let scenes = self.scenes(subject);
        let mut runners = Vec::new();
        for &contestant in contestants {
            match self.runner(contestant, lane, &scenes[0]) {
                Err(error) if error.leaves_out() => {
                    report(Event::LeftOut(contestant, None, error));
                    report(Event::Frames(self.frames(1)));
                }
                other => runners.push(other?),
            }
        }
        self.construction(&mut runners, &scenes[..1], &mut report)?;
        for &factor in &self.options.factors {
            let mut racing = Vec::new();
            for runner in &mut runners {
                match runner.drawable.set_factor(factor) {
                    Err(error) if error.leaves_out() => {
                        report(Event::LeftOut(runner.contestant, Some(factor), error));
                        report(Event::Frames(scenes.len() as u64 * 2 * self.rounds()));
                    }
                    Ok(()) => racing.push(runner),
                    Err(error) => return Err(error),
                }
            }
            let series = self.turns(&mut racing, &scenes, factor, &Pass::ALL, &mut report)?;
            let mut rows = Vec::new();
            for (scene, series) in scenes.iter().zip(series) {
                for (runner, series) in racing.iter_mut().zip(series) {
                    rows.push(self.row(runner, scene, subject, factor, series)?);
                }
            }
            report(Event::Rows(rows));
        }
        Ok(())
    }

    /// Picture of a contestant from the first camera: rows from the top, four bytes sRGB and opacity a pixel.
    ///
    /// # Errors
    /// As [`Bench::race`], but a contestant that would be left out is an error here.
    pub fn picture(&self, subject: &Subject, contestant: Contestant, factor: f32) -> Result<Vec<u8>, BenchError> {
        let target = &self.targets[0];
        let scenes = self.scenes(subject);
        let mut drawable = open(contestant, self.lane(subject))?;
        drawable.set_factor(factor)?;
        // SAFETY: the command buffer is being recorded, outside rendering; each submission is waited for.
        let frame = scenes[0].frame(factor, Pass::Pixels);
        self.headless.try_submit(|cmd| unsafe {
            drawable.cmd_prepare(cmd, self.options.motion)?;
            drawable.cmd_begin_pass(cmd, &frame)
        })?;
        target.draw(self.headless, [0.0; 4], |cmd| {
            // SAFETY: inside rendering that fits the target, after the frame was prepared.
            unsafe { drawable.cmd_draw(cmd, &frame) }
        })
    }

    fn scenes(&self, subject: &Subject) -> Vec<Scene> {
        self.options.cameras.iter().map(|&camera| Scene::new(subject, &self.options, camera)).collect()
    }

    pub(super) fn headless(&self) -> &'h Headless {
        self.headless
    }

    /// Target of 16 x 16 pixels, for frames without rasterization.
    pub(super) fn geometry_target(&self) -> &Offscreen {
        &self.targets[1]
    }

    pub(super) fn lane<'a>(&'a self, subject: &'a Subject) -> Lane<'a> {
        let BenchOptions { spacing, passes, single_sided, .. } = self.options;
        let cull = if single_sided { vk::CullModeFlags::BACK } else { vk::CullModeFlags::NONE };
        Lane { headless: self.headless, target: self.targets[0].desc(), subject, spacing, cull, passes }
    }

    fn runner<'a>(&self, contestant: Contestant, lane: Lane<'a>, scene: &Scene) -> Result<Runner<'a>, BenchError> {
        let mut drawable = open(contestant, lane)?;
        drawable.set_factor(1.0)?;
        let mut first_frame = 0.0;
        for pass in Pass::ALL {
            first_frame += milliseconds(self.frame(&mut *drawable, &scene.frame(1.0, pass))?[1]);
        }
        Ok(Runner { contestant, drawable, first_frame, construction: None })
    }

    /// Time to make the control points: factor 1, less the bilinear floor at factor 1, which goes through the same stages.
    fn construction(
        &self,
        runners: &mut [Runner],
        scenes: &[Scene],
        report: &mut impl FnMut(Event),
    ) -> Result<(), BenchError> {
        if self.options.motion == Motion::Still {
            return Ok(());
        }
        let is_floor = |runner: &Runner| runner.contestant.path == Path::Bilinear;
        let has_floor = runners.iter().any(is_floor);
        let all = runners.len();
        let drawn = |runner: &&mut Runner| has_floor && runner.contestant.path.tessellates();
        let mut drawn: Vec<&mut Runner> = runners.iter_mut().filter(drawn).collect();
        report(Event::Frames(self.rounds() * (all - drawn.len()) as u64));
        let series = self.turns(&mut drawn, scenes, 1.0, &[Pass::Geometry], report)?.swap_remove(0);
        let Some(floor) = drawn.iter().position(|runner| is_floor(runner)) else { return Ok(()) };
        let floor = &series[floor][0].device;
        for (runner, series) in drawn.iter_mut().zip(&series).filter(|(runner, _)| !is_floor(runner)) {
            runner.construction = paired_difference(&series[0].device, floor);
        }
        Ok(())
    }

    /// Warms up, and draws in turns: for each scene and runner a series for each pass.
    fn turns(
        &self,
        runners: &mut [&mut Runner],
        scenes: &[Scene],
        factor: f32,
        passes: &[Pass],
        report: &mut impl FnMut(Event),
    ) -> Result<Vec<Vec<Vec<Series>>>, BenchError> {
        let mut all = vec![vec![vec![Series::default(); passes.len()]; runners.len()]; scenes.len()];
        for round in 0..self.options.warm_up + self.options.frames {
            for (index, runner) in runners.iter_mut().enumerate() {
                for (scene, series) in scenes.iter().zip(&mut all) {
                    for (&pass, series) in passes.iter().zip(&mut series[index]) {
                        let [device, host] = self.frame(&mut *runner.drawable, &scene.frame(factor, pass))?;
                        if round >= self.options.warm_up {
                            series.device.push(milliseconds(device));
                            series.host.push(milliseconds(host));
                        }
                    }
                    report(Event::Frames(passes.len() as u64));
                }
            }
        }
        Ok(all)
    }

    /// Draws a frame: how long it takes on the device and on the host.
    fn frame(&self, drawable: &mut dyn Drawable, frame: &Frame) -> Result<[Duration; 2], BenchError> {
        // SAFETY: each submission is waited for.
        let timing = self.headless.timed(|cmd| unsafe { self.record(cmd, drawable, frame) })?;
        Ok([timing.device, timing.host])
    }

    /// # Safety
    /// `cmd` is being recorded, outside rendering; the device is done with earlier frames.
    unsafe fn record(
        &self,
        cmd: vk::CommandBuffer,
        drawable: &mut dyn Drawable,
        frame: &Frame,
    ) -> Result<(), BenchError> {
        let target = &self.targets[usize::from(frame.pass == Pass::Geometry)];
        // SAFETY: as the caller promises.
        unsafe {
            drawable.cmd_prepare(cmd, self.options.motion)?;
            for _ in 0..self.options.passes {
                drawable.cmd_begin_pass(cmd, frame)?;
                target.cmd_begin(cmd, [0.0; 4]);
                drawable.cmd_draw(cmd, frame)?;
                target.cmd_end(cmd);
            }
        }
        Ok(())
    }

    fn row(
        &self,
        runner: &mut Runner,
        scene: &Scene,
        subject: &Subject,
        factor: f32,
        series: Vec<Series>,
    ) -> Result<Row, BenchError> {
        let frame = scene.frame(factor, Pass::Pixels);
        let drawable = &mut *runner.drawable;
        let counted = if self.headless.context().features().statistics {
            // SAFETY: each submission is waited for.
            Some(self.headless.counted(|cmd| unsafe { self.record(cmd, drawable, &frame) })?)
        } else {
            None
        };
        let count = |of: fn(&Statistics) -> u64| counted.as_ref().map(of);
        let evaluations = count(|s| s.evaluation_invocations);
        // Strips have at least a vertex for each triangle.
        let vertices = |s: &Statistics| s.evaluation_invocations.max(s.vertex_invocations).max(s.geometry_primitives);
        let vertices = count(vertices).unwrap_or(0);
        let times = u64::from(self.options.instances) * u64::from(self.options.passes);
        let [once, each] = drawable.moved_bytes(self.options.motion);
        let traffic = Traffic {
            tables: once + times * each,
            control_points: times * drawable.control_point_bytes(),
            vertices: VERTEX_BYTES * vertices,
        };
        let [gpu, geometry] = <[Series; 2]>::try_from(series).unwrap_or_default();
        Ok(Row {
            contestant: runner.contestant,
            camera: scene.camera,
            factor,
            patches: times * drawable.patches().unwrap_or_else(|| subject.patches()),
            evaluations,
            computed: count(|s| s.compute_invocations),
            triangles: count(|s| s.clipping_invocations),
            visible: count(|s| s.clipping_primitives),
            gpu,
            geometry,
            construction: runner.construction,
            setup: Setup { first_frame: runner.first_frame, ..drawable.setup() },
            bytes: drawable.bytes(),
            traffic,
        })
    }
}

/// Makes everything of a contestant that does not depend on the factor.
fn open(contestant: Contestant, lane: Lane<'_>) -> Result<Box<dyn Drawable + '_>, BenchError> {
    Ok(match contestant.path {
        Path::Cpu => Box::new(Cpu::new(lane)?),
        Path::Bilinear => Box::new(Bilinear::new(lane)?),
        Path::VertexBuffer => Box::new(VertexBuffer::new(lane)?),
        _ => Box::new(Surface::new(lane, contestant)?),
    })
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}
