//! Both bounds of a convex body from its contacts, and the gap between them.

mod agreement;
mod gap;
mod incremental;

pub use agreement::Contradiction;
pub(crate) use agreement::{PRINTED, ROUNDING_ULPS, beyond};
pub use gap::Gap;
pub use incremental::IncrementalBounds;

use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::HalfSpace;
use exact_hull::{Hull, PointsError};
use exact_hull::{Intersection, IntersectionError};
use gap::GapSearch;
use glam::DVec3;
use thiserror::Error;

/// Contacts that a body in space needs at least for bounds with a volume.
const FEWEST: usize = 4;

/// Why contacts give no bounds.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BoundsError {
    /// Too few contacts.
    #[error("{found} contacts: bounds in space need at least {needed}")]
    TooFew {
        /// Contacts given.
        found: usize,
        /// Contacts needed.
        needed: usize,
    },
    /// A contact point lies beyond the tangent plane of another, by more than rounding.
    #[error(
        "contact {} (from 0) lies {:e} m beyond the tangent plane of contact {} (from 0), which no convex body allows: a contact is wrong or its normal points inwards, \
         contacts are noisy (state or estimate their noise), or the body is concave (take it for that)",
        .0.contact, .0.excess, .0.plane
    )]
    Contradiction(Contradiction),
    /// The contact points have no hull.
    #[error("lower bound: {0}")]
    Points(#[from] PointsError),
    /// The half-spaces have no intersection.
    #[error("upper bound: {0}")]
    HalfSpaces(#[from] IntersectionError),
}

/// Lower bound (hull of the contact points) and upper bound (intersection of the half-spaces) of a convex body, from
/// contacts without noise (paper, section 8).
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeBounds {
    lower: Hull,
    corners: Vec<DVec3>,
    upper: Intersection,
}

impl ShapeBounds {
    /// Bounds from contacts on a convex body.
    ///
    /// # Errors
    /// [`BoundsError`] for fewer than four contacts, values that are not finite, and contacts of which one lies beyond the
    /// tangent plane of another, by more than printing with six digits moves it (the worst two are named). By what is less,
    /// the half-spaces are moved out, so that the lower bound lies in the upper one.
    pub fn from_contacts(contacts: &[ContactSample]) -> Result<Self, BoundsError> {
        Self::exact(contacts)
    }

    /// Whether there are contacts enough, all of finite coordinates.
    pub(crate) fn check(contacts: &[ContactSample]) -> Result<(), BoundsError> {
        if contacts.len() < FEWEST {
            return Err(BoundsError::TooFew { found: contacts.len(), needed: FEWEST });
        }
        match contacts.iter().position(|c| !c.point.is_finite()) {
            Some(index) => Err(PointsError::NotFinite { index, point: contacts[index].point }.into()),
            None => Ok(()),
        }
    }

    /// Bounds from points that are in the body and half-spaces that contain it.
    pub(crate) fn from_parts(points: &[DVec3], half_spaces: &[HalfSpace]) -> Result<Self, BoundsError> {
        Self::of_hull(Hull::of(points)?, points, half_spaces)
    }

    /// The same with the hull of the points made already.
    fn of_hull(lower: Hull, points: &[DVec3], half_spaces: &[HalfSpace]) -> Result<Self, BoundsError> {
        let upper = Intersection::of(half_spaces)?;
        let corners = lower.corner_points(points);
        Ok(Self { lower, corners, upper })
    }

    /// The lower bound of one and the upper bound of the other.
    pub(crate) fn outermost(inside: Self, around: Self) -> Self {
        Self { lower: inside.lower, corners: inside.corners, upper: around.upper }
    }

    /// Bounds that are made already; `None` for a lower one without volume.
    pub(crate) fn between(lower: Hull, upper: Intersection) -> Option<Self> {
        let corners = lower.solid()?.vertices().to_vec();
        Some(Self { lower, corners, upper })
    }

    /// The hull of the contact points: in the body.
    #[must_use]
    pub fn lower(&self) -> &Hull {
        &self.lower
    }

    /// The intersection of the half-spaces: around the body.
    #[must_use]
    pub fn upper(&self) -> &Intersection {
        &self.upper
    }

    /// Volume of the lower bound in m^3; zero for a hull without interior.
    #[must_use]
    pub fn lower_volume(&self) -> f64 {
        self.lower.solid().map_or(0.0, |solid| solid.volume())
    }

    /// Volume of the upper bound in m^3; infinite when it is unbounded.
    #[must_use]
    pub fn upper_volume(&self) -> f64 {
        self.upper.bounded().map_or(f64::INFINITY, |polyhedron| polyhedron.volume())
    }

    /// Support functions `(lower, upper)` in direction `n`, in m: the body's lies between them. The upper one is infinite
    /// where the upper bound has no end, and everywhere if it has no end anywhere (clip it to know more).
    #[must_use]
    pub fn support(&self, n: Direction) -> (f64, f64) {
        let lower = self.corners.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max);
        (lower, self.upper.bounded().map_or(f64::INFINITY, |polyhedron| polyhedron.support(n)))
    }

    /// How much further the upper bound reaches than the lower one in direction `n`, in m.
    #[must_use]
    pub fn gap_along(&self, n: Direction) -> f64 {
        let (lower, upper) = self.support(n);
        upper - lower
    }

    /// For each corner of the upper bound, its nearest point of the lower one: the gap as a field. Empty when the
    /// upper bound is unbounded.
    ///
    /// Gaps below rounding have no direction and are left out.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        let Some(mut search) = self.gap_search() else { return Vec::new() };
        (0..self.upper.bounded().map_or(0, |upper| upper.vertices().len()))
            .filter_map(|corner| search.at_corner(corner, 0.0))
            .collect()
    }

    /// The gaps at `corners` of the upper bound, each an index into its vertices: [`Self::gaps`] for few of many. `None` where the
    /// gap is below rounding, the upper bound is unbounded or has no such corner.
    #[must_use]
    pub fn gaps_at(&self, corners: &[usize]) -> Vec<Option<Gap>> {
        let count = self.upper.bounded().map_or(0, |upper| upper.vertices().len());
        let Some(mut search) = self.gap_search() else { return vec![None; corners.len()] };
        corners.iter().map(|k| if *k < count { search.at_corner(*k, 0.0) } else { None }).collect()
    }

    /// Those of [`Self::gaps`] that are above `least` (m): much cheaper where few are.
    pub(crate) fn gaps_above(&self, least: f64) -> Vec<Gap> {
        let Some(mut search) = self.gap_search() else { return Vec::new() };
        let corners = self.upper.bounded().map_or(0, |upper| upper.vertices().len());
        let mut gaps = Vec::new();
        for corner in 0..corners {
            if search.at_most(corner) > least {
                gaps.extend(search.at_corner(corner, least).filter(|gap| gap.distance > least));
            }
        }
        gaps
    }

    fn gap_search(&self) -> Option<GapSearch<'_>> {
        Some(GapSearch::new(self.upper.bounded()?, &self.lower, &self.corners))
    }

    /// The largest gap: its distance is the Hausdorff distance of the bounds, because the distance to a convex set is a
    /// convex function, which is largest at a corner. `None` when the upper bound is unbounded or the gap is zero.
    #[must_use]
    pub fn largest_gap(&self) -> Option<Gap> {
        self.gap_search()?.largest()
    }
}

#[cfg(test)]
mod tests;
