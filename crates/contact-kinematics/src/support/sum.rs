use super::{CurvatureRadii, SupportFunction, SupportJet};
use crate::Direction;
use glam::DVec3;

/// Minkowski sum of two bodies: their support functions add, and so do points and Hessians.
///
/// An ellipsoid plus a ball has rounded tips; an ellipsoid plus a [`crate::PolynomialSupport`] is a general smooth
/// body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MinkowskiSum<A, B>(
    /// One body.
    pub A,
    /// The other.
    pub B,
);

impl<A: SupportFunction, B: SupportFunction> SupportFunction for MinkowskiSum<A, B> {
    fn jet(&self, n: Direction) -> SupportJet {
        let (a, b) = (self.0.jet(n), self.1.jet(n));
        SupportJet { value: a.value + b.value, point: a.point + b.point, hessian: a.hessian + b.hessian }
    }

    fn value(&self, n: Direction) -> f64 {
        self.0.value(n) + self.1.value(n)
    }

    /// The bounds add (Weyl's inequality), so they hold but need not be attained.
    fn curvature_radii(&self) -> CurvatureRadii {
        let (a, b) = (self.0.curvature_radii(), self.1.curvature_radii());
        CurvatureRadii { min: a.min + b.min, max: a.max + b.max }
    }
}

/// A body moved against its origin, for a centre of mass that is not the centre of the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Translated<S> {
    /// The body about its own centre.
    pub body: S,
    /// Where that centre is, from the body's origin, in m.
    pub offset: DVec3,
}

impl<S: SupportFunction> SupportFunction for Translated<S> {
    fn jet(&self, n: Direction) -> SupportJet {
        let jet = self.body.jet(n);
        SupportJet { value: jet.value + self.offset.dot(n.get()), point: jet.point + self.offset, ..jet }
    }

    fn value(&self, n: Direction) -> f64 {
        self.body.value(n) + self.offset.dot(n.get())
    }

    fn curvature_radii(&self) -> CurvatureRadii {
        self.body.curvature_radii()
    }
}
