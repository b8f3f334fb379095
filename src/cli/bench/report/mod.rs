//! The report: one page that needs nothing but itself, and the numbers beside it.

mod figures;
mod page;
mod plots;
mod thumbnail;

pub(super) use thumbnail::thumbnail;

use super::super::error::CliError;
use super::super::output::Part;
use super::columns::write_csv;
use super::results::Results;
use std::path::{Path, PathBuf};

/// Makes sure, before anything is measured, that the report can be written.
pub(super) fn prepare(folder: &Path) -> Result<(), CliError> {
    paths(folder).iter().try_for_each(|path| write_part(path, b"").map(drop))
}

/// Writes `results.json`, `results.csv` and `index.html`, each whole, and none before all could be written.
pub(super) fn write(folder: &Path, results: &Results) -> Result<(), CliError> {
    let mut csv = Vec::new();
    write_csv(results, &mut csv)?;
    let json = serde_json::to_string_pretty(results)?;
    let page = page::page(results, &csv, &json)?;
    let paths = paths(folder);
    let all = paths.iter().zip([json.as_bytes(), &csv, page.as_bytes()]);
    let parts = all.map(|(path, bytes)| write_part(path, bytes)).collect::<Result<Vec<_>, _>>()?;
    parts.into_iter().try_for_each(Part::keep)
}

fn paths(folder: &Path) -> [PathBuf; 3] {
    ["results.json", "results.csv", "index.html"].map(|name| folder.join(name))
}

fn write_part<'p>(path: &'p Path, bytes: &[u8]) -> Result<Part<'p>, CliError> {
    Part::write(path, |part| std::fs::write(part, bytes).map_err(|e| e.to_string()))
}
