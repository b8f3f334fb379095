//! What is particular about each evaluation, in one place: a new one is a file beside this, its shaders, and its line in [`path`].

use super::drawn::{Asked, Drawn};
use super::recorder::{DrawnGroup, Recorder};
use super::{compute, geometry, instanced, subdivision, tessellation, two_pass};
use crate::gpu::{DeviceProperties, Features};
use crate::renderer::options::{Error, Factor};
use crate::renderer::pipelines::{DrawPipelines, MadeFor, Recipe};
use crate::renderer::shader::{Cut, GeometryKey, PatchStages};
use crate::table::Evaluation;
use ash::vk;

/// A way from control points to triangles.
pub(crate) trait Path: Sync {
    /// Features that the device must have, besides those that everything needs.
    fn features(&self) -> Features {
        Features::NONE
    }

    /// Whether instances have their control points as vertex attributes.
    fn has_attributes(&self, _pipelines: &DrawPipelines, _stages: PatchStages) -> bool {
        false
    }

    /// What pipelines take from the number in a draw's factor: nothing, or the level of subdivision.
    fn level(&self, _factor: Factor) -> Option<u32> {
        None
    }

    /// What tells the pipelines of its draws apart in one style; none for a factor that it does not have.
    fn key(&self, stages: PatchStages, cut: Cut, _factor: Factor) -> Option<GeometryKey> {
        Some(GeometryKey::Patches(stages, cut.without_control()))
    }

    /// What these pipelines are made of.
    fn recipe(&self, stages: PatchStages, cut: Cut, key: GeometryKey, made_for: &MadeFor) -> Recipe;

    /// What a draw is of.
    ///
    /// # Errors
    /// Factors that it does not have, segments that were not set.
    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error>;

    /// Records the draws of a group of patches.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`](crate::Renderer::cmd_draw), with the pipeline, the sets and what `drawn` is of bound.
    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup);

    /// Bytes of the indirect draws of a region of a visible list.
    fn command_bytes(&self) -> usize {
        size_of::<vk::DrawIndexedIndirectCommand>()
    }

    /// Patches per instance of a draw of a visible list; 0 where each patch has an instance.
    fn patches_per_instance(&self, _device: &DeviceProperties, _stages: PatchStages, _patches: u32, _most: f32) -> u32 {
        0
    }
}

/// The path of each evaluation.
pub(crate) fn path(evaluation: Evaluation) -> &'static dyn Path {
    match evaluation {
        Evaluation::Tessellation => &tessellation::Tessellation,
        Evaluation::Compute => &compute::Compute,
        Evaluation::Instanced => &instanced::Instanced,
        Evaluation::Geometry => &geometry::Geometry,
        Evaluation::GeometryTwoPass => &two_pass::TwoPass,
        Evaluation::Subdivision => &subdivision::Subdivision,
    }
}

impl Evaluation {
    /// Features that the device must have, besides those that everything needs.
    pub fn features(self) -> Features {
        path(self).features()
    }
}
