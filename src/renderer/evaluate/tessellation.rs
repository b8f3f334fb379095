//! Evaluation by the tessellation stages.

use super::drawn::{Asked, Drawn};
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::gpu::{DeviceProperties, Domain, Spacing, tessellated_vertices};
use crate::renderer::options::{Error, Factor};
use crate::renderer::pipelines::{MadeFor, Recipe, RecipeStage};
use crate::renderer::shader::{Capture, Cut, GeometryKey, PatchStages, ShaderKey, Source, names};
use crate::table::Sharing;
use ash::vk;

pub(super) struct Tessellation;

/// The most vertices that the tessellation stages make of a patch whose factors are at most `most`.
fn vertices_of_patch(device: &DeviceProperties, stages: PatchStages, most: f32) -> u32 {
    let domain = if stages.kind.is_triangular() { Domain::Triangles } else { Domain::Quads };
    tessellated_vertices(domain, stages.spacing, most, device.max_tessellation_level)
}

impl Path for Tessellation {
    fn key(&self, stages: PatchStages, cut: Cut, _factor: Factor) -> Option<GeometryKey> {
        Some(GeometryKey::Patches(stages, cut))
    }

    fn recipe(&self, stages: PatchStages, cut: Cut, _key: GeometryKey, made_for: &MadeFor) -> Recipe {
        let &MadeFor { properties, capture, texcoords } = made_for;
        // Control points are the same whatever patches share.
        let sharing = if capture == Capture::Points { Sharing::Positions } else { stages.sharing };
        let stages = PatchStages { sharing, ..stages };
        let constants = stages.specialization(cut, properties);
        // Control points are captured without what patches share.
        let sharing = if capture == Capture::Points { Sharing::Positions } else { stages.sharing };
        let shared = PatchStages { sharing, ..stages };
        let evaluation = shared.shader(Source::TessellationTese, capture.evaluated(texcoords));
        let spacing = if capture == Capture::Grid { Spacing::Equal } else { stages.spacing };
        let mut shaders = vec![
            RecipeStage::new(shared.vertex(), &constants),
            RecipeStage::new(shared.control(capture, texcoords), &constants),
            RecipeStage { spacing, ..RecipeStage::new(evaluation, &constants) },
        ];
        if capture == Capture::Triangles {
            shaders.push(RecipeStage::new(ShaderKey::of(Source::TrianglesGeom), &[]));
        }
        Recipe {
            input_points: stages.input_points(),
            displaced: stages.sharing == Sharing::Displacement,
            ..Recipe::new(names::patches(stages, cut), shaders)
        }
    }

    fn drawn<'m>(&self, _asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        Ok(Drawn::Patches)
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, _drawn: Drawn, group: &DrawnGroup) {
        let &DrawnGroup { stages, group, most, .. } = group;
        let vertices = vertices_of_patch(recorder.properties, stages, most);
        // SAFETY: as the caller promises.
        unsafe { recorder.cmd_draw_batches(group.patches.len() as u32, stages.input_points(), vertices) };
    }

    /// Of whole instances, and of the rest.
    fn command_bytes(&self) -> usize {
        2 * size_of::<vk::DrawIndirectCommand>()
    }

    fn patches_per_instance(&self, device: &DeviceProperties, stages: PatchStages, patches: u32, most: f32) -> u32 {
        let vertices = vertices_of_patch(device, stages, most);
        device.patch_batch.patches_per_instance(patches, stages.input_points(), vertices)
    }
}
