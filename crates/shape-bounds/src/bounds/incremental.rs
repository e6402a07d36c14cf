//! Both bounds, contact by contact.

use super::{BoundsError, ShapeBounds, agreement};
use crate::halfspaces::{Intersection, OUTWARD_ULPS, interior_point};
use crate::hull::IncrementalHull;
use crate::sample::{ContactSample, HalfSpace};
use glam::DVec3;

/// A dual is kept while its centre is at least this deep inside of every half-space, relative to the size of the data;
/// nearer to a plane, its dual point would be far from all others and carry their rounding.
const DEEP: f64 = 1e-3;

/// Lower and upper bound that take one contact at a time: a new point into the hull, a new half-space into the hull of the
/// polar duals. Neither starts over, except when a half-space comes close to the centre of the duality.
pub struct IncrementalBounds {
    lower: IncrementalHull,
    half_spaces: Vec<HalfSpace>,
    dual: Option<Dual>,
}

struct Dual {
    centre: DVec3,
    /// Largest coordinate that the outward rounding was made for.
    largest: f64,
    hull: IncrementalHull,
}

impl Default for IncrementalBounds {
    fn default() -> Self {
        Self::new()
    }
}

impl IncrementalBounds {
    /// Bounds from no contacts.
    #[must_use]
    pub fn new() -> Self {
        Self { lower: IncrementalHull::new(), half_spaces: Vec::new(), dual: None }
    }

    /// Takes a contact.
    ///
    /// # Errors
    /// [`BoundsError`] for a contact that is not finite or contradicts those before (a smallest contradictory set is
    /// named); it is then not taken.
    pub fn insert(&mut self, contact: &ContactSample) -> Result<(), BoundsError> {
        self.lower.check(contact.point)?;
        self.half_spaces.push(contact.half_space());
        if let Err(error) = self.update_dual() {
            self.half_spaces.pop();
            return Err(error);
        }
        self.lower.insert(contact.point)?;
        Ok(())
    }

    /// Takes the last half-space into the dual, or starts a new one.
    fn update_dual(&mut self) -> Result<(), BoundsError> {
        if let (Some(dual), Some(last)) = (&mut self.dual, self.half_spaces.last())
            && dual.has_room_for(last)
        {
            return dual.take(last);
        }
        self.dual = Some(Dual::start(&self.half_spaces)?);
        Ok(())
    }

    /// Contacts so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.half_spaces.len()
    }

    /// Whether there are no contacts yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.half_spaces.is_empty()
    }

    /// The bounds as they are now, in time O(n). Contacts that contradict each other by no more than
    /// [`ShapeBounds::from_contacts`] allows for are bounded anew as it does, in time O(n log n).
    ///
    /// # Errors
    /// [`BoundsError::TooFew`] before the fourth contact, and [`BoundsError::Contradiction`].
    pub fn bounds(&self) -> Result<ShapeBounds, BoundsError> {
        let (found, needed) = (self.half_spaces.len(), super::FEWEST);
        let Some(dual) = self.dual.as_ref().filter(|_| found >= needed) else {
            return Err(BoundsError::TooFew { found, needed });
        };
        let lower = self.lower.hull()?;
        let contact = |h: &HalfSpace| ContactSample { point: h.point, normal: h.normal };
        let contacts: Vec<ContactSample> = self.half_spaces.iter().map(contact).collect();
        if agreement::contradiction_of(&lower, self.lower.points(), &contacts).is_some() {
            return ShapeBounds::from_contacts(&contacts);
        }
        let corners = lower.corner_points(self.lower.points());
        let upper =
            Intersection::from_dual(dual.hull.hull()?, &self.half_spaces, dual.outwards(), dual.centre)?;
        Ok(ShapeBounds { lower, corners, upper })
    }
}

impl Dual {
    fn start(half_spaces: &[HalfSpace]) -> Result<Self, BoundsError> {
        let centre = interior_point(half_spaces)?;
        // Room to grow: rounding is provided for coordinates of twice the size.
        let largest = 2.0 * half_spaces.iter().map(|h| h.point.abs().max_element()).fold(0.0, f64::max);
        let mut dual = Self { centre, largest, hull: IncrementalHull::new() };
        for h in half_spaces {
            dual.take(h)?;
        }
        Ok(dual)
    }

    /// Whether the half-space leaves the centre deep enough inside, and is no larger than provided for.
    fn has_room_for(&self, half_space: &HalfSpace) -> bool {
        let size = half_space.point.abs().max_element();
        size <= self.largest && -half_space.excess(self.centre) >= DEEP * self.largest
    }

    /// How far half-spaces are moved outwards for rounding, in m.
    fn outwards(&self) -> f64 {
        OUTWARD_ULPS * f64::EPSILON * self.largest
    }

    fn take(&mut self, half_space: &HalfSpace) -> Result<(), BoundsError> {
        let outer = half_space.moved(self.outwards());
        self.hull.insert(outer.normal.get() / -outer.excess(self.centre))?;
        Ok(())
    }
}
