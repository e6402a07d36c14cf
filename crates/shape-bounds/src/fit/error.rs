use super::choose::reasons;
use super::{Candidate, Refutation, ShapeFamily};
use contact_kinematics::ShapeError;
use glam::DVec3;
use thiserror::Error;

/// Why contacts give no fitted shape.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum FitError {
    /// Fewer equations than parameters.
    #[error("{family}: {found} contacts give {} equations; at least {needed} contacts are needed", 3 * found)]
    TooFew {
        /// What was to be fitted.
        family: ShapeFamily,
        /// Contacts given.
        found: usize,
        /// Contacts needed.
        needed: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("contact {index}: point ({}, {}, {}) has a coordinate that is not finite", point.x, point.y, point.z)]
    NotFinite {
        /// Which contact.
        index: usize,
        /// The point as given.
        point: DVec3,
    },
    /// All contact points coincide, or are one to within the stated noise, so that there is no length to measure by.
    #[error(
        "all {found} contact points coincide, or are one to within the stated noise: there is no size to fit; touch the body from more sides"
    )]
    NoExtent {
        /// Contacts given.
        found: usize,
    },
    /// The stated noise of a contact is no covariance with full rank.
    #[error(
        "contact {index}: noise `{name}` is {value}; a weight needs a covariance of the point above zero"
    )]
    Noise {
        /// Which contact.
        index: usize,
        /// Which field.
        name: &'static str,
        /// The entry at fault.
        value: f64,
    },
    /// The stated noise of a contact has a part that is common to many contacts.
    #[error(
        "contact {index}: errors of the pose are shared by contacts and are not modelled by a fit; set them to zero, \
         and add what is independent from contact to contact to the covariance of the point"
    )]
    PoseNoise {
        /// Which contact.
        index: usize,
    },
    /// The contacts leave a combination of parameters open.
    #[error(
        "{family}: the contacts determine {rank} of {parameters} parameters (condition {condition:.1e}); the least \
         determined, mostly {weakest}, has a standard deviation of {deviation:.1e} sizes of the data; touch elsewhere \
         or fit fewer parameters"
    )]
    Undetermined {
        /// What was to be fitted.
        family: ShapeFamily,
        /// Combinations that are determined, but for rounding.
        rank: usize,
        /// Parameters of the family.
        parameters: usize,
        /// Condition number of the least-squares problem in scaled parameters.
        condition: f64,
        /// The parameter with the largest share in the least determined combination.
        weakest: String,
        /// Standard deviation of that combination, relative to the size of the data.
        deviation: f64,
    },
    /// The iteration did not come to rest.
    #[error(
        "{family}: no convergence in {iterations} iterations; the contacts are not those of such a shape"
    )]
    NotConverged {
        /// What was to be fitted.
        family: ShapeFamily,
        /// Iterations made.
        iterations: usize,
    },
    /// The contacts refute the shape.
    #[error("{family}: refuted by the contacts: {by}")]
    Refuted {
        /// What was fitted.
        family: ShapeFamily,
        /// How they do.
        by: Refutation,
    },
    /// A family with fewer parameters is exact already.
    #[error("{family}: not tried, since the {exact} fits exactly")]
    Needless {
        /// What was not fitted.
        family: ShapeFamily,
        /// What fits.
        exact: ShapeFamily,
    },
    /// No family of those given fits.
    #[error("no family fits the contacts: {}", reasons(candidates))]
    NoneFits {
        /// All families, and why each does not.
        candidates: Vec<Candidate>,
    },
    /// No convex shape of the family has radii of curvature as large as asked for.
    #[error("{family}: no body has all radii of curvature above {radius:e} m and comes near the contacts")]
    NoConvexBody {
        /// What was to be fitted.
        family: ShapeFamily,
        /// The limit, in m.
        radius: f64,
    },
    /// An option that is none.
    #[error("smallest radius of curvature {0} m: it must be finite and at least zero")]
    Radius(f64),
    /// No family to choose from.
    #[error("no family to choose from")]
    NoFamily,
    /// The fitted numbers are no shape.
    #[error(transparent)]
    Shape(#[from] ShapeError),
}
