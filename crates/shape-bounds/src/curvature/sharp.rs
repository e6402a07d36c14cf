//! The sharpest bounds that contacts and limits on the radii of curvature give.

use super::ball_hull::BallHull;
use super::balls::{BallIntersection, Outside, Unsettled};
use super::error::CurvatureError;
use super::steiner::ConvexMeasures;
use super::support::BallWalk;
use super::{ROUNDING, VolumeRange, check_contacts};
use crate::body::{Climb, ConvexBody};
use crate::bounds::ShapeBounds;
use crate::distance::nearest;
use crate::faceted::FacetError;
use crate::sample::ContactSample;
use contact_kinematics::{CurvatureRadii, Direction};
use glam::DVec3;

/// The smallest and the largest body with the given contacts and principal radii of curvature within the limits (in the
/// closure: their own radii reach the limits, and where they reach zero and infinity, edges and flats).
///
/// A body with radii from `rho_min` to `rho_max` is `C + B(rho_min)` with `C` an intersection of balls of radius
/// `rho = rho_max - rho_min`, and the other way round. With `p_k = x_k - rho_min n_k` and `q_k = x_k - rho_max n_k`, `C` has the
/// points `p_k` and lies in the balls of radius `rho` about the `q_k`. So the ball hull of the `p_k` is the smallest `C`, the
/// intersection of the balls about the `q_k` the largest one, and both have the contacts: no tighter bounds hold for all
/// such bodies. Contacts and limits agree just if every `p_j` is within `rho` of every `q_k`.
#[derive(Clone, Debug, PartialEq)]
pub struct SharpBounds {
    lower: BallHull,
    upper: RoundedIntersection,
}

impl SharpBounds {
    /// Bounds from contacts without noise on a body whose principal radii of curvature lie within `radii`.
    ///
    /// # Errors
    /// [`CurvatureError`] for limits that are not `0 <= min < max < infinity`, no contacts, values that are not finite, and
    /// [`CurvatureError::Contradicted`] with a pair of contacts that no body within the limits has.
    pub fn from_contacts(contacts: &[ContactSample], radii: CurvatureRadii) -> Result<Self, CurvatureError> {
        let CurvatureRadii { min, max } = radii;
        if !(0.0 <= min && min < max && max.is_finite()) {
            return Err(CurvatureError::Radii { min, max });
        }
        check_contacts(contacts)?;
        let inside = |r: f64| contacts.iter().map(|c| c.point - c.normal.get() * r).collect::<Vec<DVec3>>();
        let (inner, outer) = (inside(min), inside(max));
        let size = contacts.iter().map(|c| c.point.abs().max_element()).fold(max, f64::max);
        let contradicted =
            |sample, other, excess| CurvatureError::Contradicted { sample, other, excess, min, max };
        let volumes = VolumeRange::of(contacts, min);
        let settled =
            |centres: &[DVec3], touching: &[DVec3], is_right: &dyn Fn(&BallIntersection, f64) -> bool| {
                BallIntersection::settled(centres, touching, max - min, ROUNDING * size, is_right)
            };
        let widened =
            |core: &BallIntersection, slack| volumes.holds(core.measures().grown(min).volume, slack);
        let core = settled(&outer, &inner, &widened).map_err(|error| match error {
            Unsettled::Outside(o) => contradicted(o.sample, o.other, o.excess),
            Unsettled::Rounding => CurvatureError::Rounding { min, max },
        })?;
        let hull_of = |dual: &BallIntersection| BallHull::of_dual(dual.clone(), min);
        let agrees =
            |hull: BallHull, slack| volumes.holds(hull.volume(), slack) && hull.agrees_with_duality();
        let dual =
            settled(&inner, &outer, &|dual, slack| agrees(hull_of(dual), slack)).map_err(
                |error| match error {
                    Unsettled::Outside(o) => contradicted(o.other, o.sample, o.excess),
                    Unsettled::Rounding => CurvatureError::Rounding { min, max },
                },
            )?;
        Ok(Self { lower: BallHull::of_dual(dual, min), upper: RoundedIntersection { core, margin: min } })
    }

    /// Bounds of a body that has balls of radius `inside` (m) about `inner`, and of which the points that are centres of such
    /// balls of radius `min` lie within `reach` (m) of each of `outer`; all `inner` are within `reach` of all `outer`, too.
    ///
    /// # Errors
    /// [`CurvatureError::Contradicted`] names a pair that is not.
    pub(crate) fn around(
        inner: &[DVec3],
        outer: &[DVec3],
        reach: f64,
        inside: f64,
        radii: CurvatureRadii,
    ) -> Result<Self, CurvatureError> {
        let CurvatureRadii { min, max } = radii;
        let (core, outside) = BallIntersection::build(outer, inner, reach, 0.0);
        if let Some(Outside { sample, other, excess }) = outside {
            return Err(CurvatureError::Contradicted { sample, other, excess, min, max });
        }
        let (dual, _) = BallIntersection::build(inner, outer, reach, f64::INFINITY);
        Ok(Self { lower: BallHull::of_dual(dual, inside), upper: RoundedIntersection { core, margin: min } })
    }

    /// The smallest body within the limits: in every other.
    #[must_use]
    pub fn lower(&self) -> &BallHull {
        &self.lower
    }

    /// The largest body within the limits: around every other.
    #[must_use]
    pub fn upper(&self) -> &RoundedIntersection {
        &self.upper
    }

    /// Polytopes as bounds: one inside of the lower bound, one around the upper one, each no further than `tolerance` (m) from
    /// it. For meshes, and for the gap.
    ///
    /// # Errors
    /// [`FacetError`].
    pub fn polytopes(&self, tolerance: f64) -> Result<ShapeBounds, FacetError> {
        Ok(ShapeBounds::outermost(self.lower.faceted(tolerance)?, self.upper.faceted(tolerance)?))
    }

    /// Support functions `(lower, upper)` in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> (f64, f64) {
        (self.lower.support(n), self.upper.support(n))
    }
}

/// An intersection of equal balls, widened by a ball: its edges and corners are rounded.
#[derive(Clone, Debug, PartialEq)]
pub struct RoundedIntersection {
    core: BallIntersection,
    margin: f64,
}

impl RoundedIntersection {
    /// The intersection of balls before it is widened.
    #[must_use]
    pub fn core(&self) -> &BallIntersection {
        &self.core
    }

    /// Radius of the ball by which the intersection is widened, in m.
    #[must_use]
    pub fn margin(&self) -> f64 {
        self.margin
    }

    /// Volume, area and mean curvature.
    #[must_use]
    pub fn measures(&self) -> ConvexMeasures {
        self.core.measures().grown(self.margin)
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.measures().volume
    }
}

impl ConvexBody for RoundedIntersection {
    fn climb(&self) -> Climb<'_> {
        let mut walk = BallWalk::new(&self.core);
        Box::new(move |d| walk.farthest(d) + d.normalize_or_zero() * self.margin)
    }

    /// Support function in m, in time O(n).
    fn support(&self, n: Direction) -> f64 {
        self.core.support(n) + self.margin
    }

    /// Whether `point` is inside; one outside by a few units of rounding may be admitted.
    fn contains(&self, point: DVec3) -> bool {
        let mut walk = BallWalk::new(&self.core);
        let start = walk.farthest(point - self.core.interior());
        let found = nearest(point, &[start], |d| walk.farthest(d));
        found.certified <= self.margin + 4.0 * f64::EPSILON * (point.abs().max_element() + self.core.radius())
    }
}
