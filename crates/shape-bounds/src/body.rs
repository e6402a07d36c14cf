//! Convex bodies, whatever they were bounded by: all of them are known by their farthest points, and what else is asked follows from these.
//!
//! ```
//! use contact_kinematics::CurvatureRadii;
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::body::ConvexBody;
//! use shape_bounds::curvature::SharpBounds;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A unit sphere that was touched at the corners of a cube, and is nowhere sharper than one of radius 0.8, nor flatter than one of 1.5.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
//! let contacts = ContactSample::from_raw((0..8).map(|i| corner(i).normalize()).map(|n| (n, n)))?;
//! let bounds = SharpBounds::from_contacts(&contacts, CurvatureRadii { min: 0.8, max: 1.5 })?;
//! let bodies: [&dyn ConvexBody; 2] = [bounds.lower(), bounds.upper()];
//! let outside = DVec3::X * 3.0;
//! let [far, near] = bodies.map(|body| body.distance(outside).certified);
//! assert!(far > 2.0 && near < 2.0 && bodies.iter().all(|body| body.contains(DVec3::ZERO)));
//! // Volumes, certified from within and from without.
//! let [[_, above], [below, _]] = [bodies[0].moments(1e-3)?, bodies[1].moments(1e-3)?];
//! assert!(above.volume < below.volume);
//! # Ok(())
//! # }
//! ```

use crate::bounds::ShapeBounds;
use crate::distance::{Nearest, farthest_of, nearest};
use crate::faceted::{FacetError, faceted_by_support};
use contact_kinematics::{Direction, SupportFunction};
use exact_hull::{Intersection, Polyhedron, SolidHull, SolidMoments, SupportWalk};
use glam::DVec3;

/// Farthest points of a body: a function that keeps where it was, so that one direction near to the one before costs little.
pub type Climb<'a> = Box<dyn FnMut(DVec3) -> DVec3 + 'a>;

/// A convex body that is known by its farthest points along directions: every bound of this crate, and every fit.
///
/// What a type knows better than by its farthest points alone it answers itself.
pub trait ConvexBody {
    /// A farthest point along each direction (of any length but zero) that is asked for, in m.
    fn climb(&self) -> Climb<'_>;

    /// The farthest point along `n`, in m.
    fn support_point(&self, n: Direction) -> DVec3 {
        self.climb()(n.get())
    }

    /// Support function `max n . y` over the body, in m.
    fn support(&self, n: Direction) -> f64 {
        self.support_point(n).dot(n.get())
    }

    /// Whether `point` is inside; one outside by a few units of rounding may be admitted.
    fn contains(&self, point: DVec3) -> bool {
        let found = self.distance(point);
        let size = point.abs().max_element().max(found.point.abs().max_element());
        found.certified <= 4.0 * f64::EPSILON * size
    }

    /// The nearest point of the body to `point`, and what distance that is certified by.
    fn distance(&self, point: DVec3) -> Nearest {
        let mut climb = self.climb();
        // That farthest towards it is a better start than any: from one that is far away, much of the surface is walked over.
        let start = climb(if point == DVec3::ZERO { DVec3::X } else { point });
        nearest(point, &[start], climb)
    }

    /// Polytopes inside and outside of the body, within `tolerance` (m) of each other: meshes of its surface, and a certified
    /// bracket of its volume.
    ///
    /// # Errors
    /// [`FacetError`] for a tolerance that is not possible or takes too many facets, and for a body without interior.
    fn faceted(&self, tolerance: f64) -> Result<ShapeBounds, FacetError> {
        faceted_by_support(self.climb(), tolerance)
    }

    /// Volume, centroid and area of these polytopes, the one inside first: the body's volume is between theirs.
    ///
    /// # Errors
    /// Those of [`Self::faceted`].
    fn moments(&self, tolerance: f64) -> Result<[SolidMoments; 2], FacetError> {
        let polytopes = self.faceted(tolerance)?;
        let inner = polytopes.lower().solid().map_or_else(SolidMoments::default, SolidHull::moments);
        match polytopes.upper() {
            Intersection::Bounded(outer) => Ok([inner, outer.moments()]),
            Intersection::Unbounded(_) => Err(FacetError::Unbounded),
        }
    }
}

