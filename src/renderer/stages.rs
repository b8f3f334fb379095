//! Which shaders a patch is drawn with: found by name, so that a scheme adds files and its arm in [`files`].

use super::{Capture, Construction};
use crate::gpu::{GpuError, Spacing, shaders};
use crate::patch::Scheme;
use crate::topology::PatchKind;

/// What tells the tessellation stages of a patch apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct PatchStages {
    pub scheme: Scheme,
    pub kind: PatchKind,
    pub construction: Construction,
    pub spacing: Spacing,
}

/// The files `glsl/construct/_.tesc` and `glsl/evaluate/_.tese` of a kind of patch.
fn files(scheme: Scheme, kind: PatchKind) -> [&'static str; 2] {
    match (kind, scheme) {
        (PatchKind::Regular, _) => ["REGULAR", "BICUBIC"],
        (PatchKind::IrregularQuad, Scheme::Gregory) => ["GREGORY", "GREGORY_QUAD"],
        (PatchKind::Triangle, Scheme::Gregory) => ["GREGORY", "GREGORY_TRIANGLE"],
        (_, Scheme::Acc) => ["ACC", "ACC"],
        (PatchKind::IrregularQuad, Scheme::Pm | Scheme::CPatch) => ["PM", "PM_QUAD"],
        (PatchKind::Triangle, Scheme::Pm | Scheme::CPatch) => ["PM", "PM_TRIANGLE"],
    }
}

impl PatchStages {
    /// Control points that go into the control shader: one a corner, or one a patch that only says which patch it is.
    pub(super) fn input_points(self) -> u32 {
        match self.construction {
            Construction::TwoStage => self.kind.corners() as u32,
            Construction::Stencil | Construction::Cached => 1,
        }
    }

    pub(super) fn control(self, capture: Capture, texcoords: bool) -> Result<&'static [u32], GpuError> {
        let [file, _] = files(self.scheme, self.kind);
        let mut name = match self.construction {
            Construction::TwoStage => format!("CONSTRUCT_{file}_TESC"),
            Construction::Stencil => format!("CONSTRUCT_STENCIL_TESC_OWNED_{}", self.scheme.owned(self.kind)),
            Construction::Cached => format!("CONSTRUCT_CACHED_TESC_OWNED_{}", self.scheme.owned(self.kind)),
        };
        if self.kind == PatchKind::Triangle {
            name += "_TRIANGLE";
        }
        name += match capture {
            Capture::Points => "_CAPTURE_POINTS",
            Capture::Vertices | Capture::Grid => "_CAPTURE",
            Capture::Off if texcoords => "_TEXCOORD",
            Capture::Off => "",
        };
        find(&name)
    }

    pub(super) fn evaluation(self, capture: Capture, texcoords: bool) -> Result<&'static [u32], GpuError> {
        let [_, file] = files(self.scheme, self.kind);
        let mut name = format!("EVALUATE_{file}_TESE");
        if capture != Capture::Grid {
            name += match self.spacing {
                Spacing::Equal => "",
                Spacing::FractionalOdd => "_FRACTIONAL_ODD",
                Spacing::FractionalEven => "_FRACTIONAL_EVEN",
            };
        }
        name += match capture {
            Capture::Grid => "_CAPTURE_GRID",
            Capture::Vertices => "_CAPTURE",
            Capture::Off if texcoords => "_TEXCOORD",
            Capture::Off | Capture::Points => "",
        };
        find(&name)
    }
}

fn find(name: &str) -> Result<&'static [u32], GpuError> {
    let missing = || GpuError::BadPipeline { object: name.to_owned(), message: "there is no such shader".to_owned() };
    shaders::find(name).ok_or_else(missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_patch_has_its_shaders() {
        for scheme in Scheme::ALL {
            for kind in PatchKind::ALL {
                if matches!(scheme, Scheme::Acc | Scheme::CPatch) && kind == PatchKind::Triangle {
                    continue;
                }
                for construction in Construction::ALL {
                    for spacing in [Spacing::Equal, Spacing::FractionalOdd, Spacing::FractionalEven] {
                        let stages = PatchStages { scheme, kind, construction, spacing };
                        for (capture, texcoords) in [
                            (Capture::Off, false),
                            (Capture::Off, true),
                            (Capture::Points, false),
                            (Capture::Vertices, false),
                            (Capture::Grid, false),
                        ] {
                            assert!(!stages.control(capture, texcoords).unwrap().is_empty());
                            assert!(!stages.evaluation(capture, texcoords).unwrap().is_empty());
                        }
                    }
                }
            }
        }
    }
}
