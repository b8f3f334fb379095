use super::super::error::CliError;
use super::results::Results;
use ash_subdiv::bench::Subject;
use ash_subdiv::headless::Headless;
use std::path::Path;
pub(super) fn thumbnail(_: &Headless, _: &Subject) -> Result<Option<String>, CliError> {
    Ok(None)
}
pub(super) fn write(_: &Path, _: &Results) -> Result<(), CliError> {
    Ok(())
}
