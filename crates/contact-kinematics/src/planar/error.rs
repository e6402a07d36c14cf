//! What can be wrong with a planar shape or a pair of palms.

use thiserror::Error;

/// Why numbers do not describe a smooth strictly convex planar body.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A length is zero, negative or not a number.
    #[error("{what} is {value} m; it must be positive and finite")]
    Length {
        /// Which length.
        what: &'static str,
        /// As given, in m.
        value: f64,
    },
    /// A number is not finite.
    #[error("{what} {index} is {value}; it must be finite")]
    NotFinite {
        /// What the number is.
        what: &'static str,
        /// Which one, from 0.
        index: usize,
        /// As given.
        value: f64,
    },
    /// Cosine and sine coefficients do not pair up.
    #[error(
        "{cosines} cosine and {sines} sine coefficients; give as many of each, from order 0, and at least one"
    )]
    Coefficients {
        /// Number of cosine coefficients.
        cosines: usize,
        /// Number of sine coefficients.
        sines: usize,
    },
    /// Somewhere the outline is not strictly convex.
    #[error(
        "radius of curvature is {rho:.3e} m at normal direction {theta:.4} rad; a strictly convex outline needs it \
         positive: shrink the higher coefficients or enlarge the mean radius"
    )]
    NotConvex {
        /// Normal direction in rad.
        theta: f64,
        /// Radius of curvature there, in m.
        rho: f64,
    },
    /// The outline is so nearly flat or cornered somewhere that convexity could not be proved.
    #[error("convexity cannot be proved: radius of curvature is only known to exceed {bound:.3e} m")]
    Unproved {
        /// Guaranteed lower bound on the radius of curvature, in m.
        bound: f64,
    },
    /// Fewer than three corners.
    #[error("polygon has {found} corner(s); it needs at least 3")]
    TooFewCorners {
        /// How many there are.
        found: usize,
    },
    /// A corner does not turn left.
    #[error(
        "polygon turns by {turn:.4} rad at corner {corner}; corners must go counter-clockwise and turn left"
    )]
    Corner {
        /// Index from 0.
        corner: usize,
        /// Turn to the left in rad.
        turn: f64,
    },
    /// Bulging edges would overlap at a corner.
    #[error(
        "edge half-angle {half_angle} rad must be positive and below {limit:.6} rad, half the sharpest turn"
    )]
    Bulge {
        /// As given, in rad.
        half_angle: f64,
        /// Half of the smallest turn, in rad.
        limit: f64,
    },
}

/// Why a pair of palms cannot hold an object.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PalmPairError {
    /// The wedge between the palms is closed or flat.
    #[error(
        "angle between the palms is {phi2} rad; it must lie strictly between 0 and pi (angles are in radians)"
    )]
    Wedge {
        /// Angle of palm 2 against palm 1, in rad.
        phi2: f64,
    },
    /// A number is not finite.
    #[error("{what} is {value}; it must be finite")]
    NotFinite {
        /// What the number is.
        what: &'static str,
        /// As given.
        value: f64,
    },
}
