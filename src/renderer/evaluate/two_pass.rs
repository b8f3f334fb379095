//! Evaluation in two passes (Ni et al. 2008): the geometry shader makes the control points, the rest is as instanced.

use super::drawn::{Asked, Drawn};
use super::instanced::Instanced;
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::gpu::Features;
use crate::renderer::options::Error;
use crate::renderer::pipelines::{DrawPipelines, MadeFor, Recipe};
use crate::renderer::shader::{Cut, GeometryKey, PatchStages};

pub(super) struct TwoPass;

impl Path for TwoPass {
    fn features(&self) -> Features {
        Features { geometry: true, vertex_stores: true, ..Features::NONE }
    }

    fn has_attributes(&self, pipelines: &DrawPipelines, stages: PatchStages) -> bool {
        Instanced.has_attributes(pipelines, stages)
    }

    fn recipe(&self, stages: PatchStages, cut: Cut, key: GeometryKey, made_for: &MadeFor) -> Recipe {
        Instanced.recipe(stages, cut, key, made_for)
    }

    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        Instanced.drawn(asked)
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup) {
        // SAFETY: as the caller promises.
        unsafe { Instanced.cmd_draw(recorder, drawn, group) };
    }
}
