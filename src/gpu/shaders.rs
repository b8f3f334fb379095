//! The SPIR-V of every shader below `glsl/`, one constant for each file and each variant that the file asks for.
//!
//! `glsl/evaluate/gregory_quad.tese` is `EVALUATE_GREGORY_QUAD_TESE`; with the macro `CAPTURE` defined it is
//! `EVALUATE_GREGORY_QUAD_TESE_CAPTURE`. `build.rs` compiles them.

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// The SPIR-V of the shader whose constant has this name.
pub fn find(constant: &str) -> Option<&'static [u32]> {
    ALL.binary_search_by_key(&constant, |(name, _)| name).ok().map(|at| ALL[at].1)
}
