//! Both bounds, contact by contact.

use super::{BoundsError, ShapeBounds, agreement};
use crate::sample::ContactSample;
use exact_hull::{HalfSpace, IncrementalHull, IncrementalIntersection};

/// Lower and upper bound that take one contact at a time: a new point into the hull, a new half-space into the hull of the
/// polar duals. Neither starts over, except when a half-space comes close to the centre of the duality.
#[derive(Default)]
pub struct IncrementalBounds {
    lower: IncrementalHull,
    upper: IncrementalIntersection,
}

impl IncrementalBounds {
    /// Bounds from no contacts.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a contact.
    ///
    /// # Errors
    /// [`BoundsError`] for a contact that is not finite or contradicts those before (a smallest contradictory set is
    /// named); it is then not taken.
    pub fn insert(&mut self, contact: &ContactSample) -> Result<(), BoundsError> {
        self.lower.check(contact.point)?;
        self.upper.insert(contact.half_space())?;
        self.lower.insert(contact.point)?;
        Ok(())
    }

    /// Contacts so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.upper.half_spaces().len()
    }

    /// Whether there are no contacts yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.upper.half_spaces().is_empty()
    }

    /// The bounds as they are now, in time O(n). Contacts that contradict each other by no more than
    /// [`ShapeBounds::from_contacts`] allows for are bounded anew as it does, in time O(n log n).
    ///
    /// # Errors
    /// [`BoundsError::TooFew`] before the fourth contact, and [`BoundsError::Contradiction`].
    pub fn bounds(&self) -> Result<ShapeBounds, BoundsError> {
        let (found, needed) = (self.upper.half_spaces().len(), super::FEWEST);
        if found < needed {
            return Err(BoundsError::TooFew { found, needed });
        }
        let lower = self.lower.hull()?;
        let contact = |h: &HalfSpace| ContactSample { point: h.point, normal: h.normal };
        let contacts: Vec<ContactSample> = self.upper.half_spaces().iter().map(contact).collect();
        if agreement::contradiction_of(&lower, self.lower.points(), &contacts).is_some() {
            return ShapeBounds::from_contacts(&contacts);
        }
        let corners = lower.corner_points(self.lower.points());
        Ok(ShapeBounds { lower, corners, upper: self.upper.intersection()? })
    }
}
