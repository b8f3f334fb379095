//! Evaluation by the geometry shader: a point is a tile of a patch, which comes out as strips.

use super::drawn::{Asked, Drawn};
use super::path::Path;
use super::recorder::{DrawnGroup, Recorder};
use crate::gpu::Features;
use crate::renderer::options::Error;
use crate::renderer::pipelines::{MadeFor, Recipe, RecipeStage};
use crate::renderer::shader::{Cut, GeometryKey, PatchStages, ShaderKey, Source, names};
use crate::table::{Sharing, TILE_VERTICES, uniform_grid_tiles};
use ash::vk;

pub(super) struct Geometry;

impl Path for Geometry {
    fn features(&self) -> Features {
        Features { geometry: true, ..Features::NONE }
    }

    fn recipe(&self, stages: PatchStages, cut: Cut, _key: GeometryKey, made_for: &MadeFor) -> Recipe {
        let tile = RecipeStage::new(ShaderKey::of(Source::PatchNumberVert), &[]);
        let strips = stages.shader(Source::StripsGeom, made_for.capture.evaluated(made_for.texcoords));
        let strips = RecipeStage::new(strips, &stages.specialization(cut, made_for.properties));
        Recipe {
            topology: vk::PrimitiveTopology::POINT_LIST,
            displaced: stages.sharing == Sharing::Displacement,
            ..Recipe::new(names::patches(stages, cut), vec![tile, strips])
        }
    }

    fn drawn<'m>(&self, asked: &Asked<'m>) -> Result<Drawn<'m>, Error> {
        asked.tiles()
    }

    unsafe fn cmd_draw(&self, recorder: &mut Recorder, drawn: Drawn, group: &DrawnGroup) {
        let Drawn::Tiles { segments } = drawn else { return };
        let &DrawnGroup { stages, group, .. } = group;
        let (tiles, patches) = (uniform_grid_tiles(segments), group.patches.len() as u32);
        // No more than can be counted.
        let step = u32::MAX / tiles;
        for first in (0..patches).step_by(step as usize) {
            let first_corner = group.first_corner + first as usize * stages.kind.corners();
            recorder.constants.first_corner = first_corner as u32;
            recorder.constants.first_patch = group.patches.start as u32 + first;
            let count = step.min(patches - first) * tiles;
            // SAFETY: as the caller promises.
            unsafe { recorder.cmd_draw_batches(count, 1, TILE_VERTICES) };
        }
    }
}
