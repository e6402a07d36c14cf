use thiserror::Error;

/// Why the surface of a palm or its motion cannot be used as given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The radius is not a positive number.
    #[error("radius of the palm is {radius} m; it must be positive and finite")]
    Radius {
        /// As given, in m.
        radius: f64,
    },
    /// The body would touch the cup in more than a point.
    #[error(
        "cup of radius {radius} m is not wider than the object's largest radius of curvature, {largest} m, and would \
         touch it in more than one point; take a wider cup"
    )]
    CupTooSmall {
        /// Radius of the cup, m.
        radius: f64,
        /// Largest radius of curvature of the body, m.
        largest: f64,
    },
    /// A number of a pose or a motion cannot be used.
    #[error("{what} of the palm is {value}; it must be finite, and a duration above zero")]
    Parameter {
        /// Which number.
        what: &'static str,
        /// As given.
        value: f64,
    },
}

/// Why a contact could not be found, or its rates not be told.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// Newton's iteration did not settle.
    #[error(
        "contact with the palm was not found: after {iterations} steps its normal is still {offset:.1e} m off the \
         palm's centre"
    )]
    NotFound {
        /// Steps taken.
        iterations: u32,
        /// Distance of the palm's centre from the body's normal, m.
        offset: f64,
    },
    /// The curvatures of body and palm match: the contact is not one point.
    #[error(
        "body and palm have matching curvatures at their contact (condition {condition:.1e}, limit {limit:.0e}): it is \
         not one point there"
    )]
    Matching {
        /// Ratio of the radii to their difference.
        condition: f64,
        /// Largest accepted.
        limit: f64,
    },
    /// The palm's centre lies inside of the body.
    #[error("the palm's centre lies {depth} m inside of the object")]
    CentreInside {
        /// How deep, in m.
        depth: f64,
    },
    /// An input is NaN or infinite.
    #[error("pose of object or palm is not finite")]
    NotFinite,
}
