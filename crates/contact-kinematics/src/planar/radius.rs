//! The radius function of a planar body (paper, section 3).

use glam::DVec2;

/// Radius function and what follows from it at one outward normal direction `theta` in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusJet {
    /// `r = x . n`: distance of the tangent line from the centre of mass, in m.
    pub r: f64,
    /// `d = x . t = -r'`: offset of the contact point along the tangent `t = (sin theta, -cos theta)`, in m.
    pub d: f64,
    /// `rho = r + r''`: radius of curvature, positive on a smooth strictly convex body, in m.
    pub rho: f64,
}

/// Guaranteed bounds on the radius of curvature over a whole outline, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiusBounds {
    /// Nowhere is the radius of curvature below this.
    pub min: f64,
    /// Nowhere is it above this.
    pub max: f64,
}

/// A smooth convex planar body by its radius function about the centre of mass: the support function in the plane.
pub trait RadiusFunction {
    /// `r`, `d = -r'` and `rho = r + r''` where the outward normal is `(cos theta, sin theta)` in body axes.
    fn jet(&self, theta: f64) -> RadiusJet;

    /// Guaranteed bounds on `rho`.
    fn radius_bounds(&self) -> RadiusBounds;

    /// Point of the outline with outward normal direction `theta`, body axes, m: `x = r n + d t`.
    fn point(&self, theta: f64) -> DVec2 {
        let RadiusJet { r, d, .. } = self.jet(theta);
        let (sin, cos) = theta.sin_cos();
        DVec2::new(r * cos + d * sin, r * sin - d * cos)
    }
}

impl<S: RadiusFunction + ?Sized> RadiusFunction for &S {
    fn jet(&self, theta: f64) -> RadiusJet {
        (**self).jet(theta)
    }
    fn radius_bounds(&self) -> RadiusBounds {
        (**self).radius_bounds()
    }
}

/// Jet of the point `p` (body axes): what moving the outline by `p` against the centre of mass adds.
pub(super) fn point_jet(p: DVec2, theta: f64) -> RadiusJet {
    let (sin, cos) = theta.sin_cos();
    RadiusJet { r: p.x * cos + p.y * sin, d: p.x * sin - p.y * cos, rho: 0.0 }
}

impl std::ops::Add for RadiusJet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { r: self.r + other.r, d: self.d + other.d, rho: self.rho + other.rho }
    }
}
