use exact_hull::IntersectionError;
use thiserror::Error;

/// Why contacts have no spline through them, or points no principal surface or curve.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ApproximationError {
    /// Too few of them.
    #[error("{found} contacts: {least} are needed; touch it more often")]
    TooFew {
        /// Contacts given.
        found: usize,
        /// Fewest accepted.
        least: usize,
    },
    /// A point is not finite.
    #[error("contact {index} has a coordinate that is not finite")]
    NotFinite {
        /// Which contact.
        index: usize,
    },
    /// The points do not span the space that the body is in, or only to rounding.
    #[error("the contacts span {dimension} dimension(s) only: touch the object from all sides")]
    Flat {
        /// How many they span.
        dimension: usize,
    },
    /// Coordinates of such different sizes that they have no hull.
    #[error("the contacts have no hull: coordinates from the tiniest to the largest leave the range of f64")]
    Range,
    /// From no place inside does one see all contacts from their inner sides.
    #[error(
        "contacts {contacts:?} turn away from every place inside: the object is not star-shaped, or they are wrong; take a surface \
         that need not be (HermiteSurface, AlphaShape)"
    )]
    NotStarShaped {
        /// Indices of contacts that exclude each other, or of one that is seen along its surface.
        contacts: Vec<usize>,
    },
    /// A standard deviation that is none.
    #[error("noise is {0} m; it must be above zero")]
    Noise(f64),
    /// The equations could not be solved.
    #[error("the equations of the surface are singular: the contacts lie on too little of it")]
    Singular,
}

impl ApproximationError {
    /// Of a star's kernel that is empty, the contacts that make it so.
    pub(super) fn of_kernel(error: IntersectionError) -> Self {
        let contacts = match error {
            IntersectionError::Contradiction { conflict, .. } => conflict,
            IntersectionError::NoInterior { tight, .. } => tight,
            _ => Vec::new(),
        };
        Self::NotStarShaped { contacts }
    }
}
