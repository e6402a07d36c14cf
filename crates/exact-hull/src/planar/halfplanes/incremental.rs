//! An intersection that takes one half-plane at a time.

use super::{Intersection, IntersectionError, OUTWARD_ULPS, interior_point};
use crate::planar::{HalfPlane, IncrementalHull};
use glam::DVec2;

/// A dual is kept while its centre is at least this deep inside of every half-plane, relative to the size of the data;
/// nearer to a plane, its dual point would be far from all others and carry their rounding.
const DEEP: f64 = 1e-3;

/// An intersection of half-planes that takes one at a time, as a point of the hull of the polar duals. It starts over only where a
/// half-plane comes close to the centre of the duality.
#[derive(Default)]
pub struct IncrementalIntersection {
    half_planes: Vec<HalfPlane>,
    dual: Option<Dual>,
}

struct Dual {
    centre: DVec2,
    /// Largest coordinate that the outward rounding was made for.
    largest: f64,
    /// The half-planes, moved out for rounding.
    outer: Vec<HalfPlane>,
    hull: IncrementalHull,
}

impl IncrementalIntersection {
    /// All of the plane.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a half-plane.
    ///
    /// # Errors
    /// [`IntersectionError`] for values that are not finite and for one that leaves nothing of the intersection, with those that
    /// contradict it; it is then not taken.
    pub fn insert(&mut self, half_plane: HalfPlane) -> Result<(), IntersectionError> {
        let HalfPlane { point, margin, .. } = half_plane;
        if !point.is_finite() || !margin.is_finite() {
            return Err(IntersectionError::NotFinite { index: self.half_planes.len(), point, margin });
        }
        if let Some(dual) = self.dual.as_mut().filter(|dual| dual.has_room_for(&half_plane)) {
            dual.take(&half_plane)?;
            self.half_planes.push(half_plane);
            return Ok(());
        }
        self.half_planes.push(half_plane);
        match Dual::start(&self.half_planes) {
            Ok(dual) => self.dual = Some(dual),
            Err(error) => {
                self.half_planes.pop();
                return Err(error);
            }
        }
        Ok(())
    }

    /// All half-planes so far.
    #[must_use]
    pub fn half_planes(&self) -> &[HalfPlane] {
        &self.half_planes
    }

    /// The intersection as it is now, in time O(n).
    ///
    /// # Errors
    /// [`IntersectionError::Empty`] before the first half-plane, and [`IntersectionError::NoInterior`].
    pub fn intersection(&self) -> Result<Intersection, IntersectionError> {
        let dual = self.dual.as_ref().ok_or(IntersectionError::Empty)?;
        Intersection::from_dual(
            dual.hull.hull()?,
            &self.half_planes,
            &dual.outer,
            dual.hull.points(),
            dual.centre,
        )
    }
}

impl Dual {
    fn start(half_planes: &[HalfPlane]) -> Result<Self, IntersectionError> {
        let centre = interior_point(half_planes)?;
        // Room to grow: rounding is provided for coordinates of twice the size.
        let largest = 2.0 * half_planes.iter().map(|h| h.point.abs().max_element()).fold(0.0, f64::max);
        let mut dual = Self { centre, largest, outer: Vec::new(), hull: IncrementalHull::new() };
        for h in half_planes {
            dual.take(h)?;
        }
        Ok(dual)
    }

    /// Whether the half-plane leaves the centre deep enough inside, and is no larger than provided for.
    fn has_room_for(&self, half_plane: &HalfPlane) -> bool {
        let size = half_plane.point.abs().max_element();
        size <= self.largest && -half_plane.excess(self.centre) >= DEEP * self.largest
    }

    fn take(&mut self, half_plane: &HalfPlane) -> Result<(), IntersectionError> {
        let margin = half_plane.margin + OUTWARD_ULPS * f64::EPSILON * self.largest;
        let outer = HalfPlane { margin, ..*half_plane };
        self.hull.insert(outer.normal.get() / -outer.excess(self.centre))?;
        self.outer.push(outer);
        Ok(())
    }
}
