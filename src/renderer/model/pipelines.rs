//! Every pipeline that the models of a renderer need.

use crate::gpu::{DeviceContext, GpuError};
use crate::renderer::construct::{CachedPipelines, Conversion};
use crate::renderer::evaluate::{LatticePipelines, path};
use crate::renderer::options::{Factor, Options, Target};
use crate::renderer::pipelines::DrawPipelines;
use crate::renderer::shader::{Capture, Cut, PatchStages, SetLayouts};
use crate::table::{Construction, Evaluation};
use ash::vk;
use std::sync::Arc;

/// Pipelines of draws, and of what comes before them.
pub(crate) struct ModelPipelines {
    context: Arc<DeviceContext>,
    cache: vk::PipelineCache,
    pub sets: Arc<SetLayouts>,
    pub draws: DrawPipelines,
    /// For what the cached construction computes.
    pub cached: CachedPipelines,
    /// For the first of two passes, once a model wants it.
    pub conversion: Option<Conversion>,
    /// For evaluation by compute.
    pub lattice: LatticePipelines,
}

impl ModelPipelines {
    pub(crate) fn new(
        context: &Arc<DeviceContext>,
        target: &Target,
        options: &Options,
        capture: Capture,
    ) -> Result<Self, GpuError> {
        let (sets, cache) = (SetLayouts::new(context)?, options.pipeline_cache);
        let draws = DrawPipelines::new(context, target, options, capture, &sets)?;
        let cached = CachedPipelines::new(context, sets.shared(), cache)?;
        let wireframe = options.styles.iter().any(|style| style.wireframe);
        let lattice = LatticePipelines::new(context, &sets, cache, options.texcoords, wireframe)?;
        Ok(Self { context: context.clone(), cache, sets, draws, cached, conversion: None, lattice })
    }

    /// Makes what draws of these patches need in every style, and what comes before.
    pub(crate) fn make(&mut self, patches: &[PatchStages], cut: Cut, factor: Factor) -> Result<(), GpuError> {
        self.draws.make_control()?;
        for &stages in patches {
            // A factor that the evaluation does not have is reported by the draw.
            let path = path(stages.evaluation);
            let Some(key) = path.key(stages, cut, factor) else { continue };
            self.draws.make(key, |key, made_for| path.recipe(stages, cut, key, made_for))?;
            match (stages.construction, stages.evaluation) {
                (_, Evaluation::Subdivision) => {}
                (Construction::Cached, Evaluation::GeometryTwoPass) => self.convert(stages)?,
                (Construction::Cached, _) => self.cached.make(stages, &self.draws.shaders)?,
                _ => {}
            }
            if stages.evaluation == Evaluation::Compute {
                self.lattice.make(stages, &self.draws.shaders)?;
            }
        }
        Ok(())
    }

    /// Makes what the first of two passes needs.
    fn convert(&mut self, stages: PatchStages) -> Result<(), GpuError> {
        let made = match self.conversion.take() {
            Some(made) => made,
            None => Conversion::new(&self.context, self.sets.shared(), self.cache)?,
        };
        self.conversion.insert(made).make(stages, &self.draws.shaders)
    }
}
