//! The intersection of balls of one radius.

use super::circle::Circle;
use super::error::CurvatureError;
use super::insert::Builder;
use super::measure::face_moments;
use super::steiner::ConvexMeasures;
use super::surface::{Shape, Surface};
use super::{ROUNDING, check_contacts};
use crate::bounds::ShapeBounds;
use crate::faceted::{FacetError, faceted_by_support};
use crate::hull::insertion_order;
use crate::integrals::Compensated;
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::DVec3;
use std::f64::consts::PI;

/// The intersection of balls of one radius, each touching from outside at a known point of the body: an upper bound of a
/// body that rolls freely inside of such a ball.
///
/// Balls are inserted one by one; each cuts off the corners that are outside of it. A ball that would cut the surface
/// inconsistently, which only rounding can cause, is left out and counted: that leaves the bound valid.
#[derive(Clone, Debug, PartialEq)]
pub struct BallIntersection {
    interior: DVec3,
    /// The caller's index of each ball of the surface.
    sources: Vec<u32>,
    surface: Surface,
    skipped: usize,
}

impl BallIntersection {
    /// The intersection of the balls of `radius` that touch at `contacts`, each centred at `point - radius normal`.
    ///
    /// # Errors
    /// [`CurvatureError::TooFlat`] names a contact outside of another's ball; [`CurvatureError::Points`] for no contacts or
    /// values that are not finite.
    pub fn through_contacts(contacts: &[ContactSample], radius: f64) -> Result<Self, CurvatureError> {
        check_contacts(contacts)?;
        if !(radius.is_finite() && radius > 0.0) {
            return Err(CurvatureError::Radii { min: 0.0, max: radius });
        }
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        let centres: Vec<DVec3> = contacts.iter().map(|c| c.point - c.normal.get() * radius).collect();
        let (all, outside) = Self::build(&centres, &points, radius, ROUNDING * radius);
        match outside {
            None => Ok(all),
            Some(Outside { sample, other, excess }) => {
                Err(CurvatureError::TooFlat { sample, other, excess, radius })
            }
        }
    }

    /// The intersection of the balls about `centres`, of which there is at least one; `touching[k]` is a point on sphere `k`
    /// and in all balls. Where that is not so by more than `tolerance` (m), a point outside of a ball is named, and the surface
    /// means nothing.
    pub(super) fn build(
        centres: &[DVec3],
        touching: &[DVec3],
        radius: f64,
        tolerance: f64,
    ) -> (Self, Option<Outside>) {
        let interior = touching.iter().sum::<DVec3>() / touching.len() as f64;
        let sources = insertion_order(touching);
        let sorted = sources.iter().map(|k| centres[*k as usize]).collect();
        let mut builder = Builder::new(sorted, radius, interior);
        for (p, source) in sources.iter().enumerate().skip(1) {
            builder.insert(p as u32, touching[*source as usize]);
        }
        let all = Self { interior, sources, surface: builder.surface, skipped: builder.skipped };
        let outside = all.find_outside(touching, tolerance);
        (all, outside)
    }

    /// A touching point that is outside of a ball.
    fn find_outside(&self, touching: &[DVec3], tolerance: f64) -> Option<Outside> {
        let surface = &self.surface;
        let mut face = 0;
        for (p, source) in self.sources.iter().enumerate() {
            let at = touching[*source as usize];
            let excess = |ball: u32| at.distance(surface.centre(ball)) - surface.radius;
            let mut worst = (f64::NEG_INFINITY, 0);
            let mut compare = |ball: u32| {
                let excess = excess(ball);
                if excess > worst.0 {
                    worst = (excess, ball);
                }
            };
            if surface.has_face(p as u32) {
                // A face is what its neighbours leave of its sphere, on which the point is.
                surface.for_each_neighbour(p as u32, &mut compare);
            } else {
                if !surface.has_face(face) {
                    face = self.any_face();
                }
                let direction = (at - self.interior).normalize_or_zero();
                face = surface.face_along(self.interior, direction, face).0;
                compare(face);
            }
            if worst.0 > tolerance {
                let other = self.sources[worst.1 as usize] as usize;
                return Some(Outside { sample: *source as usize, other, excess: worst.0 });
            }
        }
        None
    }

    fn any_face(&self) -> u32 {
        match self.surface.shape {
            Shape::Ball(k) | Shape::Lens(k, _) => k,
            Shape::Net => self.surface.live_corners().next().map_or(0, |c| c.balls[0]),
        }
    }

