//! Work on long logs on two cores at once.

use contact_kinematics::{at_once, in_parts};

/// Samples from which on two threads read a log. Of whole logs alone: the windows of a stream are shorter, and leave the other cores to the robot.
const MANY: usize = 5000;

/// What both give, of a log of so many samples.
pub(super) fn both<A: Send, B>(
    samples: usize,
    first: impl FnOnce() -> A + Send,
    second: impl FnOnce() -> B,
) -> (A, B) {
    if samples < MANY { (first(), second()) } else { at_once(first, second) }
}

/// What `of` gives of each of these samples, nodes or palms of a log of so many samples.
pub(super) fn of_each<R: Send>(samples: usize, all: &[usize], of: impl Fn(usize) -> R + Sync) -> Vec<R> {
    of_some(samples, all, |some| some.iter().map(|&one| of(one)).collect())
}

/// The same, one after the other, of a function that takes some of them.
pub(super) fn of_some<T: Sync, R: Send>(
    samples: usize,
    all: &[T],
    of: impl Fn(&[T]) -> Vec<R> + Sync,
) -> Vec<R> {
    if samples < MANY { of(all) } else { in_parts(all, of) }
}
