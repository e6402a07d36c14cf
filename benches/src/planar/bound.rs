//! The least deviations of a motion in the plane that contacts and forces of two frictionless palms allow (Cramér-Rao), by sensitivities about
//! the motion that was simulated.
//!
//! The shape is anything: at each sample both contact points and both forces are unknowns of their own beside what was read of them, and
//! what ties all samples together are Newton's and Euler's equations and that neither contact opens, `n . (v + w x (c - p)) = n . W x c`.
//! About the truth all of it is linear; least squares of linear equations with normal noise attain the bound (Gorman and Hero 1990, for unknowns under
//! constraints), and a Kalman filter is such least squares, whose covariance after the last sample is the bound there. Nothing here is
//! of the estimator: its nodes, windows and numbers in space are not known to this file.

use glam::DVec2;
use nalgebra::{SMatrix, SVector};
use recon::contact_kinematics::planar::PalmPairState;
use recon::object_dynamics::planar::{PlanarMass, PlanarNoise};

/// Centre of mass, velocity, angular velocity, logarithms of mass and moment of inertia.
const OWN: usize = 7;
/// Errors of both contacts and of both forces at a sample.
const READ: usize = 4;
const ALL: usize = OWN + READ;

type Own = SMatrix<f64, OWN, OWN>;
type Inputs = SMatrix<f64, OWN, READ>;
type Covariance = SMatrix<f64, ALL, ALL>;

/// Deviation of what nothing is known of beforehand, natural units: far beyond all that a log of use leaves open.
const UNKNOWN: f64 = 10.0;
/// Deviation of a logarithm that is known.
const KNOWN: f64 = 1e-6;
/// Deviation of a condition by itself, natural speeds: against the rounding of a filter whose readings are exact.
const ROUNDING: f64 = 1e-7;

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

/// Length (m) and time (s) in which numbers are of the order of one.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// Mean radius of the body, m.
    pub length: f64,
    /// Natural time, s.
    pub time: f64,
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
    let read = SVector::from([noise.contact, noise.contact, noise.force, noise.force]);
    let mut filter = Filter { errors, ..Filter::begun(mass, known, read, scales) };
    filter.condition(samples.first()?)?;
    for pair in samples.windows(2) {
        filter.carry([&pair[0], &pair[1]])?;
        filter.condition(&pair[1])?;
    }
    (samples.len() > 1).then(|| filter.covariance.fixed_view::<5, 5>(0, 0).into_owned())
}

impl TrueSample {
    /// Contact point, normal into the wedge, and direction away from the hinge, of a palm.
    fn touch(&self, palm: usize) -> [DVec2; 3] {
        let (u, n) = (self.palms.pair.along()[palm], self.palms.pair.normals()[palm]);
        [u * self.contacts[palm], n, u]
    }

    /// Derivatives of the rates of motion by the motion and the body's constants, and by errors of the readings.
    fn derivatives(&self, body: PlanarMass) -> (Own, Inputs) {
        let (mut by_own, mut by_read) = (Own::zeros(), Inputs::zeros());
        (by_own[(0, 2)], by_own[(1, 3)]) = (1.0, 1.0);
        for palm in 0..2 {
            let ([c, n, u], force) = (self.touch(palm), self.forces[palm]);
            let lever = c - self.p_WCm;
            for (axis, n) in [n.x, n.y].into_iter().enumerate() {
                by_own[(2 + axis, 5)] -= force * n / body.mass();
                by_read[(2 + axis, 2 + palm)] = n / body.mass();
            }
            // Of the moment `(c - p) x n f` over the inertia.
            by_own[(4, 0)] -= n.y * force / body.inertia();
            by_own[(4, 1)] += n.x * force / body.inertia();
            by_own[(4, 6)] -= lever.perp_dot(n) * force / body.inertia();
            by_read[(4, palm)] = u.perp_dot(n) * force / body.inertia();
            by_read[(4, 2 + palm)] = lever.perp_dot(n) / body.inertia();
        }
        (by_own, by_read)
    }

