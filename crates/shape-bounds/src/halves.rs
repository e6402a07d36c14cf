//! Work on a list by halves.

use contact_kinematics::at_once;

/// What `of` gives of each half of `all`, one after the other.
pub(crate) fn by_halves<T: Sync, R: Send>(all: &[T], of: impl Fn(&[T]) -> Vec<R> + Sync) -> Vec<R> {
    let (first, second) = all.split_at(all.len() / 2);
    let (mut all, second) = at_once(|| of(first), || of(second));
    all.extend(second);
    all
}
