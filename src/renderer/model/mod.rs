//! A model on the GPU.

mod bindings;
mod displacements;
mod drawn;
mod edge_factors;
mod pipelines;
mod streamed;

pub(crate) use displacements::Displacements;
pub(crate) use pipelines::ModelPipelines;

use crate::gpu::{Buffer, DeviceContext, MAX_OFFSET_ALIGNMENT};
use crate::renderer::evaluate::{Lattice, LatticePipelines, check_evaluation, path};
use crate::renderer::options::{
    DisplacementId, DisplacementMap, Error, Geometry, MemoryUsage, ModelId, ModelOptions, Options,
};
use crate::renderer::shader::{FRAMES_BINDING, POINTS_BINDING, PatchStages, TEXELS, displacement_flags};
use crate::table::PatchGroup;
use crate::table::{Evaluation, ModelTables, Sharing, TEXEL_BYTES};
use ash::vk;
use bindings::ModelSet;
use edge_factors::EdgeFactors;
use std::sync::Arc;
use streamed::Streamed;

pub(crate) struct Model {
    pub id: ModelId,
    pub tables: ModelTables,
    /// How each group of patches is drawn, in the order of the plan.
    pub stages: Vec<PatchStages>,
    /// What there are pipelines for, by [`Cut::bit`](crate::renderer::shader::Cut::bit).
    pub made: u64,
    pub set: ModelSet,
    /// All tables of the construction and the texture coordinates, one after the other.
    table_buffer: Buffer,
    positions: Streamed,
    /// To put the vertices in that are then written.
    stored: Vec<[f32; 4]>,
    /// If edges are to have their own.
    edge_factors: Option<EdgeFactors>,
    /// What the cached construction keeps of corners, and of rings.
    pub control_points: Option<Buffer>,
    frames: Option<Buffer>,
    pub evaluation: Evaluation,
    /// What is drawn instead of patches, once it is known how finely.
    pub lattice: Option<Lattice>,
    /// Whether control points are out of date.
    stale_points: bool,
    /// Whether vertices that compute evaluates are.
    stale_vertices: bool,
    /// Edges, then faces of the control mesh, if a style draws them.
    pub control: Option<ControlIndices>,
    /// What was not copied to the device yet.
    uploads: Vec<(Buffer, vk::Buffer)>,
    map: DisplacementMap,
    pub displacement: Option<DisplacementId>,
    pub prepared: bool,
}

pub(crate) struct ControlIndices {
    pub buffer: Buffer,
    pub edges: u32,
    pub faces: u32,
    pub vertex_offset: i32,
}

/// What a model needs of its renderer.
#[derive(Clone, Copy)]
pub(crate) struct Surroundings<'r> {
    pub context: &'r Arc<DeviceContext>,
    pub pipelines: &'r ModelPipelines,
    pub options: &'r Options,
}

impl Model {
    pub(crate) fn new(
        Surroundings { context, pipelines, options }: Surroundings,
        id: ModelId,
        model_options: &ModelOptions,
        tables: ModelTables,
        control: &[[f32; 3]],
        map: DisplacementMap,
    ) -> Result<Self, Error> {
        check_evaluation(id, model_options, &tables, context.features())?;
        let name = if model_options.name.is_empty() { "model" } else { &model_options.name };
        let max = context.properties().max_storage_buffer_range;
        let most_texels = context.properties().max_texel_buffer_elements;
        // `binding` is that of set 1.
        let check = |table: &'static str, bytes: u64, binding: usize| {
            // Fans are read as storage buffers only, positions are not.
            let fans = model_options.evaluation == Evaluation::Subdivision && binding > 0;
            let reads_texels = context.properties().reads_texels && !fans;
            let texels = TEXELS.iter().find(|(of, ..)| *of == binding).filter(|_| reads_texels);
            let max = texels.map_or(max, |(.., texel)| max.min(most_texels * texel));
            if bytes > max { Err(Error::TableTooLarge { id, table, bytes, max }) } else { Ok(()) }
        };

        let zeros;
        let needed = options.texcoords || tables.sharing() == Sharing::Displacement;
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

        let mut offset = 0;
        let mut ranges = Vec::with_capacity(arrays.len());
        for (binding, (table, array)) in (1..).zip(&arrays) {
            check(table, array.len() as u64, binding)?;
            // An empty table still gets a range, so that every descriptor is written, and has a texel.
            let size = (array.len() as u64).max(16);
            ranges.push((offset, size));
            offset = (offset + size).next_multiple_of(MAX_OFFSET_ALIGNMENT);
        }
        let mut staged_tables = Buffer::upload(context, &format!("{name}: tables to copy"), offset)?;
        for ((_, array), (offset, _)) in arrays.iter().zip(&ranges) {
            staged_tables.write(*offset, array)?;
        }
        let storage = vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let table_buffer = Buffer::device_local(context, &format!("{name}: tables"), offset, storage)?;

