//! Work on two cores at once.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// In which work is shared out: more of them even out what each takes, and cost as often what each begins with.
const PARTS: usize = 32;

/// What both give, the first on a thread of its own, which does not ask whether to stop.
pub fn at_once<A: Send, B>(first: impl FnOnce() -> A + Send, second: impl FnOnce() -> B) -> (A, B) {
    thread::scope(|scope| {
        let first = scope.spawn(first);
        let second = second();
        (first.join().unwrap_or_else(|panic| resume_unwind(panic)), second)
    })
}

/// What `of` gives of each part of `all`, in their order. One thread takes parts from the start and one from the end, until they meet: where the one is
/// held up, or its parts take longer, the other one does more of them.
pub fn in_parts<T: Sync, R: Send>(all: &[T], of: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    let parts = || all.chunks(all.len().div_ceil(PARTS).max(1));
    let (count, taken) = (parts().len(), AtomicUsize::new(0));
    let is_left = |_: &&[T]| taken.fetch_add(1, Ordering::Relaxed) < count;
    let from_end = || parts().rev().take_while(is_left).map(&of).collect::<Vec<_>>();
    let from_start = || {
        let mut done = Vec::with_capacity(all.len());
        parts().take_while(is_left).for_each(|part| done.extend(of(part)));
        done
    };
    let (rest, mut done) = at_once(from_end, from_start);
    rest.into_iter().rev().for_each(|of| done.extend(of));
    done
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_done_once_and_in_its_place() {
        for count in [0, 1, 2, 7, 12, 13, 1000] {
            let all: Vec<usize> = (0..count).collect();
            assert_eq!(in_parts(&all, <[usize]>::to_vec), all);
        }
    }
}
