//! Long work: without the interpreter's lock, told step by step, and stopped by Ctrl-C.

use crate::errors::raised;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use recon_cli::{Failure, Watch, unless_stopped};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

/// How long Ctrl-C waits at most before it is looked at.
const PATIENCE: Duration = Duration::from_millis(50);

enum News<T> {
    Step(&'static str),
    Done(Result<T, Failure>),
}

/// Runs `work` on a thread of its own while others may hold the interpreter; `progress` is called with the name of each step.
///
/// Ctrl-C, or an exception of `progress`, ends the call at once and the work soon after.
pub(crate) fn unlocked<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(Option<Watch>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let (to, from) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let (tell, stopped) = (to.clone(), Arc::clone(&stop));
    let watch = progress.is_some().then(|| -> Watch {
        Box::new(move |step| {
            // Whoever asked may have gone.
            let _ = tell.send(News::Step(step));
        })
    });
    let begun = thread::Builder::new().name("recon".to_owned()).spawn(move || {
        let _ = to.send(News::Done(unless_stopped(&stopped, || work(watch))));
    });
    begun.map_err(|error| PyRuntimeError::new_err(format!("no thread can be begun: {error}")))?;
    let from = std::sync::Mutex::new(from);
    loop {
        let news = py.detach(|| {
            // Only this loop takes the lock.
            let from = from.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            from.recv_timeout(PATIENCE)
        });
        let told = match news {
            Ok(News::Done(result)) => return result.map_err(raised),
            Ok(News::Step(step)) => match &progress {
                Some(progress) => progress.call1(py, (step,)).map(drop),
                None => Ok(()),
            },
            Err(RecvTimeoutError::Timeout) => py.check_signals(),
            Err(RecvTimeoutError::Disconnected) => Err(PyRuntimeError::new_err(
                "recon failed by a fault of its own, which the standard error tells",
            )),
        };
        if let Err(error) = told {
            stop.store(true, Relaxed);
            return Err(error);
        }
    }
}
