//! The forms of patches, over all schemes: one for each kind of face that a scheme has patches for. Compiled into `build.rs`, too: an
//! axis along which shaders vary.

use crate::named::named;

named! {
    /// The form of a patch. A scheme registers one for each kind of face that it has; regular faces are bicubic in every scheme.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
    pub enum PatchForm {
        Bicubic = "bicubic",
        GregoryQuad = "gregory-quad",
        GregoryTriangle = "gregory-triangle",
        AccQuad = "acc-quad",
        PmQuad = "pm-quad",
        PmTriangle = "pm-triangle",
        PmPentagon = "pm-pentagon",
    }
}

/// What sets a form of patches apart, and what its shaders are compiled with.
pub struct FormFacts {
    /// The folder below `glsl/schemes`.
    pub scheme: &'static str,
    pub corners: usize,
    /// Control points that each corner owns.
    pub owned: usize,
    /// How many of those enclose the patch, with those of the other corners: what culling looks at; 0 if they need not.
    pub hull: usize,
    /// Whether corners keep points as seen from their limit points, which they share with their neighbours: such patches are
    /// watertight.
    pub keeps_frame: bool,
    /// Whether a corner has two inner points, one for each of its edges.
    pub two_face_points: bool,
    /// Whether faces may be refined, with such patches for end caps: then leaves are evaluated.
    pub may_be_adaptive: bool,
}

impl PatchForm {
    /// The registration.
    pub const fn facts(self) -> FormFacts {
        let quad = FormFacts {
            scheme: "bicubic",
            corners: 4,
            owned: 4,
            hull: 4,
            keeps_frame: true,
            two_face_points: false,
            may_be_adaptive: false,
        };
        let gregory =
            FormFacts { scheme: "gregory", owned: 5, hull: 5, two_face_points: true, may_be_adaptive: true, ..quad };
        let pm = FormFacts { scheme: "pm", owned: 6, hull: 0, keeps_frame: false, ..quad };
        match self {
            Self::Bicubic => quad,
            Self::GregoryQuad => gregory,
            Self::GregoryTriangle => FormFacts { corners: 3, ..gregory },
            Self::AccQuad => FormFacts { scheme: "acc", owned: 8, keeps_frame: false, ..quad },
            Self::PmQuad => pm,
            Self::PmTriangle => FormFacts { corners: 3, ..pm },
            Self::PmPentagon => FormFacts { corners: 5, ..pm },
        }
    }

    /// The first form of the same scheme.
    pub fn of_scheme(self) -> Self {
        let scheme = self.facts().scheme;
        Self::ALL.into_iter().find(|form| form.facts().scheme == scheme).unwrap_or(self)
    }
}
