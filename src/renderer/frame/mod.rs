//! The renderer, and what it records in a frame.

#[cfg(doc)]
use crate::renderer::{Fragment, Style, check};
mod begun;
mod cull;
mod draw;
mod instances;
mod lists;
mod positions;
mod prepare;
mod replace;
mod resolved;
pub(crate) mod segments;
#[cfg(all(test, feature = "headless"))]
mod tests;
pub(crate) mod visible;

use crate::gpu::{Buffer, BufferDesc, DeviceContext, MemoryLocation};
use crate::mesh::ControlMesh;
use crate::renderer::evaluate::UniformGrid;
use crate::renderer::model::ModelPipelines;
use crate::renderer::model::{Displacements, Model, Used};
use crate::renderer::options::{
    Cull, DisplacementId, DisplacementMap, Error, Factor, MemoryUsage, ModelId, ModelOptions, Options, Target,
};
use crate::renderer::pipelines::{check_passes, check_properties};
use crate::renderer::shader::Capture;
use crate::table::ModelTables;
use crate::table::Notice;
use ash::vk;
use begun::Begun;
pub use begun::Frame;
use instances::FrameInstances;
use lists::{FrameLists, ListPipelines};
use rustc_hash::FxHashMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// How many renderers there were so far: each has a number of its own.
static RENDERERS: AtomicU64 = AtomicU64::new(0);

/// Items of a frame that there is room for from the start.
const FIRST_RECORDS: u32 = 64;

/// Something that must outlive the frames that may still use it.
struct Retired {
    /// The frames that may use it, by their indices; it goes when each has begun again.
    frames: Vec<bool>,
    _what: RetiredObject,
}

#[expect(dead_code, reason = "kept only to be dropped later")]
enum RetiredObject {
    Model(Box<Model>),
    Used(Vec<Used>),
    UniformGrid(Box<UniformGrid>),
    Lists(Box<FrameLists>),
}

/// Draws subdivision surfaces into the caller's command buffers.
///
/// It is `Send` and `Sync`, as [`Frame`] is; what records or sets something takes it mutably.
///
/// Dropping it destroys its Vulkan objects: the device must be done with every frame they were recorded in.
pub struct Renderer {
    context: Arc<DeviceContext>,
    options: Options,
    pipelines: ModelPipelines,
    list_pipelines: ListPipelines,
    displacements: Displacements,
    models: FxHashMap<ModelId, Model>,
    next_id: ModelId,
    retired: Vec<Retired>,
    views: Buffer,
    /// Of each frame.
    lists: Vec<FrameLists>,
    instances: Vec<FrameInstances>,
    begun: Begun,
    /// Views drawn in each frame since it began.
    views_drawn: Vec<u32>,
}

impl Renderer {
    /// A renderer for targets like `target`, but for styles with one of their own ([`Style::target`]).
    ///
    /// # Errors
    /// As [`check`], of what `context` was made with; [`Error::NoRenderPass`]; failed Vulkan calls.
    ///
    /// # Safety
    /// * The handles in `target` and `options` are of the context's device and live as long as the renderer, and the
    ///   caller's fragment shaders match the stage interface ([`Fragment`]) and the targets of their styles.
    /// * The SPIR-V in `options` is valid: of [`Options::shaders`] each has the interface of the shader it stands for. No more is
    ///   checked than that it is whole, of its stage, and that the sets that it reads are there.
    /// * The renderer is dropped only when the device is done with all command buffers recorded with it.
    pub unsafe fn new(context: &Arc<DeviceContext>, target: &Target, options: &Options) -> Result<Self, Error> {
        // SAFETY: as the caller promises.
        unsafe { Self::with_capture(context, target, options, Capture::Off) }
    }

