//! Models that are evaluated by compute: what the caller sees of them, and their draws.

use super::lattice::{Lattice, MAX_SEGMENTS, vertex_bytes};
use super::model::Model;
use super::stages::Sharing;
use super::{
    Construction, Error, Evaluation, Factor, ModelId, ModelOptions, ModelTables, Renderer, Retired, RetiredObject,
};
use crate::gpu::Spacing;
use ash::vk;

/// Tells what a model has that evaluation by compute has not.
pub(super) fn check_evaluation(id: ModelId, options: &ModelOptions, tables: &ModelTables) -> Result<(), Error> {
    if options.evaluation != Evaluation::Compute {
        return Ok(());
    }
    let what = match tables.sharing() {
        _ if tables.construction() != Construction::Cached => "constructions other than Construction::Cached",
        Sharing::Displacement => "displacement",
        Sharing::Normals => "shared normals",
        Sharing::Positions if tables.edges().is_some() => "factors of edges",
        Sharing::Positions if options.spacing != Spacing::Equal => "fractional spacing",
        Sharing::Positions => return Ok(()),
    };
    Err(Error::NotByCompute { id, what })
}

/// The vertices of a model that is evaluated by compute, for your own use: for acceleration structures, or draws without
/// this crate.
///
/// They are written in the compute stage by the commands of [`Renderer::cmd_prepare`], followed by a barrier for vertex
/// input; other uses need barriers of their own, before and after. The buffer may be read as vertex buffer, as storage buffer and by
/// copies, and lives until the model is removed or its segments change, and every frame was prepared again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EvaluatedVertices {
    /// Patch by patch in the order of [`ModelTables::plan`], in each in the order of
    /// [`grid_parameters`](crate::table::grid_parameters): position and normal in object space, three `f32` each; two more for the texture
    /// coordinate with [`Options::texcoords`](super::Options::texcoords).
    pub buffer: vk::Buffer,
    /// Bytes of them all.
    pub size: u64,
    /// Bytes from one vertex to the next.
    pub stride: u32,
    /// Segments along each side of each patch.
    pub segments: u32,
}

impl Renderer {
    /// Sets how many segments every edge of a model has, which is [`Evaluation::Compute`]: from the next
    /// [`Renderer::cmd_prepare`] on, until others are set. Draws name the same number as their [`Factor::Uniform`].
    ///
    /// Takes memory for the vertices, (n + 1)² a quad, and lets that of the segments before go when every frame has been
    /// prepared again. The number that is set already costs nothing.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`]; [`Error::NotComputed`]; [`Error::BadSegments`] unless from 1 to 1024; [`Error::TableTooLarge`]
    /// if the vertices are more than a shader of the device can see. The model is as it was before.
    pub fn set_segments(&mut self, id: ModelId, segments: u32) -> Result<(), Error> {
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        if model.evaluation != Evaluation::Compute {
            return Err(Error::NotComputed { id });
        }
        if !(1..=MAX_SEGMENTS).contains(&segments) {
            return Err(Error::BadSegments { id, given: segments, max: MAX_SEGMENTS });
        }
        if model.lattice.as_ref().is_some_and(|lattice| lattice.segments == segments) {
            return Ok(());
        }
        let lattice = Lattice::new(&self.pipelines.lattice, id, &model.tables.plan, segments)?;
        if let Some(before) = model.set_lattice(lattice) {
            let frames = vec![true; self.options.frames_in_flight as usize];
            self.retired.push(Retired { frames, _what: RetiredObject::Lattice(Box::new(before)) });
        }
        Ok(())
    }

    /// Where the vertices of a model are; none before [`Renderer::set_segments`].
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::NotComputed`].
    pub fn evaluated_vertices(&self, id: ModelId) -> Result<Option<EvaluatedVertices>, Error> {
        let model = self.model(id)?;
        if model.evaluation != Evaluation::Compute {
            return Err(Error::NotComputed { id });
        }
        Ok(model.lattice.as_ref().map(|lattice| EvaluatedVertices {
            buffer: lattice.vertices.raw(),
            size: lattice.vertices.size(),
            stride: vertex_bytes(self.options.texcoords),
            segments: lattice.segments,
        }))
    }

    /// Records the draws of a surface that was evaluated.
    ///
    /// # Safety
    /// As [`Renderer::cmd_draw`]; the pipeline is bound, and `push` records the constants of a group.
    pub(super) unsafe fn cmd_draw_lattice(
        &self,
        cmd: vk::CommandBuffer,
        model: &Model,
        factor: Factor,
        mut push: impl FnMut(usize),
    ) -> Result<(), Error> {
        let segments = model.lattice.as_ref().map_or(0, |lattice| lattice.segments);
        let fits = |lattice: &&Lattice| matches!(factor, Factor::Uniform(f) if f.ceil() == lattice.segments as f32);
        let lattice = model.lattice.as_ref().filter(fits);
        let lattice = lattice.ok_or(Error::NotEvaluated { id: model.id, factor, segments })?;
        if !lattice.ready {
            return Err(Error::NotPrepared { id: model.id });
        }
        let device = self.context.device();
        // SAFETY: as the caller promises.
        unsafe {
            device.cmd_bind_vertex_buffers(cmd, 0, &[lattice.vertices.raw()], &[0]);
            device.cmd_bind_index_buffer(cmd, lattice.indices.raw(), 0, vk::IndexType::UINT32);
            for (number, group) in lattice.groups.iter().enumerate() {
                push(number);
                for (count, first, offset) in group.draws() {
                    device.cmd_draw_indexed(cmd, count, 1, first, offset, 0);
                }
            }
        }
        Ok(())
    }
}
