//! Both bounds of a convex outline from its contacts, and the gap between them.

use super::ContactSample;
use super::distance::nearest_around;
use crate::bounds::{Contradiction, PRINTED, ROUNDING_ULPS};
use exact_hull::planar::Ring;
use exact_hull::planar::{
    Direction, HalfPlane, Hull, IncrementalHull, IncrementalIntersection, Intersection, IntersectionError,
    PointsError,
};
use glam::DVec2;
use thiserror::Error;

/// Contacts that a body in the plane needs at least for bounds with an area.
const FEWEST: usize = 3;

/// Why contacts give no bounds.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum BoundsError {
    /// Too few contacts.
    #[error("{found} contacts: bounds in the plane need at least {needed}")]
    TooFew {
        /// Contacts given.
        found: usize,
        /// Contacts needed.
        needed: usize,
    },
    /// A contact point lies beyond the tangent line of another, by more than rounding.
    #[error(
        "contact {} (from 0) lies {:e} m beyond the tangent line of contact {} (from 0), which no convex outline allows: a contact is wrong or its normal points inwards, \
         contacts are noisy (state or estimate their noise), or the body is concave",
        .0.contact, .0.excess, .0.plane
    )]
    Contradiction(Contradiction),
    /// The contact points have no hull.
    #[error("lower bound: {0}")]
    Points(#[from] PointsError),
    /// The half-planes have no intersection.
    #[error("upper bound: {0}")]
    HalfPlanes(#[from] IntersectionError),
}

/// Lower bound (hull of the contact points) and upper bound (intersection of the half-planes) of a convex outline.
#[derive(Clone, Debug, PartialEq)]
pub struct ShapeBounds {
    lower: Hull,
    corners: Vec<DVec2>,
    upper: Intersection,
}

/// Where, and how far, the bounds are apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Direction in which the upper bound exceeds the lower one.
    pub direction: Direction,
    /// The point of the upper bound.
    pub outer: DVec2,
    /// The nearest point of the lower bound.
    pub inner: DVec2,
    /// Their distance in m.
    pub distance: f64,
}

impl ShapeBounds {
    /// Bounds from contacts on a convex body.
    ///
    /// # Errors
    /// [`BoundsError`] for fewer than three contacts, values that are not finite, and contacts of which one lies beyond the
    /// tangent line of another, by more than printing with six digits moves it (the worst two are named). By what is
    /// less, the half-planes are moved out, so that the lower bound lies in the upper one.
    pub fn from_contacts(contacts: &[ContactSample]) -> Result<Self, BoundsError> {
        Self::check(contacts)?;
        let points: Vec<DVec2> = contacts.iter().map(|c| c.point).collect();
        let lower = Hull::of(&points)?;
        let mut worst = Contradiction { contact: 0, plane: 0, excess: 0.0 };
        let mut half_planes = Vec::with_capacity(contacts.len());
        let rounding =
            ROUNDING_ULPS * f64::EPSILON * points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        for (plane, (contact, c)) in
            farthest_along_normals(&lower, contacts).into_iter().zip(contacts).enumerate()
        {
            let own = c.half_plane();
            let excess = own.excess(points[contact]);
            if excess > worst.excess {
                worst = Contradiction { contact, plane, excess };
            }
            half_planes.push(HalfPlane { margin: if excess > rounding { excess } else { 0.0 }, ..own });
        }
        let mean = points.iter().sum::<DVec2>() / points.len() as f64;
        let extent = points.iter().map(|p| p.distance(mean)).fold(0.0, f64::max);
        if worst.excess > PRINTED * extent + rounding {
            return Err(BoundsError::Contradiction(worst));
        }
        Self::from_parts(&points, &half_planes)
    }

    pub(super) fn check(contacts: &[ContactSample]) -> Result<(), BoundsError> {
        if contacts.len() < FEWEST {
            return Err(BoundsError::TooFew { found: contacts.len(), needed: FEWEST });
        }
        match contacts.iter().position(|c| !c.point.is_finite()) {
            Some(index) => Err(PointsError::NotFinite { index, point: contacts[index].point }.into()),
            None => Ok(()),
        }
    }

