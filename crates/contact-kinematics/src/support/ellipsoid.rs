use super::{CurvatureRadii, ShapeError, SupportFunction, SupportJet, check_length};
use crate::Direction;
use glam::{DMat3, DVec3};

/// A ball about the body's origin: the radius in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    radius: f64,
}

impl Sphere {
    /// A ball of the given radius in m.
    ///
    /// # Errors
    /// [`ShapeError::Length`] unless the radius is positive and finite.
    pub fn new(radius: f64) -> Result<Self, ShapeError> {
        check_length("radius", radius)?;
        Ok(Self { radius })
    }

    /// Radius in m.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }
}

impl SupportFunction for Sphere {
    fn jet(&self, n: Direction) -> SupportJet {
        let n = n.get();
        SupportJet {
            value: self.radius,
            point: self.radius * n,
            hessian: (DMat3::IDENTITY - outer(n, n)) * self.radius,
        }
    }

    fn curvature_radii(&self) -> CurvatureRadii {
        CurvatureRadii { min: self.radius, max: self.radius }
    }
}

/// An ellipsoid about the body's origin with its axes along the body axes.
///
/// `h(u) = sqrt(u' D u)` with `D = diag(a^2, b^2, c^2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipsoid {
    semi_axes: DVec3,
}

impl Ellipsoid {
    /// From the semi-axes along body X, Y, Z, in m.
    ///
    /// # Errors
    /// [`ShapeError::Length`] unless all three are positive and finite.
    pub fn new(semi_axes: DVec3) -> Result<Self, ShapeError> {
        for (what, length) in
            ["semi-axis x", "semi-axis y", "semi-axis z"].into_iter().zip(semi_axes.to_array())
        {
            check_length(what, length)?;
        }
        Ok(Self { semi_axes })
    }

    /// Semi-axes in m.
    #[must_use]
    pub fn semi_axes(&self) -> DVec3 {
        self.semi_axes
    }
}

impl SupportFunction for Ellipsoid {
    fn jet(&self, n: Direction) -> SupportJet {
        let squares = self.semi_axes * self.semi_axes;
        let scaled = squares * n.get();
        // At least the square of the smallest semi-axis, which the constructor keeps above zero.
        let value = scaled.dot(n.get()).sqrt();
        let point = scaled / value;
        let hessian = (DMat3::from_diagonal(squares) - outer(point, point)) * (1.0 / value);
        SupportJet { value, point, hessian }
    }

    fn value(&self, n: Direction) -> f64 {
        (self.semi_axes * n.get()).length()
    }

    /// Exact: `c^2 / a` at the end of the longest axis, `a^2 / c` at the end of the shortest.
    fn curvature_radii(&self) -> CurvatureRadii {
        let (short, long) = (self.semi_axes.min_element(), self.semi_axes.max_element());
        CurvatureRadii { min: short * short / long, max: long * long / short }
    }
}

/// `a b'`.
pub(super) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
