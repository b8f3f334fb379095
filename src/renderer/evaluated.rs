//! Models that are not evaluated by the tessellation stages: what they go with, and what the caller sees of them.

use super::lattice::Lattice;
use super::model::Model;
use super::stages::Sharing;
use super::subdivision;
use super::vertex_input::vertex_bytes;
use super::{Error, Evaluation, Factor, ModelId, ModelOptions, ModelTables, Renderer, RetiredObject};
use crate::gpu::{Features, Spacing};
use crate::table::MAX_SEGMENTS;
use ash::vk;

/// Tells what a model has that its evaluation does not go with, or what the device lacks for it.
pub(super) fn check_evaluation(
    id: ModelId,
    options: &ModelOptions,
    tables: &ModelTables,
    features: Features,
) -> Result<(), Error> {
    let ModelOptions { evaluation, construction, .. } = *options;
    let missing = features.missing(evaluation.features());
    if !missing.is_empty() {
        return Err(Error::EvaluationNeeds { id, evaluation, missing });
    }
    let tables_of = |evaluation| [Evaluation::GeometryTwoPass, Evaluation::Subdivision].map(|own| evaluation == own);
    if tables_of(tables.evaluation) != tables_of(evaluation) {
        return Err(Error::OtherTables { id, built: tables.evaluation, evaluation });
    }
    let displaced = tables.sharing() == Sharing::Displacement;
    for (option, built, asked) in [
        ("displacement", displaced, options.displacement.is_some()),
        // Displacement shares normals in any case.
        ("shared_normals", tables.sharing() != Sharing::Positions, displaced || options.shared_normals),
        ("edge_factors", tables.edges().is_some(), options.edge_factors),
    ] {
        if built != asked {
            return Err(Error::OtherOption { id, option, built });
        }
    }
    if !evaluation.constructions().contains(&construction) {
        return Err(Error::NotConstructedBy { id, evaluation, construction });
    }
    if evaluation == Evaluation::Tessellation {
        return Ok(());
    }
    let shares = evaluation.shares(construction);
    let stencils = evaluation == Evaluation::Geometry;
    let what = match tables.sharing() {
        Sharing::Displacement if !shares && stencils => "displacement of Construction::Stencil",
        Sharing::Displacement if !shares => "displacement",
        Sharing::Normals if !shares && stencils => "shared normals of Construction::Stencil",
        Sharing::Normals if !shares => "shared normals",
        _ if evaluation != Evaluation::Subdivision && options.spacing != Spacing::Equal => "fractional spacing",
        _ if evaluation == Evaluation::Subdivision && tables.edges().is_some() => "factors of edges",
        _ => return Ok(()),
    };
    Err(Error::NotEvaluatedBy { id, evaluation, what })
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
    /// coordinate with [`Options::texcoords`](super::Options::texcoords). With displacement the surface is not displaced yet: draws
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
    /// model cannot be drawn from now on before the next [`Renderer::cmd_prepare`], also not in a frame that was prepared. Draws
    /// name the same number as their [`Factor::Uniform`].
    ///
    /// With [`ModelOptions::edge_factors`] it is the most that an edge has, and what every patch has inside: edges with
    /// smaller factors have fewer segments, their factors rounded up. Draws have [`Factor::Edges`]`(1.0)`.
    ///
    /// Takes memory for the indices of a patch, unless another model has the same, and for the vertices that compute evaluates, (n + 1)² a quad; lets that of the
    /// segments before go when every frame has been prepared again. The number that is set already costs nothing.
    ///
    /// # Errors
    /// [`Error::NoSuchModel`]; [`Error::NoSegments`]; [`Error::BadSegments`] unless from 1 to 1024; [`Error::TableTooLarge`]
    /// if the vertices are more than a shader of the device can see. The model is as it was before.
    pub fn set_segments(&mut self, id: ModelId, segments: u32) -> Result<(), Error> {
        let model = self.models.get_mut(&id).ok_or(Error::NoSuchModel { id })?;
        let evaluation = model.evaluation;
        if !evaluation.needs_segments() {
            return Err(Error::NoSegments { id, evaluation });
        }
        if !(1..=MAX_SEGMENTS).contains(&segments) {
            return Err(Error::BadSegments { id, given: segments, max: MAX_SEGMENTS });
        }
        if model.lattice.as_ref().is_some_and(|lattice| lattice.segments == segments) {
            return Ok(());
        }
        let lattice = Lattice::new(
            &mut self.pipelines.lattice,
            id,
            evaluation,
            model.tables.sharing(),
            &model.tables.plan,
            segments,
        )?;
        if let Some(before) = model.set_lattice(lattice) {
            self.retire(None, RetiredObject::Lattice(Box::new(before)));
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
        let kept = model.lattice.as_ref().and_then(|lattice| Some((lattice, lattice.vertices.as_ref()?)));
        Ok(kept.map(|(lattice, vertices)| EvaluatedVertices {
            buffer: vertices.buffer.raw(),
            size: vertices.buffer.size(),
            stride: vertex_bytes(self.options.texcoords, model.tables.sharing()),
            segments: lattice.segments,
        }))
    }
}

/// What the surface of a model is drawn from.
#[derive(Clone, Copy)]
pub(super) enum Drawn<'m> {
    /// Patches, for the tessellation stages.
    Patches,
    Lattice(&'m Lattice),
    /// Tiles of patches, for the geometry shader.
    Tiles {
        segments: u32,
    },
    /// Faces, subdivided so often.
    Subdivided {
        level: u32,
    },
}

impl Drawn<'_> {
    /// If it is a lattice.
    pub(super) fn lattice_segments(self) -> Option<u32> {
        match self {
            Self::Lattice(lattice) => Some(lattice.segments),
            _ => None,
        }
    }
}

impl Model {
    /// What a draw with this factor is of.
    pub(super) fn drawn(&self, factor: Factor) -> Result<Drawn<'_>, Error> {
        let (id, evaluation) = (self.id, self.evaluation);
        match evaluation {
            Evaluation::Tessellation => return Ok(Drawn::Patches),
            Evaluation::Subdivision => return Ok(Drawn::Subdivided { level: subdivision::level(id, factor)? }),
            _ => {}
        }
        let kept = self.lattice.as_ref();
        let segments = match (factor, self.largest_edge_factor()) {
            (Factor::Uniform(factor), None) => factor.ceil() as u32,
            (_, None) => return Err(Error::NotUniform { id, evaluation, factor }),
            // Vertices may have been evaluated before the draw, too late to scale factors.
            (Factor::Edges(1.0), Some(largest)) => kept.map_or(largest.ceil() as u32, |lattice| lattice.segments),
            (_, Some(_)) => return Err(Error::NotOfEdges { id, evaluation, factor }),
        };
        if evaluation.needs_segments() {
            let lattice = kept.filter(|lattice| lattice.segments == segments);
            let segments = kept.map_or(0, |lattice| lattice.segments);
            let lattice = lattice.ok_or(Error::OtherSegments { id, factor, segments })?;
            if lattice.prepared { Ok(Drawn::Lattice(lattice)) } else { Err(Error::NotPrepared { id }) }
        } else if segments > MAX_SEGMENTS {
            Err(Error::BadSegments { id, given: segments, max: MAX_SEGMENTS })
        } else {
            Ok(Drawn::Tiles { segments })
        }
    }
}
