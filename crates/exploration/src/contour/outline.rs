//! Smooth closed curves.

use contact_kinematics::planar::RadiusFunction;
use glam::DVec2;

/// A point of an outline with its derivatives over the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePoint {
    /// In m.
    pub point: DVec2,
    /// First derivative.
    pub first: DVec2,
    /// Second derivative.
    pub second: DVec2,
}

impl OutlinePoint {
    /// The outward unit normal.
    #[must_use]
    pub fn normal(&self) -> DVec2 {
        -self.first.perp().normalize_or_zero()
    }

    /// Curvature in 1/m, negative in hollows.
    #[must_use]
    pub fn curvature(&self) -> f64 {
        self.first.perp_dot(self.second) / self.first.length().powi(3)
    }
}

/// A closed curve without crossings, twice differentiable, once round counter-clockwise as the parameter goes from 0 to `2 pi`.
pub trait SmoothOutline {
    /// At a parameter.
    fn at(&self, t: f64) -> OutlinePoint;
}

impl<F: Fn(f64) -> OutlinePoint> SmoothOutline for F {
    fn at(&self, t: f64) -> OutlinePoint {
        self(t)
    }
}

/// The outline of a convex body, by the angle of its normal.
#[derive(Clone, Copy, Debug)]
pub struct ConvexOutline<S>(pub S);

impl<S: RadiusFunction> SmoothOutline for ConvexOutline<S> {
    /// The second derivative without its part along the tangent, which neither curvature nor places nearest to a point need.
    fn at(&self, t: f64) -> OutlinePoint {
        let (normal, rho) = (DVec2::from_angle(t), self.0.jet(t).rho);
        OutlinePoint { point: self.0.point(t), first: normal.perp() * rho, second: -normal * rho }
    }
}

/// `r = size (1 + depth cos(waves t))` in polar coordinates: hollow between the waves if `depth (waves^2 + 1) > 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Waved {
    /// Mean radius, m.
    pub size: f64,
    /// Height of the waves over the mean radius, in [0, 1).
    pub depth: f64,
    /// How many.
    pub waves: u32,
}

impl Waved {
    /// Radius of curvature at the bottom of the hollows, m, where `r' = 0`: `r^2 / (r'' - r)`. None where there are none.
    #[must_use]
    pub fn hollow(&self) -> Option<f64> {
        let (low, bend) = (1.0 - self.depth, self.depth * f64::from(self.waves * self.waves));
        (bend > low).then(|| self.size * low * low / (bend - low))
    }
}

impl SmoothOutline for Waved {
    fn at(&self, t: f64) -> OutlinePoint {
        let m = f64::from(self.waves);
        let (sin, cos) = (m * t).sin_cos();
        let (r, r1, r2) = (1.0 + self.depth * cos, -self.depth * m * sin, -self.depth * m * m * cos);
        let (e, p) = (DVec2::from_angle(t), DVec2::from_angle(t).perp());
        OutlinePoint {
            point: e * (self.size * r),
            first: (e * r1 + p * r) * self.size,
            second: (e * (r2 - r) + p * (2.0 * r1)) * self.size,
        }
    }
}
