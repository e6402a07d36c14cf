//! Simulations, each against another way to the same motion, or what it must keep to.

mod friction;
mod planar;
mod three_palms;

pub(super) use friction::METHOD as FRICTION;
pub(super) use planar::METHOD as PLANAR;
pub(super) use three_palms::METHOD as THREE_PALMS;

/// Tolerance where it is not the way.
const TOLERANCE: f64 = 1e-9;
/// What a motion may be off by over its tolerance: errors grow along it.
const GROWN: f64 = 1e4;
/// Errors of a tolerance that steps make along a motion, of which each grows as much as one of the start does.
const ERRORS: f64 = 10.0;

/// What a motion may be off by at a tolerance, of which one more of the start has grown to so much.
fn allowed(tolerance: f64, grown: f64) -> f64 {
    (GROWN * tolerance).max(ERRORS * grown)
}

fn largest(all: impl Iterator<Item = f64>) -> f64 {
    all.fold(0.0, |most, of| if of > most || of.is_nan() { of } else { most })
}
