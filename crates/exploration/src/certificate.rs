//! What is proven in the end.

use crate::confidence::Spending;
use crate::goal::Goal;
use crate::knowledge::{Knowledge, Measures};

/// What the contacts prove, whoever chose them: a reader needs no trust in the planner.
#[derive(Clone, Debug, PartialEq)]
pub struct Certificate<H> {
    /// What was asked for.
    pub goal: Goal<H>,
    /// What is proven of it, in its unit: at most so much is left.
    pub proven: f64,
    /// Sizes of the bounds.
    pub measures: Measures,
    /// Hausdorff distance of the bounds in m; infinite while one is missing.
    pub hausdorff: f64,
    /// Confidence of all this together, over all touches that might have been made; none for exact contacts.
    pub confidence: Option<(f64, Spending)>,
    /// Contacts.
    pub touches: usize,
}

impl<H: crate::Heading> Certificate<H> {
    /// What `known` proves with respect to `goal`.
    #[must_use]
    pub fn of<K: Knowledge<Heading = H>>(known: &K, goal: Goal<H>, spending: Option<Spending>) -> Self {
        Self {
            goal,
            proven: known.progress(&goal),
            measures: known.measures(),
            hausdorff: known.hausdorff(),
            confidence: known.confidence().zip(spending),
            touches: known.touches(),
        }
    }
}

/// Why a goal was not reached.
#[derive(Clone, Debug, PartialEq)]
pub enum Shortfall {
    /// All touches were made that were allowed for.
    Budget,
    /// What is left lies where no touch can go.
    Unreachable {
        /// Directions out of reach along which the bounds would narrow most, as coordinates, the best first.
        directions: Vec<Vec<f64>>,
    },
    /// No touch narrows the bounds any more: noise or rounding is left.
    NothingToGain,
    /// No motion of palms uncovers what is left: all that they can do was gone through, step by step.
    NotFound {
        /// Outward normals where most is left, as coordinates, the worst first.
        directions: Vec<Vec<f64>>,
    },
}

/// How an exploration ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome<H> {
    /// The goal is proven; before the first touch if no touch was made.
    Reached(Certificate<H>),
    /// It is not.
    Short {
        /// Why.
        shortfall: Shortfall,
        /// What is proven.
        certificate: Certificate<H>,
    },
}

impl<H> Outcome<H> {
    /// What is proven.
    #[must_use]
    pub fn certificate(&self) -> &Certificate<H> {
        match self {
            Self::Reached(certificate) | Self::Short { certificate, .. } => certificate,
        }
    }

    /// Whether the goal is proven.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        matches!(self, Self::Reached(_))
    }
}
