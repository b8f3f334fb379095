//! Every pipeline that the models of a renderer need.

use super::gather::GatherPipeline;
use crate::gpu::{DeviceContext, GpuError};
use crate::renderer::construct::{CachedPipelines, Conversion};
use crate::renderer::evaluate::{UniformGridPipelines, path};
use crate::renderer::options::{Factor, Options, Target};
use crate::renderer::pipelines::DrawPipelines;
use crate::renderer::shader::{Capture, Cut, PatchStages, PipelineKey, SetLayouts};
use crate::table::{Construction, Evaluation};
use ash::vk;
use std::sync::Arc;

/// The pipelines of a model's draws that are cut in one way. The renderer owns them.
pub(crate) struct MadeCut {
    cut: Cut,
    /// [`Path::level`](crate::renderer::evaluate::Path::level).
    level: Option<u32>,
    styles: usize,
    /// By group of patches, then by style; null in styles of the control mesh.
    pipelines: Vec<vk::Pipeline>,
}

impl MadeCut {
    /// Whether they are of this cut and level.
    pub(crate) fn is_of(&self, cut: Cut, level: Option<u32>) -> bool {
        self.cut == cut && self.level == level
    }

    /// The pipeline of a group of patches in a style.
    pub(crate) fn of(&self, group: usize, style: usize) -> vk::Pipeline {
        self.pipelines[group * self.styles + style]
    }
}

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
    pub uniform_grid: UniformGridPipelines,
    /// For positions that the device wrote.
    pub gather: GatherPipeline,
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
        let uniform_grid = UniformGridPipelines::new(context, &sets, cache, options.texcoords, wireframe)?;
        let gather = GatherPipeline::new(context, &sets, cache)?;
        Ok(Self { context: context.clone(), cache, sets, draws, cached, conversion: None, uniform_grid, gather })
    }

    /// Makes what draws of these groups of patches need in every style, and what comes before.
    pub(crate) fn make(&mut self, groups: &[PatchStages], cut: Cut, factor: Factor) -> Result<MadeCut, GpuError> {
        let instances = cut.has_instances();
        self.draws.make_control(instances)?;
        let (styles, level) =
            (self.draws.styles().len(), groups.first().and_then(|stages| path(stages.evaluation).level(factor)));
        let mut pipelines = Vec::with_capacity(styles * groups.len());
        for &stages in groups {
            // A factor that the evaluation does not have is reported by the draw.
            let path = path(stages.evaluation);
            let Some(key) = path.key(stages, cut, factor) else {
                pipelines.resize(pipelines.len() + styles, vk::Pipeline::null());
                continue;
            };
            self.draws.make((key, instances), |key, made_for| path.recipe(stages, cut, key, made_for))?;
            let of_style = |style| self.draws.get(PipelineKey { style, geometry: key, instances }).unwrap_or_default();
            pipelines.extend((0..styles).map(of_style));
            match (stages.construction, stages.evaluation) {
                (_, Evaluation::Subdivision) => {}
                (Construction::Cached, Evaluation::GeometryTwoPass) => self.convert(stages)?,
                (Construction::Cached, _) => self.cached.make(stages, &self.draws.shaders)?,
                _ => {}
            }
            if stages.evaluation == Evaluation::Compute {
                self.uniform_grid.make(stages, &self.draws.shaders)?;
            }
        }
        Ok(MadeCut { cut, level, styles, pipelines })
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
