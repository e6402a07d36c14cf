//! The surface of an intersection of equal balls: corners where three spheres meet, with the corners at the other ends of
//! their three edges. As a graph it is the dual of a triangulated sphere, in which two balls may share several edges.

use super::circle::Circle;
use glam::DVec3;
use std::f64::consts::TAU;

/// No corner, or no ball.
pub(super) const NONE: u32 = u32::MAX;

/// Corners this close, in rad along their edge, may have changed places by rounding.
const SWAPPED: f64 = 1e-6;

/// A corner, in one cache line.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(align(64))]
pub(super) struct Corner {
    pub(super) at: DVec3,
    /// The balls whose spheres meet here, anticlockwise from outside; [`NONE`] when the corner is no longer there.
    pub(super) balls: [u32; 3],
    /// The corner at the other end of the edge between ball `i` and ball `i + 1`.
    pub(super) neighbours: [u32; 3],
    /// Twice the insertion at which the corner was last judged, plus one if it was found outside.
    pub(super) mark: u32,
}

impl Corner {
    pub(super) fn is_there(&self) -> bool {
        self.balls[0] != NONE
    }
}

/// What the intersection looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// One ball.
    Ball(u32),
    /// Two balls with a whole circle between their faces.
    Lens(u32, u32),
    /// Three faces or more.
    Net,
}

/// An edge of a face: an arc of the circle in which the face's sphere meets that of ball `other`, from `start` to the
/// start of the next arc, with the face on its left as seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub(super) other: u32,
    pub(super) start: DVec3,
}

/// Balls in the order of insertion, and the surface of their intersection.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Surface {
    pub(super) radius: f64,
    /// How far beyond a ball a point may be by rounding, in m: what a ball cuts off by less is left, so that balls that
    /// coincide, or pass through one corner, count once.
    pub(super) rounding: f64,
    pub(super) centres: Vec<DVec3>,
    pub(super) shape: Shape,
    pub(super) corners: Vec<Corner>,
    /// For each ball a corner of its face; stale where it has none.
    pub(super) corner_of: Vec<u32>,
}

impl Surface {
    pub(super) fn centre(&self, ball: u32) -> DVec3 {
        self.centres[ball as usize]
    }

    /// Whether the point is outside of the ball, by more than rounding.
    #[inline]
    pub(super) fn is_outside(&self, ball: u32, point: DVec3) -> bool {
        point.distance_squared(self.centre(ball)) > self.limit()
    }

    /// The squared distance from a centre beyond which a point is outside of the ball.
    #[inline]
    pub(super) fn limit(&self) -> f64 {
        let reach = self.radius + self.rounding;
        reach * reach
    }

    /// The corner whose faces `i`, `j`, `k` follow each other anticlockwise; `None` when rounding leaves no such point.
    ///
    /// With `a`, `b` the differences of the centres from that opposite to the longest side, `n = a x b` and `m` the middle of
    /// the circle through the centres, the corner is at `m + n sqrt((rho^2 - m^2) / n^2)`: the orientation picks one of the
    /// two common points. From that centre `n` is right to rounding even for neighbouring samples of a dense curve.
    #[inline]
    pub(super) fn common_point(&self, [i, j, k]: [u32; 3]) -> Option<DVec3> {
        let [p, q, r] = [self.centre(i), self.centre(j), self.centre(k)];
        let (pq, qr, rp) = (p.distance_squared(q), q.distance_squared(r), r.distance_squared(p));
        let (base, a, b, aa, bb) = if qr >= pq && qr >= rp {
            (p, q - p, r - p, pq, rp)
        } else if rp >= pq {
            (q, r - q, p - q, qr, pq)
        } else {
            (r, p - r, q - r, rp, qr)
        };
        let n = a.cross(b);
        let nn = n.length_squared();
        let middle = (b.cross(n) * aa + n.cross(a) * bb) / (2.0 * nn);
        let height = (self.radius * self.radius - middle.length_squared()) / nn;
        // Not a number where the centres are collinear.
        (height >= 0.0 && height.is_finite()).then(|| base + middle + n * height.sqrt())
    }

