//! Long work: without the interpreter's lock, told step by step, and stopped by Ctrl-C.

use crate::errors::raised;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use recon_cli::{Failure, Watch};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
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
/// Ctrl-C, or an exception of `progress`, ends the call at once; the thread ends at its next step, and nobody hears of it.
pub(crate) fn unlocked<T: Send + 'static>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(Option<Watch>) -> Result<T, Failure> + Send + 'static,
) -> PyResult<T> {
    let (to, from) = channel();
    let stop = Arc::new(AtomicBool::new(false));
    let watch = watch(to.clone(), Arc::clone(&stop), progress.is_some());
    let begun = thread::Builder::new().name("recon".to_owned()).spawn(move || {
        // Whoever asked may have gone.
        let _ = to.send(News::Done(work(Some(watch))));
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

fn watch<T: Send + 'static>(to: Sender<News<T>>, stop: Arc<AtomicBool>, tell: bool) -> Watch {
    Box::new(move |step| {
        if tell {
            let _ = to.send(News::Step(step));
        }
        !stop.load(Relaxed)
    })
}
