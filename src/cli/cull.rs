//! Patches to cull.

use ash_subdiv::renderer::Cull;
use clap::{Args, ValueEnum};

#[derive(Debug, Args)]
pub(super) struct CullArgs {
    /// Cull patches that are not seen: `back` those that face away, `frustum` those out of the picture, `small` those
    /// between pixels (with one sample a pixel).
    #[arg(long, value_name = "WHICH", value_delimiter = ',', value_enum)]
    cull: Vec<CullArg>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CullArg {
    Back,
    Frustum,
    Small,
}

impl CullArgs {
    pub(super) fn cull(&self) -> Cull {
        cull(&self.cull)
    }
}

/// These together.
pub(super) fn cull(which: &[CullArg]) -> Cull {
    let has = |one| which.contains(&one);
    Cull { frustum: has(CullArg::Frustum), back: has(CullArg::Back), small: has(CullArg::Small) }
}

/// As the argument is given, with `+` between; `none` for none.
pub(super) fn name(cull: Cull) -> String {
    let named = [(cull.back, "back"), (cull.frustum, "frustum"), (cull.small, "small")];
    let names: Vec<&str> = named.into_iter().filter(|(on, _)| *on).map(|(_, name)| name).collect();
    if names.is_empty() { "none".to_owned() } else { names.join("+") }
}
