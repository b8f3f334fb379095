//! No patches: a geometry shader subdivides each face, straight from the control vertices.

use super::drawn::{Asked, Drawn};
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::gpu::Features;
use crate::renderer::options::{Error, Factor, ModelId};
use crate::renderer::pipelines::{MadeFor, Recipe, RecipeStage};
use crate::renderer::shader::{Cut, GeometryKey, PatchStages, ShaderKey, Source, reads_texels};
use ash::vk;

pub(super) struct Subdivision;

/// The most levels: every device with geometry shaders has room for their strips (`glsl/subdivide/faces.geom`).
const MAX_LEVEL: u32 = 3;

/// Levels of subdivision in a draw with a factor, if it is one of a level.
fn level_of(factor: Factor) -> Option<u32> {
    (0..=MAX_LEVEL).find(|level| factor == Factor::Uniform((1 << level) as f32))
}

/// Levels of subdivision in a draw with a factor.
pub(crate) fn level(id: ModelId, factor: Factor) -> Result<u32, Error> {
    level_of(factor).ok_or(Error::NoSuchLevel { id, factor })
}

/// Vertices of a face in strips, which are no longer than four segments.
pub(crate) fn vertices(level: u32) -> u32 {
    let (side, drawn) = (1 << level, 1 << level.min(2));
    side / drawn * side * 2 * (drawn + 1)
}

impl Path for Subdivision {
    fn features(&self) -> Features {
        Features { geometry: true, ..Features::NONE }
    }

    fn level(&self, factor: Factor) -> Option<u32> {
        level_of(factor)
    }

    fn key(&self, _stages: PatchStages, _cut: Cut, factor: Factor) -> Option<GeometryKey> {
        level_of(factor).map(GeometryKey::Subdivision)
    }

    fn recipe(&self, _stages: PatchStages, _cut: Cut, key: GeometryKey, made_for: &MadeFor) -> Recipe {
        let level = if let GeometryKey::Subdivision(level) = key { level } else { 0 };
        let output = made_for.capture.evaluated(made_for.texcoords);
        let faces = ShaderKey { level: level as u8, output, ..ShaderKey::of(Source::FacesGeom) }.canonical();
        let stages = vec![
            RecipeStage::new(ShaderKey::of(Source::PatchNumberVert), &[]),
            RecipeStage::new(faces, &[reads_texels(made_for.properties)]),
        ];
        Recipe {
            topology: vk::PrimitiveTopology::POINT_LIST,
            ..Recipe::new(format!("faces subdivided {level} times"), stages)
        }
    }

    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        Ok(Drawn::Subdivided { level: level(asked.id, asked.factor)? })
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup) {
        let Drawn::Subdivided { level } = drawn else { return };
        // SAFETY: as the caller promises.
        unsafe { recorder.cmd_draw_batches(group.group.patches.len() as u32, 1, vertices(level)) };
    }
}
