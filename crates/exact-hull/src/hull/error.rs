use glam::DVec3;
use thiserror::Error;

/// Why a set of points has no hull.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PointsError {
    /// No points at all.
    #[error("no points: a hull needs at least one")]
    Empty,
    /// More points than a 32-bit index holds.
    #[error("{count} points: a hull holds at most {limit}; thin the samples out")]
    TooMany {
        /// Points given.
        count: usize,
        /// Points that are possible.
        limit: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("point {index} ({}, {}, {}) has a coordinate that is not finite", point.x, point.y, point.z)]
    NotFinite {
        /// Which point.
        index: usize,
        /// The point as given.
        point: DVec3,
    },
    /// Coordinates of such different sizes that their products leave the range of `f64`, where no answer is exact.
    #[error(
        "coordinates from {smallest:e} to {largest:e} in one set: products of three leave the range of f64; \
         set the tiny ones to zero"
    )]
    DynamicRange {
        /// Smallest non-zero size of a coordinate.
        smallest: f64,
        /// Largest size of a coordinate.
        largest: f64,
    },
}
