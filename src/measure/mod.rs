//! Measurements: how far the patches of a scheme are from the surface they approximate. Nothing here knows files or
//! prints.

mod dense;
mod error;
mod field;
mod nearest;
mod sums;
#[cfg(feature = "headless")]
pub mod watertight;

pub use error::{Deviation, ErrorOptions, ErrorReport, FaceErrors, SchemeError, surface_errors};
pub use field::{Quantity, error_field};
