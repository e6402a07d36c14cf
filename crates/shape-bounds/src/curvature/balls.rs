//! The intersection of balls of one radius.

use super::circle::Circle;
use super::error::CurvatureError;
use super::insert::Builder;
use super::measure::face_moments;
use super::steiner::ConvexMeasures;
use super::support::BallWalk;
use super::surface::{Shape, Surface};
use super::{ROUNDING, VolumeRange, check_contacts};
use crate::body::{Climb, ConvexBody};
use crate::sample::ContactSample;
use exact_hull::arithmetic::Compensated;
use exact_hull::insertion_order;
use glam::DVec3;
use std::f64::consts::PI;

/// What a ball cuts off by less than this, relative to radius and coordinates, is rounding of its centre.
const CUT: f64 = 64.0 * f64::EPSILON;

/// By how much radii are made larger, one after the other, until the surface stands a check.
const SLACKS: [f64; 6] = [0.0, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5];
/// How far vector areas may be from closing, relative to the area.
const CLOSED: f64 = 1e-9;
/// Of so many balls one may be left out for rounding.
const LEFT_OUT: usize = 100;

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
        let volumes = VolumeRange::of(contacts, 0.0);
        match Self::settled(&centres, &points, radius, ROUNDING * radius, |all, slack| {
            volumes.holds(all.volume(), slack)
        }) {
            Ok(all) => Ok(all),
            Err(Unsettled::Outside(Outside { sample, other, excess })) => {
                Err(CurvatureError::TooFlat { sample, other, excess, radius })
            }
            Err(Unsettled::Rounding) => Err(CurvatureError::Rounding { min: 0.0, max: radius }),
        }
    }

    /// [`Self::build`] of balls whose touching points are on their spheres, with a radius as much larger as it takes for
    /// surface and measures to stand a check.
    ///
    /// Where a body's own radius is the limit, all spheres of a part of its surface pass through one point, and rounding of
    /// their centres decides what is left there. Of larger balls there is a small ball left in common instead, whose corners
    /// can be told. That makes an intersection larger and a ball hull smaller, so that both remain bounds.
    pub(super) fn settled(
        centres: &[DVec3],
        touching: &[DVec3],
        radius: f64,
        tolerance: f64,
        is_right: impl Fn(&Self, f64) -> bool,
    ) -> Result<Self, Unsettled> {
        let size = centres.iter().map(|c| c.abs().max_element()).fold(radius, f64::max);
        for slack in SLACKS {
            let kept = distinct(centres, slack * size);
            let of = |all: &[DVec3]| kept.iter().map(|k| all[*k as usize]).collect::<Vec<DVec3>>();
            let (mut all, outside) =
                Self::build(&of(centres), &of(touching), radius + slack * size, tolerance);
            all.sources.iter_mut().for_each(|source| *source = kept[*source as usize]);
            // A pair that contradicts the radius is what it is, however the surface came out.
            if let Some(Outside { sample, other, excess }) = outside {
                let [sample, other] = [sample, other].map(|k| kept[k] as usize);
                return Err(Unsettled::Outside(Outside { sample, other, excess }));
            }
            let room = tolerance + 2.0 * slack * size;
            let whole = all.skipped * LEFT_OUT <= centres.len() && all.is_closed();
            if whole && all.touches(centres, touching, radius, room) && is_right(&all, slack) {
                return Ok(all);
            }
        }
        Err(Unsettled::Rounding)
    }

    /// Whether the surface reaches as far along each touching point's normal as that point, and no more than `room` (m) further.
    fn touches(&self, centres: &[DVec3], touching: &[DVec3], radius: f64, room: f64) -> bool {
        let mut walk = BallWalk::new(self);
        let rounding = 4.0 * self.surface.rounding;
        insertion_order(touching).into_iter().all(|k| {
            let (centre, touching) = (centres[k as usize], touching[k as usize]);
            let n = (touching - centre) / radius;
            let height = n.dot(walk.farthest(n) - touching);
            (-room - rounding..=room + rounding).contains(&height)
        })
    }

    /// Whether the vector areas of the faces add up to zero, as those of a closed surface do.
    fn is_closed(&self) -> bool {
        let (mut sum, mut total, mut arcs) = (DVec3::ZERO, 0.0, Vec::new());
        for k in self.faces() {
            self.surface.arcs_of(k, &mut arcs);
            if !arcs.is_empty() {
                let (area, vector) = face_moments(&self.surface, k, &arcs);
                sum += vector;
                total += area;
            }
        }
        sum.length() <= CLOSED * total
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
        let size = centres.iter().chain(touching).map(|c| c.abs().max_element()).fold(radius, f64::max);
        let mut builder = Builder::new(sorted, radius, CUT * size);
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

    pub(super) fn any_face(&self) -> u32 {
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
}

impl ConvexBody for BallIntersection {
    fn climb(&self) -> Climb<'_> {
        let mut walk = BallWalk::new(self);
        Box::new(move |d| walk.farthest(d))
    }

    /// Whether `point` is in all balls, to rounding.
    fn contains(&self, point: DVec3) -> bool {
        self.faces().all(|k| point.distance(self.surface.centre(k)) <= self.radius() * (1.0 + ROUNDING))
    }
}

/// Indices of centres of which no two are closer to each other than `least` (m); any other is that close to one of them.
fn distinct(centres: &[DVec3], least: f64) -> Vec<u32> {
    let mut order: Vec<u32> = (0..centres.len() as u32).collect();
    if least == 0.0 {
        return order;
    }
    // Along a direction that is across no plane of the data, few are level with each other.
    const ACROSS: DVec3 = DVec3::new(0.417_3, 0.551_9, 0.722_1);
    let along = |k: u32| centres[k as usize].dot(ACROSS);
    order.sort_unstable_by(|a, b| along(*a).total_cmp(&along(*b)));
    let mut kept: Vec<u32> = Vec::with_capacity(order.len());
    for k in order {
        let level = kept.iter().rev().take_while(|other| along(k) - along(**other) <= least);
        let is_new = !level.into_iter().any(|o| centres[*o as usize].distance(centres[k as usize]) <= least);
        if is_new {
            kept.push(k);
        }
    }
    kept.sort_unstable();
    kept
}

/// Why balls have no intersection that stands a check.
pub(super) enum Unsettled {
    /// A touching point is not in all balls.
    Outside(Outside),
    /// Rounding decides, whatever the slack.
    Rounding,
}

/// A point that is outside of a ball, by the caller's indices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Outside {
    pub(super) sample: usize,
    pub(super) other: usize,
    /// How far, in m.
    pub(super) excess: f64,
}
