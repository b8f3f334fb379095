//! Models that are not evaluated by the tessellation stages: what they go with, and what the caller sees of them.

use super::{Renderer, RetiredObject};
use crate::renderer::evaluate::UniformGrid;
use crate::renderer::options::{Error, ModelId};
use crate::renderer::pipelines::vertex_bytes;
#[cfg(doc)]
use crate::renderer::{Factor, ModelOptions, ModelTables};
use crate::table::Evaluation;
use crate::table::MAX_SEGMENTS;
use ash::vk;

/// The vertices of a model that is evaluated by compute, for your own use: for acceleration structures, or draws without
/// this crate.
///
/// They are written in the compute stage by the commands of [`Renderer::cmd_prepare`], followed by a barrier for vertex
/// input; other uses need barriers of their own, before and after. The buffer may be read as vertex buffer, as storage buffer and by
/// copies, and lives until the model is removed or its segments change, and [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight)
/// frames began since.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct EvaluatedVertices {
    /// Patch by patch in the order of [`ModelTables::plan`], in each in the order of
    /// [`grid_parameters`](crate::table::grid_parameters): position and normal in object space, three `f32` each; two more for the texture
    /// coordinate with [`Options::texcoords`](crate::renderer::Options::texcoords). With displacement the surface is not displaced yet: draws
    /// do that, and there are always two for the texture coordinate, three for the direction in which it goes, two for where in
    /// the map it looks, and one for the level of the map.
    pub buffer: vk::Buffer,
    /// Bytes of them all.
    pub size: u64,
    /// Bytes from one vertex to the next.
    pub stride: u32,
    /// Segments along each side of each patch.
    pub segments: u32,
}

impl Renderer {
    /// Sets how many segments every edge of a model has, where [`Evaluation::needs_segments`], until others are set. The
    /// model cannot be drawn from now on before the next [`Renderer::cmd_prepare`], also not in a frame that was prepared. Draws have
    /// [`Factor::Segments`].
    ///
    /// With [`ModelOptions::edge_factors`] it is the most that an edge has, and what every patch has inside: edges with
    /// smaller factors have fewer segments, their factors rounded up.
    ///
    /// Takes memory for the indices of a patch, unless another model has the same, and for the vertices that compute evaluates, (n + 1)² a quad; lets that of the
    /// segments before go when [`Options::frames_in_flight`](crate::renderer::Options::frames_in_flight) frames have begun since. The number that is set already costs nothing.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`]; [`Error::NoSegments`]; [`Error::BadSegments`] unless from 1 to 1024; [`Error::TableTooLarge`]
    /// if the vertices are more than a shader of the device can see. The model is as it was before.
    pub fn set_segments(&mut self, id: ModelId, segments: u32) -> Result<(), Error> {
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        let evaluation = model.options.evaluation;
        if !evaluation.needs_segments() {
            return Err(Error::NoSegments { id, evaluation });
        }
        if !(1..=MAX_SEGMENTS).contains(&segments) {
            return Err(Error::BadSegments { id, given: segments, max: MAX_SEGMENTS });
        }
        if model.uniform_grid.as_ref().is_some_and(|uniform_grid| uniform_grid.segments == segments) {
            return Ok(());
        }
        let uniform_grid = UniformGrid::new(
            &mut self.pipelines.uniform_grid,
            id,
            evaluation,
            model.tables.sharing(),
            &model.tables.plan,
            segments,
        )?;
        if let Some(before) = model.set_uniform_grid(uniform_grid) {
            self.retire(None, RetiredObject::UniformGrid(Box::new(before)));
        }
        Ok(())
    }

    /// Where the vertices of a model are; none before [`Renderer::set_segments`].
    ///
    /// # Errors
    /// [`Error::NoSuchModel`], [`Error::NotComputed`].
    pub fn evaluated_vertices(&self, id: ModelId) -> Result<Option<EvaluatedVertices>, Error> {
        let model = self.model(id)?;
        if model.options.evaluation != Evaluation::Compute {
            return Err(Error::NotComputed { id });
        }
        let kept =
            model.uniform_grid.as_ref().and_then(|uniform_grid| Some((uniform_grid, uniform_grid.vertices.as_ref()?)));
        Ok(kept.map(|(uniform_grid, vertices)| EvaluatedVertices {
            buffer: vertices.buffer.raw(),
            size: vertices.buffer.size(),
            stride: vertex_bytes(self.options.texcoords, model.tables.sharing()),
            segments: uniform_grid.segments,
        }))
    }
}
