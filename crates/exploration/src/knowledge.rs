//! What contacts say of a shape, in the plane and in space alike.

use crate::confidence::ConfidenceError;
use crate::goal::Goal;
use crate::heading::Heading;
use thiserror::Error;

/// Sizes of what is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measures {
    /// Volume in m^3 (area in m^2) that is certainly in the body.
    pub lower: f64,
    /// Volume (area) that certainly holds the body; infinite while it has no end.
    pub upper: f64,
}

impl Measures {
    /// Of no contacts.
    pub const NOTHING: Self = Self { lower: 0.0, upper: f64::INFINITY };

    /// What is between the bounds, over the upper one; 1 while that has no end or the lower one is flat.
    #[must_use]
    pub fn gap(&self) -> f64 {
        if self.upper.is_finite() && self.upper > 0.0 {
            // Rounding may put the bounds of a polytope past each other.
            ((self.upper - self.lower) / self.upper).clamp(0.0, 1.0)
        } else {
            1.0
        }
    }
}

/// Why a contact says nothing of the shape.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum KnowledgeError {
    /// In space: not finite, contradictory beyond the noise, or noise that is none.
    #[error("contact {touch} (from 1): {reason}")]
    Space {
        /// Number of the contact, from 1.
        touch: usize,
        /// What is wrong.
        #[source]
        reason: shape_bounds::noise::NoiseError,
    },
    /// The same in the plane.
    #[error("contact {touch} (from 1): {reason}")]
    Plane {
        /// Number of the contact, from 1.
        touch: usize,
        /// What is wrong.
        #[source]
        reason: shape_bounds::planar::noise::NoiseError,
    },
    /// A contact beside an estimate.
    #[error("contacts of an estimate come together with it: make the estimate anew")]
    Estimated,
    /// More touches than the confidence was shared among.
    #[error(transparent)]
    Confidence(#[from] ConfidenceError),
}

/// A state of knowledge: contacts, and the bounds that they prove.
///
/// A planner sees this and nothing else; the body itself is known to the finger alone.
pub trait Knowledge {
    /// A direction of touch.
    type Heading: Heading;
    /// A contact as measured.
    type Contact: Copy + PartialEq + std::fmt::Debug;
    /// A place.
    type Point: Copy + PartialEq + std::fmt::Debug;

    /// Takes a contact.
    ///
    /// # Errors
    /// [`KnowledgeError`]; the contact is then not taken.
    fn insert(&mut self, contact: Self::Contact) -> Result<(), KnowledgeError>;

    /// Number of contacts.
    fn touches(&self) -> usize;

    /// Sizes of the bounds.
    fn measures(&self) -> Measures;

    /// Hausdorff distance of the bounds in m: the largest distance of a corner of the upper bound from the lower one
    /// (the distance to a convex set is largest at a corner). Infinite while a bound is missing or without end.
    fn hausdorff(&self) -> f64;

    /// Support functions of the bounds along a direction, in m: the body's is between them. Infinite, of opposite signs, where nothing
    /// is known.
    fn support(&self, along: Self::Heading) -> (f64, f64);

    /// The confidence at which the body is between the bounds; none where contacts are taken as exact.
    fn confidence(&self) -> Option<f64>;

    /// A number below which no touches bring `goal`, for noise as stated and a body of mean width `width` (m) or less: what
    /// the noise adds to the bounds. Zero where contacts are exact.
    fn noise_floor(&self, goal: &Goal<Self::Heading>, width: f64) -> f64;

    /// Mean width of the upper bound in m; infinite while it has no end.
    fn mean_width(&self) -> f64;

    /// How far the goal's quantity is now: to be compared with [`Goal::value`].
    fn progress(&self, goal: &Goal<Self::Heading>) -> f64 {
        match goal {
            Goal::Gap(_) => self.measures().gap(),
            Goal::Hausdorff(_) => self.hausdorff(),
            Goal::Width { along, .. } => {
                let ([l1, u1], [l2, u2]) = (
                    <[f64; 2]>::from(self.support(*along)),
                    <[f64; 2]>::from(self.support(along.opposite())),
                );
                (u1 + u2) - (l1 + l2)
            }
        }
    }

    /// Whether the goal is proven. A gap is not until both bounds have a size.
    fn proves(&self, goal: &Goal<Self::Heading>) -> bool {
        self.progress(goal) <= goal.value()
    }
}
