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
