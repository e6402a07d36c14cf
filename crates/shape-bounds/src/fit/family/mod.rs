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

use contact_kinematics::{Direction, SupportFunction};
use glam::DVec3;
use nalgebra::DVector;

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

fn outer(a: DVec3, b: DVec3) -> glam::DMat3 {
    glam::DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
