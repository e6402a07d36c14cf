//! The bodies that `benches/peers/tosses.py` tosses, as it tells them.

use glam::DVec3;
use recon::shape_bounds::exact_hull::Hull;
use std::f64::consts::PI;

/// A convex body about its own origin, sizes in m.
pub(crate) enum Body {
    /// The hull of points.
    Points(Vec<DVec3>),
    /// Semi-axes.
    Ellipsoid(DVec3),
    /// Radius and half of the length between the centres of the caps, along z.
    Capsule(f64, f64),
    /// Radius and half of the length, along z.
    Cylinder(f64, f64),
}

impl Body {
    /// From `points x y z ...`, `ellipsoid a b c`, `capsule r l` or `cylinder r l`.
    pub(crate) fn parse(text: &str) -> Result<Self, Box<dyn std::error::Error>> {
        let mut words = text.split_whitespace();
        let name = words.next().unwrap_or_default();
        let sizes: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>()?;
        Ok(match (name, &sizes[..]) {
            ("points", all) => Self::Points(all.chunks_exact(3).map(DVec3::from_slice).collect()),
            ("ellipsoid", [a, b, c]) => Self::Ellipsoid(DVec3::new(*a, *b, *c)),
            ("capsule", [r, l]) => Self::Capsule(*r, *l),
            ("cylinder", [r, l]) => Self::Cylinder(*r, *l),
            _ => return Err(format!("no body: {text}").into()),
        })
    }

    pub(crate) fn support(&self, n: DVec3) -> f64 {
        match self {
            Self::Points(points) => points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max),
            Self::Ellipsoid(axes) => (*axes * n).length(),
            Self::Capsule(r, l) => r + l * n.z.abs(),
            Self::Cylinder(r, l) => r * n.x.hypot(n.y) + l * n.z.abs(),
        }
    }

    pub(crate) fn volume(&self) -> f64 {
        match self {
            Self::Points(points) => hull_volume(points),
            Self::Ellipsoid(axes) => 4.0 / 3.0 * PI * axes.element_product(),
            Self::Capsule(r, l) => PI * r * r * (2.0 * l + 4.0 / 3.0 * r),
            Self::Cylinder(r, l) => 2.0 * PI * r * r * l,
        }
    }

    /// Whether the hull of `points` is in the body, but for rounding.
    pub(crate) fn holds(&self, points: &[DVec3]) -> bool {
        match self {
            Self::Points(own) => {
                let both: Vec<DVec3> = own.iter().chain(points).copied().collect();
                hull_volume(&both) <= hull_volume(own) * (1.0 + 1e-12)
            }
            Self::Ellipsoid(axes) => points.iter().all(|p| (*p / *axes).length() <= 1.0),
            Self::Capsule(r, l) => points.iter().all(|p| p.distance(DVec3::Z * p.z.clamp(-l, *l)) <= *r),
            Self::Cylinder(r, l) => points.iter().all(|p| p.x.hypot(p.y) <= *r && p.z.abs() <= *l),
        }
    }
}

fn hull_volume(points: &[DVec3]) -> f64 {
    Hull::of(points).ok().and_then(|hull| hull.solid().map(|s| s.volume())).unwrap_or(f64::NAN)
}
