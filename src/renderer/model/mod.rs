//! A model on the GPU.

mod bindings;
mod displacements;
mod drawn;
mod edge_factors;
mod gather;
mod pipelines;
mod positions;
mod sent;
mod streamed;
mod tables;

pub(crate) use displacements::Displacements;
pub(crate) use gather::{GatherPipeline, Given};
use pipelines::MadeCut;
pub(crate) use pipelines::ModelPipelines;
pub(crate) use sent::{Sent, Used};

use crate::gpu::{Buffer, DeviceContext, DeviceProperties, GpuError};
use crate::renderer::evaluate::{UniformGrid, UniformGridPipelines, check_evaluation, path};
use crate::renderer::options::{DisplacementMap, Error, Factor, Geometry, MemoryUsage, ModelId, ModelOptions, Options};
use crate::renderer::shader::{PatchStages, VECTOR_TEXEL};
use crate::table::PatchGroup;
use crate::table::{Construction, Evaluation, ModelTables, Sharing, TEXEL_BYTES};
use ash::vk;
use bindings::{ModelBuffers, ModelSet};
use edge_factors::EdgeFactors;
use positions::Positions;
use std::sync::Arc;
use tables::Tables;

pub(crate) struct Model {
    pub id: ModelId,
    pub options: ModelOptions,
    pub tables: ModelTables,
    /// How each group of patches is drawn, in the order of the plan.
    pub stages: Vec<PatchStages>,
    /// Pipelines of the draws that there were: a few.
    pub made: Vec<MadeCut>,
    pub set: ModelSet,
    table_buffer: Tables,
    positions: Positions,
    /// If edges are to have their own.
    edge_factors: Option<EdgeFactors>,
    /// What the cached construction keeps of corners, and of rings.
    pub control_points: Option<Buffer>,
    frames: Option<Buffer>,
    /// What is drawn instead of patches, once it is known how finely.
    pub uniform_grid: Option<UniformGrid>,
    /// Whether control points are out of date.
    stale_points: bool,
    /// Whether the vertices of adaptive subdivision are.
    stale_refinement: bool,
    /// Whether vertices that compute evaluates are.
    stale_vertices: bool,
    /// Edges, then faces of the control mesh, if a style draws them.
    pub control: Option<ControlIndices>,
    /// What was not copied to the device yet.
    uploads: Vec<(Buffer, vk::Buffer)>,
    pub(crate) map: DisplacementMap,
    pub prepared: bool,
}

pub(crate) struct ControlIndices {
    pub buffer: Buffer,
    pub edges: u32,
    pub faces: u32,
}

impl ControlIndices {
    /// Room for the indices of the control mesh, and the staging buffer with them.
    fn new(context: &Arc<DeviceContext>, name: &str, tables: &ModelTables) -> Result<(Self, Buffer), GpuError> {
        let indices = [&tables.control_edges[..], &tables.control_faces[..]].concat();
        let bytes = 4 * indices.len() as u64;
        let mut staged = Buffer::upload(context, &format!("{name}: control mesh to copy"), bytes)?;
        staged.write(0, &indices)?;
        let usage = vk::BufferUsageFlags::INDEX_BUFFER;
        let buffer = Buffer::device_local(context, &format!("{name}: control mesh"), bytes, usage)?;
        let [edges, faces] = [&tables.control_edges, &tables.control_faces].map(|indices| indices.len() as u32);
        Ok((Self { buffer, edges, faces }, staged))
    }
}

/// Checks that shaders can see a buffer whole: as a storage buffer, and as a texel buffer where the device reads those.
fn check_size(id: ModelId, properties: &DeviceProperties, table: &'static str, bytes: u64) -> Result<(), Error> {
    let texels = properties.max_texel_buffer_elements * VECTOR_TEXEL.1;
    let max = properties.max_storage_buffer_range.min(if properties.reads_texels { texels } else { u64::MAX });
    if bytes > max { Err(Error::TableTooLarge { id, table, bytes, max }) } else { Ok(()) }
}