    /// # Safety
    /// As [`Renderer::new`]; with capture, `options.set_layouts` starts with the layout of the capture buffer.
    pub(crate) unsafe fn with_capture(
        context: &Arc<DeviceContext>,
        target: &Target,
        options: &Options,
        capture: Capture,
    ) -> Result<Self, Error> {
        check_passes(target, options)?;
        let formats = |format| context.format_properties(format);
        check_properties(context.properties(), context.features(), &formats, target, options)?;
        let pipelines = ModelPipelines::new(context, target, options, capture)?;
        let list_pipelines = ListPipelines::new(context, pipelines.sets.shared(), options.pipeline_cache)?;
        let views = Buffer::new(
            context,
            &BufferDesc {
                name: "subdiv views",
                size: options.view_bytes(),
                usage: vk::BufferUsageFlags::UNIFORM_BUFFER | vk::BufferUsageFlags::STORAGE_BUFFER,
                location: MemoryLocation::Upload,
            },
        )?;
        let lists = |_| FrameLists::new(context, &pipelines.sets, &views, 0, FIRST_RECORDS);
        let lists = (0..options.frames_in_flight).map(lists).collect::<Result<_, _>>()?;
        let renderer = RENDERERS.fetch_add(1, Ordering::Relaxed);
        Ok(Self {
            context: context.clone(),
            options: options.clone(),
            pipelines,
            list_pipelines,
            displacements: Displacements::new(context)?,
            models: FxHashMap::default(),
            next_id: ModelId { renderer, number: 0 },
            retired: Vec::new(),
            views,
            lists,
            instances: (0..options.frames_in_flight).map(|_| FrameInstances::default()).collect(),
            begun: Begun::new(renderer, options.frames_in_flight),
            views_drawn: vec![0; options.frames_in_flight as usize],
        })
    }

    /// Adds a model: builds its tables, uploads them with the next [`Renderer::cmd_prepare`], and makes the pipelines
    /// that it is the first to need.
    ///
    /// # Errors
    /// Meshes that cannot be addressed when refined, tables larger than a shader of the device can see, failed Vulkan
    /// calls. The renderer is as it was before.
    pub fn add_model(&mut self, mesh: &ControlMesh, options: &ModelOptions) -> Result<ModelId, Error> {
        let tables = ModelTables::new(mesh, options)?;
        self.add_tables(tables, &mesh.positions_f32(), options)
    }

    /// As [`Renderer::add_model`], with tables that were built elsewhere, such as on another thread, with the same
    /// options. Scheme, fallback, construction and refinement are those of the tables.
    ///
    /// # Errors
    /// As [`Renderer::add_model`]; [`Error::PositionCount`]; [`Error::OtherTables`], [`Error::OtherOption`].
    pub fn add_tables(
        &mut self,
        tables: ModelTables,
        positions: &[[f32; 3]],
        options: &ModelOptions,
    ) -> Result<ModelId, Error> {
        self.add_drawn(tables, positions, options, (Factor::Uniform(1.0), Cull::NONE))
    }

    /// As [`Renderer::add_tables`], with the pipelines of one kind of draw.
    pub(crate) fn add_drawn(
        &mut self,
        tables: ModelTables,
        positions: &[[f32; 3]],
        options: &ModelOptions,
        (factor, cull): (Factor, Cull),
    ) -> Result<ModelId, Error> {
        let id = self.next_id;
        let options = ModelOptions { construction: tables.options().construction, ..options.clone() };
        let map = self.displacements.get(options.displacement)?;
        let model = self.new_model(id, tables, positions, &options, map)?;
        self.next_id.number += 1;
        self.models.insert(id, model);
        let made = self.make_pipelines(id, factor, cull);
        made.inspect_err(|_| drop(self.models.remove(&id)))?;
        Ok(id)
    }

    /// Makes a displacement map known, for [`ModelOptions::displacement`].
    ///
    /// # Safety
    /// The view and the sampler are of the context's device and live as long as the renderer, or until
    /// [`Options::frames_in_flight`] frames began after [`Renderer::remove_displacement`]. Whenever a model that uses the map is drawn, the image is in its layout and
    /// visible to the vertex, tessellation, geometry and fragment stages, as far as [`ModelOptions::evaluation`] has them.
    pub unsafe fn add_displacement(&mut self, map: DisplacementMap) -> DisplacementId {
        self.displacements.add(map)
    }

    /// Forgets a displacement map, which no model uses any more. When [`Options::frames_in_flight`] frames have begun since, the image
    /// and the sampler are yours to destroy.
    ///
    /// # Errors
    /// [`Error::NoSuchDisplacement`]; [`Error::DisplacementInUse`] if there is still a model with it.
    pub fn remove_displacement(&mut self, id: DisplacementId) -> Result<(), Error> {
        let uses = |(&number, model): (&ModelId, &Model)| (model.options.displacement == Some(id)).then_some(number);
        match self.models.iter().filter_map(uses).min() {
            Some(model) => Err(Error::DisplacementInUse { id, model }),
            None => self.displacements.remove(id),
        }
    }

