//! Measurements: how far the patches of a scheme are from the surface they approximate, and what repeated measurements
//! say. Nothing here knows files or prints.

mod dense;
mod error;
mod field;
mod nearest;
#[cfg(feature = "headless")]
mod screen;
pub mod statistics;
mod sums;
mod surfaces;
#[cfg(feature = "headless")]
pub mod watertight;

pub use error::{ErrorOptions, ErrorReport, FaceErrors, SchemeError, surface_errors};
pub use field::{Quantity, error_field};
#[cfg(feature = "headless")]
pub use screen::{PixelDeviation, ScreenError, screen_error};
pub use sums::Deviation;
