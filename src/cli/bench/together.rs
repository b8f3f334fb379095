//! Combinations: notes on what is asked for and cannot be measured.

use super::super::error::CliError;
use super::args::BenchArgs;
use super::unique;
use ash_subdiv::Scheme;
use ash_subdiv::bench::{Contestant, Normals, Path};
use ash_subdiv::renderer::{Cull, Evaluation};

const SHARED_NORMALS: &str = "shared normals go with watertight schemes (gregory, gregory-fitted), and without tessellation with cached, but not with geometry-two-pass";
const CULLED: &str = "it is for the paths tessellation and, by compute, instanced";

/// Rule of a path: the schemes and constructions it goes with, if not all.
fn rule(path: Path) -> Option<String> {
    let schemes = Some(path.schemes()).filter(|&schemes| schemes != Scheme::ALL).unwrap_or_default();
    let constructions = path.constructions().iter().map(|construction| construction.name());
    let names: Vec<_> = schemes.iter().map(|scheme| scheme.name()).chain(constructions).collect();
    (!names.is_empty()).then(|| format!("{} goes with {}", path.name(), names.join(" and ")))
}

impl BenchArgs {
    /// Rules of the paths that are asked for, and of shared normals, if they are.
    fn rules(&self) -> Vec<String> {
        let mut rules: Vec<String> = unique(&self.paths, |&path| path).into_iter().filter_map(rule).collect();
        if self.normals.contains(&Normals::Shared) {
            rules.push(SHARED_NORMALS.into());
        }
        rules
    }

    /// Error where nothing of what is asked for goes together.
    pub(super) fn no_contestants(&self) -> CliError {
        let message = "none of --paths, --constructions, --schemes and --normals go together";
        let preset = self.preset.map(|preset| format!("the preset is of {}", preset.about_patches()));
        CliError::Usage(format!("{message}: {}", self.rules().into_iter().chain(preset).collect::<Vec<_>>().join("; ")))
    }

    /// Notes on what is asked for and none of the contestants has.
    pub(super) fn in_vain(&self, contestants: &[Contestant]) -> Vec<String> {
        let mut notes = Vec::new();
        // Without shared normals there may be some that have it.
        let plain = self.plain_contestants();
        let has = |all: &[Contestant], is: &dyn Fn(&Contestant) -> bool| all.iter().any(is);
        let mut left_out = |name: &str, rule: String, is: &dyn Fn(&Contestant) -> bool| match has(&plain, is) {
            _ if has(contestants, is) => {}
            true => notes.push(format!("{name} is left out: {SHARED_NORMALS}")),
            false => notes.push(format!("{name} is left out: {rule}")),
        };
        for path in unique(&self.paths, |&path| path) {
            left_out(path.name(), rule(path).unwrap_or_default(), &|one| one.path == path);
        }
        let none = || "none of --paths goes with it".to_owned();
        for scheme in unique(&self.schemes, |&scheme| scheme) {
            left_out(scheme.name(), none(), &|one| one.patches.is_some_and(|(other, _)| other == scheme));
        }
        for how in unique(&self.constructions, |&how| how) {
            left_out(how.name(), none(), &|one| one.patches.is_some_and(|(_, other)| other == how));
        }
        if self.recording.is_some() {
            for path in unique(&self.paths, |&path| path).into_iter().filter(|path| !path.is_recorded()) {
                notes.push(format!("{} is left out: the renderer alone does not record it", path.name()));
            }
        }
        let drawn = |path| has(contestants, &|one| one.path == path);
        let culled = |path| contestants.iter().any(|one| one.path == path && one.cull != Cull::NONE);
        if !self.cull.is_empty() {
            if contestants.iter().all(|contestant| contestant.cull == Cull::NONE) {
                notes.push(format!("--cull changes nothing here: {CULLED}"));
            } else {
                let could =
                    |path: &Path| path.evaluation().is_some_and(Evaluation::culls) && drawn(*path) && !culled(*path);
                for path in unique(&self.paths, |&path| path).iter().filter(|path| could(path)) {
                    notes.push(format!("--cull changes nothing of {}: {CULLED}", path.name()));
                }
            }
        }
        let shared = Normals::Shared;
        if self.normals.contains(&shared) && contestants.iter().all(|contestant| contestant.normals != shared) {
            notes.push(format!("--normals shared changes nothing here: {SHARED_NORMALS}"));
        }
        notes
    }
}
