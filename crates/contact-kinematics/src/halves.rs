//! Work on two cores at once.

use std::panic::resume_unwind;
use std::thread;

/// What both give, the first on a thread of its own, which does not ask whether to stop.
pub fn at_once<A: Send, B>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B) -> (A, B) {
    thread::scope(|scope| {
        let first = scope.spawn(first);
        let second = second();
        (first.join().unwrap_or_else(|panic| resume_unwind(panic)), second)
    })
}
