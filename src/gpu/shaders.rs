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
mod contraction;

#[cfg(test)]
mod tests {
    /// Depth of one pipeline is tested against that of another.
    #[test]
    fn positions_are_invariant() {
        const HEADER_WORDS: usize = 5;
        const OP_MEMBER_DECORATE: u32 = 72;
        const INVARIANT: u32 = 18;
        let draws = |name: &str| {
            let surface = name.starts_with("EVALUATE_") || name.starts_with("SUBDIVIDE_");
            surface && !name.contains("_COMP") || name.starts_with("CONSTRUCT_CONTROL_MESH_VERT")
        };
        let is_invariant = |code: &[u32]| {
            let mut rest = &code[HEADER_WORDS..];
            while let Some(&first) = rest.first() {
                let (instruction, after) = rest.split_at((first >> 16) as usize);
                if (first & 0xffff, instruction.last()) == (OP_MEMBER_DECORATE, Some(&INVARIANT)) {
                    return true;
                }
                rest = after;
            }
            false
        };
        let (mut count, mut varying) = (0, Vec::new());
        for (name, code) in super::ALL.iter().filter(|(name, _)| draws(name)) {
            count += 1;
            if !is_invariant(code) {
                varying.push(name);
            }
        }
        assert!(count > 50 && varying.is_empty(), "of {count}: {varying:?}");
    }

    #[test]
    fn shaders_that_are_not_there_are_named() {
        assert_eq!(super::named("SHADE_LIT_FRAG").unwrap(), super::SHADE_LIT_FRAG);
        let error = super::named("SHADE_NOTHING_FRAG").unwrap_err().to_string();
        assert!(error.contains("SHADE_NOTHING_FRAG") && error.contains("there is no such shader"), "{error}");
    }
}