        let position_bytes = TEXEL_BYTES * tables.stored_vertices() as u64;
        check("positions", position_bytes, 0)?;
        let in_flight = options.frames_in_flight;
        let kept = |what: &'static str, bytes: u64, binding: usize| -> Result<_, Error> {
            check(what, bytes, binding)?;
            let usage = storage | vk::BufferUsageFlags::VERTEX_BUFFER;
            Ok((bytes > 0)
                .then(|| Buffer::device_local(context, &format!("{name}: {what}"), bytes, usage))
                .transpose()?)
        };
        let [point_bytes, frame_bytes] = tables.kept_bytes();
        let (control_points, frames) =
            (kept("control points", point_bytes, POINTS_BINDING)?, kept("frames", frame_bytes, FRAMES_BINDING)?);
        let mut stored = Vec::new();
        tables.store_positions(control, &mut stored);
        let positions = Streamed::new(context, &format!("{name}: positions"), &stored, in_flight)?;
        let edge_factors = tables.edges().map(|edges| EdgeFactors::new(context, name, edges, in_flight)).transpose()?;

        let mut uploads = vec![(staged_tables, table_buffer.raw())];
        let control = if options.styles.iter().any(|s| s.geometry != Geometry::Surface) {
            let indices = [&tables.control_edges[..], &tables.control_faces[..]].concat();
            let bytes = 4 * indices.len() as u64;
            let mut staged = Buffer::upload(context, &format!("{name}: control mesh to copy"), bytes)?;
            staged.write(0, &indices)?;
            let usage = vk::BufferUsageFlags::INDEX_BUFFER;
            let buffer = Buffer::device_local(context, &format!("{name}: control mesh"), bytes, usage)?;
            uploads.push((staged, buffer.raw()));
            Some(ControlIndices {
                buffer,
                edges: tables.control_edges.len() as u32,
                faces: tables.control_faces.len() as u32,
                vertex_offset: tables.first_control_vertex() as i32,
            })
        } else {
            None
        };

        // By binding.
        fn whole(buffer: &Buffer) -> (&Buffer, u64, u64) {
            (buffer, 0, buffer.size())
        }
        let mut parts = vec![whole(positions.buffer())];
        parts.extend(ranges.iter().map(|&(offset, bytes)| (&table_buffer, offset, bytes)));
        if let Some(frames) = &frames {
            parts[FRAMES_BINDING] = whole(frames);
        }
        // Every descriptor has to be written; without factors of its own a model's edges never read any.
        parts.push(whole(edge_factors.as_ref().map_or(positions.buffer(), EdgeFactors::buffer)));
        parts.push(whole(control_points.as_ref().unwrap_or(positions.buffer())));
        // SAFETY: the buffers live as long as the model, and the map longer.
        let set = unsafe { ModelSet::new(context, pipelines.draws.model_layout.raw(), name, &parts, map)? };
        let ModelOptions { construction, evaluation, spacing, .. } = *model_options;
        let (sharing, stride, has_speakers) = (tables.sharing(), tables.kept_texels(), tables.has_speakers());
        // The control shader knows by its flags.
        let lattice_edges = edge_factors.is_some() && evaluation != Evaluation::Tessellation;
        let stages = |group: &PatchGroup| {
            let PatchGroup { scheme, kind, .. } = *group;
            let attributes = false;
            let stages = PatchStages {
                scheme,
                kind,
                construction,
                evaluation,
                spacing,
                sharing,
                has_speakers,
                edge_factors: lattice_edges,
                stride,
                attributes,
            };
            PatchStages { attributes: path(evaluation).has_attributes(&pipelines.draws, stages), ..stages }
        };
        Ok(Self {
            id,
            stages: tables.plan.groups().iter().map(stages).collect(),
            made: 0,
            tables,
            set,
            table_buffer,
            positions,
            stored,
            edge_factors,
            control_points,
            frames,
            evaluation,
            lattice: None,
            stale_points: false,
            stale_vertices: false,
            control,
            uploads,
            map,
            displacement: model_options.displacement,
            prepared: false,
        })
    }

    pub(crate) fn set_positions(&mut self, frame: u32, control: &[[f32; 3]]) -> Result<(), Error> {
        let needed = self.tables.control_vertices;
        if control.len() != needed {
            return Err(Error::PositionCount { id: self.id, given: control.len(), needed });
        }
        self.tables.store_positions(control, &mut self.stored);
        Ok(self.positions.write(frame, &self.stored)?)
    }

    pub(crate) fn set_edge_factors(&mut self, frame: u32, factors: &[f32]) -> Result<(), Error> {
        match (self.tables.edges(), &mut self.edge_factors) {
            (Some(edges), Some(own)) => own.write(self.id, frame, edges, factors),
            _ => Err(Error::NoEdgeFactors { id: self.id }),
        }
    }

    /// The largest factor of an edge, if they have any: of the frame that was last prepared.
    pub(crate) fn largest_edge_factor(&self) -> Option<f32> {
        self.edge_factors.as_ref().map(EdgeFactors::largest)
    }

    /// The bits of a draw's flags that displacement by this scale and bias takes.
    pub(crate) fn displacement_flags(&self, displacement: [f32; 2]) -> u32 {
        displacement_flags(&self.map, displacement)
    }

    pub(crate) fn needs_copies(&self, frame: u32) -> bool {
        let indices = self.lattice.as_ref().is_some_and(|lattice| !lattice.prepared);
        let factors = self.edge_factors.as_ref().is_some_and(|factors| factors.is_due(frame));
        !self.prepared || indices || factors || self.positions.is_due(frame)
    }

    /// Whether nothing has to be copied or computed in this frame.
    pub(crate) fn is_at_rest(&self, frame: u32) -> bool {
        !self.needs_copies(frame) && !self.stale_points
    }

    /// Whether compute shaders make something of it.
    pub(crate) fn computes(&self) -> bool {
        self.control_points.is_some() && self.evaluation != Evaluation::GeometryTwoPass
    }

    /// Has the control points computed anew in the next frame, even though nothing moved.
    #[cfg(all(feature = "measure", feature = "headless"))]
    pub(crate) fn forget_points(&mut self) {
        self.stale_points = self.control_points.is_some();
    }

    /// Takes a lattice in place of another, to be evaluated in the next frame.
    pub(crate) fn set_lattice(&mut self, lattice: Lattice) -> Option<Lattice> {
        self.lattice.replace(lattice)
    }

    /// Has what follows from the copies of this frame computed after them; before they are recorded.
    pub(crate) fn mark_stale(&mut self, frame: u32) {
        if self.control_points.is_some() {
            self.stale_points |= !self.prepared || self.positions.is_due(frame);
            // They depend on the lattice and on the factors of edges, too.
            self.stale_vertices = self.stale_points || self.needs_copies(frame);
        }
    }

    /// Whether control points are to be computed now.
    pub(crate) fn has_stale_points(&self) -> bool {
        self.stale_points
    }

    /// Whether anything is.
    pub(crate) fn is_stale(&self) -> bool {
        self.stale_points || self.stale_vertices
    }

    /// Records the evaluation of the lattice, if there is one, which is the last of what was out of date.
    ///
    /// # Safety
    /// As [`Lattice::cmd_evaluate`].
    pub(crate) unsafe fn cmd_evaluate(&mut self, pipelines: &LatticePipelines, cmd: vk::CommandBuffer) {
        (self.stale_points, self.stale_vertices) = (false, false);
        if let Some(lattice) = &self.lattice {
            // SAFETY: as the caller promises.
            unsafe { lattice.cmd_evaluate(pipelines, cmd, self.set.raw, &self.stages, &self.tables.plan) };
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
                Some(conversion) if self.evaluation == Evaluation::GeometryTwoPass => {
                    conversion.cmd_convert(cmd, set, stages, plan);
                }
                _ => pipelines.cached.cmd_points(cmd, set, stages, plan),
            }
        }
    }

    /// Records the copies that are due, and gives away the staging buffers to be kept until the frame is done.
    ///
    /// # Safety
    /// `cmd` is being recorded, outside rendering.
    pub(crate) unsafe fn cmd_copy(&mut self, device: &ash::Device, cmd: vk::CommandBuffer, frame: u32) -> Vec<Buffer> {
        self.uploads.extend(self.lattice.as_mut().and_then(Lattice::take_upload));
        // SAFETY: as the caller promises; both buffers hold the whole range.
        unsafe {
            self.positions.cmd_send(device, cmd, frame);
            if let Some(factors) = &mut self.edge_factors {
                factors.cmd_send(device, cmd, frame);
            }
            for (staged, target) in &self.uploads {
                let region = vk::BufferCopy { size: staged.size(), ..vk::BufferCopy::default() };
                device.cmd_copy_buffer(cmd, staged.raw(), *target, &[region]);
            }
        }
        let uploads = std::mem::take(&mut self.uploads);
        self.prepared = true;
        uploads.into_iter().map(|(staged, _)| staged).collect()
    }

    pub(crate) fn add_memory(&self, usage: &mut MemoryUsage) {
        usage.tables += self.table_buffer.size();
        let [positions, staged_positions] = self.positions.bytes();
        let [factors, staged_factors] = self.edge_factors.as_ref().map_or([0; 2], EdgeFactors::bytes);
        usage.positions += positions + factors;
        usage.control_points += self.control_points.iter().chain(&self.frames).map(Buffer::size).sum::<u64>();
        usage.control_meshes += self.control.as_ref().map_or(0, |c| c.buffer.size());
        let uploads: u64 = self.uploads.iter().map(|(buffer, _)| buffer.size()).sum();
        usage.staging += staged_positions + staged_factors + uploads;
        if let Some(lattice) = &self.lattice {
            lattice.add_memory(usage);
        }
    }
}
