//! Bounds in the plane.

mod chain;

pub(crate) use chain::convex_corners;