/// Room for the tables of a model, and the staging buffer with them. Where texture coordinates are needed, they are zero for a mesh
/// without.
fn table_buffer(
    context: &Arc<DeviceContext>,
    (id, name): (ModelId, &str),
    tables: &ModelTables,
    texcoords: bool,
) -> Result<(Tables, Buffer), Error> {
    let zeros;
    let needed = texcoords || tables.sharing() == Sharing::Displacement;
    let texcoords: &[[f32; 2]] = match (&tables.texcoords, needed) {
        (_, false) => &[],
        (Some(texcoords), true) => texcoords,
        (None, true) => {
            zeros = vec![[0.0; 2]; tables.plan.corner_count()];
            &zeros
        }
    };
    let arrays = tables.bindings().map(|(name, array)| match name {
        "texcoords" => (name, bytemuck::cast_slice(texcoords)),
        _ => (name, array),
    });
    let first_refined = tables.leaves().map_or(0, |leaves| leaves.first_patch);
    Tables::new(context, (id, name), tables.options().evaluation, &arrays, first_refined)
}

/// Stages of each group of patches, in the order of the plan.
fn stages(tables: &ModelTables, options: &ModelOptions, pipelines: &ModelPipelines) -> Vec<PatchStages> {
    let &ModelOptions { construction, evaluation, spacing, .. } = options;
    // Leaves are in tables, as stencils are, whatever makes other patches.
    let construction = if tables.options().is_by_leaves() { Construction::Stencil } else { construction };
    let of_group = |group: &PatchGroup| {
        let stages = PatchStages {
            scheme: group.scheme,
            kind: group.kind,
            construction,
            evaluation,
            spacing,
            sharing: tables.sharing(),
            has_foreign_owners: tables.has_foreign_owners(),
            // The control shader knows by its flags.
            edge_factors: tables.edges().is_some() && evaluation != Evaluation::Tessellation,
            stride: tables.kept_texels(),
            attributes: false,
            adaptive: group.refined.then(|| tables.options().adaptive.unwrap_or_default().drawn_by),
        };
        PatchStages { attributes: path(evaluation).has_attributes(&pipelines.draws, stages), ..stages }
    };
    tables.plan.groups().iter().map(of_group).collect()
}

fn name(options: &ModelOptions) -> &str {
    if options.name.is_empty() { "model" } else { &options.name }
}

/// What a model needs of its renderer.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'r> {
    pub context: &'r Arc<DeviceContext>,
    pub pipelines: &'r ModelPipelines,
    pub options: &'r Options,
}

impl Model {
    // Longer than a screen: one buffer or set after another, each once.
    pub(crate) fn new(
        Surroundings { context, pipelines, options }: Surroundings,
        id: ModelId,
        model_options: &ModelOptions,
        tables: ModelTables,
        control: &[[f32; 3]],
        map: DisplacementMap,
    ) -> Result<Self, Error> {
        check_evaluation(id, model_options, &tables, context.features())?;
        let name = name(model_options);
        let (table_buffer, staged_tables) = table_buffer(context, (id, name), &tables, options.texcoords)?;
        let mut uploads = vec![(staged_tables, table_buffer.buffer.raw())];

        let properties = context.properties();
        check_size(id, properties, "positions", TEXEL_BYTES * tables.stored_vertices() as u64)?;
        let kept = |what: &'static str, bytes: u64| -> Result<_, Error> {
            check_size(id, properties, what, bytes)?;
            use vk::BufferUsageFlags as Usage;
            let usage = Usage::STORAGE_BUFFER | Usage::UNIFORM_TEXEL_BUFFER | Usage::VERTEX_BUFFER;
            let make = || Buffer::device_local(context, &format!("{name}: {what}"), bytes, usage);
            Ok((bytes > 0).then(make).transpose()?)
        };
        let [point_bytes, frame_bytes] = tables.kept_bytes();
        let (control_points, frames) = (kept("control points", point_bytes)?, kept("frames", frame_bytes)?);
        let in_flight = options.frames_in_flight;
        let positions = Positions::new(context, name, &tables, control, in_flight)?;
        let edge_factors = tables.edges().map(|edges| EdgeFactors::new(context, name, edges, in_flight)).transpose()?;
        let control = if options.styles.iter().any(|style| style.geometry != Geometry::Surface) {
            let (indices, staged) = ControlIndices::new(context, name, &tables)?;
            uploads.push((staged, indices.buffer.raw()));
            Some(indices)
        } else {
            None
        };