    /// Removes a model. Its memory is freed when [`Options::frames_in_flight`] frames have begun since.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`].
    pub fn remove_model(&mut self, id: ModelId) -> Result<(), Error> {
        let model = self.models.remove(&id).ok_or(Error::NoSuchModel { id })?;
        self.retire(None, RetiredObject::Model(Box::new(model)));
        Ok(())
    }

    /// Keeps what may still be used: in this frame, or in any.
    fn retire(&mut self, frame: Option<u32>, what: RetiredObject) {
        let frames = (0..self.options.frames_in_flight).map(|each| frame.is_none_or(|frame| frame == each));
        self.retired.push(Retired { frames: frames.collect(), _what: what });
    }

    /// Makes room in a frame for lists of `bytes` bytes and the records of `items` items.
    fn make_room(&mut self, frame: u32, bytes: u64, items: usize) -> Result<(), Error> {
        let (lists, items) = (&self.lists[frame as usize], items as u64);
        if lists.has_room(bytes) && lists.records.has_room(items) {
            return Ok(());
        }
        let (bytes, records) = lists.grown(bytes, items)?;
        let larger = FrameLists::new(&self.context, &self.pipelines.sets, &self.views, bytes, records)?;
        let before = std::mem::replace(&mut self.lists[frame as usize], larger);
        // What was found and drawn in this frame so far is in there.
        self.retire(Some(frame), RetiredObject::Lists(Box::new(before)));
        Ok(())
    }

    /// The tables of a model.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`].
    pub fn tables(&self, id: ModelId) -> Result<&ModelTables, Error> {
        Ok(&self.model(id)?.tables)
    }

    /// What a user will want to know about how a model is drawn, such as that it was refined.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`].
    pub fn notices(&self, id: ModelId) -> Result<&[Notice], Error> {
        Ok(self.model(id)?.tables.notices())
    }

    /// Sets the tessellation factors of a model's edges, for [`Factor::Edges`], from the next [`Renderer::cmd_prepare`] of
    /// `frame` on until others are set. In the order of [`ModelTables::edges`].
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::OldFrame`], [`Error::NoEdgeFactors`], [`Error::EdgeFactorCount`],
    /// [`Error::BadEdgeFactor`]; failed Vulkan calls.
    pub fn set_edge_factors(&mut self, id: ModelId, frame: Frame, factors: &[f32]) -> Result<(), Error> {
        self.check_frame(frame)?;
        self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?.set_edge_factors(frame.index(), factors)
    }

    /// The layout that the caller's own descriptor sets are bound with.
    pub fn pipeline_layout(&self) -> vk::PipelineLayout {
        self.pipelines.draws.layout.raw()
    }

    /// Bytes of all models together.
    pub fn memory_usage(&self) -> MemoryUsage {
        let lists = self.lists.iter().map(FrameLists::bytes).sum();
        let records: u64 = self.lists.iter().map(|lists| lists.records.bytes()).sum();
        let instances: u64 = self.instances.iter().map(FrameInstances::bytes).sum();
        let mut usage = MemoryUsage { views: self.views.size() + records + instances, lists, ..MemoryUsage::default() };
        self.models.values().for_each(|model| model.add_memory(&mut usage));
        let uniform_grids = self.models.values().filter_map(|model| model.uniform_grid.as_ref());
        let indices: FxHashMap<_, _> =
            uniform_grids.map(|uniform_grid| (Arc::as_ptr(&uniform_grid.indices), &uniform_grid.indices)).collect();
        indices.values().for_each(|indices| indices.add_memory(&mut usage));
        usage
    }

    fn model(&self, id: ModelId) -> Result<&Model, Error> {
        self.models.get(&id).ok_or(Error::NoSuchModel { id })
    }
}

// Renderers and frames go from thread to thread.
const _: () = {
    const fn goes_between_threads<T: Send + Sync>() {}
    goes_between_threads::<Renderer>();
    goes_between_threads::<Frame>();
};

impl std::fmt::Debug for Renderer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Renderer")
            .field("context", &self.context)
            .field("models", &self.models.len())
            .finish_non_exhaustive()
    }
}
