//! SPIR-V, read and changed word by word.

use crate::constants::{LOCATION_INSTANCE, LOCATION_PATCH_INSTANCE};
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

/// The storage class of what a shader takes from the stage before (SPIR-V 1.6, 3.7).
const INPUT: u32 = 1;
/// The storage class of what it hands on.
const OUTPUT: u32 = 3;

/// A shader for draws of items that have no instances; `is_last` if rasterization follows.
pub(crate) fn without_instances(code: &[u32], stage: vk::ShaderStageFlags, is_last: bool) -> Vec<u32> {
    let code = match stage {
        vk::ShaderStageFlags::TESSELLATION_CONTROL => without_variable(code, OUTPUT, LOCATION_PATCH_INSTANCE),
        vk::ShaderStageFlags::TESSELLATION_EVALUATION => without_variable(code, INPUT, LOCATION_PATCH_INSTANCE),
        vk::ShaderStageFlags::FRAGMENT => without_variable(code, INPUT, LOCATION_INSTANCE),
        _ => code.to_vec(),
    };
    if is_last { without_variable(&code, OUTPUT, LOCATION_INSTANCE) } else { code }
}

/// A shader without the number that it takes or hands on at a location, which nothing that runs reads or writes: drivers keep room
/// for all that is declared. A shader that has none, or does more with it than read and write, is as it was.
fn without_variable(code: &[u32], class: u32, location: u32) -> Vec<u32> {
    const OP_UNDEF: u32 = 1;
    const OP_NAME: u32 = 5;
    const OP_ENTRY_POINT: u32 = 15;
    const OP_VARIABLE: u32 = 59;
    const OP_LOAD: u32 = 61;
    const OP_STORE: u32 = 62;
    const OP_ACCESS_CHAIN: u32 = 65;
    const OP_DECORATE: u32 = 71;
    const LOCATION: u32 = 30;
    let all = instructions(code).unwrap_or_default();
    let is_there = |id: u32| all.iter().any(|(opcode, w)| *opcode == OP_DECORATE && *w == [id, LOCATION, location]);
    let found = all.iter().find(|(opcode, w)| *opcode == OP_VARIABLE && w[2] == class && is_there(w[1]));
    let Some(variable) = found.map(|(_, words)| words[1]) else { return code.to_vec() };
    if all.iter().any(|(opcode, words)| *opcode == OP_ACCESS_CHAIN && words[2] == variable) {
        return code.to_vec();
    }
    let mut rest = code[..HEADER_WORDS].to_vec();
    let mut push = |opcode: u32, words: &[u32]| {
        rest.push((words.len() as u32 + 1) << 16 | opcode);
        rest.extend_from_slice(words);
    };
    for (opcode, words) in all {
        match opcode {
            OP_NAME | OP_DECORATE | OP_STORE if words[0] == variable => {}
            OP_VARIABLE if words[1] == variable => {}
            OP_LOAD if words[2] == variable => push(OP_UNDEF, &words[..2]),
            OP_ENTRY_POINT => {
                // The name ends with a zero byte; what the shader takes and hands on comes after it.
                let name =
                    words[2..].iter().position(|word| word.to_le_bytes().contains(&0)).map_or(words.len(), |n| n + 3);
                let kept = words[name..].iter().filter(|&&id| id != variable);
                push(opcode, &words[..name].iter().chain(kept).copied().collect::<Vec<_>>());
            }
            _ => push(opcode, words),
        }
    }
    rest
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

    #[test]
    fn variables_are_left_out() {
        let code = ShaderId::EvaluateTessellationTeseBicubic.code();
        let stage = vk::ShaderStageFlags::TESSELLATION_EVALUATION;
        let [less, least] = [false, true].map(|is_last| without_instances(code, stage, is_last));
        // A variable, its place, what writes it and its name among those of the entry point; what reads it becomes what is not known.
        let count = |code: &[u32]| instructions(code).expect("SPIR-V").len();
        assert!(count(code) > count(&less) && count(&less) > count(&least), "{} {}", count(code), count(&less));
        for (class, location) in [(OUTPUT, LOCATION_INSTANCE), (INPUT, LOCATION_PATCH_INSTANCE), (OUTPUT, 99)] {
            assert_eq!(without_variable(&least, class, location), least);
        }
    }
}
