//! Evaluation by compute, before the draws: these are of indexed vertices.

use super::drawn::{Asked, Drawn};
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::renderer::options::{Error, Factor};
use crate::renderer::pipelines::{MadeFor, Recipe, RecipeStage, VertexInput};
use crate::renderer::shader::{Cut, GeometryKey, Output, PatchStages, ShaderKey, Source};
use crate::table::Sharing;

pub(super) struct Compute;

impl Path for Compute {
    fn key(&self, stages: PatchStages, _cut: Cut, _factor: Factor) -> Option<GeometryKey> {
        Some(GeometryKey::Evaluated { displaced: stages.sharing == Sharing::Displacement })
    }

    fn recipe(&self, stages: PatchStages, _cut: Cut, _key: GeometryKey, made_for: &MadeFor) -> Recipe {
        let displaced = stages.sharing == Sharing::Displacement;
        let sharing = if displaced { Sharing::Displacement } else { Sharing::Positions };
        let output = if made_for.texcoords { Output::Texcoords } else { Output::Surface };
        let vertex = ShaderKey { sharing, output, ..ShaderKey::of(Source::UniformGridVert) };
        Recipe {
            topology_is_dynamic: true,
            input: VertexInput::of_vertices(made_for.texcoords, sharing),
            displaced,
            ..Recipe::new("evaluated vertices", vec![RecipeStage::new(vertex.canonical(), &[])])
        }
    }

    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        asked.uniform_grid()
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup) {
        let Some(uniform_grid) = drawn.uniform_grid() else { return };
        // SAFETY: as the caller promises.
        unsafe {
            uniform_grid.cmd_draw(recorder, group.number);
        }
    }
}
