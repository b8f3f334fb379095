//! What a frame sends of a model to the device, for it to be taken back if the frame is lost.

use super::Model;
use crate::gpu::{Buffer, DescriptorSet};
use crate::renderer::evaluate::SharedIndices;
use ash::vk;
use std::sync::Arc;

/// What the device reads in a frame, and nobody after.
#[expect(dead_code, reason = "kept only to be dropped later")]
pub(crate) enum Used {
    Staging(Buffer),
    Set(DescriptorSet),
}

/// What a frame's preparation records for a model, and how the model was before.
pub(crate) struct Sent {
    /// Copied, and whereto.
    pub(super) uploads: Vec<(Buffer, vk::Buffer)>,
    pub(super) indices: Option<(Buffer, Arc<SharedIndices>)>,
    /// Of the buffer whose positions are gathered.
    pub(super) given: Option<DescriptorSet>,
    was_prepared: bool,
    was_uniform_grid_prepared: bool,
    /// Positions that the host wrote, and factors of edges.
    were_due: [bool; 2],
}

impl Sent {
    /// What is to be kept until the frame is done.
    pub(crate) fn into_used(self) -> impl Iterator<Item = Used> {
        let indices = self.indices.map(|(staged, _)| staged);
        let staged = self.uploads.into_iter().map(|(staged, _)| staged).chain(indices);
        staged.map(Used::Staging).chain(self.given.map(Used::Set))
    }

    /// Has the model, if it is still there, send all of it again, the copies of the frame with this index among it.
    pub(crate) fn take_back(self, model: Option<&mut Model>, frame: u32) {
        // Other models count on them, too.
        if let Some((staged, indices)) = self.indices {
            indices.give_back(staged);
        }
        let Some(model) = model else { return };
        model.uploads.extend(self.uploads);
        model.prepared &= self.was_prepared;
        if let Some(uniform_grid) = &mut model.uniform_grid {
            uniform_grid.prepared &= self.was_uniform_grid_prepared;
        }
        let [positions, factors] = self.were_due;
        if positions {
            model.positions.send_again(frame);
        }
        if let Some(of_edges) = model.edge_factors.as_mut().filter(|_| factors) {
            of_edges.send_again(frame);
        }
    }
}

impl Model {
    /// How it is before a frame is prepared, of which nothing is sent yet.
    pub(crate) fn before(&self) -> Sent {
        Sent {
            uploads: Vec::new(),
            indices: None,
            given: None,
            was_prepared: self.prepared,
            was_uniform_grid_prepared: self.uniform_grid.as_ref().is_some_and(|uniform_grid| uniform_grid.prepared),
            were_due: [self.positions.is_due(), self.edge_factors.as_ref().is_some_and(|factors| factors.is_due())],
        }
    }
}
