//! Long work that another thread may end.

use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use thiserror::Error;

thread_local! {
    /// What ends the work of this thread.
    static STOP: RefCell<Option<Arc<AtomicBool>>> = const { RefCell::new(None) };
}

/// The caller wanted no more of the work.
#[derive(Clone, Copy, Debug, Eq, Error, PartialEq)]
#[error("stopped: the caller wanted no more of it")]
pub struct Stopped;

/// Puts back what ended the work of this thread before.
struct Before(Option<Arc<AtomicBool>>);

impl Drop for Before {
    fn drop(&mut self) {
        STOP.set(self.0.take());
    }
}

/// Runs `work` on this thread until it is done, or `stop` is set. Simulations and estimates of motion, whose loops ask, then end after a
/// step or two; what they gave up with is dropped.
///
/// Bounds, contact modes and planners do not ask yet: they run to their end. What work begins on threads of its own is not ended. `stop` may be set at any time and by any thread, also before.
///
/// # Errors
/// [`Stopped`] once `stop` is set, whatever became of `work`.
pub fn unless_stopped<T>(stop: &Arc<AtomicBool>, work: impl FnOnce() -> T) -> Result<T, Stopped> {
    let _before = Before(STOP.replace(Some(Arc::clone(stop))));
    let done = if is_stopped() { None } else { Some(work()) };
    if is_stopped() { Err(Stopped) } else { done.ok_or(Stopped) }
}

/// Whether the work of this thread is to end. A loop that may run long asks at each turn and leaves with any error of its own, which
/// [`unless_stopped`] replaces; that costs a few nanoseconds.
#[must_use]
pub fn is_stopped() -> bool {
    STOP.with_borrow(|stop| stop.as_ref().is_some_and(|stop| stop.load(Relaxed)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flag(set: bool) -> Arc<AtomicBool> {
        Arc::new(AtomicBool::new(set))
    }

    #[test]
    fn work_ends_once_another_thread_wants_it() {
        let stop = flag(false);
        let other = Arc::clone(&stop);
        let setter = std::thread::spawn(move || other.store(true, Relaxed));
        let ended = unless_stopped(&stop, || while !is_stopped() {});
        assert_eq!(ended, Err(Stopped));
        assert!(setter.join().is_ok() && !is_stopped());
    }

    #[test]
    fn what_is_not_stopped_gives_what_it_gives() {
        assert_eq!(unless_stopped(&flag(false), || 7), Ok(7));
    }

    #[test]
    fn nothing_is_begun_where_the_stop_is_set_before() {
        let mut begun = false;
        assert_eq!(unless_stopped(&flag(true), || begun = true), Err(Stopped));
        assert!(!begun);
    }

    #[test]
    fn work_within_work_is_stopped_alone() {
        let (outer, inner) = (flag(false), flag(true));
        assert_eq!(unless_stopped(&outer, || unless_stopped(&inner, || ())), Ok(Err(Stopped)));
    }
}
