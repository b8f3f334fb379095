//! Output: standard output, notes, progress, files.

use super::described::{Described, columns, holds};
use super::error::CliError;
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use serde_json::Value;
use std::ffi::OsString;
use std::fmt::Display;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Writes a small value to standard output, readable.
pub(super) fn json_pretty<T: Serialize + Described>(value: &T) -> Result<(), CliError> {
    debug_assert!(serde_json::to_value(value).is_ok_and(|value| holds::<T>(&value)), "keys without description");
    with_stdout(|out| {
        serde_json::to_writer_pretty(&mut *out, value)?;
        Ok(writeln!(out)?)
    })
}

/// Writes a value to standard output as it is walked, without building it first.
pub(super) fn json(value: &impl Serialize) -> Result<(), CliError> {
    with_stdout(|out| {
        serde_json::to_writer(&mut *out, value)?;
        Ok(writeln!(out)?)
    })
}

/// Writes a line of comma-separated values for each of these: see [`columns`].
pub(super) fn csv<T: Described + Serialize>(lines: &[T], out: &mut dyn Write) -> Result<(), CliError> {
    let mut csv = csv::Writer::from_writer(out);
    let columns = columns::<T>();
    csv.write_record(columns.iter().map(|(name, _)| name))?;
    for line in lines {
        // By way of text, which has numbers of 32 bits as short as they are.
        let line: Value = serde_json::from_str(&serde_json::to_string(line)?)?;
        csv.write_record(columns.iter().map(|(_, path)| cell(path.iter().fold(&line, |value, key| &value[*key]))))?;
    }
    Ok(csv.flush()?)
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => text.clone(),
        // Whole numbers have no point.
        Value::Number(number) => {
            number.as_f64().filter(|_| number.is_f64()).map_or(number.to_string(), |x| x.to_string())
        }
        other => other.to_string(),
    }
}

/// Writes to standard output.
pub(super) fn with_stdout(write: impl FnOnce(&mut dyn Write) -> Result<(), CliError>) -> Result<(), CliError> {
    let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
    write(&mut out)?;
    Ok(out.flush()?)
}

/// Reports something that is not asked for but good to know.
pub(super) fn note(message: impl Display) {
    // Where standard error is closed there is nobody to tell.
    let _ = writeln!(io::stderr(), "note: {message}");
}

/// Rows of text whose columns stand under each other.
pub(super) struct Table {
    rows: Vec<Vec<String>>,
    /// Columns of numbers, which stand at the right.
    right: &'static [usize],
}

impl Table {
    pub(super) fn new(right: &'static [usize]) -> Self {
        Self { rows: Vec::new(), right }
    }

    pub(super) fn row<const N: usize>(&mut self, cells: [&dyn Display; N]) {
        self.rows.push(cells.map(|cell| cell.to_string()).into());
    }

    /// Writes the rows to standard output.
    pub(super) fn print(&self) -> Result<(), CliError> {
        let columns = self.rows.iter().map(Vec::len).max().unwrap_or(0);
        let width =
            |column: usize| self.rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max();
        let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
        with_stdout(|out| {
            for row in &self.rows {
                let mut line = String::new();
                for (column, cell) in row.iter().enumerate() {
                    let width = widths[column];
                    line += &match self.right.contains(&column) {
                        true => format!("{cell:>width$}  "),
                        false => format!("{cell:<width$}  "),
                    };
                }
                writeln!(out, "{}", line.trim_end())?;
            }
            Ok(())
        })
    }
}

/// What a bar shows.
const BAR: &str = "{msg} {wide_bar} {elapsed}, {eta} left";

/// Shows on a terminal that something is going on, until dropped.
pub(super) struct Progress(ProgressBar);

impl Progress {
    /// Nothing is shown where standard error is no terminal.
    pub(super) fn new(what: &'static str) -> Self {
        let bar = ProgressBar::new_spinner().with_message(what);
        if let Ok(style) = ProgressStyle::with_template("{spinner} {msg} {elapsed}") {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(120));
        Self(bar)
    }

    /// A bar that fills with `steps` steps of [`Progress::advance`], and says how long the rest will take.
    pub(super) fn bar(what: &'static str, steps: u64) -> Self {
        let bar = ProgressBar::new(steps).with_message(what);
        if let Ok(style) = ProgressStyle::with_template(BAR) {
            bar.set_style(style);
        }
        bar.enable_steady_tick(Duration::from_millis(500));
        Self(bar)
    }

    /// From now on a bar, as [`Progress::bar`] has it.
    pub(super) fn fill(&self, what: &'static str, steps: u64) {
        if let Ok(style) = ProgressStyle::with_template(BAR) {
            self.0.set_style(style);
        }
        self.0.set_length(steps);
        self.0.set_position(0);
        self.0.set_message(what);
    }

    /// Further steps are done.
    pub(super) fn advance(&self, steps: u64) {
        self.0.inc(steps);
    }

    /// Does something to the terminal without being drawn over it.
    pub(super) fn suspend<R>(&self, work: impl FnOnce() -> R) -> R {
        self.0.suspend(work)
    }

    /// Work that is going on now.
    pub(super) fn now(&self, what: &'static str) {
        self.0.set_message(what);
    }

    /// Writes a note without being drawn over it.
    pub(super) fn note(&self, message: impl Display) {
        self.0.suspend(|| note(message));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.0.finish_and_clear();
    }
}

/// A file that was written beside its place, so that nobody finds half of it there. Taken away again if it is dropped.
pub(super) struct Part<'a> {
    path: &'a Path,
    part: PathBuf,
}

impl<'a> Part<'a> {
    /// Makes missing folders. `write` says what went wrong without naming the file.
    pub(super) fn write(path: &'a Path, write: impl FnOnce(&Path) -> Result<(), String>) -> Result<Self, CliError> {
        let Some(name) = path.file_name().filter(|_| !path.is_dir()) else {
            return Err(about(path, "this is a folder: name a file"));
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|e| about(path, format!("its folder can't be made: {e}")))?;
        }
        let mut hidden = OsString::from(".");
        hidden.push(name);
        hidden.push(format!(".{}.part", std::process::id()));
        let part = Self { path, part: path.with_file_name(hidden) };
        write(&part.part).map_err(|message| about(path, message))?;
        Ok(part)
    }

    /// Puts it in its place.
    pub(super) fn keep(self) -> Result<(), CliError> {
        std::fs::rename(&self.part, self.path).map_err(|e| about(self.path, e))
    }
}

impl Drop for Part<'_> {
    fn drop(&mut self) {
        // After it was kept there is nothing to take away.
        let _ = std::fs::remove_file(&self.part);
    }
}

fn about(path: &Path, message: impl Display) -> CliError {
    CliError::Work(format!("{}: {message}", path.display()))
}

/// Writes a file, whole or not at all: see [`Part`].
pub(super) fn write_file(path: &Path, write: impl FnOnce(&Path) -> Result<(), String>) -> Result<(), CliError> {
    Part::write(path, write)?.keep()
}

/// A number for people, of at most four digits.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.3e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let digits = digits.trim_end_matches('0').trim_end_matches('.');
    match exponent.parse() {
        Ok(-3..=3) => format!("{}", format!("{digits}e{exponent}").parse().unwrap_or(value)),
        _ => format!("{digits}e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (0.0015, "0.0015"),
            (0.00075, "7.5e-4"),
            (2.0 / 3.0 * 1e-5, "6.667e-6"),
            (0.25, "0.25"),
            (1234.5, "1234"),
            (0.1 + 0.2, "0.3"),
            (4e6, "4e6"),
        ] {
            assert_eq!(short(value), text);
        }
    }
}
