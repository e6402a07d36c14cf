//! The ball hull: the intersection of all balls of one radius that hold some points.

use super::balls::BallIntersection;
use super::circle::Circle;
use super::steiner::ConvexMeasures;
use super::support::BallWalk;
use super::surface::{Corner, Shape};
use crate::body::{Climb, ConvexBody};
use contact_kinematics::Direction;
use exact_hull::arithmetic::Compensated;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Below this half-angle a series takes the place of differences that cancel.
const SHORT: f64 = 0.5;
/// How far volumes by duality may differ, as a share of the ball's.
const DUALITY: f64 = 1e-11;
/// Terms of those series: the first left out is below 2^-53 of the first one at [`SHORT`].
const TERMS: u32 = 10;

/// The ball hull of points, widened by a ball: the smallest body that holds a ball of radius `rho_min` about each of the
/// points and none of whose radii of curvature is above `rho_max`.
///
/// The ball hull for radius `rho = rho_max - rho_min` is dual to the intersection `K` of the balls about the points: its
/// support function is `h(n) = rho - h_K(-n)`, because the ball is a generating set (Schneider, "Convex bodies", section
/// 3.2: an intersection of translates of it is a summand of it). Corners of `K` are the centres of its spherical triangles,
/// edges of `K` those of the spindle surfaces between them, and faces of `K` its corners.
#[derive(Clone, Debug, PartialEq)]
pub struct BallHull {
    dual: BallIntersection,
    margin: f64,
}

impl BallHull {
    /// The ball hull of the centres of `dual`, widened by `margin`.
    pub(super) fn of_dual(dual: BallIntersection, margin: f64) -> Self {
        Self { dual, margin }
    }

    /// Indices of the contacts that are on the hull.
    pub fn sources(&self) -> impl Iterator<Item = usize> + '_ {
        self.dual.face_sources()
    }

    /// Contacts left out because rounding made the dual's edges inconsistent; the bound holds without them.
    #[must_use]
    pub fn skipped(&self) -> usize {
        self.dual.skipped()
    }

    /// Volume in m^3.
    #[must_use]
    pub fn volume(&self) -> f64 {
        self.measures().volume
    }

    /// Volume, area and mean curvature.
    ///
    /// The hull is cut into a polyhedron with the triangles that belong to the corners of the dual, the spherical segments
    /// over them, and over each edge what a segment of a circle sweeps when it turns about its chord. No part is computed
    /// by differences that cancel, however large the radius is; duality would give the volume as `4/3 pi rho^3 - rho^2 M +
    /// rho S - V` of the dual, which loses the digits of `(rho / size)^3`.
    #[must_use]
    pub fn measures(&self) -> ConvexMeasures {
        self.core_measures().grown(self.margin)
    }

    /// Whether the measures agree with those of the dual, as far as those have digits.
    pub(super) fn agrees_with_duality(&self) -> bool {
        let (own, dual, rho) = (self.core_measures(), self.dual.measures(), self.dual.radius());
        let ball = 4.0 / 3.0 * PI * rho * rho * rho;
        let volume = ball - rho * rho * dual.mean_curvature + rho * dual.area - dual.volume;
        (own.volume - volume).abs() <= DUALITY * ball
    }

    fn core_measures(&self) -> ConvexMeasures {
        let (surface, rho) = (self.dual.surface(), self.dual.radius());
        let [mut volume, mut area, mut curvature] = [(); 3].map(|()| Compensated::default());
        let mut add_spindle = |chord: f64, angle: f64| {
            let part = spindle(rho, chord, angle);
            volume.add(part.volume);
            area.add(part.area);
            curvature.add(part.mean_curvature);
        };
        match surface.shape {
            Shape::Ball(_) => {}
            Shape::Lens(i, j) => add_spindle(surface.centre(i).distance(surface.centre(j)), TAU),
            Shape::Net => {
                for (number, corner) in surface.corners.iter().enumerate() {
                    for (edge, beyond) in
                        corner.neighbours.iter().enumerate().filter(|(_, b)| number < **b as usize)
                    {
                        if !corner.is_there() {
                            continue;
                        }
                        let (a, b) = (corner.balls[edge], corner.balls[(edge + 1) % 3]);
                        let (a, b) = (surface.centre(a), surface.centre(b));
                        let circle = Circle::between(b, a, rho);
                        let end = surface.corners[*beyond as usize].at;
                        add_spindle(a.distance(b), surface.angle(&circle, corner.at, end));
                    }
                }
            }
        }
        // The points are all around this one, which is hence a good reference.
        let reference =
            self.dual.faces().fold((DVec3::ZERO, 0.0), |(sum, n), k| (sum + surface.centre(k), n + 1.0));
        let reference = reference.0 / reference.1;
        for corner in surface.live_corners() {
            let Corner { at, balls: [i, j, k], .. } = *corner;
            // Seen from outside of the hull, the order is the opposite of that on the dual.
            let [p, q, r] = [i, k, j].map(|b| surface.centre(b));
            let part = segment(rho, at, [p, q, r]);
            volume.add((p - reference).dot((q - p).cross(r - p)) / 6.0 + part.volume);
            area.add(part.area);
            curvature.add(part.mean_curvature);
        }
        ConvexMeasures { volume: volume.value(), area: area.value(), mean_curvature: curvature.value() }
    }
}

