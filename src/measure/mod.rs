//! Measurements: how far the patches of a scheme are from the surface they approximate, and what repeated measurements
//! say. Nothing here knows files or prints.

mod error;
mod nearest;
pub mod statistics;
mod sums;

pub use error::{Deviation, ErrorOptions, ErrorReport, FaceErrors, SchemeError, surface_errors};
