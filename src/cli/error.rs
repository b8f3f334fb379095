//! Errors that end the program.

use std::error::Error;
use std::io::ErrorKind;
use std::process::ExitCode;

/// Why a command did not run to its end.
#[derive(Debug)]
pub(super) enum CliError {
    /// The arguments make no sense.
    Usage(String),
    /// They do, but the work could not be done.
    Work(String),
    /// Help or version was asked for, and printed.
    Help,
    /// The reader of standard output has gone, as `head` does: nothing to complain about.
    BrokenPipe,
}

impl CliError {
    /// Prints help, or makes an error of one line out of clap's several.
    pub(super) fn from_clap(error: clap::Error) -> Self {
        use clap::error::ErrorKind as Kind;
        if matches!(error.kind(), Kind::DisplayHelp | Kind::DisplayVersion) {
            let _ = error.print();
            return Self::Help;
        }
        if error.kind() == Kind::DisplayHelpOnMissingArgumentOrSubcommand {
            return Self::Usage("no command is given: try 'subdiv --help'".into());
        }
        let text = error.to_string();
        let lines = text.lines().map(str::trim);
        let lines: Vec<&str> = lines
            .take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more information"))
            .filter(|line| !line.is_empty())
            .collect();
        let line = lines.join(" ");
        Self::Usage(line.strip_prefix("error: ").unwrap_or(&line).to_owned())
    }

    /// Message for the user, on one line.
    pub(super) fn message(&self) -> Option<String> {
        match self {
            Self::Usage(message) | Self::Work(message) => Some(message.replace('\n', " ")),
            Self::Help | Self::BrokenPipe => None,
        }
    }

    pub(super) fn exit_code(&self) -> ExitCode {
        match self {
            Self::Usage(_) => ExitCode::from(2),
            Self::Work(_) => ExitCode::from(1),
            Self::Help | Self::BrokenPipe => ExitCode::SUCCESS,
        }
    }
}

impl<E: Error + 'static> From<E> for CliError {
    fn from(error: E) -> Self {
        let any: &(dyn Error + 'static) = &error;
        let kind = any
            .downcast_ref::<std::io::Error>()
            .map(std::io::Error::kind)
            .or_else(|| any.downcast_ref::<serde_json::Error>().and_then(serde_json::Error::io_error_kind));
        match kind {
            Some(ErrorKind::BrokenPipe) => Self::BrokenPipe,
            _ => Self::Work(error.to_string()),
        }
    }
}
