use crate::planar::PointsError;
use glam::DVec2;
use thiserror::Error;

/// Why half-planes have no intersection that can be described.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IntersectionError {
    /// No half-planes at all: everything is inside.
    #[error("no half-planes: their intersection is the whole plane")]
    Empty,
    /// More half-planes than a 32-bit index holds.
    #[error("{count} half-planes: at most {limit} are possible; thin the samples out")]
    TooMany {
        /// Half-planes given.
        count: usize,
        /// Half-planes that are possible.
        limit: usize,
    },
    /// A point or margin is NaN or infinite.
    #[error("half-plane {index}: point ({}, {}), margin {margin} is not finite", point.x, point.y)]
    NotFinite {
        /// Which half-plane.
        index: usize,
        /// Its point as given.
        point: DVec2,
        /// Its margin as given.
        margin: f64,
    },
    /// No point is in all half-planes.
    #[error(
        "half-planes {conflict:?} have no point in common: every point is at least {deficit} m outside of one of \
         them; drop a wrong one or widen their margins"
    )]
    Contradiction {
        /// Indices of half-planes that contradict each other while any subset of them does not.
        conflict: Vec<usize>,
        /// The smallest margin, in m, which added to each of them makes them meet in a point.
        deficit: f64,
    },
    /// The intersection is so thin that rounding decides whether it is empty.
    #[error(
        "half-planes {tight:?} leave a disc of radius {inradius:e} m at most, too little to tell from rounding; \
         widen their margins"
    )]
    NoInterior {
        /// Indices of the half-planes that leave no room.
        tight: Vec<usize>,
        /// Radius of the largest disc inside of all half-planes, as computed, in m.
        inradius: f64,
    },
    /// Normals or distances of such different sizes that exact arithmetic leaves the range of `f64`.
    #[error("the half-planes' polar duals: {0}")]
    Range(#[from] PointsError),
}
