//! `subdiv bench`: how long everything takes.
//!
//! | file | holds |
//! |---|---|
//! | `args`, `together` | arguments, and which go together |
//! | `meshes` | what is drawn |
//! | `measuring` | the measurement |
//! | `results`, `row`, `facts` | results, and the facts about them, as they are written and read |
//! | `findings` | findings over several rows |
//! | `text` | all of it as tables |
//! | `recorded` | times to record a frame on the host |
//! | `presets` | measurements of papers |
//! | `compare`, `change` | against results of another day |
//! | `report` | the same as one page, with plots |

mod args;
mod change;
mod compare;
mod facts;
mod findings;
mod measuring;
mod meshes;
mod presets;
mod recorded;
mod report;
mod results;
mod row;
mod text;
mod together;

use super::error::CliError;
use super::output;
pub(super) use args::BenchArgs;
use findings::Findings;
use results::Results;

pub(super) fn run(args: &BenchArgs, json: bool) -> Result<(), CliError> {
    let old = args.compare.as_deref().map(Results::read).transpose()?;
    let mut results = match &args.results {
        Some(path) => Results::read(path)?,
        None => args.measure(old.as_ref(), !json && !args.csv)?,
    };
    if let Some(preset) = args.preset {
        results.published = preset.beside(&results.rows, &results.meshes, &results.options);
        results.preset = Some(preset.about(&results.published));
    }
    results.findings = Findings::of(&results.rows, &results.meshes);
    results.changes = old.map(|old| compare::changes(&old, &results)).transpose()?;
    if let Some(folder) = &args.report {
        args.prepare_report(folder)?.write(&results)?;
    }
    if json {
        return output::json_pretty(&results);
    }
    if args.csv {
        return output::with_stdout(|out| results.write_csv(out));
    }
    if args.results.is_some() {
        text::rows(&results.rows)?;
    }
    text::recording(&results.recording)?;
    text::findings(&results.findings)?;
    text::published(results.preset.as_ref(), &results.published)?;
    results.changes.as_deref().map_or(Ok(()), text::changes)
}

/// Values that occur, each once, in the order in which they first appear.
fn unique<'a, A, T: PartialEq>(all: &'a [A], of: impl Fn(&'a A) -> T) -> Vec<T> {
    let mut once = Vec::new();
    all.iter().map(of).for_each(|one| {
        if !once.contains(&one) {
            once.push(one);
        }
    });
    once
}
