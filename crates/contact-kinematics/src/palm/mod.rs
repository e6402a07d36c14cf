//! Flat palms through the world origin: frames, prescribed motion, and three of them together.

mod frame;
mod motion;
mod triple;

pub use frame::PalmFrame;
pub use motion::{Palm, PalmState};
pub use triple::PalmTriple;

use glam::DVec3;
use thiserror::Error;

/// Why palms cannot be used as given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PalmError {
    /// The palm's axis would be undefined: it is the horizontal line in the palm.
    #[error(
        "palm normal ({}, {}, {}) is within {limit} of vertical, so the palm has no horizontal axis; tilt the palm",
        normal.x, normal.y, normal.z
    )]
    VerticalNormal {
        /// The normal as given, in world axes.
        normal: DVec3,
        /// Smallest horizontal component that is accepted.
        limit: f64,
    },
    /// The vector is not a unit vector.
    #[error("palm normal: {0}")]
    Normal(#[from] crate::DirectionError),
    /// The normals do not span space, so the body could slide along their common line.
    #[error(
        "palms are too close to sharing a line: |det [n_1 n_2 n_3]| = {determinant:.3e}, condition {condition:.3e} \
         (limit {limit:.1e}); turn the palms apart"
    )]
    Parallel {
        /// Determinant of the matrix of normals.
        determinant: f64,
        /// Ratio of its largest to its smallest singular value.
        condition: f64,
        /// Largest condition accepted.
        limit: f64,
    },
    /// A parameter of the palm's motion is not a finite number, or a duration not above zero.
    #[error("palm {what} is {value}; it must be finite, and a duration above zero")]
    NotFinite {
        /// Which parameter.
        what: &'static str,
        /// Its value.
        value: f64,
    },
}
