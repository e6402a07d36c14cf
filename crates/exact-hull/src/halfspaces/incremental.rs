//! An intersection that takes one half-space at a time.

use super::polyhedron::OUTWARD_ULPS;
use super::{Intersection, IntersectionError, interior_point};
use crate::HalfSpace;
use crate::hull::IncrementalHull;
use glam::DVec3;

/// A dual is kept while its centre is at least this deep inside of every half-space, relative to the size of the data;
/// nearer to a plane, its dual point would be far from all others and carry their rounding.
const DEEP: f64 = 1e-3;

/// An intersection of half-spaces that takes one at a time, as a point of the hull of the polar duals. It starts over only where a
/// half-space comes close to the centre of the duality.
#[derive(Default)]
pub struct IncrementalIntersection {
    half_spaces: Vec<HalfSpace>,
    dual: Option<Dual>,
}

struct Dual {
    centre: DVec3,
    /// Largest coordinate that the outward rounding was made for.
    largest: f64,
    hull: IncrementalHull,
}

impl IncrementalIntersection {
    /// All of space.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a half-space.
    ///
    /// # Errors
    /// [`IntersectionError`] for values that are not finite and for one that leaves nothing of the intersection, with those that
    /// contradict it; it is then not taken.
    pub fn insert(&mut self, half_space: HalfSpace) -> Result<(), IntersectionError> {
        let HalfSpace { point, margin, .. } = half_space;
        if !point.is_finite() || !margin.is_finite() {
            return Err(IntersectionError::NotFinite { index: self.half_spaces.len(), point, margin });
        }
        if let Some(dual) = self.dual.as_mut().filter(|dual| dual.has_room_for(&half_space)) {
            dual.take(&half_space)?;
            self.half_spaces.push(half_space);
            return Ok(());
        }
        self.half_spaces.push(half_space);
        match Dual::start(&self.half_spaces) {
            Ok(dual) => self.dual = Some(dual),
            Err(error) => {
                self.half_spaces.pop();
                return Err(error);
            }
        }
        Ok(())
    }

    /// All half-spaces so far.
    #[must_use]
    pub fn half_spaces(&self) -> &[HalfSpace] {
        &self.half_spaces
    }

    /// The intersection as it is now, in time O(n).
    ///
    /// # Errors
    /// [`IntersectionError::Empty`] before the first half-space, and [`IntersectionError::Duals`].
    pub fn intersection(&self) -> Result<Intersection, IntersectionError> {
        let dual = self.dual.as_ref().ok_or(IntersectionError::Empty)?;
        Intersection::from_dual(dual.hull.hull()?, &self.half_spaces, dual.outwards(), dual.centre)
    }
}

impl Dual {
    fn start(half_spaces: &[HalfSpace]) -> Result<Self, IntersectionError> {
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

    fn take(&mut self, half_space: &HalfSpace) -> Result<(), IntersectionError> {
        let outer = half_space.moved(self.outwards());
        self.hull.insert(outer.normal.get() / -outer.excess(self.centre))?;
        Ok(())
    }
}
