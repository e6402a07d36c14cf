//! Support functions of smooth convex bodies.

use crate::Direction;
use glam::{DMat3, DVec3};

/// Support function, contact point and curvature at one outward normal, all in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupportJet {
    /// Support function value `h(n)`, the paper's radius function `r`, in m.
    pub value: f64,
    /// `x(n) = grad h`: the surface point whose outward normal is `n`, from the body's origin, in m.
    pub point: DVec3,
    /// Hessian of the 1-homogeneous extension of `h` at `n`, in m. It maps `n` to zero; its other two eigenvalues
    /// are the principal radii of curvature. `dx = hessian * dn`.
    pub hessian: DMat3,
}

/// The support function `h(n) = max n . y` over the points `y` of a smooth convex body.
///
/// `h` is extended to all vectors as a 1-homogeneous function, `h(c n) = c h(n)` for `c > 0`, so that its gradient is
/// the surface point itself and no chart of the sphere is needed (the paper's equations (3) to (5) use one, and fail
/// where `cos theta_2 = 0`). The origin is the centre of mass wherever dynamics are concerned.
pub trait SupportFunction {
    /// Value, gradient and Hessian at the unit normal `n` in body axes, in one pass.
    fn jet(&self, n: Direction) -> SupportJet;

    /// `h(n)` in m.
    fn value(&self, n: Direction) -> f64 {
        self.jet(n).value
    }

    /// The surface point with outward normal `n`, in body axes, in m.
    fn point(&self, n: Direction) -> DVec3 {
        self.jet(n).point
    }

    /// Guaranteed bounds `min <= principal radius of curvature <= max` over the whole surface, in m.
    ///
    /// A body is smooth and strictly convex where `min > 0`. A support function that is only one term of a sum may
    /// have a negative `min`.
    fn curvature_radii(&self) -> CurvatureRadii;
}

/// Guaranteed bounds on the principal radii of curvature of a body, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureRadii {
    /// No principal radius is below this.
    pub min: f64,
    /// No principal radius is above this.
    pub max: f64,
}

impl<S: SupportFunction + ?Sized> SupportFunction for &S {
    fn jet(&self, n: Direction) -> SupportJet {
        (**self).jet(n)
    }
    fn value(&self, n: Direction) -> f64 {
        (**self).value(n)
    }
    fn point(&self, n: Direction) -> DVec3 {
        (**self).point(n)
    }
    fn curvature_radii(&self) -> CurvatureRadii {
        (**self).curvature_radii()
    }
}
