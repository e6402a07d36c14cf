//! Seeded convex bodies of five families each, in the plane and in space: what planners are measured on.
//!
//! A body is the function that gives its farthest point along a direction. Sizes are about 1 m.

mod outlines;
mod solids;

pub use outlines::{Outline, ellipse, outline, outline_sum, polygon, rounded_polygon, superellipse, waves};
pub use solids::{Solid, egg, ellipsoid, rounded_hull, solid, solid_sum, superquadric};

/// A family of bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Family {
    /// Ellipses and ellipsoids, axes to 3:1.
    Ellipsoid,
    /// Minkowski sums of two or three of them, axes to 4:1.
    Sum,
    /// Random waves on a support function, with the least radius of curvature held above 0.05 of the mean one.
    Egg,
    /// Superellipses and superquadrics, exponents from 1.4 to 5.
    Superquadric,
    /// Hulls of a few points, rounded.
    Rounded,
}

impl Family {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Ellipsoid, Self::Sum, Self::Egg, Self::Superquadric, Self::Rounded];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Ellipsoid => "ellipsoid",
            Self::Sum => "sum",
            Self::Egg => "egg",
            Self::Superquadric => "superquadric",
            Self::Rounded => "rounded hull",
        }
    }

    /// Smooth everywhere, without flats: where the theory of the least number of touches applies as it stands.
    #[must_use]
    pub fn is_smooth(self) -> bool {
        matches!(self, Self::Ellipsoid | Self::Sum | Self::Egg)
    }
}

/// `sign(x) |x|^p`.
fn signed_power(x: f64, p: f64) -> f64 {
    x.abs().powf(p).copysign(x)
}

/// The norm of exponent `p` of two numbers and its gradient; zero at zero.
fn norm_and_gradient(x: f64, y: f64, p: f64) -> (f64, [f64; 2]) {
    let largest = x.abs().max(y.abs());
    if largest == 0.0 {
        return (0.0, [0.0, 0.0]);
    }
    let (x, y) = (x / largest, y / largest);
    let norm = (x.abs().powf(p) + y.abs().powf(p)).powf(1.0 / p);
    (largest * norm, [x, y].map(|c| signed_power(c / norm, p - 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Heading;
    use crate::random::Source;

    /// A support function's own law: no point of the body is farther along a direction than the one that it gives.
    #[test]
    fn every_body_is_convex_and_its_points_are_its_farthest() {
        for family in Family::ALL {
            for seed in 0..4 {
                let (plane, space) = (outline(family, seed), solid(family, seed));
                let mut source = Source::new(seed);
                for _ in 0..200 {
                    let (u, v) = (source.direction(), source.direction());
                    assert!(u.get().dot(space(u) - space(v)) > -1e-12, "{family:?} {seed}");
                    let flat = |_: ()| {
                        shape_bounds::exact_hull::planar::Direction::from_angle(source.between(0.0, 6.3))
                    };
                    let [a, b] = [(), ()].map(flat);
                    assert!(a.get().dot(plane(a) - plane(b)) > -1e-12, "{family:?} {seed}");
                }
            }
        }
    }

    #[test]
    fn eggs_are_bent_outwards_everywhere() {
        for seed in 0..10 {
            let body = outline(Family::Egg, seed);
            let lattice = shape_bounds::exact_hull::planar::Direction::spread(3600);
            let least = (0..lattice.len())
                .map(|k| {
                    let (a, b) = (lattice[k], lattice[(k + 1) % lattice.len()]);
                    a.get().perp().dot(body(b) - body(a)) / a.angle_to(b)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(least > 0.045, "{seed} {least}");
        }
    }
}
