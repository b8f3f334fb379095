//! What the surface of a model is drawn from.

use super::Model;
use crate::renderer::evaluate::{Asked, Drawn, path};
use crate::renderer::options::{Error, Factor};

impl Model {
    /// What a draw with a factor is of.
    pub(crate) fn drawn(&self, factor: Factor) -> Result<Drawn<'_>, Error> {
        let (id, evaluation, uniform_grid) = (self.id, self.options.evaluation, self.uniform_grid.as_ref());
        path(evaluation).drawn(&Asked { id, evaluation, factor, largest: self.largest_edge_factor(), uniform_grid })
    }
}
