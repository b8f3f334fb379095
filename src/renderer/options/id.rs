//! Names of models.

#[cfg(doc)]
use crate::renderer::Renderer;
/// Names a model of one [`Renderer`]; others do not know it. Never used again after the model is removed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ModelId {
    pub(crate) renderer: u64,
    pub(crate) number: u64,
}
