//! How an exploration by palms ends.

use super::palms::PalmsError;
use crate::certificate::Certificate;
use shape_bounds::exact_hull::planar::Direction;

/// Why a goal was not reached.
#[derive(Clone, Debug, PartialEq)]
pub enum RollEnd {
    /// All motions or radians were made that were allowed for, or all contacts taken that the confidence was shared among.
    Budget,
    /// No motion uncovers what is left: all that the palms can do was gone through, in steps of 0.3 rad, but for what the risk forbids.
    NotFound {
        /// Outward normals in body axes, with the most left first.
        directions: Vec<Direction>,
    },
    /// The body left the palms.
    Lost(PalmsError),
}

/// How an exploration ended.
#[derive(Clone, Debug, PartialEq)]
pub enum RollOutcome {
    /// The goal is proven.
    Reached(Certificate<Direction>),
    /// It is not.
    Short {
        /// Why.
        end: RollEnd,
        /// What is proven.
        certificate: Certificate<Direction>,
    },
}

impl RollOutcome {
    /// Whether the goal is proven.
    #[must_use]
    pub fn is_reached(&self) -> bool {
        matches!(self, Self::Reached(_))
    }

    /// What is proven.
    #[must_use]
    pub fn certificate(&self) -> &Certificate<Direction> {
        match self {
            Self::Reached(certificate) | Self::Short { certificate, .. } => certificate,
        }
    }
}
