use exact_hull::PointsError;
use thiserror::Error;

/// Why contacts and limits on the radii of curvature give no bounds.
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
    /// A contact lies outside of the outer ball of another.
    #[error(
        "contact {sample} is {excess:e} m outside of the ball of radius {radius} m that touches at contact {other}: \
         the body is flatter somewhere than the upper limit says, or a contact is wrong"
    )]
    TooFlat {
        /// The contact outside.
        sample: usize,
        /// The contact whose ball it is.
        other: usize,
        /// How far outside, in m.
        excess: f64,
        /// The upper limit, in m.
        radius: f64,
    },
    /// The inner ball of a contact reaches beyond the tangent plane of another.
    #[error(
        "the ball of radius {radius} m inside of contact {other} reaches {excess:e} m beyond the plane of contact \
         {sample}: the body is rounder somewhere than the lower limit says, or a contact is wrong"
    )]
    TooRound {
        /// The contact whose plane is crossed.
        sample: usize,
        /// The contact whose ball crosses it.
        other: usize,
        /// How far beyond, in m.
        excess: f64,
        /// The lower limit, in m.
        radius: f64,
    },
    /// No body within the limits has both of two contacts.
    #[error(
        "no body with radii of curvature from {min} m to {max} m has both contact {sample} and contact {other}: the ball of \
         the smallest radius inside of the one reaches {excess:e} m beyond that of the largest radius at the other"
    )]
    Contradicted {
        /// The contact whose inner ball it is.
        sample: usize,
        /// The contact whose outer ball it is.
        other: usize,
        /// How far beyond, in m.
        excess: f64,
        /// The lower limit, in m.
        min: f64,
        /// The upper limit, in m.
        max: f64,
    },
    /// Rounding decides what the balls leave, as far as tried.
    #[error(
        "radii of curvature from {min} m to {max} m leave so little between the bounds that rounding decides; state wider \
         limits, such as a largest radius larger by a thousandth"
    )]
    Rounding {
        /// The lower limit, in m.
        min: f64,
        /// The upper limit, in m.
        max: f64,
    },
}