    /// Radius of the balls, in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.surface.radius
    }

    pub(super) fn surface(&self) -> &Surface {
        &self.surface
    }

    /// A point in all balls.
    pub(super) fn interior(&self) -> DVec3 {
        self.interior
    }

    pub(super) fn faces(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.sources.len() as u32).filter(|k| self.surface.has_face(*k))
    }

    /// Balls that carry a face, by index into the contacts.
    pub fn face_sources(&self) -> impl Iterator<Item = usize> + '_ {
        self.faces().map(|k| self.sources[k as usize] as usize)
    }

    /// Balls left out because rounding made their edges inconsistent; the bound holds without them.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.skipped
    }

    /// Corners, where three faces meet.
    pub fn corners(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.surface.live_corners().map(|c| c.at)
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.measures().volume
    }

    /// Volume, area and mean curvature.
    ///
    /// Volume is the sum over the faces of `(rho A + (c - o) . N) / 3` with the face's area `A` and vector area `N`, both as
    /// integrals along its edges; the mean curvature is that of the faces, `A / rho`, and half of length times angle between
    /// the faces of each edge.
    #[must_use]
    pub fn measures(&self) -> ConvexMeasures {
        let (surface, rho) = (&self.surface, self.surface.radius);
        let (mut threefold, mut total, mut edges) =
            (Compensated::default(), Compensated::default(), Compensated::default());
        let mut arcs = Vec::new();
        for k in self.faces() {
            surface.arcs_of(k, &mut arcs);
            let (area, vector) = if arcs.is_empty() {
                (4.0 * PI * rho * rho, DVec3::ZERO)
            } else {
                face_moments(surface, k, &arcs)
            };
            threefold.add(rho * area + (surface.centre(k) - self.interior).dot(vector));
            total.add(area);
            for (i, arc) in arcs.iter().enumerate() {
                let circle = Circle::between(surface.centre(k), surface.centre(arc.other), rho);
                let length =
                    circle.radius * surface.angle(&circle, arc.start, arcs[(i + 1) % arcs.len()].start);
                // Each edge is met from both sides.
                edges.add(0.25 * length * circle.face_angle(rho));
            }
        }
        let area = total.value();
        ConvexMeasures { volume: threefold.value() / 3.0, area, mean_curvature: area / rho + edges.value() }
    }

    /// Polytopes inside and outside of the body, within `tolerance` (m) of each other: meshes of its surface, and a certified
    /// bracket of its volume.
    ///
    /// # Errors
    /// [`FacetError`] for a tolerance that is not possible or takes too many facets, and for a body without interior.
    pub fn faceted(&self, tolerance: f64) -> Result<ShapeBounds, FacetError> {
        faceted_by_support(|d| self.support_point(d), tolerance)
    }

    /// Whether `point` is in all balls, to rounding.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.faces().all(|k| point.distance(self.surface.centre(k)) <= self.radius() * (1.0 + ROUNDING))
    }

    /// Support function in m, in time O(n).
    #[must_use]
    pub fn support(&self, n: Direction) -> f64 {
        self.support_point(n.get()).dot(n.get())
    }

    /// The point farthest along `d`: of a face, an edge or a corner.
    pub(super) fn support_point(&self, d: DVec3) -> DVec3 {
        let n = d.normalize_or_zero();
        self.extreme_point(
            |centre| n * self.radius() + centre,
            |circle| n - circle.axis * n.dot(circle.axis),
            |p| p.dot(n),
            |_| n,
        )
    }

    /// The largest distance of a point of the intersection from `point`.
    pub(super) fn farthest_from(&self, point: DVec3) -> f64 {
        let away = |from: DVec3| (from - point).normalize_or(DVec3::X);
        let farthest = self.extreme_point(
            |centre| centre + away(centre) * self.radius(),
            |circle| {
                let w = circle.middle - point;
                w - circle.axis * w.dot(circle.axis)
            },
            |p| p.distance_squared(point),
            |p| p - point,
        );
        farthest.distance(point)
    }

    /// The point of the surface that is best by a measure that has one maximum on each sphere, `top` of its centre, and one on
    /// each circle, in a direction `across` from its middle; it rises along its `gradient`.
    fn extreme_point(
        &self,
        top: impl Fn(DVec3) -> DVec3,
        across: impl Fn(&Circle) -> DVec3,
        measure: impl Fn(DVec3) -> f64,
        gradient: impl Fn(DVec3) -> DVec3,
    ) -> DVec3 {
        let (surface, rho) = (&self.surface, self.surface.radius);
        let mut best = (f64::NEG_INFINITY, self.interior);
        let mut compare = |p: DVec3| {
            let value = measure(p);
            if value > best.0 {
                best = (value, p);
            }
        };
        let mut arcs = Vec::new();
        for k in self.faces() {
            let top = top(surface.centre(k));
            surface.arcs_of(k, &mut arcs);
            if arcs.iter().all(|arc| !surface.is_outside(arc.other, top)) {
                compare(top);
            }
            for (i, arc) in arcs.iter().enumerate() {
                compare(arc.start);
                let end = arcs[(i + 1) % arcs.len()].start;
                // An edge of less than half a circle has its best point inside just if the measure rises from its start and
                // falls to its end: two products in the place of two angles.
                let (a, b) = (surface.centre(k), surface.centre(arc.other));
                let (axis, middle) = (b - a, (a + b) * 0.5);
                let rises = |p: DVec3| gradient(p).dot(axis.cross(p - middle)) > 0.0;
                let is_short = axis.cross(arc.start - middle).dot(end - middle) > 0.0;
                if is_short && (!rises(arc.start) || rises(end)) {
                    continue;
                }
                let circle = Circle::between(surface.centre(k), surface.centre(arc.other), rho);
                let across = across(&circle);
                if across.length_squared() > 0.0 {
                    let highest = circle.middle + across.normalize() * circle.radius;
                    if surface.angle(&circle, arc.start, highest) <= surface.angle(&circle, arc.start, end) {
                        compare(highest);
                    }
                }
            }
        }
        best.1
    }
}

/// A point that is outside of a ball, by the caller's indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outside {
    pub(super) sample: usize,
    pub(super) other: usize,
    /// How far, in m.
    pub(super) excess: f64,
}
