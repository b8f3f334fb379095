//! Drawables: what the race needs of every path.

use super::{BenchError, Contestant, Creases, Motion, Normals, Subject};
use crate::adaptive::{AdaptiveOptions, MAX_DEPTH};
use crate::gpu::Spacing;
use crate::headless::{Headless, OffscreenDesc};
use crate::mesh::{ControlMesh, SHARPNESS_INFINITE};
use crate::renderer::{ModelOptions, TableBytes, View};
use ash::vk;
use std::time::Instant;

/// Times before the first frame, in milliseconds; of tables and upload of the renderer's own paths the median
/// of several times.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Setup {
    /// Everything that the GPU reads, out of the mesh: topology, plan and tables; for a vertex buffer its vertices.
    pub tables: f64,
    /// Buffers, copies to the device, and control points that are kept, with pipelines that are there and have been used.
    pub upload: f64,
    /// Pipelines, once for all models, and a first model with its copies and control points: some drivers compile compute
    /// shaders when they are used.
    pub pipelines: f64,
    /// The first frame with new pipelines, at factor 1, once with pixels and once without.
    pub first_frame: f64,
}

impl Setup {
    /// Time that each model takes: all but pipelines and compilation.
    pub fn per_model(&self) -> f64 {
        self.tables + self.upload
    }

    /// Time that the first use of a path takes besides.
    pub fn first_use(&self) -> f64 {
        self.pipelines + self.first_frame
    }
}

/// Bytes that a frame moves, by count: what a device without caches would move at least. A device may keep much of it
/// on the chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct Traffic {
    /// Tables, positions, control points that are kept, vertices and indices: each byte once an instance and pass that reads
    /// it, and what is made once a frame as often as making it reads and writes it.
    pub tables: u64,
    /// Control points that go from the control stage to the evaluation stage.
    pub control_points: u64,
    /// Evaluated vertices on their way to the rasterizer.
    pub vertices: u64,
}

/// Bytes of a vertex on its way to the rasterizer: `gl_Position`, position and normal.
pub(super) const VERTEX_BYTES: u64 = 16 + 12 + 12;

/// Kind of frame.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Pass {
    Pixels,
    /// The rasterizer is off.
    Geometry,
}

impl Pass {
    pub(super) const ALL: [Self; 2] = [Self::Pixels, Self::Geometry];
}

/// One frame of one contestant.
pub(super) struct Frame<'a> {
    pub view: &'a View,
    /// Object to world of each instance, by columns.
    pub instances: &'a [[[f32; 4]; 4]],
    pub factor: f32,
    pub pass: Pass,
}

/// A contestant with its pipelines and buffers, for one mesh and one spacing.
pub(super) trait Drawable {
    /// Before frames of another factor are drawn.
    fn set_factor(&mut self, _factor: f32) -> Result<(), BenchError> {
        Ok(())
    }

    /// Records what a frame does before it draws, of which the control vertices moved or did not.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering; the device is done with earlier frames.
    unsafe fn cmd_prepare(&mut self, _cmd: vk::CommandBuffer, _motion: Motion) -> Result<(), BenchError> {
        Ok(())
    }

    /// Records what a pass does before it draws.
    ///
    /// # Safety
    /// As [`Drawable::cmd_prepare`], after it.
    unsafe fn cmd_begin_pass(&mut self, _cmd: vk::CommandBuffer, _frame: &Frame) -> Result<(), BenchError> {
        Ok(())
    }

    /// Records the draws of a pass.
    ///
    /// # Safety
    /// `cmd` is being recorded, inside rendering that fits [`Lane::target`], after [`Drawable::cmd_begin_pass`].
    unsafe fn cmd_draw(&mut self, cmd: vk::CommandBuffer, frame: &Frame) -> Result<(), BenchError>;

    fn setup(&self) -> Setup;

    /// Everything that drawing reads.
    fn bytes(&self) -> Vec<TableBytes>;

    /// Bytes that a frame moves before it draws, and bytes that each instance in each pass reads.
    fn moved_bytes(&self, _motion: Motion) -> [u64; 2] {
        [0, self.bytes().iter().map(|(_, bytes)| bytes).sum()]
    }

    /// Patches of the model, if not those of the subject.
    fn patches(&self) -> Option<u64> {
        None
    }

    /// Bytes of the control points of all patches, as the control stage passes them on, if it is used.
    fn control_point_bytes(&self) -> u64;
}

/// Device, target and subject that a drawable is made for.
#[derive(Clone, Copy)]
pub(super) struct Lane<'a> {
    pub headless: &'a Headless,
    pub target: &'a OffscreenDesc,
    pub subject: &'a Subject,
    pub spacing: Spacing,
    /// Faces that the rasterizer culls.
    pub cull: vk::CullModeFlags,
    /// Calls of [`Drawable::cmd_draw`] in a frame.
    pub passes: u32,
}

impl Contestant {
    /// For paths that are the renderer's own.
    pub(super) fn model_options(self, lane: Lane) -> ModelOptions {
        let evaluation = self.path.evaluation().unwrap_or_default();
        let (scheme, construction) = self.patches.unwrap_or_default();
        ModelOptions {
            name: lane.subject.name.clone(),
            scheme,
            construction,
            evaluation,
            spacing: lane.spacing,
            shared_normals: self.normals == Normals::Shared,
            refine: lane.subject.refine,
            adaptive: self.adaptive_options(&lane.subject.mesh, lane.subject.refine),
            ..ModelOptions::default()
        }
    }

    /// Depths of the adaptive surface, if it is one, of a mesh that is refined this often before.
    pub fn adaptive_options(self, mesh: &ControlMesh, refine: u32) -> Option<AdaptiveOptions> {
        self.depth.map(|depth| AdaptiveOptions {
            depth,
            sharp_depth: (self.creases != Creases::Direct).then(|| depth.max(levels_of_creases(mesh, refine))),
            refine_creases: self.creases == Creases::Refined,
            sums: self.sums,
            drawn_by: self.drawn_by,
        })
    }
}

/// Further steps of refinement after which no crease is left of finite sharpness, or as many as there can be.
fn levels_of_creases(mesh: &ControlMesh, refine: u32) -> u32 {
    let creases = mesh.data().creases.iter().map(|crease| crease.sharpness);
    let finite = creases.filter(|&sharpness| sharpness < SHARPNESS_INFINITE);
    (finite.fold(0.0, f32::max).ceil() as u32).saturating_sub(refine).min(MAX_DEPTH)
}

/// Milliseconds that some work takes.
pub(super) fn timed<R, E>(work: impl FnOnce() -> Result<R, E>) -> Result<(R, f64), E> {
    let start = Instant::now();
    let done = work()?;
    Ok((done, start.elapsed().as_secs_f64() * 1e3))
}
