//! What the surface of a model is drawn from.

use super::uniform_grid::UniformGrid;
use crate::renderer::options::{Error, Factor, ModelId};
use crate::table::{Evaluation, MAX_SEGMENTS};

/// A draw that is asked for.
pub(crate) struct Asked<'m> {
    pub id: ModelId,
    pub evaluation: Evaluation,
    pub factor: Factor,
    /// The largest factor of an edge, if edges have factors of their own.
    pub largest: Option<f32>,
    /// The uniform grid that is kept, if its segments were set.
    pub uniform_grid: Option<&'m UniformGrid>,
}

/// What the surface of a model is drawn from.
#[derive(Clone, Copy)]
pub(crate) enum Drawn<'m> {
    /// Patches, for the tessellation stages.
    Patches,
    UniformGrid(&'m UniformGrid),
    /// Tiles of patches, for the geometry shader.
    Tiles {
        segments: u32,
    },
    /// Faces, subdivided `level` times.
    Subdivided {
        level: u32,
    },
}

impl<'m> Drawn<'m> {
    /// The uniform grid, if it is one.
    pub(crate) fn uniform_grid(self) -> Option<&'m UniformGrid> {
        match self {
            Self::UniformGrid(uniform_grid) => Some(uniform_grid),
            _ => None,
        }
    }

    /// Segments along every edge, if all have as many.
    pub(crate) fn segments(self) -> Option<u32> {
        match self {
            Self::UniformGrid(uniform_grid) => Some(uniform_grid.segments),
            Self::Tiles { segments } => Some(segments),
            Self::Patches | Self::Subdivided { .. } => None,
        }
    }
}

impl<'m> Asked<'m> {
    /// Segments along every edge.
    fn segments(&self) -> Result<u32, Error> {
        let &Self { id, evaluation, factor, largest, .. } = self;
        match (factor, largest) {
            (Factor::Uniform(factor), None) => Ok(factor.ceil() as u32),
            (_, None) => Err(Error::NotUniform { id, evaluation, factor }),
            (Factor::Edges(1.0), Some(largest)) => Ok(largest.ceil() as u32),
            (_, Some(_)) => Err(Error::NotOfEdges { id, evaluation, factor }),
        }
    }

    /// The uniform grid that is kept.
    pub(crate) fn uniform_grid(&self) -> Result<Drawn<'m>, Error> {
        let id = self.id;
        let uniform_grid = self.uniform_grid.ok_or(Error::SegmentsNotSet { id })?;
        if uniform_grid.prepared { Ok(Drawn::UniformGrid(uniform_grid)) } else { Err(Error::NotPrepared { id }) }
    }

    /// Tiles with the segments that are asked for.
    pub(crate) fn tiles(&self) -> Result<Drawn<'m>, Error> {
        let segments = self.segments()?;
        if segments > MAX_SEGMENTS {
            return Err(Error::BadSegments { id: self.id, given: segments, max: MAX_SEGMENTS });
        }
        Ok(Drawn::Tiles { segments })
    }
}
