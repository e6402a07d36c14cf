//! The families of shapes, each as a support function with the derivatives of its points by its parameters.

mod ellipsoid;
mod harmonics;
mod norm;
mod sphere;
mod superquadric;

pub use ellipsoid::SkewEllipsoid;
pub use superquadric::Superquadric;

pub(super) use ellipsoid::EllipsoidModel;
pub(super) use harmonics::HarmonicModel;
pub(super) use sphere::SphereModel;
pub(super) use superquadric::SuperquadricModel;

use contact_kinematics::{
    CurvatureRadii, Direction, PolynomialSupport, Sphere, SupportFunction, SupportJet, Translated,
};
use glam::DVec3;
use nalgebra::DVector;
use std::fmt;

/// Families of shapes, by what their parameters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum ShapeFamily {
    /// A ball: centre and radius, 4 parameters.
    Sphere,
    /// An ellipsoid, the general bounded quadric: 9 parameters.
    Ellipsoid,
    /// A convex superquadric: 11 parameters.
    Superquadric,
    /// A support function of spherical harmonics up to a degree: `(degree + 1)^2` parameters.
    Harmonics {
        /// The highest degree, 0 to 32; degree 1 is a ball.
        degree: usize,
    },
}

impl fmt::Display for ShapeFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sphere => f.write_str("sphere"),
            Self::Ellipsoid => f.write_str("ellipsoid"),
            Self::Superquadric => f.write_str("superquadric"),
            Self::Harmonics { degree } => write!(f, "harmonics to degree {degree}"),
        }
    }
}

impl ShapeFamily {
    /// Number of parameters.
    #[must_use]
    pub fn parameters(self) -> usize {
        match self {
            Self::Sphere => 4,
            Self::Ellipsoid => 9,
            Self::Superquadric => 11,
            Self::Harmonics { degree } => (degree + 1) * (degree + 1),
        }
    }

    /// The model, or `None` for a degree that is not accepted.
    pub(super) fn model(self) -> Option<Box<dyn Model>> {
        Some(match self {
            Self::Sphere => Box::new(SphereModel),
            Self::Ellipsoid => Box::new(EllipsoidModel),
            Self::Superquadric => Box::new(SuperquadricModel),
            Self::Harmonics { degree } => Box::new(HarmonicModel::new(degree).ok()?),
        })
    }
}

/// A fitted body.
#[derive(Clone, Debug, PartialEq)]
pub enum FittedBody {
    /// A ball.
    Sphere(Translated<Sphere>),
    /// An ellipsoid.
    Ellipsoid(SkewEllipsoid),
    /// A superquadric.
    Superquadric(Superquadric),
    /// A polynomial support function, certified convex.
    Harmonics(PolynomialSupport),
}

impl FittedBody {
    fn support(&self) -> &dyn SupportFunction {
        match self {
            Self::Sphere(body) => body,
            Self::Ellipsoid(body) => body,
            Self::Superquadric(body) => body,
            Self::Harmonics(body) => body,
        }
    }
}

impl SupportFunction for FittedBody {
    fn jet(&self, n: Direction) -> SupportJet {
        self.support().jet(n)
    }
    fn value(&self, n: Direction) -> f64 {
        self.support().value(n)
    }
    fn curvature_radii(&self) -> CurvatureRadii {
        self.support().curvature_radii()
    }
}

/// A family of support functions by parameters.
pub(super) trait Model {
    /// Number of parameters.
    fn count(&self) -> usize;

    /// The body; `None` where the parameters are none.
    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn SupportFunction>>;

    /// Derivative of the surface point with normal `n` by each parameter; `None` where the parameters are no body.
    fn columns(&self, theta: &DVector<f64>, n: Direction, columns: &mut [DVec3]) -> Option<()>;

    /// The parameters after a step in the coordinates in which the derivatives are taken.
    fn moved(&self, theta: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        theta + step
    }

    /// Natural sizes of the parameters for a body of the given size in m.
    fn scales(&self, size: f64) -> DVector<f64> {
        DVector::from_element(self.count(), size)
    }

    /// What a parameter is called.
    fn name(&self, parameter: usize) -> String;

    /// Parameters of the ball with this centre and radius.
    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64>;
}

/// Writes `values` to `columns`.
fn write(columns: &mut [DVec3], values: impl IntoIterator<Item = DVec3>) {
    columns.iter_mut().zip(values).for_each(|(column, value)| *column = value);
}
