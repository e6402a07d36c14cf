//! Forces and accelerations at contacts that are off, slide or stick, and the choice between these.
//!
//! Everything is computed in mass-weighted coordinates `(sqrt m a, sqrt I0 alpha)`, in which the inverse mass matrix is the
//! unit matrix: a contact direction `e` at the lever `b` is the row `(e / sqrt m, e . (z x b) / sqrt I0)`.

mod choose;
mod feasible;
mod respond;
mod scene;
#[cfg(test)]
mod tests;

pub(super) use choose::CONSISTENT;
pub use choose::{Choice, ModeError};
pub use respond::{Jammed, Response};
pub use scene::{ContactScene, ContactSceneError, ScenePalm};

use super::mass::PlanarMass;
use crate::modes::ContactMode;
use glam::DVec2;
use nalgebra::Vector3;

/// Most palms of a scene: the choice of modes goes through up to four of each contact.
pub const MOST_PALMS: usize = 5;

/// What a planar contact does: its mode, and where it slides the sense of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PlanarMode {
    /// No force.
    #[default]
    Off,
    /// Slip along the palm's tangent.
    Slide {
        /// 1 or -1, the sign of the body's slip along the palm's tangent `t`; 0 on a frictionless palm, where it has no say.
        sense: f64,
    },
    /// No slip.
    Stick,
}

impl PlanarMode {
    /// The mode without its sense.
    #[must_use]
    pub fn mode(&self) -> ContactMode {
        match self {
            Self::Off => ContactMode::Off,
            Self::Slide { .. } => ContactMode::Slide,
            Self::Stick => ContactMode::Stick,
        }
    }
}

/// A contact that touches, at one instant. World axes.
///
/// In a blow velocities take the place of accelerations: biases are then those of the first rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchingContact {
    /// The palm's normal, into the object.
    pub n: DVec2,
    /// Its tangent.
    pub t: DVec2,
    /// Contact point from the centre of mass, m.
    pub b_W: DVec2,
    /// `gap'' = n . (a + alpha x b) + biases[0]` and `t . slip' = t . (a + alpha x b) + biases[1]`, m/s^2.
    pub biases: [f64; 2],
    /// Coefficient of friction.
    pub mu: f64,
    /// Sign of the present slip along `t`; 0 where the contact does not slip, and the forces decide whether it will.
    pub sense: f64,
}

/// A body with its touching contacts at one instant: what its acceleration is asked of.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactProblem {
    roots: [f64; 2],
    free: Vector3<f64>,
    contacts: Vec<Rows>,
}

/// Rows of a contact in mass-weighted coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rows {
    normal: Vector3<f64>,
    tangent: Vector3<f64>,
    contact: TouchingContact,
}

impl ContactProblem {
    /// From mass, the acceleration of the centre of mass (m/s^2) and the angular acceleration (rad/s^2) without contacts,
    /// and the contacts.
    #[must_use]
    pub fn new(mass: PlanarMass, free: (DVec2, f64), contacts: &[TouchingContact]) -> Self {
        let roots = [mass.mass().sqrt(), mass.inertia().sqrt()];
        let row = |e: DVec2, b: DVec2| {
            let linear = e / roots[0];
            Vector3::new(linear.x, linear.y, e.dot(b.perp()) / roots[1])
        };
        let contacts = contacts.iter().map(|&contact| Rows {
            normal: row(contact.n, contact.b_W),
            tangent: row(contact.t, contact.b_W),
            contact,
        });
        let (a, alpha) = (free.0 * roots[0], free.1 * roots[1]);
        Self { roots, free: Vector3::new(a.x, a.y, alpha), contacts: contacts.collect() }
    }

    /// The motion with least kinetic energy that takes the rates `residuals` (along normal and tangent of each contact; m/s
    /// or, of gaps, m) away from the contacts, along the normals of sliding contacts and both axes of sticking ones: velocity
    /// of the centre of mass and angular velocity.
    #[must_use]
    pub(crate) fn correction(&self, modes: &[PlanarMode], residuals: &[[f64; 2]]) -> (DVec2, f64) {
        let (mut rows, mut right) = (Vec::new(), Vec::new());
        for ((contact, mode), residual) in self.contacts.iter().zip(modes).zip(residuals) {
            if *mode != PlanarMode::Off {
                rows.push(contact.normal);
                right.push(-residual[0]);
            }
            if *mode == PlanarMode::Stick {
                rows.push(contact.tangent);
                right.push(-residual[1]);
            }
        }
        self.unweighted(&respond::least_norm(&rows, &right).solution)
    }

    /// Natural units of mass-weighted coordinates back to acceleration and angular acceleration.
    fn unweighted(&self, x: &Vector3<f64>) -> (DVec2, f64) {
        (DVec2::new(x[0], x[1]) / self.roots[0], x[2] / self.roots[1])
    }
}
