//! The report: one page that needs nothing but itself, and the numbers beside it.

mod figures;
mod front;
mod page;
mod plots;
mod thumbnail;

pub(super) use thumbnail::thumbnail;

use super::super::error::CliError;
use super::super::output::Part;
use super::results::Results;
use std::path::{Path, PathBuf};

/// The folder of a report. Folders that were made for it are taken away again if nothing is written.
pub(super) struct Folder<'f> {
    folder: &'f Path,
    /// The innermost first.
    made: Vec<&'f Path>,
}

impl<'f> Folder<'f> {
    /// Makes sure, before anything is measured, that the report can be written, and that it takes the place of nothing but a
    /// report, and not of what it is compared with.
    pub(super) fn prepare(folder: &'f Path, compared: Option<&Path>) -> Result<Self, CliError> {
        let failed = |path: &Path, why: &str| Err(CliError::Work(format!("{}: {why}", path.display())));
        if folder.exists() && !folder.is_dir() {
            return failed(folder, "this is no folder: name one for the report");
        }
        let files = paths(folder);
        let [results, ..] = &files;
        let is_report = || files.iter().all(|path| path.is_file()) && Results::read(results).is_ok();
        if let Some(there) = files.iter().find(|path| path.is_file()).filter(|_| !is_report()) {
            return failed(there, "this is there already, and is not of a report: name another folder");
        }
        let is_same = |other: &Path| Some(results.canonicalize().ok()? == other.canonicalize().ok()?);
        if compared.is_some_and(|compared| is_same(compared) == Some(true)) {
            return failed(results, "the report would take the place of what it is compared with: name another folder");
        }
        let made = folder.ancestors().take_while(|path| !path.as_os_str().is_empty() && !path.exists()).collect();
        let prepared = Self { folder, made };
        files.iter().try_for_each(|path| write_part(path, b"").map(drop))?;
        Ok(prepared)
    }

    /// Writes `results.json`, `results.csv` and `index.html`, each whole, and none before all could be written.
    pub(super) fn write(self, results: &Results) -> Result<(), CliError> {
        let mut csv = Vec::new();
        results.write_csv(&mut csv)?;
        let json = serde_json::to_string_pretty(results)?;
        let page = page::page(results, &csv, &json)?;
        let paths = paths(self.folder);
        let all = paths.iter().zip([json.as_bytes(), &csv, page.as_bytes()]);
        let parts = all.map(|(path, bytes)| write_part(path, bytes)).collect::<Result<Vec<_>, _>>()?;
        parts.into_iter().try_for_each(Part::keep)
    }
}

impl Drop for Folder<'_> {
    fn drop(&mut self) {
        // Those with something in them stay.
        self.made.iter().take_while(|folder| std::fs::remove_dir(folder).is_ok()).for_each(drop);
    }
}

fn paths(folder: &Path) -> [PathBuf; 3] {
    ["results.json", "results.csv", "index.html"].map(|name| folder.join(name))
}

fn write_part<'p>(path: &'p Path, bytes: &[u8]) -> Result<Part<'p>, CliError> {
    Part::write(path, |part| std::fs::write(part, bytes).map_err(|e| e.to_string()))
}
