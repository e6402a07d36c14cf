//! Bounds tightened by limits on the radii of curvature (paper, section 8).
//!
//! Where no principal radius of curvature is below `rho_min`, a ball of that radius rolls freely inside of the body; where
//! none is above `rho_max`, the body rolls freely inside of a ball of that radius (Blaschke). So the ball of radius
//! `rho_min` that touches from inside at a contact is in the body, and the one of radius `rho_max` contains it.
//!
//! ```
//! use contact_kinematics::CurvatureRadii;
//! use glam::DVec3;
//! use shape_bounds::curvature::CurvatureBounds;
//! use shape_bounds::{ContactSample, ShapeBounds};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit ball, touched at the corners of a cube.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
//! let contacts = ContactSample::from_raw((0..8).map(|i| corner(i).normalize()).map(|n| (n, n)))?;
//! let plain = ShapeBounds::from_contacts(&contacts)?;
//! let limited = CurvatureBounds::from_contacts(&contacts, CurvatureRadii { min: 0.7, max: 1.5 })?;
//! let ball = 4.0 / 3.0 * std::f64::consts::PI;
//! assert!(plain.lower_volume() < limited.lower().volume() && limited.lower().volume() < ball);
//! assert!(ball < limited.upper().volume() && limited.upper().volume() < plain.upper_volume());
//! # Ok(())
//! # }
//! ```

mod ball_hull;
mod balls;
mod circle;
#[cfg(test)]
mod degenerate_tests;
mod error;
mod insert;
mod measure;
#[cfg(test)]
mod oracle;
mod rounded;
mod sharp;
#[cfg(test)]
mod sharp_tests;
mod steiner;
mod support;
mod surface;
#[cfg(test)]
mod tests;

pub use ball_hull::BallHull;
pub use balls::BallIntersection;
pub use error::CurvatureError;
pub use rounded::RoundedHull;
pub use sharp::{RoundedIntersection, SharpBounds};
pub use steiner::ConvexMeasures;

use crate::body::ConvexBody;
use crate::sample::ContactSample;
use contact_kinematics::{CurvatureRadii, Direction};
use exact_hull::HalfSpace;
use exact_hull::Intersection;
use exact_hull::PointsError;
use glam::DVec3;

/// By how much contacts may contradict the limits before it is an error, relative to their size: rounding.
const ROUNDING: f64 = 1e-12;
/// Rounding of volumes, relative.
const VOLUME_ROUNDING: f64 = 1e-9;

/// Lower and upper bound of a convex body whose radii of curvature are limited.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvatureBounds {
    lower: RoundedHull,
    upper: BallIntersection,
}

impl CurvatureBounds {
    /// Bounds from contacts without noise on a body whose principal radii of curvature lie within `radii`.
    ///
    /// # Errors
    /// [`CurvatureError`] for limits that are not `0 <= min <= max < infinity`, values that are not finite, and contacts
    /// that contradict the limits (a pair of which the one lies outside of the other's outer ball, or inside of its inner
    /// ball, is named).
    pub fn from_contacts(contacts: &[ContactSample], radii: CurvatureRadii) -> Result<Self, CurvatureError> {
        if !(0.0 <= radii.min && radii.min <= radii.max && radii.max.is_finite()) {
            return Err(CurvatureError::Radii { min: radii.min, max: radii.max });
        }
        let centre = |c: &ContactSample, r: f64| c.point - c.normal.get() * r;
        let inner: Vec<DVec3> = contacts.iter().map(|c| centre(c, radii.min)).collect();
        let lower = RoundedHull::of(&inner, radii.min)?;
        let upper = BallIntersection::through_contacts(contacts, radii.max)?;
        check_inner(contacts, radii.min, &lower)?;
        Ok(Self { lower, upper })
    }

    /// The hull of the inner balls: in the body.
    #[must_use]
    pub fn lower(&self) -> &RoundedHull {
        &self.lower
    }

    /// The intersection of the outer balls: around the body.
    #[must_use]
    pub fn upper(&self) -> &BallIntersection {
        &self.upper
    }

    /// Support functions `(lower, upper)` in direction `n`, in m.
    #[must_use]
    pub fn support(&self, n: Direction) -> (f64, f64) {
        (self.lower.support(n), self.upper.support(n))
    }
}

/// Volumes between which that of each bound lies, from constructions whose signs are exact: the hull of the inner balls, and the
/// half-spaces.
struct VolumeRange {
    least: f64,
    most: f64,
}

impl VolumeRange {
    /// For balls of radius `min` inside of the body.
    fn of(contacts: &[ContactSample], min: f64) -> Self {
        let inner: Vec<DVec3> = contacts.iter().map(|c| c.point - c.normal.get() * min).collect();
        let half_spaces: Vec<HalfSpace> = contacts.iter().map(ContactSample::half_space).collect();
        let least = RoundedHull::of(&inner, min).map_or(0.0, |hull| hull.volume());
        let upper = Intersection::of(&half_spaces).ok();
        let most = upper.and_then(|all| all.bounded().map(|p| p.volume())).unwrap_or(f64::INFINITY);
        Self { least, most }
    }

    /// Whether a volume is in the range, to rounding and what a relative `slack` of the radii changes.
    fn holds(&self, volume: f64, slack: f64) -> bool {
        let room = VOLUME_ROUNDING + 100.0 * slack;
        (self.least * (1.0 - room)..=self.most * (1.0 + room)).contains(&volume)
    }
}

/// Whether there are contacts, all of finite coordinates.
fn check_contacts(contacts: &[ContactSample]) -> Result<(), PointsError> {
    if contacts.is_empty() {
        return Err(PointsError::Empty);
    }
    match contacts.iter().position(|c| !c.point.is_finite()) {
        Some(index) => Err(PointsError::NotFinite { index, point: contacts[index].point }),
        None => Ok(()),
    }
}

/// The hull of the inner balls must not reach beyond a contact's plane.
fn check_inner(contacts: &[ContactSample], radius: f64, lower: &RoundedHull) -> Result<(), CurvatureError> {
    let size = contacts.iter().map(|c| c.point.abs().max_element()).fold(radius, f64::max);
    let mut farthest = lower.core_support();
    for (sample, c) in contacts.iter().enumerate() {
        let n = c.normal.get();
        let top = farthest(n);
        let excess = n.dot(top - c.point) + radius;
        if excess > ROUNDING * size {
            let centre = |c: &ContactSample| c.point - c.normal.get() * radius;
            let other = contacts.iter().position(|c| centre(c) == top).unwrap_or(sample);
            return Err(CurvatureError::TooRound { sample, other, excess, radius });
        }
    }
    Ok(())
}
