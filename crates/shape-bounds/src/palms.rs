//! What contacts with spherical palms say about a convex body.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::palms::{PalmContact, PalmIntersection};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit ball, touched at the corners of a cube.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
//! let contacts = ContactSample::from_raw((0..8).map(|i| corner(i).normalize()).map(|n| (n, n)))?;
//! // The palms are hollow, of radius 3: smaller is what they leave than what flat ones would, a regular octahedron.
//! let palms: Vec<_> = contacts.into_iter().map(|contact| PalmContact { contact, hollow_radius: 3.0 }).collect();
//! let bounds = PalmIntersection::of(&palms)?.faceted(0.01)?;
//! let ball = 4.0 / 3.0 * std::f64::consts::PI;
//! assert!(ball < bounds.lower_volume() && bounds.upper_volume() < 4.0 * 3.0_f64.sqrt());
//! # Ok(())
//! # }
//! ```

use crate::bounds::ShapeBounds;
use crate::faceted::{FacetError, faceted};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::DVec3;
use thiserror::Error;

/// By how much a contact may be outside of another palm's ball, relative to the size, before it is an error: rounding.
const ROUNDING: f64 = 1e-12;

/// Steps tried on the way to a point deep inside.
const STEPS: usize = 40;

/// A contact with a palm that is part of a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmContact {
    /// Where the palm touches, in the body's frame.
    pub contact: ContactSample,
    /// Radius in m of the palm where it is hollow, as seen from the body: the body lies in the ball of this radius. Infinite for
    /// a palm that is flat or bulges towards the body, of which a convex body knows the tangent plane alone.
    pub hollow_radius: f64,
}

impl PalmContact {
    /// How far `y` is outside of what the palm leaves, in m; negative inside.
    #[must_use]
    pub fn excess(&self, y: DVec3) -> f64 {
        let ContactSample { point, normal } = self.contact;
        let w = y - point;
        let height = w.dot(normal.get());
        if self.hollow_radius.is_infinite() {
            return height;
        }
        // |w + b n| - b, written so that a large radius costs no digits.
        let b = self.hollow_radius;
        let distance = (w + normal.get() * b).length();
        (w.length_squared() + 2.0 * b * height) / (distance + b)
    }

    /// The outward normal of the palm's surface as seen from `y` on it.
    fn normal_at(&self, y: DVec3) -> Direction {
        let ContactSample { point, normal } = self.contact;
        Direction::new((y - point) / self.hollow_radius + normal.get()).unwrap_or(normal)
    }

    /// Distance at which the ray from `origin`, inside, along the unit vector `d` leaves what the palm leaves.
    fn exit(&self, origin: DVec3, d: DVec3) -> f64 {
        let ContactSample { point, normal } = self.contact;
        let w = origin - point;
        // t^2 / (2 b) + t p + q = 0, with the product of the roots for the one that does not cancel.
        let half = 0.5 / self.hollow_radius;
        let p = normal.get().dot(d) + 2.0 * half * w.dot(d);
        let q = half * w.length_squared() + normal.get().dot(w);
        let root = (p * p - 4.0 * half * q).max(0.0).sqrt();
        if p > 0.0 { -2.0 * q / (p + root) } else { (root - p) / (2.0 * half) }
    }
}

/// Why contacts with palms give no bound.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PalmError {
    /// No contacts.
    #[error("no contacts: touch the body")]
    Empty,
    /// A point or radius that is not possible.
    #[error("contact {index}: point ({}, {}, {}), palm radius {radius} m: the point must be finite, the radius positive", point.x, point.y, point.z)]
    Value {
        /// Which contact.
        index: usize,
        /// Its point as given.
        point: DVec3,
        /// Its palm's radius as given.
        radius: f64,
    },
    /// A contact is outside of another palm's ball.
    #[error(
        "contact {sample} is {excess:e} m behind the palm at contact {other}: a contact is wrong, or the palm's radius"
    )]
    Behind {
        /// The contact outside.
        sample: usize,
        /// The contact whose palm it is behind.
        other: usize,
        /// How far, in m.
        excess: f64,
    },
}

