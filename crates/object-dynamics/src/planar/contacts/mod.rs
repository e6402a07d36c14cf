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

pub use choose::ModeError;
pub(super) use choose::{CONSISTENT, WEDGED, letters};
pub use respond::Jammed;
pub(super) use respond::Response;
pub use scene::{ContactScene, ContactSceneError, ScenePalm};

use super::mass::PlanarMass;
use crate::modes::ContactMode;
use glam::DVec2;
use nalgebra::Vector3;

/// What a planar contact does: its mode, and where it slides the sense of it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum PlanarMode {
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
    pub(super) fn mode(self) -> ContactMode {
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
pub(super) struct TouchingContact {
    /// The palm's normal, into the object.
    pub(super) n: DVec2,
    /// Its tangent.
    pub(super) t: DVec2,
    /// Contact point from the centre of mass, m.
    pub(super) b_W: DVec2,
    /// `gap'' = n . (a + alpha x b) + biases[0]` and `t . slip' = t . (a + alpha x b) + biases[1]`, m/s^2.
    pub(super) biases: [f64; 2],
    /// Coefficient of friction.
    pub(super) mu: f64,
    /// Sign of the present slip along `t`; 0 where the contact does not slip, and the forces decide whether it will.
    pub(super) sense: f64,
}

/// A body with its touching contacts at one instant: what its acceleration is asked of.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ContactProblem {
    roots: [f64; 2],
    free: Vector3<f64>,
    contacts: Vec<Rows>,
}

/// A small change of motion, and the impulses that make it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Correction {
    /// Of the centre of mass, m/s (or m).
    pub(super) linear: DVec2,
    /// Of the orientation, rad/s (or rad).
    pub(super) angular: f64,
    /// At each contact along its normal and tangent, N s.
    pub(super) impulses: Vec<[f64; 2]>,
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
    pub(super) fn new(mass: PlanarMass, free: (DVec2, f64), contacts: &[TouchingContact]) -> Self {
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
    /// or, of gaps, m) away from the contacts, along the normals of sliding contacts and both axes of sticking ones.
    pub(super) fn correction(&self, modes: &[PlanarMode], residuals: &[[f64; 2]]) -> Correction {
        let (mut rows, mut right, mut axes) = (Vec::new(), Vec::new(), Vec::new());
        for (i, (contact, mode)) in self.contacts.iter().zip(modes).enumerate() {
            let count = match mode {
                PlanarMode::Off => 0,
                PlanarMode::Slide { .. } => 1,
                PlanarMode::Stick => 2,
            };
            for axis in 0..count {
                rows.push([contact.normal, contact.tangent][axis]);
                right.push(-residuals[i][axis]);
                axes.push((i, axis));
            }
        }
        let least = respond::least_norm(&rows, &right);
        let mut impulses = vec![[0.0; 2]; self.contacts.len()];
        for ((i, axis), share) in axes.into_iter().zip(least.shares) {
            impulses[i][axis] = share;
        }
        let (linear, angular) = self.unweighted(&least.solution);
        Correction { linear, angular, impulses }
    }

    /// Natural units of mass-weighted coordinates back to acceleration and angular acceleration.
    fn unweighted(&self, x: &Vector3<f64>) -> (DVec2, f64) {
        (DVec2::new(x[0], x[1]) / self.roots[0], x[2] / self.roots[1])
    }
}
