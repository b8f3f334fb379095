//! SPIR-V, read and changed word by word.

use crate::gpu::Spacing;

/// Words before the instructions of SPIR-V (1.6, 2.3).
const HEADER_WORDS: usize = 5;

/// Whether words start as SPIR-V does, and go on. Drivers crash on less.
pub(crate) fn is_spirv(code: &[u32]) -> bool {
    const MAGIC: u32 = 0x0723_0203;
    code.len() > HEADER_WORDS && code[0] == MAGIC
}

/// A tessellation evaluation shader with another spacing: the files all say `equal_spacing`.
pub(crate) fn spaced(code: &[u32], spacing: Spacing) -> Vec<u32> {
    // SPIR-V 1.6, 2.3 and 3.6: an instruction's first word is its length and its opcode.
    const OP_EXECUTION_MODE: u32 = 16;
    const SPACING_EQUAL: u32 = 1;
    let mode = match spacing {
        Spacing::Equal => SPACING_EQUAL,
        Spacing::FractionalEven => 2,
        Spacing::FractionalOdd => 3,
    };
    let mut code = code.to_vec();
    let mut at = HEADER_WORDS;
    while at < code.len() {
        let (words, opcode) = ((code[at] >> 16) as usize, code[at] & 0xffff);
        if opcode == OP_EXECUTION_MODE && code.get(at + 2) == Some(&SPACING_EQUAL) {
            code[at + 2] = mode;
        }
        at += words.max(1);
    }
    code
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::renderer::ShaderId;

    #[test]
    fn spacing_is_one_word() {
        let equal = ShaderId::EvaluateTessellationTeseBicubic.code();
        assert_eq!(spaced(equal, Spacing::Equal), equal);
        for (spacing, mode) in [(Spacing::FractionalEven, 2), (Spacing::FractionalOdd, 3)] {
            let code = spaced(equal, spacing);
            let changed: Vec<_> = (0..code.len()).filter(|&i| code[i] != equal[i]).collect();
            assert_eq!((changed.len(), code[changed[0]], equal[changed[0]]), (1, mode, 1));
        }
    }
}
