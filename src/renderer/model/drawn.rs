//! What the surface of a model is drawn from.

use super::Model;
use crate::renderer::evaluate::{Lattice, subdivision};
use crate::renderer::options::{Error, Factor};
use crate::table::{Evaluation, MAX_SEGMENTS};

/// What the surface of a model is drawn from.
#[derive(Clone, Copy)]
pub(crate) enum Drawn<'m> {
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
    pub(crate) fn lattice_segments(self) -> Option<u32> {
        match self {
            Self::Lattice(lattice) => Some(lattice.segments),
            _ => None,
        }
    }
}

impl Model {
    /// What a draw with this factor is of.
    pub(crate) fn drawn(&self, factor: Factor) -> Result<Drawn<'_>, Error> {
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