    /// Derivatives of the speed at which contacts open.
    fn conditions(&self) -> SMatrix<f64, 2, ALL> {
        let mut rows = SMatrix::<f64, 2, ALL>::zeros();
        for palm in 0..2 {
            let [c, n, u] = self.touch(palm);
            let relative = self.omega0 - self.palms.motion.rates[palm];
            let own =
                [-self.omega0 * n.y, self.omega0 * n.x, n.x, n.y, n.dot((c - self.p_WCm).perp()), 0.0, 0.0];
            own.into_iter().enumerate().for_each(|(i, by)| rows[(palm, i)] = by);
            rows[(palm, OWN + palm)] = relative * n.dot(u.perp());
        }
        rows
    }
}

/// What the readings so far leave open.
struct Filter {
    body: PlanarMass,
    /// Deviations of the readings at a sample.
    read: SVector<f64, READ>,
    /// Deviation of a condition by itself, m/s.
    rounding: f64,
    errors: ContactErrors,
    covariance: Covariance,
}

impl Filter {
    fn begun(
        body: PlanarMass,
        known: bool,
        read: SVector<f64, READ>,
        Scales { length, time }: Scales,
    ) -> Self {
        let speed = length / time;
        let constant = if known { KNOWN / UNKNOWN } else { 1.0 };
        let natural = [length, length, speed, speed, time.recip(), constant, constant];
        let mut deviations = SVector::<f64, ALL>::zeros();
        deviations.fixed_rows_mut::<OWN>(0).copy_from(&(SVector::from(natural) * UNKNOWN));
        deviations.fixed_rows_mut::<READ>(OWN).copy_from(&read);
        let covariance = Covariance::from_diagonal(&deviations.component_mul(&deviations));
        Self { body, read, rounding: ROUNDING * speed, errors: ContactErrors::Once, covariance }
    }

    /// To the next sample, whose readings have errors of their own; rates change linearly in between.
    fn carry(&mut self, [before, after]: [&TrueSample; 2]) -> Option<()> {
        let half = 0.5 * (after.t - before.t);
        let ((own, mut inputs), (next, mut next_inputs)) =
            (before.derivatives(self.body), after.derivatives(self.body));
        let mut apart = 0.0;
        if self.errors == ContactErrors::Apart {
            for palm in 0..2 {
                // All of a sample's error in the interval after it.
                apart += (2.0 * half * inputs[(4, palm)] * self.read[palm]).powi(2);
                (inputs[(4, palm)], next_inputs[(4, palm)]) = (0.0, 0.0);
            }
        }
        let implicit = (Own::identity() - next * half).try_inverse()?;
        let mut step = Covariance::zeros();
        step.fixed_view_mut::<OWN, OWN>(0, 0).copy_from(&(implicit * (Own::identity() + own * half)));
        step.fixed_view_mut::<OWN, READ>(0, OWN).copy_from(&(implicit * inputs * half));
        let mut fresh = SMatrix::<f64, ALL, READ>::zeros();
        fresh.fixed_view_mut::<OWN, READ>(0, 0).copy_from(&(implicit * next_inputs * half));
        fresh.fixed_view_mut::<READ, READ>(OWN, 0).fill_with_identity();
        let fresh = fresh * SMatrix::<f64, READ, READ>::from_diagonal(&self.read);
        self.covariance = step * self.covariance * step.transpose() + fresh * fresh.transpose();
        self.covariance[(4, 4)] += apart;
        Some(())
    }

    /// That neither contact opens.
    fn condition(&mut self, now: &TrueSample) -> Option<()> {
        let (rows, variance) = (now.conditions(), self.rounding * self.rounding);
        let across = self.covariance * rows.transpose();
        let gain = across * (rows * across + SMatrix::<f64, 2, 2>::identity() * variance).try_inverse()?;
        // Joseph's form stays symmetric and positive.
        let left = Covariance::identity() - gain * rows;
        self.covariance = left * self.covariance * left.transpose() + gain * gain.transpose() * variance;
        Some(())
    }
}

#[cfg(test)]
mod tests;
