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

/// What `of` gives of each half of `all`, one after the other.
pub fn by_halves<T: Sync, R: Send>(all: &[T], of: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    let (first, second) = all.split_at(all.len() / 2);
    let (mut all, second) = at_once(|| of(first), || of(second));
    all.extend(second);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_done_once_and_in_its_place() {
        for count in [0, 1, 2, 7, 1000] {
            let all: Vec<usize> = (0..count).collect();
            assert_eq!(by_halves(&all, <[usize]>::to_vec), all);
        }
    }
}
