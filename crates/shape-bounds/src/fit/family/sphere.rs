use super::{Model, write};
use crate::matrix::outer;
use contact_kinematics::{CurvatureRadii, Direction, SupportFunction, SupportJet};
use glam::{DMat3, DVec3};
use nalgebra::DVector;

/// A ball whose radius may be negative: what an iteration may pass through.
struct AnyBall(DVector<f64>);

impl SupportFunction for AnyBall {
    fn jet(&self, n: Direction) -> SupportJet {
        let (centre, radius) = (DVec3::new(self.0[0], self.0[1], self.0[2]), self.0[3]);
        let n = n.get();
        SupportJet {
            value: centre.dot(n) + radius,
            point: centre + n * radius,
            hessian: (DMat3::IDENTITY - outer(n, n)) * radius,
        }
    }

    fn curvature_radii(&self) -> CurvatureRadii {
        CurvatureRadii { min: self.0[3], max: self.0[3] }
    }
}

/// Centre and radius: `h = c . n + R`, linear in all four.
pub(in crate::fit) struct SphereModel;

impl Model for SphereModel {
    fn count(&self) -> usize {
        4
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn SupportFunction>> {
        Some(Box::new(AnyBall(theta.clone())))
    }

    fn columns(&self, _theta: &DVector<f64>, n: Direction, columns: &mut [DVec3]) -> Option<()> {
        write(columns, [DVec3::X, DVec3::Y, DVec3::Z, n.get()]);
        Some(())
    }

    fn name(&self, parameter: usize) -> String {
        ["centre x", "centre y", "centre z", "radius"][parameter].to_owned()
    }

    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64> {
        DVector::from_column_slice(&[centre.x, centre.y, centre.z, radius])
    }
}