impl ConvexBody for BallHull {
    fn climb(&self) -> Climb<'_> {
        let (mut walk, radius) = (BallWalk::new(&self.dual), self.dual.radius() + self.margin);
        Box::new(move |d| d.normalize_or_zero() * radius + walk.farthest(-d))
    }

    /// Support function in m, in time O(n).
    fn support(&self, n: Direction) -> f64 {
        self.dual.radius() + self.margin - self.dual.support(-n)
    }

    /// Whether `point` is inside, to rounding of the largest radius; in time O(n).
    ///
    /// The body is the intersection of the balls of radius `rho_max` about all points of the dual, so that the one farthest
    /// from `point` decides.
    fn contains(&self, point: DVec3) -> bool {
        let limit = self.dual.radius() + self.margin;
        self.dual.farthest_from(point) <= limit * (1.0 + 4.0 * f64::EPSILON)
    }
}

/// What turns about the chord of a circle of radius `rho` by `angle`: the volume between arc and chord, and area and mean
/// curvature of the surface that the arc sweeps.
///
/// With `a` half the angle of the arc, these are `rho^3 (sin a - sin^3 a / 3 - a cos a)`, `2 rho^2 (sin a - a cos a)` and
/// `rho (2 sin a - a cos a)` for each unit of `angle`.
fn spindle(rho: f64, chord: f64, angle: f64) -> ConvexMeasures {
    let sine = (chord / (2.0 * rho)).min(1.0);
    let half = sine.asin();
    let (v, s) = if half < SHORT {
        // (-1)^k a^(2k+1) / (2k+1)! times (3 + 3^(2k)) / 4 - (2k+1) and 1 - (2k+1).
        let (mut v, mut s) = (0.0, 0.0);
        let (mut power, mut nine) = (half, 1.0);
        for k in 1..TERMS {
            let odd = f64::from(2 * k + 1);
            power *= -half * half / (odd * (odd - 1.0));
            nine *= 9.0;
            // The first of the volume's terms is zero.
            v += power * (0.75 + 0.25 * nine - odd);
            s += power * (1.0 - odd);
        }
        (v, s)
    } else {
        let moment = half * half.cos();
        (sine - sine * sine * sine / 3.0 - moment, sine - moment)
    };
    ConvexMeasures {
        volume: angle * rho * rho * rho * v,
        area: angle * rho * rho * 2.0 * s,
        mean_curvature: angle * rho * (s + sine),
    }
}

/// The spherical triangle about `centre` with corners `p`, `q`, `r`, anticlockwise from outside: the volume of its cone from
/// the centre without the tetrahedron, its area and mean curvature.
///
/// The solid angle is `2 atan(x)` with `x = N / D`, `N` the determinant of the directions and `D = 4 - E` with `E` half the
/// sum of the squared sides (van Oosterom and Strackee 1983), so that the volume `rho^3 (angle / 3 - N / 6)` is
/// `rho^3 (N E / (6 D) - 2/3 (x - atan x))`, where nothing cancels on small triangles.
fn segment(rho: f64, centre: DVec3, [p, q, r]: [DVec3; 3]) -> ConvexMeasures {
    let (u, v) = ((q - p) / rho, (r - p) / rho);
    let n = ((p - centre) / rho).dot(u.cross(v));
    let e = (u.length_squared() + v.length_squared() + (v - u).length_squared()) / 2.0;
    let d = 4.0 - e;
    let angle = 2.0 * n.atan2(d);
    let unit = if d > 2.0 {
        let x = n / d;
        n * e / (6.0 * d) - 2.0 / 3.0 * beyond_arctangent(x)
    } else {
        angle / 3.0 - n / 6.0
    };
    ConvexMeasures { volume: rho * rho * rho * unit, area: rho * rho * angle, mean_curvature: rho * angle }
}

/// `x - atan x`.
fn beyond_arctangent(x: f64) -> f64 {
    if x.abs() > 0.1 {
        return x - x.atan();
    }
    let square = x * x;
    (1..9).rev().fold(0.0, |sum, k| 1.0 / f64::from(2 * k + 1) - square * sum) * square * x
}
