use super::{Model, outer, write};
use contact_kinematics::{Direction, SupportJet};
use glam::{DMat3, DVec3};
use nalgebra::DVector;

/// Centre and radius: `h = c . n + R`, linear in all four.
pub(in crate::fit) struct SphereModel;

impl Model for SphereModel {
    fn count(&self) -> usize {
        4
    }

    fn jet(&self, theta: &DVector<f64>, n: Direction, columns: Option<&mut [DVec3]>) -> Option<SupportJet> {
        let (centre, radius) = (DVec3::new(theta[0], theta[1], theta[2]), theta[3]);
        let n = n.get();
        write(columns, [DVec3::X, DVec3::Y, DVec3::Z, n]);
        Some(SupportJet {
            value: centre.dot(n) + radius,
            point: centre + n * radius,
            hessian: (DMat3::IDENTITY - outer(n, n)) * radius,
        })
    }

    fn name(&self, parameter: usize) -> String {
        ["centre x", "centre y", "centre z", "radius"][parameter].to_owned()
    }

    fn ball(&self, centre: DVec3, radius: f64) -> DVector<f64> {
        DVector::from_column_slice(&[centre.x, centre.y, centre.z, radius])
    }
}
