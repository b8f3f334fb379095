//! What frame debuggers call the pipelines of patches.

use super::cut::Cut;
use super::key::PatchStages;
use crate::gpu::Spacing;
use crate::table::Sharing;
use crate::topology::PatchKind;

/// Such as `gregory irregular quads, two-stage, tessellation`, and what is not as always.
pub(crate) fn patches(stages: PatchStages, cut: Cut) -> String {
    let PatchStages { scheme, kind, construction, evaluation, spacing, sharing, .. } = stages;
    let kind = match kind {
        PatchKind::Regular => "regular quads",
        PatchKind::IrregularQuad => "irregular quads",
        PatchKind::Triangle => "triangles",
        PatchKind::Pentagon => "pentagons",
    };
    let flag = |set, word| if set { word } else { "" };
    let more = [
        match spacing {
            Spacing::Equal => "",
            fractional => fractional.name(),
        },
        match sharing {
            Sharing::Positions => "",
            Sharing::Normals => "shared normals",
            Sharing::Displacement => "displaced",
        },
        flag(stages.has_foreign_owners, "foreign owners"),
        flag(stages.edge_factors, "factors of edges"),
        flag(stages.attributes, "attributes"),
        flag(stages.adaptive.is_some(), "adaptive"),
        flag(stages.is_by_leaves(), "by leaves"),
    ];
    let mut name = format!("{} {kind}, {}, {}", scheme.name(), construction.name(), evaluation.name());
    for word in more.into_iter().chain(cut.words()).filter(|word| !word.is_empty()) {
        name += ", ";
        name += word;
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::patch::Scheme;
    use crate::renderer::{Construction, Cull, Evaluation, Factor};

    #[test]
    fn pipelines_are_told_apart_in_few_words() {
        let stages = PatchStages {
            scheme: Scheme::Gregory,
            kind: PatchKind::IrregularQuad,
            construction: Construction::Cached,
            evaluation: Evaluation::Tessellation,
            spacing: Spacing::Equal,
            sharing: Sharing::Positions,
            has_foreign_owners: false,
            edge_factors: false,
            stride: 4,
            attributes: false,
            adaptive: None,
        };
        assert_eq!(patches(stages, Cut::default()), "gregory irregular quads, cached, tessellation");
        assert_eq!(
            patches(
                PatchStages { spacing: Spacing::FractionalOdd, sharing: Sharing::Normals, ..stages },
                Cut::new(Factor::Pixels(4.0), Cull::ALL)
            ),
            "gregory irregular quads, cached, tessellation, odd, shared normals, pixels, cull frustum, cull back, \
             cull small"
        );
        assert!(patches(stages, Cut::listed(Factor::Uniform(4.0))).ends_with("tessellation, listed"));
    }
}
