//! The report: one page that needs nothing but itself, and the numbers beside it.

mod page;
mod plots;
mod thumbnail;

pub(super) use thumbnail::thumbnail;

use super::super::error::CliError;
use super::super::output::write_file;
use super::results::Results;
use std::path::Path;

/// Writes `index.html`, `results.json` and `results.csv`.
pub(super) fn write(folder: &Path, results: &Results) -> Result<(), CliError> {
    let mut csv = Vec::new();
    results.write_csv(&mut csv)?;
    let json = serde_json::to_string_pretty(results)?;
    let page = page::page(results, &csv, &json)?;
    for (name, bytes) in [("results.json", json.as_bytes()), ("results.csv", &csv), ("index.html", page.as_bytes())] {
        write_file(&folder.join(name), |part| std::fs::write(part, bytes).map_err(|e| e.to_string()))?;
    }
    Ok(())
}
