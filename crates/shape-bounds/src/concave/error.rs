use exact_hull::delaunay::DelaunayError;
use thiserror::Error;

/// Why points have no alpha shape.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum AlphaError {
    /// The points have no Delaunay tetrahedra.
    #[error(transparent)]
    Points(#[from] DelaunayError),
    /// A radius that is none.
    #[error("alpha is {0} m; it must be above zero")]
    Alpha(f64),
}

/// Why contacts have no smooth surface through them.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// Too few or too many contacts.
    #[error(
        "{found} contacts: a surface needs {least} to {most}; thin them out, or fit a shape of few parameters"
    )]
    Count {
        /// Contacts given.
        found: usize,
        /// Fewest accepted.
        least: usize,
        /// Most accepted: the equations are dense.
        most: usize,
    },
    /// A point is not finite.
    #[error("contact {index} has a coordinate that is not finite")]
    NotFinite {
        /// Which contact.
        index: usize,
    },
    /// Two contacts at one place: the equations have no single solution.
    #[error(
        "contacts {first} and {second} are {distance:e} m apart, too near for a surface through both; leave one out"
    )]
    Coincident {
        /// One contact.
        first: usize,
        /// The other.
        second: usize,
        /// Their distance in m.
        distance: f64,
    },
    /// The equations could not be solved.
    #[error("the equations of the surface are singular")]
    Singular,
}
