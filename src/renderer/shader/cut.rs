//! What tells the draws of a patch apart besides its shaders.

use crate::constants::{CULL_BACK_FLAG, CULL_FRUSTUM_FLAG, CULL_SMALL_FLAG};
use crate::renderer::options::{Cull, Factor};

/// How the patches of a draw are cut and which of them are drawn: each way has pipelines of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(crate) struct Cut {
    metric: u32,
    /// Those that the control shader culls.
    cull: Cull,
    /// Whether only those on a list are drawn.
    listed: bool,
    /// Whether draws are of instances of an item.
    instances: bool,
}

impl Cut {
    pub(crate) fn new(factor: Factor, cull: Cull) -> Self {
        Self { metric: factor.metric(), cull, listed: false, instances: false }
    }

    /// For draws of the patches on a list.
    pub(crate) fn listed(factor: Factor) -> Self {
        Self { listed: true, ..Self::new(factor, Cull::NONE) }
    }

    /// The same for draws of instances, or of an item once.
    pub(crate) fn of_instances(self, instances: bool) -> Self {
        Self { instances, ..self }
    }

    pub(crate) fn has_instances(self) -> bool {
        self.instances
    }

    pub(crate) fn is_listed(self) -> bool {
        self.listed
    }

    /// Of draws where nothing is left for a control shader to do.
    pub(crate) fn without_control(self) -> Self {
        Self { listed: self.listed, instances: self.instances, ..Self::default() }
    }

    /// Of faces that are refined: neither hulls nor the control points of leaves tell which way they face.
    pub(crate) fn of_refined(self) -> Self {
        Self { cull: Cull { back: false, ..self.cull }, ..self }
    }

    /// GLSL twin: `DRAW_FLAGS` in `glsl/lib/edges/factors.glsl`.
    pub(crate) fn flags(self, has_hull: bool) -> u32 {
        let Cull { frustum, back, small } = if has_hull { self.cull } else { Cull::NONE };
        let flag = |set, flag| if set { flag } else { 0 };
        self.metric | flag(frustum, CULL_FRUSTUM_FLAG) | flag(back, CULL_BACK_FLAG) | flag(small, CULL_SMALL_FLAG)
    }

    /// What is not as in draws with a uniform factor of all patches; else empty.
    pub(crate) fn words(self) -> [&'static str; 6] {
        let metric = match self.metric {
            0 => "",
            1 => "pixels",
            2 => "curvature",
            _ => "edges",
        };
        let Cull { frustum, back, small } = self.cull;
        let flag = |set, word| if set { word } else { "" };
        [
            metric,
            flag(frustum, "cull frustum"),
            flag(back, "cull back"),
            flag(small, "cull small"),
            flag(self.listed, "listed"),
            flag(self.instances, "instances"),
        ]
    }
}