    /// Bounds from points that are in the body and half-planes that contain it.
    pub(super) fn from_parts(points: &[DVec2], half_planes: &[HalfPlane]) -> Result<Self, BoundsError> {
        let lower = Hull::of(points)?;
        let upper = Intersection::of(half_planes)?;
        let corners = lower.corner_points(points);
        Ok(Self { lower, corners, upper })
    }

    /// The hull of the contact points: in the body.
    #[must_use]
    pub fn lower(&self) -> &Hull {
        &self.lower
    }

    /// Corners of the lower bound in m, counter-clockwise: two of a segment, one of a point.
    #[must_use]
    pub fn lower_corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// The intersection of the half-planes: around the body.
    #[must_use]
    pub fn upper(&self) -> &Intersection {
        &self.upper
    }

    /// Area of the lower bound in m^2; zero for a hull without interior.
    #[must_use]
    pub fn lower_area(&self) -> f64 {
        self.lower.polygon().map_or(0.0, |polygon| polygon.shape().area())
    }

    /// Area of the upper bound in m^2; infinite when it is unbounded.
    #[must_use]
    pub fn upper_area(&self) -> f64 {
        self.upper.bounded().map_or(f64::INFINITY, |region| region.shape().area())
    }

    /// Support functions `(lower, upper)` in direction `n`, in m; the upper one is infinite everywhere if the upper bound
    /// has no end anywhere.
    #[must_use]
    pub fn support(&self, n: Direction) -> (f64, f64) {
        let lower = self.corners.iter().map(|v| v.dot(n.get())).fold(f64::NEG_INFINITY, f64::max);
        (lower, self.upper.bounded().map_or(f64::INFINITY, |region| region.shape().support(n)))
    }

    /// For each corner of the upper bound, its nearest point of the lower one: the gap as a field. Empty when the upper
    /// bound is unbounded.
    ///
    /// Gaps below rounding have no direction and are left out.
    #[must_use]
    pub fn gaps(&self) -> Vec<Gap> {
        let Some(upper) = self.upper.bounded() else { return Vec::new() };
        let outer = upper.shape().vertices();
        let gap = |(outer, inner): (&DVec2, DVec2)| {
            let direction = Direction::new(*outer - inner).ok()?;
            Some(Gap { direction, outer: *outer, inner, distance: outer.distance(inner) })
        };
        outer.iter().zip(nearest_around(&self.corners, outer)).filter_map(gap).collect()
    }

    /// The largest gap: its distance is the Hausdorff distance of the bounds, because the distance to a convex set is
    /// largest at a corner. `None` when the upper bound is unbounded or the gap is zero.
    #[must_use]
    pub fn largest_gap(&self) -> Option<Gap> {
        self.gaps().into_iter().max_by(|x, y| x.distance.total_cmp(&y.distance))
    }
}

/// For each contact the index of the point that is the farthest along its normal.
fn farthest_along_normals(hull: &Hull, contacts: &[ContactSample]) -> Vec<usize> {
    let sources = hull.corners();
    let corners: Vec<DVec2> = sources.iter().map(|k| contacts[*k].point).collect();
    let ring = Ring::new(&corners);
    contacts.iter().map(|c| sources[ring.farthest(c.normal.get())]).collect()
}

/// Bounds that take one contact at a time: a new point into the hull, a new half-plane into the hull of the polar duals.
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
        self.upper.insert(contact.half_plane())?;
        self.lower.insert(contact.point)?;
        Ok(())
    }

    /// Contacts so far.
    #[must_use]
    pub fn len(&self) -> usize {
        self.upper.half_planes().len()
    }

    /// Whether there are no contacts yet.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.upper.half_planes().is_empty()
    }

    /// The bounds as they are now, in time O(n).
    ///
    /// # Errors
    /// [`BoundsError::TooFew`] before the third contact.
    pub fn bounds(&self) -> Result<ShapeBounds, BoundsError> {
        let found = self.upper.half_planes().len();
        if found < FEWEST {
            return Err(BoundsError::TooFew { found, needed: FEWEST });
        }
        let lower = self.lower.hull()?;
        let corners = lower.corner_points(self.lower.points());
        Ok(ShapeBounds { lower, corners, upper: self.upper.intersection()? })
    }
}
