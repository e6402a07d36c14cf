//! Two frictionless palms in the plane: `n . (v + w x (c - p)) = n . W x c` at each.

use super::{KNOWN, Linear, ROUNDING, Scales, UNKNOWN, covariance};
use glam::DVec2;
use nalgebra::{DMatrix, DVector, SMatrix};
use recon::contact_kinematics::planar::PalmPairState;
use recon::object_dynamics::planar::{PlanarMass, PlanarNoise};

/// Centre of mass, velocity, angular velocity, logarithms of mass and moment of inertia.
const OWN: usize = 7;
/// Errors of both contacts and of both forces at a sample, and of both contacts once more where these count in the moments of their forces.
const READ: usize = 6;

/// The true motion and readings at one sample.
#[derive(Clone, Copy, Debug)]
pub struct TrueSample {
    /// Time, s.
    pub t: f64,
    /// Centre of mass, m, and its velocity, m/s.
    pub p_WCm: DVec2,
    /// Velocity of the centre of mass, m/s.
    pub v_WCm: DVec2,
    /// Angular velocity, rad/s.
    pub omega0: f64,
    /// Distances of the contacts from the hinge, m.
    pub contacts: [f64; 2],
    /// Forces along the normals, N.
    pub forces: [f64; 2],
    /// Palms.
    pub palms: PalmPairState,
}

/// Where the error of a contact that is read beside where it is counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactErrors {
    /// In its condition and, by the same number, in the moment of its force: as it is.
    Once,
    /// In both, as if they were two independent ones: what an estimator can do that takes them for that.
    Apart,
}

/// Covariance of centre of mass (m), velocity (m/s) and angular velocity (rad/s) at the last sample: no estimate that is right on average
/// has a smaller one. None of fewer than two samples, and where the equations are singular in double precision.
#[must_use]
pub fn least_covariance(
    samples: &[TrueSample],
    mass: PlanarMass,
    known: bool,
    noise: PlanarNoise,
    scales: Scales,
    errors: ContactErrors,
) -> Option<SMatrix<f64, 5, 5>> {
    let (contact, force) = (noise.contact, noise.force);
    let read = DVector::from_vec(vec![contact, contact, force, force, contact, contact]);
    let samples: Vec<Told> = samples.iter().map(|at| Told { at, mass, errors }).collect();
    let speed = scales.length / scales.time;
    let constant = if known { KNOWN / UNKNOWN } else { 1.0 };
    let natural = [scales.length, scales.length, speed, speed, scales.time.recip(), constant, constant];
    let before = DVector::from_vec(natural.to_vec()) * UNKNOWN;
    let own = covariance(&samples, &before, &read, ROUNDING * speed)?;
    Some(own.fixed_view::<5, 5>(0, 0).into_owned())
}

/// A sample with what is true of the body, and where errors of contacts count.
struct Told<'a> {
    at: &'a TrueSample,
    mass: PlanarMass,
    errors: ContactErrors,
}

impl TrueSample {
    /// Contact point, normal into the wedge, and direction away from the hinge, of a palm.
    fn touch(&self, palm: usize) -> [DVec2; 3] {
        let (u, n) = (self.palms.pair.along()[palm], self.palms.pair.normals()[palm]);
        [u * self.contacts[palm], n, u]
    }
}

impl Linear for Told<'_> {
    fn time(&self) -> f64 {
        self.at.t
    }

    fn rates(&self) -> [DMatrix<f64>; 2] {
        let (mut by_own, mut by_read) = (DMatrix::zeros(OWN, OWN), DMatrix::zeros(OWN, READ));
        let (body, p_WCm) = (self.mass, self.at.p_WCm);
        (by_own[(0, 2)], by_own[(1, 3)]) = (1.0, 1.0);
        for palm in 0..2 {
            let ([c, n, u], force) = (self.at.touch(palm), self.at.forces[palm]);
            let lever = c - p_WCm;
            for (axis, n) in [n.x, n.y].into_iter().enumerate() {
                by_own[(2 + axis, 5)] -= force * n / body.mass();
                by_read[(2 + axis, 2 + palm)] = n / body.mass();
            }
            // Of the moment `(c - p) x n f` over the inertia.
            by_own[(4, 0)] -= n.y * force / body.inertia();
            by_own[(4, 1)] += n.x * force / body.inertia();
            by_own[(4, 6)] -= lever.perp_dot(n) * force / body.inertia();
            let contact = if self.errors == ContactErrors::Once { palm } else { 4 + palm };
            by_read[(4, contact)] = u.perp_dot(n) * force / body.inertia();
            by_read[(4, 2 + palm)] = lever.perp_dot(n) / body.inertia();
        }
        [by_own, by_read]
    }

    fn openings(&self) -> [DMatrix<f64>; 2] {
        let (mut by_own, mut by_read) = (DMatrix::zeros(2, OWN), DMatrix::zeros(2, READ));
        let omega0 = self.at.omega0;
        for palm in 0..2 {
            let [c, n, u] = self.at.touch(palm);
            let arm = n.dot((c - self.at.p_WCm).perp());
            let own = [-omega0 * n.y, omega0 * n.x, n.x, n.y, arm, 0.0, 0.0];
            own.into_iter().enumerate().for_each(|(i, by)| by_own[(palm, i)] = by);
            by_read[(palm, palm)] = (omega0 - self.at.palms.motion.rates[palm]) * n.dot(u.perp());
        }
        [by_own, by_read]
    }
}

#[cfg(test)]
mod tests;
