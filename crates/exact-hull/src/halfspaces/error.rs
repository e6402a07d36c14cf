use crate::hull::PointsError;
use glam::DVec3;
use thiserror::Error;

/// Why half-spaces have no intersection that can be described.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IntersectionError {
    /// No half-spaces at all: everything is inside.
    #[error("no half-spaces: their intersection is all of space")]
    Empty,
    /// More half-spaces than a 32-bit index holds.
    #[error("{count} half-spaces: at most {limit} are possible; thin the samples out")]
    TooMany {
        /// Half-spaces given.
        count: usize,
        /// Half-spaces that are possible.
        limit: usize,
    },
    /// A point or margin is NaN or infinite.
    #[error("half-space {index}: point ({}, {}, {}), margin {margin} is not finite", point.x, point.y, point.z)]
    NotFinite {
        /// Which half-space.
        index: usize,
        /// Its point as given.
        point: DVec3,
        /// Its margin as given.
        margin: f64,
    },
    /// Points so far apart that their distances leave the range of `f64`.
    #[error("half-space {index}: point ({:e}, {:e}, {:e}), margin {margin:e}: its square leaves the range of f64; check its unit", point.x, point.y, point.z)]
    TooFar {
        /// Which half-space.
        index: usize,
        /// Its point as given.
        point: DVec3,
        /// Its margin as given.
        margin: f64,
    },
    /// No point is in all half-spaces.
    #[error(
        "half-spaces {conflict:?} have no point in common: every point is at least {deficit} m outside of one of \
         them; drop a wrong one or widen their margins"
    )]
    Contradiction {
        /// Indices of half-spaces that contradict each other while any subset of them does not.
        conflict: Vec<usize>,
        /// The smallest margin, in m, which added to each of them makes them meet in a point.
        deficit: f64,
    },
    /// The intersection is so thin that rounding decides whether it is empty.
    #[error(
        "half-spaces {tight:?} leave a ball of radius {inradius:e} m at most, too little to tell from rounding; \
         widen their margins"
    )]
    NoInterior {
        /// Indices of the half-spaces that leave no room.
        tight: Vec<usize>,
        /// Radius of the largest ball inside of all half-spaces, as computed, in m.
        inradius: f64,
    },
    /// Normals or distances of such different sizes that exact arithmetic leaves the range of `f64`.
    #[error("the half-spaces' polar duals: {0}")]
    Range(#[from] PointsError),
    /// The normals close around the body, but rounding leaves no polyhedron.
    #[error(
        "the normals leave no direction open, but the polar duals about a point {depth:e} m inside span {dimension} \
         dimension(s) to rounding: too thin a body for its distance; widen the margins"
    )]
    Duals {
        /// Dimension of the duals' hull.
        dimension: usize,
        /// How deep inside of all half-spaces the point is, in m.
        depth: f64,
    },
}
