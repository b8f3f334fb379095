//! The shaders of the renderer, compiled.

use super::axes::{Output, ShaderKey, Source};
use super::{PatchForm, Sharing};

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

impl ShaderId {
    /// Whether styles name the shader ([`Style::fragment`](crate::renderer::Style::fragment)).
    pub(crate) fn is_of_style(self) -> bool {
        self.source().starts_with("glsl/shade/")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The words after the header, instruction by instruction.
    fn instructions(code: &[u32]) -> impl Iterator<Item = &[u32]> {
        const HEADER_WORDS: usize = 5;
        let mut rest = &code[HEADER_WORDS..];
        std::iter::from_fn(move || {
            let (instruction, after) = rest.split_at_checked((*rest.first()? >> 16) as usize)?;
            rest = after;
            Some(instruction)
        })
    }

    /// Depth of one pipeline is tested against that of another.
    #[test]
    fn positions_are_invariant() {
        const OP_MEMBER_DECORATE: u32 = 72;
        const INVARIANT: u32 = 18;
        let draws = |id: &&ShaderId| {
            let source = id.source();
            let surface = source.starts_with("glsl/evaluate/") || source.starts_with("glsl/subdivide/");
            surface && !source.ends_with(".comp") || source == "glsl/construct/control_mesh.vert"
        };
        let is_invariant = |id: &ShaderId| {
            instructions(id.code()).any(|i| (i[0] & 0xffff, i.last()) == (OP_MEMBER_DECORATE, Some(&INVARIANT)))
        };
        let draws: Vec<_> = ShaderId::ALL.iter().filter(draws).collect();
        let varying: Vec<_> = draws.iter().filter(|id| !is_invariant(id)).collect();
        assert!(draws.len() > 50 && varying.is_empty(), "of {}: {varying:?}", draws.len());
    }

    #[test]
    fn every_key_has_its_shader() {
        let tools = cfg!(feature = "headless");
        let keys: Vec<_> = ShaderKey::all().into_iter().filter(|key| tools || !key.is_for_tools()).collect();
        let ids: Vec<_> = keys.iter().map(|key| key.id().unwrap_or_else(|| panic!("{key:?}"))).collect();
        assert_eq!(ids, ShaderId::ALL);
    }

    /// What a library without features embeds.
    #[test]
    fn users_embed_few() {
        let count = ShaderKey::all().iter().filter(|key| !key.is_for_tools()).count();
        assert!(count < 210, "{count}");
    }
}
