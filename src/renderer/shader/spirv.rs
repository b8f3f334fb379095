//! SPIR-V, read and changed word by word.

use crate::gpu::Spacing;
use ash::vk;
use std::collections::HashMap;

/// Words before the instructions of SPIR-V (1.6, 2.3).
const HEADER_WORDS: usize = 5;

/// The instructions of SPIR-V: the words of each, of which the first is its length and its opcode. `None` if the words do not start as
/// SPIR-V does, or end within an instruction or a function: drivers crash on those.
fn instructions(code: &[u32]) -> Option<Vec<(u32, &[u32])>> {
    const MAGIC: u32 = 0x0723_0203;
    const OP_FUNCTION_END: u32 = 56;
    /// OpLine, OpExtInst, OpNoLine: what may follow the last function.
    const REMARKS: [u32; 3] = [8, 12, 317];
    let mut rest = code.get(HEADER_WORDS..).filter(|_| code[0] == MAGIC)?;
    let mut all = Vec::new();
    while let [first, ..] = rest {
        let (words, opcode) = ((first >> 16) as usize, first & 0xffff);
        let (instruction, after) = rest.split_at_checked(words).filter(|_| words > 0)?;
        all.push((opcode, &instruction[1..]));
        rest = after;
    }
    let last = all.iter().rev().find(|(opcode, _)| !REMARKS.contains(opcode));
    last.is_some_and(|&(opcode, _)| opcode == OP_FUNCTION_END).then_some(all)
}

/// What is wrong with a shader before any driver has seen it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fault {
    NotSpirv,
    /// No entry point `main` of the stage.
    OtherStage,
    /// A set and a binding in it that are not in the pipeline's layout, or of another type.
    OtherBinding([u32; 2]),
}

/// The stage of the first entry point, by its number in SPIR-V (1.6, 3.3).
fn stage(code: &[u32]) -> Option<u32> {
    const OP_ENTRY_POINT: u32 = 15;
    let all = instructions(code)?;
    all.iter().find(|&&(opcode, _)| opcode == OP_ENTRY_POINT).and_then(|(_, words)| words.first().copied())
}

/// Checks a caller's shader against one of ours that it stands for, or at least has the stage of; `has_binding(set, binding, type)`
/// tells what the layout has.
pub(crate) fn check_spirv(
    code: &[u32],
    like: &[u32],
    has_binding: impl Fn(u32, u32, &[vk::DescriptorType]) -> bool,
) -> Result<(), Fault> {
    const OP_ENTRY_POINT: u32 = 15;
    const OP_DECORATE: u32 = 71;
    const OP_VARIABLE: u32 = 59;
    const BINDING: u32 = 33;
    const DESCRIPTOR_SET: u32 = 34;
    const MAIN: [u32; 2] = [u32::from_le_bytes(*b"main"), 0];
    let all = instructions(code).ok_or(Fault::NotSpirv)?;
    let of = |wanted: u32| all.iter().filter(move |&&(opcode, _)| opcode == wanted).map(|(_, words)| *words);
    let stage = stage(like);
    if !of(OP_ENTRY_POINT).any(|words| words.first().copied() == stage && words.get(2..4) == Some(&MAIN)) {
        return Err(Fault::OtherStage);
    }
    let decorations: HashMap<[u32; 2], u32> = of(OP_DECORATE)
        .filter_map(|words| match *words {
            [target, decoration @ (BINDING | DESCRIPTOR_SET), value] => Some(([target, decoration], value)),
            _ => None,
        })
        .collect();
    for words in of(OP_VARIABLE) {
        let &[_, variable, class, ..] = words else { return Err(Fault::NotSpirv) };
        let place = [DESCRIPTOR_SET, BINDING].map(|decoration| decorations.get(&[variable, decoration]).copied());
        let [Some(set), Some(binding)] = place else { continue };
        if !has_binding(set, binding, types(class)) {
            return Err(Fault::OtherBinding([set, binding]));
        }
    }
    Ok(())
}

/// The descriptors that variables of a storage class may be of (SPIR-V 1.6, 3.7); buffers as old compilers declare them among those.
fn types(class: u32) -> &'static [vk::DescriptorType] {
    use vk::DescriptorType as Type;
    const UNIFORM_CONSTANT: u32 = 0;
    const UNIFORM: u32 = 2;
    const STORAGE_BUFFER: u32 = 12;
    match class {
        UNIFORM_CONSTANT => &[Type::COMBINED_IMAGE_SAMPLER, Type::UNIFORM_TEXEL_BUFFER],
        UNIFORM => {
            &[Type::UNIFORM_BUFFER, Type::UNIFORM_BUFFER_DYNAMIC, Type::STORAGE_BUFFER, Type::STORAGE_BUFFER_DYNAMIC]
        }
        STORAGE_BUFFER => &[Type::STORAGE_BUFFER, Type::STORAGE_BUFFER_DYNAMIC],
        _ => &[],
    }
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
