//! Work on two cores at once.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
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

/// What `of` gives of each, in their order, for work of which some takes longer: whichever of both is free takes the next one.
pub fn one_by_one<T: Sync, R: Send>(all: &[T], of: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let taken = || {
        let mut made = Vec::new();
        while let Some((i, one)) = take(all, &next) {
            made.push((i, of(one)));
        }
        made
    };
    let (mut made, others) = at_once(taken, taken);
    made.extend(others);
    made.sort_unstable_by_key(|(i, _)| *i);
    made.into_iter().map(|(_, made)| made).collect()
}

fn take<'a, T>(all: &'a [T], next: &AtomicUsize) -> Option<(usize, &'a T)> {
    let i = next.fetch_add(1, Ordering::Relaxed);
    all.get(i).map(|one| (i, one))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_done_once_and_in_its_place() {
        for count in [0, 1, 2, 7, 1000] {
            let all: Vec<usize> = (0..count).collect();
            assert_eq!(one_by_one(&all, |i| 3 * i), all.iter().map(|i| 3 * i).collect::<Vec<_>>());
            assert_eq!(by_halves(&all, <[usize]>::to_vec), all);
        }
    }
}
