//! Points of an intersection of equal balls that are the farthest along a direction, or from a point.

use super::balls::BallIntersection;
use super::circle::Circle;
use super::surface::{Arc, Surface};
use glam::DVec3;

/// A measure of points that has one maximum on each sphere and one on each circle.
struct Measure<T, A, V, G> {
    /// The maximum on the sphere about a centre.
    top: T,
    /// The direction of the maximum on a circle from its middle.
    across: A,
    value: V,
    /// In which direction the measure rises.
    gradient: G,
}

impl<T, A, V, G> Measure<T, A, V, G>
where
    T: Fn(DVec3) -> DVec3,
    A: Fn(&Circle) -> DVec3,
    V: Fn(DVec3) -> f64,
    G: Fn(DVec3) -> DVec3,
{
    /// Calls `visit` with the points of the face of ball `k` of which one is its best: the top of its sphere, and corners and
    /// tops of its edges with the faces beyond.
    fn candidates(
        &self,
        surface: &Surface,
        k: u32,
        arcs: &mut Vec<Arc>,
        mut visit: impl FnMut(f64, DVec3, &[u32]),
    ) {
        let (centre, rho) = (surface.centre(k), surface.radius);
        let top = (self.top)(centre);
        surface.arcs_of(k, arcs);
        if arcs.iter().all(|arc| !surface.is_outside(arc.other, top)) {
            visit((self.value)(top), top, &[]);
        }
        for (i, arc) in arcs.iter().enumerate() {
            let before = arcs[(i + arcs.len() - 1) % arcs.len()].other;
            visit((self.value)(arc.start), arc.start, &[before, arc.other]);
            let end = arcs[(i + 1) % arcs.len()].start;
            // An edge of less than half a circle has its best point inside just if the measure rises from its start and
            // falls to its end: two products in the place of two angles.
            let beyond = surface.centre(arc.other);
            let (axis, middle) = (beyond - centre, (centre + beyond) * 0.5);
            let rises = |p: DVec3| (self.gradient)(p).dot(axis.cross(p - middle)) > 0.0;
            // A whole circle is not short, whatever rounding makes of its ends, which are one point.
            let is_short = arcs.len() > 1 && axis.cross(arc.start - middle).dot(end - middle) > 0.0;
            if is_short && (!rises(arc.start) || rises(end)) {
                continue;
            }
            let circle = Circle::between(centre, beyond, rho);
            let across = (self.across)(&circle);
            if across.length_squared() > 0.0 {
                let highest = circle.middle + across.normalize() * circle.radius;
                if surface.angle(&circle, arc.start, highest) <= surface.angle(&circle, arc.start, end) {
                    visit((self.value)(highest), highest, &[arc.other]);
                }
            }
        }
    }
}

impl BallIntersection {
    /// The largest distance of a point of the intersection from `point`, in time O(n).
    pub(super) fn farthest_from(&self, point: DVec3) -> f64 {
        let (surface, rho) = (self.surface(), self.radius());
        let measure = Measure {
            top: |centre: DVec3| centre + (centre - point).normalize_or(DVec3::X) * rho,
            across: |circle: &Circle| {
                let w = circle.middle - point;
                w - circle.axis * w.dot(circle.axis)
            },
            value: |p: DVec3| p.distance(point),
            gradient: |p: DVec3| p - point,
        };
        let (mut farthest, mut arcs) = (0.0_f64, Vec::new());
        for k in self.faces() {
            measure.candidates(surface, k, &mut arcs, |distance, _, _| farthest = farthest.max(distance));
        }
        farthest
    }
}

/// A climb from face to face to the farthest point along a direction: few steps where the directions change little from one
/// query to the next.
///
/// Where the best point of a face is the best of all faces at it, it is the farthest point of the surface near it, and hence
/// of the whole, which is convex. Where faces meet closer to each other than rounding tells, all that are level are looked at.
#[derive(Clone, Default)]
pub(super) struct Climb {
    /// Where the next climb starts: a ball that has a face.
    pub(super) face: u32,
    met: Vec<u32>,
    search: u32,
    stack: Vec<(f64, u32)>,
    arcs: Vec<Arc>,
}

impl Climb {
    /// The point of the surface farthest along the unit vector `n`, on ball [`Self::face`].
    pub(super) fn farthest(&mut self, surface: &Surface, n: DVec3) -> DVec3 {
        let Self { face: best_face, met, search, stack, arcs } = self;
        met.resize(surface.centres.len(), 0);
        *search += 1;
        let measure = Measure {
            top: |centre| n * surface.radius + centre,
            across: |circle: &Circle| n - circle.axis * n.dot(circle.axis),
            value: |p: DVec3| p.dot(n),
            gradient: |_| n,
        };
        stack.push((f64::INFINITY, *best_face));
        let mut best = (f64::NEG_INFINITY, surface.centre(*best_face));
        while let Some((height, face)) = stack.pop() {
            if height < best.0 - surface.rounding || met[face as usize] == *search {
                continue;
            }
            met[face as usize] = *search;
            measure.candidates(surface, face, arcs, |value, point, beyond| {
                if value > best.0 {
                    best = (value, point);
                    *best_face = face;
                }
                if value >= best.0 - surface.rounding {
                    stack.extend(beyond.iter().map(|other| (value, *other)));
                }
            });
        }
        best.1
    }
}

/// Support points of an intersection of balls.
pub(super) struct BallWalk<'a> {
    surface: &'a Surface,
    climb: Climb,
}

impl<'a> BallWalk<'a> {
    pub(super) fn new(all: &'a BallIntersection) -> Self {
        Self { surface: all.surface(), climb: Climb { face: all.any_face(), ..Climb::default() } }
    }

    /// The point farthest along `d`, which need not be of unit length.
    pub(super) fn farthest(&mut self, d: DVec3) -> DVec3 {
        self.climb.farthest(self.surface, d.normalize_or_zero())
    }
}