    /// Whether a point of the circle of the balls `a`, `b` lies on the arc from `start` to `end`, right-handed about the axis from
    /// `b` to `a`.
    #[inline]
    pub(super) fn is_between(&self, point: DVec3, start: DVec3, end: DVec3, [a, b]: [u32; 2]) -> bool {
        let (a, b) = (self.centre(a), self.centre(b));
        let middle = (a + b) * 0.5;
        self.passes(a - b, [start, end], middle, point - middle)
    }

    /// The angle of an edge, right-handed about the circle's axis: tau for a lens, and below zero, by rounding, where close
    /// corners have changed places.
    pub(super) fn angle(&self, circle: &Circle, start: DVec3, end: DVec3) -> f64 {
        if self.shape != Shape::Net {
            return TAU;
        }
        let angle = circle.angle(start, end);
        let swapped = angle.abs() < SWAPPED && self.corners.len() > 2;
        if angle >= 0.0 || swapped { angle } else { angle + TAU }
    }

    /// The next corner anticlockwise around the face of `ball`, and the ball across the edge that leads there.
    #[inline]
    pub(super) fn next_around(&self, ball: u32, corner: u32) -> (u32, u32) {
        let Corner { balls, neighbours, .. } = &self.corners[corner as usize];
        let place = if balls[0] == ball {
            2
        } else if balls[1] == ball {
            0
        } else {
            1
        };
        (neighbours[place], balls[place])
    }

    /// A corner of the ball's face, if it has one with corners.
    pub(super) fn corner_on(&self, ball: u32) -> Option<u32> {
        let corner = self.corner_of[ball as usize];
        (self.shape == Shape::Net && self.corners.get(corner as usize)?.balls.contains(&ball))
            .then_some(corner)
    }

    /// Whether the ball has a face.
    pub(super) fn has_face(&self, ball: u32) -> bool {
        match self.shape {
            Shape::Ball(k) => k == ball,
            Shape::Lens(i, j) => i == ball || j == ball,
            Shape::Net => self.corner_on(ball).is_some(),
        }
    }