        let buffers = ModelBuffers {
            positions: positions.buffer(),
            tables: &table_buffer,
            frames: frames.as_ref(),
            edge_factors: edge_factors.as_ref().map(EdgeFactors::buffer),
            control_points: control_points.as_ref(),
            map,
        };
        // SAFETY: the buffers live as long as the model, and the map longer.
        let set = unsafe { ModelSet::new(context, &pipelines.sets, name, &buffers)? };
        Ok(Self {
            id,
            options: model_options.clone(),
            stages: stages(&tables, model_options, pipelines),
            made: Vec::new(),
            tables,
            set,
            table_buffer,
            positions,
            edge_factors,
            control_points,
            frames,
            uniform_grid: None,
            stale_points: false,
            stale_refinement: false,
            stale_vertices: false,
            control,
            uploads,
            map,
            prepared: false,
        })
    }

    pub(crate) fn set_edge_factors(&mut self, frame: u32, factors: &[f32]) -> Result<(), Error> {
        match (self.tables.edges(), &mut self.edge_factors) {
            (Some(edges), Some(own)) => own.write(self.id, frame, edges, factors),
            _ => Err(Error::NoEdgeFactors { id: self.id }),
        }
    }

    /// The factors of the edges, where other tables have the same.
    pub(crate) fn edge_factors_for(&self, tables: &ModelTables) -> Option<Vec<f32>> {
        let (own, other) = (self.tables.edges()?, tables.edges()?);
        let factors = self.edge_factors.as_ref().filter(|_| own.vertices == other.vertices)?;
        let mut of_edges = vec![1.0; own.vertices.len()];
        own.of_corners.iter().zip(factors.written()).for_each(|(&edge, &factor)| of_edges[edge as usize] = factor);
        Some(of_edges)
    }

    /// The largest factor of an edge, if they have any: of the frame that was last prepared.
    pub(crate) fn largest_edge_factor(&self) -> Option<f32> {
        self.edge_factors.as_ref().map(EdgeFactors::largest)
    }

    /// Factor that stands for [`Factor::Segments`]: of segments that are not set, 1.
    pub(crate) fn own_factor(&self) -> Factor {
        let segments = self.uniform_grid.as_ref().map_or(1, |uniform_grid| uniform_grid.segments);
        if self.options.edge_factors { Factor::Edges(1.0) } else { Factor::Uniform(segments as f32) }
    }

    pub(crate) fn needs_copies(&self) -> bool {
        let indices = self.uniform_grid.as_ref().is_some_and(|uniform_grid| !uniform_grid.prepared);
        let factors = self.edge_factors.as_ref().is_some_and(|factors| factors.is_due());
        !self.prepared || indices || factors || self.positions.is_due()
    }

    /// Whether nothing has to be copied or computed in this frame.
    pub(crate) fn is_at_rest(&self) -> bool {
        !self.needs_copies() && !self.stale_points && !self.stale_refinement
    }

    /// Whether compute shaders make something of it.
    pub(crate) fn computes(&self) -> bool {
        self.tables.refinement().is_some()
            || self.control_points.is_some() && self.options.evaluation != Evaluation::GeometryTwoPass
    }

    /// Has control points and refined vertices computed anew in the next frame, even though nothing moved.
    #[cfg(all(feature = "measure", feature = "headless"))]
    pub(crate) fn forget_points(&mut self) {
        self.stale_points = self.control_points.is_some();
        self.stale_refinement = self.tables.refinement().is_some();
    }

    /// Takes a uniform grid in place of another, to be evaluated in the next frame.
    pub(crate) fn set_uniform_grid(&mut self, uniform_grid: UniformGrid) -> Option<UniformGrid> {
        self.uniform_grid.replace(uniform_grid)
    }

    /// Has what follows from the copies of this frame, or from positions that the device gives, computed after them; before they are
    /// recorded.
    pub(crate) fn mark_stale(&mut self, are_given: bool) {
        let moved = are_given || !self.prepared || self.positions.is_due();
        self.stale_refinement |= moved && self.tables.refinement().is_some();
        if self.control_points.is_some() {
            self.stale_points |= moved;
            // They depend on the uniform grid and on the factors of edges, too.
            self.stale_vertices = self.stale_points || self.needs_copies();
        }
    }

    /// Whether control points are to be computed now.
    pub(crate) fn has_stale_points(&self) -> bool {
        self.stale_points
    }

    /// Whether anything is.
    pub(crate) fn is_stale(&self) -> bool {
        self.stale_points || self.stale_vertices || self.stale_refinement
    }

    /// Records the evaluation of the uniform grid, if there is one, which is the last of what was out of date.
    ///
    /// # Safety
    /// As [`UniformGrid::cmd_evaluate`].
    pub(crate) unsafe fn cmd_evaluate(&mut self, pipelines: &UniformGridPipelines, cmd: vk::CommandBuffer) {
        (self.stale_points, self.stale_vertices, self.stale_refinement) = (false, false, false);
        if let Some(uniform_grid) = &self.uniform_grid {
            // SAFETY: as the caller promises.
            unsafe { uniform_grid.cmd_evaluate(pipelines, cmd, self.set.raw, &self.stages, &self.tables.plan) };
        }
    }

    /// Records what makes the vertices of adaptive subdivision, if they are out of date.
    ///
    /// # Safety
    /// As [`Model::cmd_frames`].
    pub(crate) unsafe fn cmd_refine(&self, pipelines: &ModelPipelines, cmd: vk::CommandBuffer) {
        if let Some(refinement) = self.tables.refinement().filter(|_| self.stale_refinement) {
            // SAFETY: as the caller promises.
            unsafe { pipelines.cached.cmd_refine(cmd, self.set.raw, refinement) };
        }
    }

    /// Records what makes the frames of the rings, if they are kept.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering, after the copies; `pipelines` have those of the model's kinds.
    pub(crate) unsafe fn cmd_frames(&self, pipelines: &ModelPipelines, cmd: vk::CommandBuffer) {
        // SAFETY: as the caller promises.
        unsafe { pipelines.cached.cmd_frames(cmd, self.set.raw, &self.stages, self.tables.kept_frames()) };
    }

    /// Records what makes the control points.
    ///
    /// # Safety
    /// As [`Model::cmd_frames`], after these.
    pub(crate) unsafe fn cmd_points(&self, pipelines: &ModelPipelines, cmd: vk::CommandBuffer) {
        let (set, stages, plan) = (self.set.raw, &self.stages, &self.tables.plan);
        // SAFETY: as the caller promises.
        unsafe {
            match &pipelines.conversion {
                Some(conversion) if self.options.evaluation == Evaluation::GeometryTwoPass => {
                    conversion.cmd_convert(cmd, set, stages, plan);
                }
                _ => pipelines.cached.cmd_points(cmd, set, stages, plan),
            }
        }
    }

    /// Records the copies that are due, and the dispatch for positions that the device gives, and gives the staging buffers to `sent`, to be kept until the frame is done.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering.
    pub(crate) unsafe fn cmd_copy(
        &mut self,
        device: &ash::Device,
        cmd: vk::CommandBuffer,
        frame: u32,
        given: Option<(&GatherPipeline, Given)>,
        sent: &mut Sent,
    ) -> Result<(), Error> {
        let copy = |staged: &Buffer, target: vk::Buffer| {
            let region = vk::BufferCopy { size: staged.size(), ..vk::BufferCopy::default() };
            // SAFETY: as the caller promises; both buffers hold the whole range.
            unsafe { device.cmd_copy_buffer(cmd, staged.raw(), target, &[region]) };
        };
        sent.uploads = std::mem::take(&mut self.uploads);
        sent.uploads.iter().for_each(|(staged, target)| copy(staged, *target));
        sent.indices = self.uniform_grid.as_mut().and_then(UniformGrid::take_upload);
        sent.indices.iter().for_each(|(staged, indices)| copy(staged, indices.buffer.raw()));
        // SAFETY: as the caller promises; both buffers hold the whole range.
        unsafe {
            if let Some((pipeline, given)) = given {
                sent.given = Some(pipeline.cmd_gather(cmd, self.set.raw, given));
                self.positions.supersede();
            }
            self.positions.cmd_send(device, cmd, frame)?;
            if let Some(factors) = &mut self.edge_factors {
                factors.cmd_send(device, cmd, frame)?;
            }
        }
        self.prepared = true;
        Ok(())
    }

    pub(crate) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.tables += self.table_buffer.buffer.size();
        let [positions, staged_positions] = self.positions.bytes();
        let [factors, staged_factors] = self.edge_factors.as_ref().map_or([0; 2], EdgeFactors::bytes);
        usage.positions += positions + factors;
        usage.control_points += self.control_points.iter().chain(&self.frames).map(Buffer::size).sum::<u64>();
        usage.control_meshes += self.control.as_ref().map_or(0, |c| c.buffer.size());
        let uploads: u64 = self.uploads.iter().map(|(buffer, _)| buffer.size()).sum();
        usage.staging += staged_positions + staged_factors + uploads;
        if let Some(uniform_grid) = &self.uniform_grid {
            uniform_grid.add_memory(usage);
        }
    }
}