impl ConvexBody for SolidHull {
    fn climb(&self) -> Climb<'_> {
        let mut walk = SupportWalk::new(self);
        Box::new(move |d| walk.farthest(d))
    }

    /// Exact.
    fn contains(&self, point: DVec3) -> bool {
        Self::contains(self, point)
    }
}

impl ConvexBody for Polyhedron {
    fn climb(&self) -> Climb<'_> {
        Box::new(|d| farthest_of(self.vertices(), d))
    }

    fn contains(&self, point: DVec3) -> bool {
        Self::contains(self, point)
    }
}

/// A body that is known by its support function, as a fit is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfSupport<F>(pub F);

impl<F: SupportFunction> ConvexBody for OfSupport<F> {
    fn climb(&self) -> Climb<'_> {
        Box::new(|d| Direction::new(d).map_or(DVec3::ZERO, |n| self.0.jet(n).point))
    }

    fn support(&self, n: Direction) -> f64 {
        self.0.value(n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::curvature::{RoundedHull, SharpBounds};
    use crate::generators::Source;
    use crate::sample::ContactSample;
    use contact_kinematics::{CurvatureRadii, Ellipsoid};
    use exact_hull::Hull;

    /// Contacts of an ellipsoid whose radii of curvature are from 0.64 to 1.57 m.
    fn contacts(source: &mut Source, shape: &Ellipsoid) -> Vec<ContactSample> {
        let mut normals = std::iter::repeat_with(|| Direction::new(source.normal3())).flatten();
        let touched = |normal: Direction| ContactSample { point: shape.jet(normal).point, normal };
        normals.by_ref().take(80).map(touched).collect()
    }

    /// Of every kind of body: the support function is the height of the farthest point, what is inside is at no distance, and what is beyond a farthest point is at
    /// that distance; polytopes are around the volume.
    #[test]
    fn all_bodies_agree_with_their_farthest_points() {
        let mut source = Source::new(19);
        let shape = Ellipsoid::new(DVec3::new(1.25, 1.0, 0.9)).unwrap();
        let touched = contacts(&mut source, &shape);
        let points: Vec<DVec3> = touched.iter().map(|c| c.point).collect();
        let Ok(Hull::Solid(hull)) = Hull::of(&points) else { panic!("flat") };
        let plain = ShapeBounds::from_contacts(&touched).unwrap();
        let sharp = SharpBounds::from_contacts(&touched, CurvatureRadii { min: 0.5, max: 2.0 }).unwrap();
        let rounded = RoundedHull::of(&points, 0.1).unwrap();
        let fit = OfSupport(shape);
        let volume = 4.0 / 3.0 * std::f64::consts::PI * 1.25 * 0.9;
        let bodies: [(&dyn ConvexBody, f64); 7] = [
            (&hull, hull.volume()),
            (plain.upper().bounded().unwrap(), plain.upper_volume()),
            (sharp.lower(), sharp.lower().volume()),
            (sharp.upper(), sharp.upper().volume()),
            (sharp.upper().core(), sharp.upper().core().volume()),
            (&rounded, rounded.volume()),
            (&fit, volume),
        ];
        for (kind, (body, volume)) in bodies.into_iter().enumerate() {
            for _ in 0..20 {
                let Ok(n) = Direction::new(source.normal3()) else { continue };
                let point = body.support_point(n);
                assert!((body.support(n) - point.dot(n.get())).abs() < 1e-12, "{kind}");
                let beyond = body.distance(point + n.get() * 0.3);
                assert!((beyond.certified - 0.3).abs() < 1e-7, "{kind}: {beyond:?}");
                assert!(
                    (body.distance(point * 2.0).certified > 0.1) && !body.contains(point * 2.0),
                    "{kind}"
                );
                assert!(
                    body.contains(point * 0.999) && body.distance(point * 0.5).certified == 0.0,
                    "{kind}"
                );
            }
            let [inner, outer] = body.moments(1e-3).unwrap();
            assert!(
                inner.volume <= volume * (1.0 + 1e-12) && volume <= outer.volume * (1.0 + 1e-12),
                "{kind}"
            );
            assert!(outer.volume - inner.volume < 2e-3 * outer.area, "{kind}: {inner:?} {outer:?}");
            assert!(inner.centroid.distance(outer.centroid) < 2e-3, "{kind}");
        }
    }
}
