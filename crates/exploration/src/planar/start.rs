use crate::random::Source;
use shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::{PI, TAU};

/// `count` directions spread evenly, the first at `angle` (rad). Five are best for gaps about 10 %: cells are halved from there, and
/// 10 is the least number that 10 % takes.
#[must_use]
pub fn even_start(count: usize, angle: f64) -> Vec<Direction> {
    (0..count).map(|k| Direction::from_angle(angle + TAU * k as f64 / count as f64)).collect()
}

/// The same, turned by the `seed`.
#[must_use]
pub fn turned_start(count: usize, seed: u64) -> Vec<Direction> {
    even_start(count, Source::new(seed).between(0.0, TAU))
}

/// Direction `k` of the turns by the golden angle.
pub(super) fn golden(k: usize) -> Direction {
    // pi (3 - sqrt 5): no multiple of it comes near a full turn soon.
    Direction::from_angle((PI * (3.0 - 5f64.sqrt()) * k as f64) % TAU)
}
