//! The SPIR-V of every shader below `glsl/`, one constant for each file and each variant that the file asks for.
//!
//! `glsl/evaluate/gregory_quad.tese` is `EVALUATE_GREGORY_QUAD_TESE`; with the macro `CAPTURE` defined it is
//! `EVALUATE_GREGORY_QUAD_TESE_CAPTURE`. `build.rs` compiles them.

use super::GpuError;

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The SPIR-V of the shader whose constant has this name.
pub fn find(constant: &str) -> Option<&'static [u32]> {
    ALL.binary_search_by_key(&constant, |(name, _)| name).ok().map(|at| ALL[at].1)
}

/// As [`find`], for shaders that are taken to be there.
///
/// # Errors
/// [`GpuError::BadPipeline`] names the shader that is not.
pub fn named(constant: &str) -> Result<&'static [u32], GpuError> {
    let missing =
        || GpuError::BadPipeline { object: constant.to_owned(), message: "there is no such shader".to_owned() };
    find(constant).ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    #[test]
    fn shaders_that_are_not_there_are_named() {
        assert_eq!(super::named("SHADE_LIT_FRAG").unwrap(), super::SHADE_LIT_FRAG);
        let error = super::named("SHADE_NOTHING_FRAG").unwrap_err().to_string();
        assert!(error.contains("SHADE_NOTHING_FRAG") && error.contains("there is no such shader"), "{error}");
    }
}
