//! What carries a touch out.

use crate::knowledge::Knowledge;
use crate::planner::Proposal;
use thiserror::Error;

/// Why a touch gave no contact.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TouchError {
    /// A ray that does not meet the body.
    #[error("the ray met nothing: the finger passed the place where the bounds said that the body is")]
    Missed,
    /// The body gave a place or a normal that is none.
    #[error("the body has no finite point there")]
    NotFinite,
}

/// Touches a body where it is told, and says what it felt. In the body's frame: point and outward normal.
pub trait Finger<K: Knowledge> {
    /// Carries a touch out.
    ///
    /// # Errors
    /// [`TouchError`] if there is no contact.
    fn touch(&mut self, proposal: &Proposal<K>) -> Result<K::Contact, TouchError>;
}

/// How a finger that is simulated moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// A plane (line) with the outward normal of the proposal is brought up to the body: the contact has that normal.
    Plane,
    /// A point moves along the proposal's ray until it meets the body: the normal is the body's there. Where a proposal has none, as
    /// before anything is known, it is as with a plane.
    Ray,
}
