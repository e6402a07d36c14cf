//! Ctrl-C, SIGTERM and SIGHUP: while computing they end the program at once, while writing they are an error, so that
//! what was begun is removed again.

use crate::error::CliError;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};

static ASKED: AtomicBool = AtomicBool::new(false);
/// Threads that are writing.
static WRITING: AtomicUsize = AtomicUsize::new(0);

/// Begins to listen.
pub(crate) fn install() -> Result<(), CliError> {
    ctrlc::set_handler(|| {
        ASKED.store(true, SeqCst);
        // Writing is announced before `ASKED` is read (below), and `ASKED` is set before `WRITING` is read (here):
        // one of the two sides sees the other.
        end_unless_writing();
    })
    .map_err(CliError::Signals)
}

/// Ends the program, unless a thread of it is writing.
fn end_unless_writing() {
    if WRITING.load(SeqCst) == 0 {
        let _ = writeln!(io::stderr(), "recon: {}", CliError::Interrupted);
        std::process::exit(130);
    }
}

/// Whether the user has asked to stop; ends the program then, unless another thread of it is writing.
pub(crate) fn asked() -> bool {
    let asked = ASKED.load(SeqCst);
    if asked {
        end_unless_writing();
    }
    asked
}

/// Runs `write`, which must check for interruption ([`Checked`], [`check`]) and clean up when it fails.
pub(crate) fn while_writing<T>(write: impl FnOnce() -> Result<T, CliError>) -> Result<T, CliError> {
    WRITING.fetch_add(1, SeqCst);
    let result = check().and_then(|()| write());
    WRITING.fetch_sub(1, SeqCst);
    // Whatever error an interruption shows up as, it is one.
    if result.is_err() {
        check()?
    }
    result
}

/// An error once the user has asked to stop.
pub(crate) fn check() -> Result<(), CliError> {
    if ASKED.load(SeqCst) { Err(CliError::Interrupted) } else { Ok(()) }
}

/// A writer that fails once the user has asked to stop.
pub(crate) struct Checked<W>(pub(crate) W);

impl<W: Write> Write for Checked<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        // Not `ErrorKind::Interrupted`, after which writers try again.
        check().map_err(io::Error::other)?;
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}
