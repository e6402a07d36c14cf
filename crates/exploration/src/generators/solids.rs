//! Bodies in space.

use super::{Family, norm_and_gradient};
use crate::Heading;
use crate::random::Source;
use contact_kinematics::Direction;
use glam::{DMat3, DQuat, DVec3};

/// The farthest point (m) of a body in space along a direction.
pub type Solid = Box<dyn Fn(Direction) -> DVec3 + Send + Sync>;

/// Least radius of curvature of an egg, over its mean one, with room for what lies between samples.
const LEAST_RADIUS: f64 = 0.07;
/// Directions at which the radii of curvature of an egg are looked at.
const SAMPLES: usize = 4000;

/// An ellipsoid with semi-axes in m, turned.
#[must_use]
pub fn ellipsoid(axes: DVec3, turn: DQuat) -> Solid {
    Box::new(move |n| {
        let own = turn.inverse() * n.get();
        turn * (axes * axes * own / (axes * own).length())
    })
}

/// The Minkowski sum.
#[must_use]
pub fn solid_sum(parts: Vec<Solid>) -> Solid {
    Box::new(move |n| parts.iter().map(|part| part(n)).sum())
}

/// `(|x/a|^p + |y/b|^p)^(r/p) + |z/c|^r <= 1`, turned.
#[must_use]
pub fn superquadric(axes: DVec3, p: f64, r: f64, turn: DQuat) -> Solid {
    Box::new(move |n| {
        let own = axes * (turn.inverse() * n.get());
        // The support function is the dual of two nested norms.
        let (across, [x, y]) = norm_and_gradient(own.x, own.y, p / (p - 1.0));
        let (_, [flat, z]) = norm_and_gradient(across, own.z, r / (r - 1.0));
        turn * (axes * DVec3::new(flat * x, flat * y, z))
    })
}

/// The hull of points plus a ball of radius `radius`, all in m.
#[must_use]
pub fn rounded_hull(points: Vec<DVec3>, radius: f64) -> Solid {
    Box::new(move |n| {
        let mut best = (f64::NEG_INFINITY, DVec3::ZERO);
        for p in &points {
            let height = p.dot(n.get());
            if height > best.0 {
                best = (height, *p);
            }
        }
        best.1 + n.get() * radius
    })
}

/// Legendre polynomial of degree `l`, 2 to 5, with its first two derivatives.
fn legendre(l: usize, x: f64) -> [f64; 3] {
    let (x2, x3) = (x * x, x * x * x);
    match l {
        2 => [1.5 * x2 - 0.5, 3.0 * x, 3.0],
        3 => [2.5 * x3 - 1.5 * x, 7.5 * x2 - 1.5, 15.0 * x],
        4 => [
            (35.0 * x2 * x2 - 30.0 * x2 + 3.0) / 8.0,
            (35.0 * x3 - 15.0 * x) / 2.0,
            (105.0 * x2 - 15.0) / 2.0,
        ],
        _ => [
            (63.0 * x2 * x3 - 70.0 * x3 + 15.0 * x) / 8.0,
            (315.0 * x2 * x2 - 210.0 * x2 + 15.0) / 8.0,
            (315.0 * x3 - 105.0 * x) / 2.0,
        ],
    }
}

/// A term of an egg: degree, coefficient in m, axis.
type Zonal = (usize, f64, DVec3);

/// `h = 1 + sum c P_l(u . a)` in m.
#[must_use]
pub fn egg(terms: Vec<Zonal>) -> Solid {
    Box::new(move |n| {
        let u = n.get();
        let mut point = u;
        for (l, c, a) in &terms {
            let x = u.dot(*a);
            let [value, slope, _] = legendre(*l, x);
            point += (u * value + (*a - u * x) * slope) * *c;
        }
        point
    })
}

/// The least eigenvalue of what the terms add to the radii of curvature, which are 1 without them.
fn lowest_bend(terms: &[Zonal]) -> f64 {
    let at = |n: Direction| {
        let (u, (e, f)) = (n.get(), n.tangent_basis());
        let mut sum = DMat3::ZERO;
        for (l, c, a) in terms {
            let x = u.dot(*a);
            let [value, slope, bend] = legendre(*l, x);
            let across = *a - u * x;
            let outer = DMat3::from_cols(across * across.x, across * across.y, across * across.z);
            sum += (outer * bend + DMat3::IDENTITY * (value - slope * x)) * *c;
        }
        let (ee, ff, ef) = (e.dot(sum * e), f.dot(sum * f), e.dot(sum * f));
        (ee + ff) / 2.0 - ((ee - ff) / 2.0).hypot(ef)
    };
    Direction::spread(SAMPLES).into_iter().map(at).fold(0.0, f64::min)
}

/// A body of a family; the same seed gives the same body.
#[must_use]
pub fn solid(family: Family, seed: u64) -> Solid {
    let mut source = Source::new(0x50_11D + seed.wrapping_mul(8).wrapping_add(family as u64));
    let s = &mut source;
    let axes = |s: &mut Source, most: f64| {
        let scale = s.between(0.5, 1.0);
        // From the longest to the shortest axis `most` at most.
        DVec3::new(1.0, 1.0 / s.between(1.0, most), 1.0 / s.between(1.0, most)) * scale
    };
    match family {
        Family::Ellipsoid => ellipsoid(axes(s, 3.0), s.rotation()),
        Family::Sum => {
            let count = if s.unit() < 0.5 { 2 } else { 3 };
            solid_sum((0..count).map(|_| ellipsoid(axes(s, 4.0), s.rotation())).collect())
        }
        Family::Egg => {
            let mut terms: Vec<Zonal> = (2..=5)
                .flat_map(|l| [l; 2])
                .map(|l| (l, s.normal() / (l * l) as f64, s.direction().get()))
                .collect();
            let scale = s.between(0.5, 1.0) * (1.0 - LEAST_RADIUS) / -lowest_bend(&terms);
            terms.iter_mut().for_each(|term| term.1 *= scale);
            egg(terms)
        }
        Family::Superquadric => {
            let semi = axes(s, 2.0);
            superquadric(semi, s.between(1.4, 5.0), s.between(1.4, 5.0), s.rotation())
        }
        Family::Rounded => {
            let count = 5 + (10.0 * s.unit()) as usize;
            let points = (0..count).map(|_| s.direction().get() * s.between(0.5, 1.0)).collect();
            rounded_hull(points, s.between(0.05, 0.25))
        }
    }
}
