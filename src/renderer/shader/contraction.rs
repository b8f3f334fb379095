//! Whether drivers may fuse what patches share: a multiplication and an addition made one round otherwise, in one pipeline and
//! not in another, and then neighbours part.
//!
//! Of every shader that makes vertices the test goes back from what it writes (outputs and buffers) over all that its numbers
//! come from, through variables and calls, and wants every sum and product on the way decorated `NoContraction`: what
//! `precise` in GLSL comes to, where glslang carries it. What is compared and what becomes an integer ends the way.

use super::ShaderId;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Functions whose sums and products may be fused, and why.
const EXCEPTIONS: [(&str, &str); 17] = [
    ("acc_across", INSIDE),
    ("acc_inner", INSIDE),
    ("acc_valence", INSIDE),
    ("bicubic_points", INSIDE),
    ("face_point", INSIDE),
    ("gregory_points", INSIDE),
    ("pm_b112_sum", INSIDE),
    ("pm_b202", INSIDE),
    ("pm_beside", INSIDE),
    ("pm_corner", INSIDE),
    ("pm_face", INSIDE),
    ("pm_outer_points", INSIDE),
    ("pm_point_inside", INSIDE),
    ("pm_points_beside", INSIDE),
    ("pm_sum_inside", INSIDE),
    ("include_point", CULLING),
    ("faces_away", CULLING),
];
const INSIDE: &str = "points inside a face, which no other patch has; those on edges are passed through";
const CULLING: &str = "conservative: the picture is the same whatever is culled";

/// Outputs that no two patches share.
const UNSHARED_OUTPUTS: [&str; 1] = ["out_texcoord"];

/// What the search needs to know of a module.
#[derive(Default)]
struct Module<'c> {
    names: HashMap<u32, String>,
    /// Results decorated `NoContraction`.
    exact: HashSet<u32>,
    /// Opcode and operands by result, of what stands in functions.
    results: HashMap<u32, (u32, &'c [u32])>,
    /// The function that a result is in.
    within: HashMap<u32, u32>,
    /// Stored values, and arguments that stand for them, by variable.
    stored: HashMap<u32, Vec<u32>>,
    parameters: HashMap<u32, Vec<u32>>,
    /// Arguments by parameter, and parameters by the variable that is their argument.
    arguments: HashMap<u32, Vec<u32>>,
    passed: HashMap<u32, Vec<u32>>,
    returned: HashMap<u32, Vec<u32>>,
    /// Variables that others read: outputs and buffers.
    outputs: Vec<u32>,
}

// SPIR-V 1.6, 3.52 and 3.20.
const NAME: u32 = 5;
const FUNCTION: u32 = 54;
const PARAMETER: u32 = 55;
const FUNCTION_END: u32 = 56;
const CALL: u32 = 57;
const VARIABLE: u32 = 59;
const LOAD: u32 = 61;
const STORE: u32 = 62;
const ACCESS_CHAINS: [u32; 2] = [65, 66];
const DECORATE: u32 = 71;
const VECTOR_SHUFFLE: u32 = 79;
const COMPOSITE_EXTRACT: u32 = 81;
const COMPOSITE_INSERT: u32 = 82;
const EXT_INST: u32 = 12;
const SELECT: u32 = 169;
const RETURN_VALUE: u32 = 254;
const NO_CONTRACTION: u32 = 42;
const CONVERTS_TO_INTEGER: [u32; 2] = [109, 110];
/// From `OpAny` to `OpFUnordGreaterThanEqual`: what gives a bool, but `OpSelect`.
const LOGIC: std::ops::RangeInclusive<u32> = 154..=191;
/// `OpFAdd`, `OpFSub`, `OpFMul`, `OpFDiv`, the products of vectors and matrices, `OpDot`.
const ARITHMETIC: [u32; 11] = [129, 131, 133, 136, 142, 143, 144, 145, 146, 147, 148];
/// Storage classes `Output`, `Uniform` and `StorageBuffer`.
const WRITTEN: [u32; 3] = [3, 2, 12];

fn instructions(code: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    const HEADER_WORDS: usize = 5;
    let mut rest = &code[HEADER_WORDS..];
    std::iter::from_fn(move || {
        let first = *rest.first()?;
        let (instruction, after) = rest.split_at((first >> 16) as usize);
        rest = after;
        Some((first & 0xffff, &instruction[1..]))
    })
}

fn text(words: &[u32]) -> String {
    let bytes = words.iter().flat_map(|word| word.to_le_bytes()).take_while(|&byte| byte != 0).collect();
    String::from_utf8(bytes).expect("a name")
}

impl<'c> Module<'c> {
    fn new(code: &'c [u32]) -> Self {
        let mut module = Self::default();
        let mut function = None;
        for (opcode, words) in instructions(code) {
            match (opcode, words) {
                (NAME, [id, name @ ..]) => _ = module.names.insert(*id, text(name)),
                (DECORATE, [id, NO_CONTRACTION]) => _ = module.exact.insert(*id),
                (FUNCTION, [_, id, ..]) => function = Some(*id),
                (FUNCTION_END, _) => function = None,
                (PARAMETER, [_, id]) => {
                    module.parameters.entry(function.expect("in a function")).or_default().push(*id)
                }
                (VARIABLE, [_, id, class, ..]) if WRITTEN.contains(class) => module.outputs.push(*id),
                (STORE, [to, value, ..]) => module.stored.entry(*to).or_default().push(*value),
                (RETURN_VALUE, [value]) => {
                    module.returned.entry(function.expect("in a function")).or_default().push(*value);
                }
                (_, [_, id, operands @ ..]) if function.is_some() => {
                    module.results.insert(*id, (opcode, operands));
                    module.within.insert(*id, function.expect("in a function"));
                }
                _ => {}
            }
        }
        module.connect();
        module
    }

