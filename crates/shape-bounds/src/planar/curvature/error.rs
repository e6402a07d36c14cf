use exact_hull::planar::PointsError;
use thiserror::Error;

/// Why contacts and discs give no bounds.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CurvatureError {
    /// Limits that no body has.
    #[error(
        "radii of curvature from {min} m to {max} m: the smallest must be at least zero and below the largest, which must be finite"
    )]
    Radii {
        /// The lower limit as given.
        min: f64,
        /// The upper limit as given.
        max: f64,
    },
    /// The contact points have no hull.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// A disc has no radius above zero, or a value is not finite.
    #[error(
        "disc or half-plane {index}: radius {radius} m; discs need a radius above zero, and all values to be finite"
    )]
    Disc {
        /// Which disc, or the number of discs plus which half-plane.
        index: usize,
        /// Its radius; infinite for a half-plane.
        radius: f64,
    },
    /// Discs and half-planes that have no point in common, or none at all were given.
    #[error(
        "{count} discs and half-planes have no interior in common, already those of the indices {conflict:?} have none: one of \
         them is wrong, or none was given"
    )]
    Empty {
        /// How many were given.
        count: usize,
        /// A smallest set of them that contradicts itself, at most three: indices of discs, or the number of discs plus
        /// that of a half-plane.
        conflict: Vec<usize>,
    },
    /// Discs and half-planes that have no end in some direction.
    #[error(
        "without a disc, {count} half-planes do not close; intersect them as half-planes, which says where"
    )]
    Unbounded {
        /// How many were given.
        count: usize,
    },
    /// A contact lies outside of the outer disc of another.
    #[error(
        "contact {sample} is {excess:e} m outside of the disc of radius {radius} m that touches at contact {other}: \
         the body is flatter somewhere than the upper limit says, or a contact is wrong"
    )]
    TooFlat {
        /// The contact outside.
        sample: usize,
        /// The contact whose disc it is.
        other: usize,
        /// How far outside, in m.
        excess: f64,
        /// The upper limit, in m.
        radius: f64,
    },
    /// The inner disc of a contact reaches beyond the tangent of another.
    #[error(
        "the disc of radius {radius} m inside of contact {other} reaches {excess:e} m beyond the tangent of contact \
         {sample}: the body is rounder somewhere than the lower limit says, or a contact is wrong"
    )]
    TooRound {
        /// The contact whose tangent is crossed.
        sample: usize,
        /// The contact whose disc crosses it.
        other: usize,
        /// How far beyond, in m.
        excess: f64,
        /// The lower limit, in m.
        radius: f64,
    },
}
