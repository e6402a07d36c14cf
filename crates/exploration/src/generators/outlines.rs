//! Bodies in the plane.

use super::{Family, norm_and_gradient};
use crate::random::Source;
use glam::DVec2;
use shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::TAU;

/// The farthest point (m) of a body in the plane along a direction.
pub type Outline = Box<dyn Fn(Direction) -> DVec2 + Send + Sync>;

/// Least radius of curvature of an egg, over its mean one.
const LEAST_RADIUS: f64 = 0.06;

/// An ellipse with semi-axes in m, turned by `angle` rad.
#[must_use]
pub fn ellipse(axes: DVec2, angle: f64) -> Outline {
    let turn = DVec2::from_angle(angle);
    Box::new(move |n| {
        let own = turn.conjugate_rotate(n.get());
        turn.rotate(axes * axes * own / (axes * own).length())
    })
}

trait ConjugateRotate {
    fn conjugate_rotate(self, v: DVec2) -> DVec2;
}

impl ConjugateRotate for DVec2 {
    fn conjugate_rotate(self, v: DVec2) -> DVec2 {
        DVec2::new(self.x, -self.y).rotate(v)
    }
}

/// The Minkowski sum.
#[must_use]
pub fn outline_sum(parts: Vec<Outline>) -> Outline {
    Box::new(move |n| parts.iter().map(|part| part(n)).sum())
}

/// `h = 1 + sum c cos k (t - phase)` in m, with terms `(k, c, phase)`.
#[must_use]
pub fn waves(terms: Vec<(f64, f64, f64)>) -> Outline {
    Box::new(move |n| {
        let t = n.angle();
        let h = 1.0 + terms.iter().map(|(k, c, p)| c * (k * (t - p)).cos()).sum::<f64>();
        let slope: f64 = terms.iter().map(|(k, c, p)| -c * k * (k * (t - p)).sin()).sum();
        n.get() * h + n.get().perp() * slope
    })
}

/// `|x/a|^p + |y/b|^p <= 1`, turned by `angle` rad.
#[must_use]
pub fn superellipse(axes: DVec2, p: f64, angle: f64) -> Outline {
    let turn = DVec2::from_angle(angle);
    Box::new(move |n| {
        let own = axes * turn.conjugate_rotate(n.get());
        // The support function is the dual norm.
        let (_, [x, y]) = norm_and_gradient(own.x, own.y, p / (p - 1.0));
        turn.rotate(axes * DVec2::new(x, y))
    })
}

/// The hull of points plus a disc of radius `radius`, all in m.
#[must_use]
pub fn rounded_polygon(points: Vec<DVec2>, radius: f64) -> Outline {
    Box::new(move |n| {
        let mut best = (f64::NEG_INFINITY, DVec2::ZERO);
        for p in &points {
            let height = p.dot(n.get());
            if height > best.0 {
                best = (height, *p);
            }
        }
        best.1 + n.get() * radius
    })
}

/// A polygon with `corners` corners on an ellipse, no two closer than a third of their mean distance, and its corners.
#[must_use]
pub fn polygon(corners: usize, seed: u64) -> (Outline, Vec<DVec2>) {
    let mut source = Source::new(seed);
    let (axes, turn) = (DVec2::new(1.0, source.between(0.4, 1.0)), source.between(0.0, TAU));
    let step = TAU / corners as f64;
    let points: Vec<DVec2> = (0..corners)
        .map(|k| axes * DVec2::from_angle(turn + step * (k as f64 + source.between(0.0, 0.66))))
        .collect();
    (rounded_polygon(points.clone(), 0.0), points)
}

/// A body of a family; the same seed gives the same body.
#[must_use]
pub fn outline(family: Family, seed: u64) -> Outline {
    let mut source = Source::new(seed.wrapping_mul(8).wrapping_add(family as u64));
    let s = &mut source;
    let turn = |s: &mut Source| s.between(0.0, TAU);
    match family {
        Family::Ellipsoid => ellipse(DVec2::new(1.0, 1.0 / s.between(1.0, 3.0)), turn(s)),
        Family::Sum => {
            let count = if s.unit() < 0.5 { 2 } else { 3 };
            let one = |_| {
                let scale = s.between(0.3, 1.0);
                ellipse(DVec2::new(scale, scale / s.between(1.0, 4.0)), turn(s))
            };
            outline_sum((0..count).map(one).collect())
        }
        Family::Egg => {
            let mut terms: Vec<(f64, f64, f64)> =
                (2..=5).map(|k| (f64::from(k), s.normal() / f64::from(k * k), turn(s))).collect();
            // Radius of curvature h + h''; the waves' part alone is as low as this.
            let bend = |t: f64| -> f64 {
                terms.iter().map(|(k, c, p)| c * (1.0 - k * k) * (k * (t - p)).cos()).sum()
            };
            let low = (0..7200).map(|k| bend(TAU * f64::from(k) / 7200.0)).fold(0.0, f64::min);
            let scale = s.between(0.5, 1.0) * (1.0 - LEAST_RADIUS) / -low;
            terms.iter_mut().for_each(|term| term.1 *= scale);
            waves(terms)
        }
        Family::Superquadric => {
            superellipse(DVec2::new(1.0, 1.0 / s.between(1.0, 2.0)), s.between(1.4, 5.0), turn(s))
        }
        Family::Rounded => {
            let count = 3 + (7.0 * s.unit()) as usize;
            let mut point = |_| DVec2::from_angle(turn(s)) * s.between(0.5, 1.0);
            let points = (0..count.max(3)).map(&mut point).collect();
            rounded_polygon(points, s.between(0.05, 0.25))
        }
    }
}