    /// Stores by the whole variable that they are in, and arguments by parameters.
    fn connect(&mut self) {
        for (to, values) in std::mem::take(&mut self.stored) {
            self.stored.entry(self.variable(to)).or_default().extend(values);
        }
        let calls = self.results.values().filter(|(opcode, _)| *opcode == CALL);
        let calls: Vec<_> = calls.map(|(_, operands)| (operands[0], &operands[1..])).collect();
        for (function, arguments) in calls {
            let parameters = self.parameters.get(&function).cloned().unwrap_or_default();
            for (parameter, &argument) in parameters.into_iter().zip(arguments) {
                self.arguments.entry(parameter).or_default().push(argument);
                self.passed.entry(self.variable(argument)).or_default().push(parameter);
            }
        }
    }

    /// The variable that a pointer is into.
    fn variable(&self, mut pointer: u32) -> u32 {
        while let Some((opcode, operands)) = self.results.get(&pointer)
            && ACCESS_CHAINS.contains(opcode)
        {
            pointer = operands[0];
        }
        pointer
    }

    /// What a value is made of: values, and variables of which all that is ever stored counts.
    fn sources(&self, id: u32) -> Vec<u32> {
        let of = |map: &HashMap<u32, Vec<u32>>| map.get(&id).cloned().unwrap_or_default();
        let Some(&(opcode, operands)) = self.results.get(&id) else {
            // A variable or a parameter: what is stored there, what is passed, and what functions store that it is passed to.
            let passed = of(&self.arguments).into_iter().map(|argument| self.variable(argument));
            return passed.chain(of(&self.stored)).chain(of(&self.passed)).collect();
        };
        match opcode {
            LOAD => vec![self.variable(operands[0])],
            CALL => self.returned.get(&operands[0]).cloned().unwrap_or_default(),
            EXT_INST => operands[2..].to_vec(),
            COMPOSITE_EXTRACT => operands[..1].to_vec(),
            VECTOR_SHUFFLE | COMPOSITE_INSERT => operands[..2].to_vec(),
            SELECT => operands[1..].to_vec(),
            _ if LOGIC.contains(&opcode) || CONVERTS_TO_INTEGER.contains(&opcode) => Vec::new(),
            // A variable of a function, whose first operand is its storage class.
            VARIABLE => [of(&self.stored), of(&self.passed)].concat(),
            _ => operands.to_vec(),
        }
    }

    /// The functions with sums and products on the way to what is written, and how many of them may be fused.
    fn functions(&self) -> BTreeMap<String, usize> {
        let shared = |id: &u32| self.names.get(id).is_none_or(|name| !UNSHARED_OUTPUTS.contains(&name.as_str()));
        let mut next: Vec<u32> = self.outputs.iter().copied().filter(shared).collect();
        let mut seen = HashSet::new();
        let mut functions = BTreeMap::new();
        while let Some(id) = next.pop() {
            if !seen.insert(id) {
                continue;
            }
            if let Some((opcode, _)) = self.results.get(&id)
                && ARITHMETIC.contains(opcode)
            {
                let signature = &self.names[&self.within[&id]];
                let name = signature.split('(').next().expect("a name").to_owned();
                *functions.entry(name).or_default() += usize::from(!self.exact.contains(&id));
            }
            next.extend(self.sources(id));
        }
        functions
    }
}

#[test]
fn nothing_shared_is_fused() {
    let (mut functions, mut wrong, mut unused) = (BTreeSet::new(), Vec::new(), EXCEPTIONS.to_vec());
    // What colours pixels makes no vertices.
    for shader in ShaderId::ALL.iter().filter(|shader| !shader.is_of_style()) {
        for (function, fused) in Module::new(shader.code()).functions() {
            if fused > 0 {
                unused.retain(|(name, _)| *name != function);
                if EXCEPTIONS.iter().all(|(name, _)| *name != function) {
                    wrong.push(format!("{fused} in {function} of {}", shader.name()));
                }
            }
            functions.insert(function);
        }
    }
    assert!(functions.len() > 60, "only {} functions lead to what is written", functions.len());
    assert!(wrong.is_empty(), "sums and products that are not `precise`: {wrong:#?}");
    assert!(unused.is_empty(), "strike these off: {unused:?}");
}

/// `precise` taken away from one function.
#[test]
fn what_may_be_fused_is_found() {
    let code = ShaderId::EvaluateTessellationTeseGregoryQuad.code();
    assert!(Module::new(code).functions().values().all(|&fused| fused == 0));
    for name in ["curve_point", "curve_basis", "exact_cross", "exact_row", "blend"] {
        let mut module = Module::new(code);
        let within = |id: &u32| module.within.get(id).and_then(|function| module.names.get(function));
        let of_function = |id: &u32| within(id).is_some_and(|signature| signature.split('(').next() == Some(name));
        module.exact = module.exact.iter().copied().filter(|id| !of_function(id)).collect();
        let fused = module.functions().into_iter().filter(|(_, fused)| *fused > 0).map(|(name, _)| name);
        assert_eq!(fused.collect::<Vec<_>>(), [name]);
    }
}
