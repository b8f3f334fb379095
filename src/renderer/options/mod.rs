//! What callers say: once of a renderer, once of a model, and for each draw.

mod displacement;
mod error;
mod id;
mod instances;
mod item;
mod memory;
mod model_options;
#[expect(clippy::module_inception, reason = "the struct that the folder is named after")]
mod options;
mod positions;
mod style;
mod target;
mod view;

pub use displacement::{DisplacementId, DisplacementMap};
pub use error::Error;
pub use id::ModelId;
pub use instances::{Instance, Instances};
pub use item::DrawItem;
pub use memory::MemoryUsage;
pub use model_options::ModelOptions;
pub use options::Options;
pub use positions::DevicePositions;
pub use style::{Fragment, Geometry, Style};
pub use target::{ColorEncoding, Pass, Target};
pub use view::{MeasuredFrom, View};

pub use crate::tessellator::{Cull, Factor};

pub(crate) use error::EVALUATED_VERTICES;
pub(crate) use view::is_size;