    /// The corners that are there.
    pub(super) fn live_corners(&self) -> impl Iterator<Item = &Corner> + '_ {
        self.corners.iter().filter(|c| c.is_there())
    }

    /// Balls across the edges of the ball's face, one after the other.
    #[inline]
    pub(super) fn for_each_neighbour(&self, ball: u32, mut visit: impl FnMut(u32)) {
        match self.shape {
            Shape::Ball(_) => {}
            Shape::Lens(i, j) => visit(if ball == i { j } else { i }),
            Shape::Net => {
                let Some(first) = self.corner_on(ball) else { return };
                let mut corner = first;
                loop {
                    let (next, across) = self.next_around(ball, corner);
                    visit(across);
                    corner = next;
                    if corner == first {
                        break;
                    }
                }
            }
        }
    }

    /// Fills `arcs` with the edges of the ball's face in order; left empty for a whole sphere and for no face.
    pub(super) fn arcs_of(&self, ball: u32, arcs: &mut Vec<Arc>) {
        arcs.clear();
        match self.shape {
            Shape::Ball(_) => {}
            Shape::Lens(i, j) => {
                let other = if ball == i { j } else { i };
                let circle = Circle::between(self.centre(ball), self.centre(other), self.radius);
                let start = circle.middle + circle.axis.any_orthonormal_vector() * circle.radius;
                if ball == i || ball == j {
                    arcs.push(Arc { other, start });
                }
            }
            Shape::Net => {
                let Some(first) = self.corner_on(ball) else { return };
                let mut corner = first;
                loop {
                    let (next, other) = self.next_around(ball, corner);
                    arcs.push(Arc { other, start: self.corners[corner as usize].at });
                    corner = next;
                    if corner == first {
                        break;
                    }
                }
            }
        }
    }

    /// Whether the edge of `corner` between its balls `edge` and `edge + 1`, both of whose ends are outside of `ball`, is
    /// inside of it in between.
    #[inline]
    pub(super) fn comes_back(&self, corner: u32, edge: u32, ball: u32) -> bool {
        let from = &self.corners[corner as usize];
        let to = self.corners[from.neighbours[edge as usize] as usize].at;
        let (a, b) = (from.balls[edge as usize], from.balls[(edge as usize + 1) % 3]);
        let (a, b, centre) = (self.centre(a), self.centre(b), self.centre(ball));
        let (axis, middle) = (a - b, (a + b) * 0.5);
        let (s, w) = (from.at - middle, centre - middle);
        // The nearest point of the circle is in direction `w`. The arc is right-handed about the axis.
        if !self.passes(axis, [from.at, to], middle, w) {
            return false;
        }
        let along = w.dot(axis) / axis.length();
        let across = (w.length_squared() - along * along).max(0.0).sqrt();
        let nearest = across - s.length();
        nearest * nearest + along * along <= self.limit()
    }

    /// Whether the edge of `corner` between its balls `edge` and `edge + 1`, both of whose ends are inside of `ball`, is
    /// outside of it in between.
    pub(super) fn breaks_out(&self, corner: u32, edge: u32, ball: u32) -> bool {
        let from = &self.corners[corner as usize];
        let to = self.corners[from.neighbours[edge as usize] as usize].at;
        let (a, b) = (from.balls[edge as usize], from.balls[(edge as usize + 1) % 3]);
        let (a, b, centre) = (self.centre(a), self.centre(b), self.centre(ball));
        let (axis, middle) = (a - b, (a + b) * 0.5);
        let (s, w) = (from.at - middle, centre - middle);
        if !self.passes(axis, [from.at, to], middle, -w) {
            return false;
        }
        let along = w.dot(axis) / axis.length();
        let across = (w.length_squared() - along * along).max(0.0).sqrt();
        let farthest = across + s.length();
        farthest * farthest + along * along > self.limit()
    }

    /// The ball whose face the ray from `origin` along `direction` meets, by descent over neighbouring faces of the distance
    /// to the spheres, whose minimum is met there; and that distance.
    pub(super) fn face_along(&self, origin: DVec3, direction: DVec3, start: u32) -> (u32, f64) {
        let mut ball = start;
        let mut reach = self.reach(origin, direction, ball);
        loop {
            let mut next = ball;
            self.for_each_neighbour(ball, |other| {
                let candidate = self.reach(origin, direction, other);
                if candidate < reach {
                    (reach, next) = (candidate, other);
                }
            });
            if next == ball {
                return (ball, reach);
            }
            ball = next;
        }
    }

    /// Distance from `origin` along `direction` to the ball's sphere.
    fn reach(&self, origin: DVec3, direction: DVec3, ball: u32) -> f64 {
        let b = self.centre(ball) - origin;
        let along = b.dot(direction);
        along + (along * along + self.radius * self.radius - b.length_squared()).max(0.0).sqrt()
    }

    /// Whether the arc from `start` to `end` about `axis` (right-handed) through `middle` passes the direction `d` from there.
    #[inline]
    fn passes(&self, axis: DVec3, [start, end]: [DVec3; 2], middle: DVec3, d: DVec3) -> bool {
        let (s, t, chord) = (start - middle, end - middle, end - start);
        // Corners that coincide bound an edge of no length, and not a whole circle.
        if chord.length_squared() <= self.rounding * self.rounding {
            return false;
        }
        let left_of = |p: DVec3, q: DVec3| axis.dot(p.cross(q)) > 0.0;
        let (after_start, before_end) = (left_of(s, d), left_of(d, t));
        // The difference of the ends keeps the sense of short arcs.
        if left_of(s, chord) { after_start && before_end } else { after_start || before_end }
    }
}
