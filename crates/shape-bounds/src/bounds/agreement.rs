//! Whether contacts are those of one convex body: no contact point lies beyond another's tangent plane.

use super::{BoundsError, ShapeBounds};
use crate::sample::{ContactSample, NORMAL_TOLERANCE};
use exact_hull::HalfSpace;
use exact_hull::{Farthest, Hull};
use glam::DVec3;

/// By how much a contact may lie beyond the plane of another, relative to the extent of the contacts: what coordinates and
/// normals with six printed digits are rounded by.
pub(crate) const PRINTED: f64 = NORMAL_TOLERANCE;
/// Rounding of a height over a plane, in units of rounding of the largest coordinate: the planes of an upper bound are
/// further out by more than that.
pub(crate) const ROUNDING_ULPS: f64 = 4.0;

/// A contact point beyond the tangent plane of another contact, which a convex body does not have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contradiction {
    /// The contact whose point is beyond.
    pub contact: usize,
    /// The contact whose plane it is.
    pub plane: usize,
    /// How far beyond, in m.
    pub excess: f64,
}

impl ShapeBounds {
    /// The contact point that lies the farthest beyond another's tangent plane; `None` where none does but for rounding.
    /// Expected time O(n log n).
    ///
    /// # Errors
    /// [`BoundsError`] for contacts that have no hull.
    pub fn contradiction(contacts: &[ContactSample]) -> Result<Option<Contradiction>, BoundsError> {
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        Ok(contradiction_of(&Hull::of(&points)?, &points, contacts))
    }

    /// Bounds from contacts that are known to contradict each other, since they were moved by an estimate: each half-space is
    /// moved out to where no contact point lies beyond it, so that the lower bound lies in the upper one. What the true
    /// body may do, they do not say.
    ///
    /// # Errors
    /// [`BoundsError`] as for [`Self::from_contacts`], but for contradictions.
    pub fn from_contradicting_contacts(contacts: &[ContactSample]) -> Result<Self, BoundsError> {
        Self::within(contacts, f64::INFINITY)
    }

    /// Bounds from contacts that contradict each other by at most `share` of their extent.
    pub(super) fn within(contacts: &[ContactSample], share: f64) -> Result<Self, BoundsError> {
        Self::check(contacts)?;
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        let lower = Hull::of(&points)?;
        let beyond = beyond(&lower, &points, contacts);
        if let Some(worst) = worst(&beyond, &points)
            && worst.excess > share * extent(&points)
        {
            return Err(BoundsError::Contradiction(worst));
        }
        let rounding = rounding(&points);
        let moved = |(c, (_, excess)): (&ContactSample, &(usize, f64))| {
            c.half_space().moved(if *excess > rounding { *excess } else { 0.0 })
        };
        let half_spaces: Vec<HalfSpace> = contacts.iter().zip(&beyond).map(moved).collect();
        Self::of_hull(lower, &points, &half_spaces)
    }

    /// Bounds from exact contacts.
    pub(super) fn exact(contacts: &[ContactSample]) -> Result<Self, BoundsError> {
        Self::within(contacts, PRINTED)
    }
}

/// The same with the hull of the points made already.
pub(super) fn contradiction_of(
    hull: &Hull,
    points: &[DVec3],
    contacts: &[ContactSample],
) -> Option<Contradiction> {
    worst(&beyond(hull, points, contacts), points)
}

/// For each contact the point that is the farthest along its normal, and how far that is beyond its plane, in m.
pub(crate) fn beyond(hull: &Hull, points: &[DVec3], contacts: &[ContactSample]) -> Vec<(usize, f64)> {
    let mut farthest = Farthest::new(hull, points);
    let one = |(k, c): (usize, &ContactSample)| {
        let n = c.normal.get();
        let top = farthest.along(n, k);
        (top, n.dot(points[top] - c.point))
    };
    contacts.iter().enumerate().map(one).collect()
}

fn worst(beyond: &[(usize, f64)], points: &[DVec3]) -> Option<Contradiction> {
    let all = beyond.iter().enumerate();
    let (plane, (contact, excess)) = all.max_by(|x, y| x.1.1.total_cmp(&y.1.1))?;
    (*excess > rounding(points)).then_some(Contradiction { contact: *contact, plane, excess: *excess })
}

/// The largest distance of a point from the mean.
fn extent(points: &[DVec3]) -> f64 {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    points.iter().map(|p| p.distance(mean)).fold(0.0, f64::max)
}

fn rounding(points: &[DVec3]) -> f64 {
    ROUNDING_ULPS * f64::EPSILON * points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
}
