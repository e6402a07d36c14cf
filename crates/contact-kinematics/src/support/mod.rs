//! Support functions of smooth convex bodies.

mod ellipsoid;
mod harmonic;
mod polynomial;
mod polytope;
mod sum;

pub use ellipsoid::{Ellipsoid, Sphere};
pub use polynomial::{Monomial, PolynomialSupport};
pub use polytope::RoundedPolytope;
pub use sum::{MinkowskiSum, Translated};

use crate::Direction;
use glam::{DMat3, DVec3};
use thiserror::Error;

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

/// Why a shape cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A length is zero, negative or not a number.
    #[error("{what} is {value} m; it must be positive and finite")]
    Length {
        /// Which length.
        what: &'static str,
        /// As given, in m.
        value: f64,
    },
    /// A coefficient is not a number.
    #[error("coefficient {index} is {value}; it must be finite")]
    Coefficient {
        /// Which term, from 0.
        index: usize,
        /// As given.
        value: f64,
    },
    /// A term has too high a degree.
    #[error("term {index} has degree {degree}; the limit is {limit}")]
    Degree {
        /// Which term, from 0.
        index: usize,
        /// Its degree.
        degree: u32,
        /// The highest accepted.
        limit: u32,
    },
    /// A row of spherical-harmonic coefficients has the wrong length.
    #[error("harmonics of degree {degree} need {expected} coefficients, found {found}")]
    HarmonicCount {
        /// Degree `l` of the row.
        degree: usize,
        /// `2 l + 1`.
        expected: usize,
        /// As given.
        found: usize,
    },
    /// A power of a rounded polytope that is none.
    #[error("sharpness is {value}; it must lie between 2 and 1e6")]
    Sharpness {
        /// As given.
        value: f64,
    },
    /// A polytope with too many corners.
    #[error("polytope has {found} corners; at most {limit} are taken")]
    CornerCount {
        /// How many.
        found: usize,
        /// The highest accepted.
        limit: usize,
    },
    /// A polytope that is flat, or does not hold its origin.
    #[error(
        "the origin (centre of mass, less the offset) is not inside of the {corners} corners; move them or give more"
    )]
    OriginOutside {
        /// How many corners.
        corners: usize,
    },
    /// The body is not certified to be smooth and strictly convex.
    #[error(
        "body is not certified convex: its principal radii of curvature are only known to be above {min:.3e} m; \
         reduce the terms that bend it inwards"
    )]
    NotConvex {
        /// Guaranteed lower bound of the radii, in m; not positive.
        min: f64,
    },
}

/// The body's radii of curvature, if they certify it smooth and strictly convex: the convexity margin is their `min`.
///
/// # Errors
/// [`ShapeError::NotConvex`].
pub fn check_convex(body: &(impl SupportFunction + ?Sized)) -> Result<CurvatureRadii, ShapeError> {
    let radii = body.curvature_radii();
    if radii.min > 0.0 && radii.max.is_finite() {
        Ok(radii)
    } else {
        Err(ShapeError::NotConvex { min: radii.min })
    }
}

/// The two principal radii of curvature in the Hessian of a support function at the normal `n`, ascending, in m.
#[must_use]
pub fn principal_radii(hessian: DMat3, n: Direction) -> [f64; 2] {
    // In a tangent basis, and not from trace and norm: those lose half of the digits where the radii are equal.
    let (a, b) = n.tangent_basis();
    let (ha, hb) = (hessian * a, hessian * b);
    let (aa, ab, bb) = (a.dot(ha), a.dot(hb), b.dot(hb));
    let (mean, half) = (0.5 * (aa + bb), (0.5 * (aa - bb)).hypot(ab));
    [mean - half, mean + half]
}

fn check_length(what: &'static str, value: f64) -> Result<(), ShapeError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ShapeError::Length { what, value }) }
}

macro_rules! forward_support_function {
    ($($pointer:ty),+) => {$(
        impl<S: SupportFunction + ?Sized> SupportFunction for $pointer {
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
    )+};
}

forward_support_function!(&S, Box<S>);

#[cfg(test)]
mod tests;
