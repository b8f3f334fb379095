//! Which patches are left out.

use ash_subdiv::renderer::Cull;
use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub(super) struct CullArgs {
    /// Leave out patches that are not seen: `back` those that face away, `frustum` those out of the picture, `small` those
    /// between pixels (with one sample a pixel).
    #[arg(long, value_name = "WHICH", value_delimiter = ',', value_enum)]
    cull: Vec<CullArg>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum CullArg {
    Back,
    Frustum,
    Small,
}

impl CullArgs {
    pub(super) fn cull(&self) -> Cull {
        let has = |which| self.cull.contains(&which);
        Cull { frustum: has(CullArg::Frustum), back: has(CullArg::Back), small: has(CullArg::Small) }
    }
}
