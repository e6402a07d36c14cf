//! Who decides where to touch next.

use crate::goal::Goal;
use crate::knowledge::Knowledge;
use crate::limits::Limits;
use thiserror::Error;

/// Why a place was chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Reason {
    /// One of the first, which close the upper bound.
    Start,
    /// The upper bound has no end there.
    Open,
    /// The largest score of all candidates.
    Best,
    /// The one that pays most for its way of those with a score that is large enough.
    Near,
    /// The direction whose width is asked for, or its opposite.
    Width,
    /// Next of a sequence that looks at nothing.
    Sequence,
    /// The place that a Gaussian process is least sure of.
    Variance,
}

impl Reason {
    /// In a few words, for people.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Open => "closes an open side",
            Self::Best => "pays most",
            Self::Near => "near, and pays nearly as much",
            Self::Width => "the width that is asked for",
            Self::Sequence => "next of a sequence",
            Self::Variance => "least sure",
        }
    }
}

/// A touch to be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal<K: Knowledge> {
    /// Outward normal of the plane (line) that is brought up to the body.
    pub along: K::Heading,
    /// For a finger that moves along a ray: from a point outside of the upper bound to one in the lower one.
    pub ray: Option<[K::Point; 2]>,
    /// Volume (area) between the bounds that the touch is expected to remove, or the distance that it is to look into, in the unit
    /// of the goal's score; none if the planner does not predict.
    pub expected: Option<f64>,
    /// Why.
    pub reason: Reason,
}

/// What a planner is shown.
pub struct Situation<'a, K: Knowledge> {
    /// Contacts and bounds.
    pub known: &'a K,
    /// Where the finger is: the direction of the last touch.
    pub here: Option<K::Heading>,
    /// What is to be reached.
    pub goal: &'a Goal<K::Heading>,
    /// Where it can go.
    pub limits: &'a Limits<K::Heading>,
}

/// Why there is no next touch.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlanError {
    /// Nothing within reach has anything to gain.
    #[error("no direction within reach has anything to gain: {} would, out of reach", directions.len())]
    Unreachable {
        /// Directions that would narrow the bounds, out of reach, as coordinates, the best first.
        directions: Vec<Vec<f64>>,
    },
    /// The bounds are as close as touches can bring them.
    #[error("no direction has anything to gain any more")]
    NothingToGain,
}

/// Chooses touches by what is known. Deterministic: the same situations, in the same order, give the same touches.
pub trait Planner<K: Knowledge> {
    /// Its name, as in tables and files.
    fn name(&self) -> &'static str;

    /// The next touch.
    ///
    /// # Errors
    /// [`PlanError`] where no touch gains anything.
    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError>;
}