/// The intersection of what palms of any radii leave: balls for hollow palms, half-spaces for others. An upper bound of a
/// convex body that they touch.
///
/// For palms of one radius [`crate::curvature::BallIntersection`] is exact; here the surface is found to any stated tolerance.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmIntersection {
    palms: Vec<PalmContact>,
    interior: DVec3,
}

impl PalmIntersection {
    /// The intersection of what `palms` leave, in time O(n^2) for the check that they agree.
    ///
    /// # Errors
    /// [`PalmError`] for no contacts, values that are not possible, and a contact that lies behind another's palm.
    pub fn of(palms: &[PalmContact]) -> Result<Self, PalmError> {
        if palms.is_empty() {
            return Err(PalmError::Empty);
        }
        for (index, palm) in palms.iter().enumerate() {
            let (point, radius) = (palm.contact.point, palm.hollow_radius);
            if !(point.is_finite() && radius > 0.0) {
                return Err(PalmError::Value { index, point, radius });
            }
        }
        let interior = palms.iter().map(|p| p.contact.point).sum::<DVec3>() / palms.len() as f64;
        let size = palms.iter().map(|p| p.contact.point.abs().max_element()).fold(0.0, f64::max);
        for (other, palm) in palms.iter().enumerate() {
            for (sample, touched) in palms.iter().enumerate() {
                let excess = palm.excess(touched.contact.point);
                if excess > ROUNDING * size {
                    return Err(PalmError::Behind { sample, other, excess });
                }
            }
        }
        let mut all = Self { palms: palms.to_vec(), interior };
        all.move_inwards();
        Ok(all)
    }

    /// Moves the interior point, where it is on the surface, as of one or two palms, against the normals to where it is
    /// deepest among steps of powers of two.
    fn move_inwards(&mut self) {
        let mean = self.interior;
        let inwards = -self.palms.iter().map(|p| p.contact.normal.get()).sum::<DVec3>().normalize_or_zero();
        let mut step = self.palms.iter().map(|p| p.hollow_radius).fold(f64::INFINITY, f64::min);
        let mut deepest = self.excess(mean);
        for _ in 0..if step.is_finite() { STEPS } else { 0 } {
            let candidate = mean + inwards * step;
            let excess = self.excess(candidate);
            if excess < deepest {
                (deepest, self.interior) = (excess, candidate);
            }
            step *= 0.5;
        }
    }

    /// The largest distance of `point` behind a palm, in m; negative inside.
    #[must_use]
    pub fn excess(&self, point: DVec3) -> f64 {
        self.palms.iter().map(|p| p.excess(point)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Polytopes inside and outside of the intersection, within `tolerance` (m) of each other: their support functions and
    /// volumes enclose those of the intersection, and their meshes its surface.
    ///
    /// # Errors
    /// [`FacetError`] for a tolerance that is not possible or takes too many facets, and an intersection that has no end or no
    /// interior.
    pub fn faceted(&self, tolerance: f64) -> Result<ShapeBounds, FacetError> {
        // A few palms do not make a polytope; where the surface lies along the axes may.
        let axes = [Direction::X, Direction::Y, Direction::Z];
        let around = axes.into_iter().flat_map(|d| [d, -d]).map(|d| self.touched_along(d.get()));
        let palms = self.palms.iter().map(|p| p.contact);
        let start = palms.chain(around.filter(|c| c.point.is_finite())).collect();
        faceted(start, tolerance, |gap| self.touched_along((gap.outer - self.interior).normalize_or_zero()))
    }

    /// The surface where the ray from the interior along `d` leaves the intersection; not finite where it does not.
    fn touched_along(&self, d: DVec3) -> ContactSample {
        let mut first = (f64::INFINITY, &self.palms[0]);
        for palm in &self.palms {
            let exit = palm.exit(self.interior, d);
            if exit < first.0 {
                first = (exit, palm);
            }
        }
        let point = self.interior + d * first.0;
        ContactSample { point, normal: first.1.normal_at(point) }
    }
}

#[cfg(test)]
mod tests;
