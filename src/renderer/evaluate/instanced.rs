//! Evaluation by the vertex shader: one uniform grid, instanced over the patches.

use super::drawn::{Asked, Drawn};
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::renderer::options::Error;
use crate::renderer::pipelines::{DrawPipelines, MadeFor, Recipe, RecipeStage, VertexInput};
use crate::renderer::shader::{Cut, GeometryKey, PatchStages, ShaderKey, Source, names};
use crate::table::Sharing;

pub(super) struct Instanced;

/// The vertex shader.
fn vertex(stages: PatchStages, made_for: &MadeFor) -> ShaderKey {
    stages.shader(Source::InstancedVert, made_for.capture.evaluated(made_for.texcoords))
}

impl Path for Instanced {
    /// Where they fit, unless the caller has a shader of its own for texels only.
    fn has_attributes(&self, pipelines: &DrawPipelines, stages: PatchStages) -> bool {
        let made_for = pipelines.made_for();
        let is_own = |attributes| pipelines.shaders.is_own(vertex(PatchStages { attributes, ..stages }, &made_for));
        stages.fit_attributes(made_for.properties) && (is_own(true) || !is_own(false))
    }

    fn recipe(&self, stages: PatchStages, cut: Cut, _key: GeometryKey, made_for: &MadeFor) -> Recipe {
        // Attributes go with what is an instance for Vulkan: a patch of an instance of the item.
        let stages = PatchStages { attributes: stages.attributes && !cut.has_instances(), ..stages };
        let constants = stages.specialization(cut, made_for.properties);
        Recipe {
            topology_is_dynamic: true,
            input: if stages.attributes { VertexInput::of_instances(stages) } else { VertexInput::default() },
            displaced: stages.sharing == Sharing::Displacement,
            ..Recipe::new(names::patches(stages, cut), vec![RecipeStage::new(vertex(stages, made_for), &constants)])
        }
    }

    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        asked.uniform_grid()
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup) {
        let Some(uniform_grid) = drawn.uniform_grid() else { return };
        let &DrawnGroup { number, stages, group, control_points, .. } = group;
        let (device, cmd) = (recorder.device, recorder.cmd);
        // SAFETY: as the caller promises.
        unsafe {
            if let Some(points) = control_points.filter(|_| stages.attributes && recorder.place.instances.is_none()) {
                let of_corner = u64::from(stages.patch_bytes()) / stages.kind.corners() as u64;
                let offset = of_corner * group.first_corner as u64;
                recorder.bound.uniform_grid.cmd_bind_vertices(device, cmd, points.raw(), offset);
            }
            uniform_grid.cmd_draw(recorder, number);
        }
    }
}
