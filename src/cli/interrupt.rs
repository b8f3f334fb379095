//! Ctrl-C while a file is being written: what is written so far is taken away.

use super::error::CliError;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

#[cfg(all(target_os = "linux", target_env = "gnu"))]
const SIGNALS: [libc::c_int; 3] = [libc::SIGINT, libc::SIGTERM, libc::SIGHUP];

/// The watches that there are.
static WATCHES: AtomicUsize = AtomicUsize::new(0);

/// While it lives, signals that ask the program to end make [`Interruptible`] fail instead. The same signal once more ends it. A watch
/// within another changes nothing.
pub(super) struct Watch(());

impl Watch {
    pub(super) fn start() -> Self {
        if WATCHES.fetch_add(1, Ordering::Relaxed) > 0 {
            return Self(());
        }
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        for signal in SIGNALS {
            extern "C" fn note(signal: libc::c_int) {
                INTERRUPTED.store(true, Ordering::Relaxed);
                // SAFETY: may be called by handlers.
                unsafe { libc::signal(signal, libc::SIG_DFL) };
            }
            let handler: extern "C" fn(libc::c_int) = note;
            // SAFETY: the handler does nothing but what handlers may do.
            let before = unsafe { libc::signal(signal, handler as libc::sighandler_t) };
            if before == libc::SIG_IGN {
                // SAFETY: as nohup wants it.
                unsafe { libc::signal(signal, libc::SIG_IGN) };
            }
        }
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        // SAFETY: what goes beyond a limit on file sizes then fails to be written, and does not end the program.
        unsafe {
            libc::signal(libc::SIGXFSZ, libc::SIG_IGN)
        };
        Self(())
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if WATCHES.fetch_sub(1, Ordering::Relaxed) > 1 {
            return;
        }
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        for signal in SIGNALS {
            // SAFETY: nothing but a query, and the default of what is not ignored.
            unsafe {
                if libc::signal(signal, libc::SIG_DFL) == libc::SIG_IGN {
                    libc::signal(signal, libc::SIG_IGN);
                }
            }
        }
    }
}

/// Whether the program is asked to end, while there is a [`Watch`].
pub(super) fn is_interrupted() -> bool {
    INTERRUPTED.load(Ordering::Relaxed)
}

/// Fails if the program is asked to end, after some of all frames.
pub(super) fn check_frames(written: usize, all: usize) -> Result<(), CliError> {
    match is_interrupted() {
        true => Err(CliError::Work(format!("interrupted: {written} of {all} frames are written"))),
        false => Ok(()),
    }
}

/// Writes until the program is asked to end.
pub(super) struct Interruptible<W>(pub W);

impl<W: Write> Write for Interruptible<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if is_interrupted() {
            return Err(io::Error::other("interrupted: nothing is written"));
        }
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
