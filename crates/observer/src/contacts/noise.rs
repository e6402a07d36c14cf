use super::problem::Units;
use crate::rigid::cross_matrix;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, Matrix6};
use std::ops::{Add, AddAssign};

/// Standard deviations of the white noise of sensors, as an estimator takes them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactNoiseLevel {
    /// Of a contact point in each tangent direction of its palm, m.
    pub contact: f64,
    /// Of each axis of a force: a fixed part, N.
    pub force_fixed: f64,
    /// Of each axis of a force: a part that grows with it, as a share of its length.
    pub force_share: f64,
    /// Of the impulses; none where they are not to be read.
    pub impulse: Option<ImpulseNoise>,
    /// What a contact condition is off by beside that, m/s: palms whose velocity is known no better, creep.
    pub floor: f64,
}

/// Standard deviation of each axis of an impulse over one interval between samples. Intervals are independent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImpulseNoise {
    /// A fixed part, N s.
    pub fixed: f64,
    /// A part that grows with the impulse, as a share of its length.
    pub share: f64,
}

impl ContactNoiseLevel {
    /// Whether the noise of contacts is what conditions are off by.
    pub(super) fn limits(&self, units: &Units) -> bool {
        self.contact > self.floor * units.time()
    }

    /// With contacts and forces so many times as noisy, as [`ContactEvidence::rougher`](crate::contacts::ContactEvidence::rougher) tells.
    #[must_use]
    pub fn times(self, [contacts, forces]: [f64; 2]) -> Self {
        let (force_fixed, force_share) = (forces * self.force_fixed, forces * self.force_share);
        Self { contact: contacts * self.contact, force_fixed, force_share, ..self }
    }

    /// Standard deviation of each axis of the force `f`, N.
    pub(super) fn force(&self, f: DVec3) -> f64 {
        self.force_fixed.hypot(self.force_share * f.length())
    }
}

impl ImpulseNoise {
    /// Standard deviation of each axis of the impulse `J`, N s.
    pub(super) fn of(&self, J: DVec3) -> f64 {
        self.fixed.hypot(self.share * J.length())
    }
}

/// Covariances of what forces, with their moments about the origin, do over some time.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct WrenchNoise {
    /// Of their integral, made by noise that is white.
    pub(super) white: Matrix6<f64>,
    /// Of their integral over time and once more, beside what white noise makes of it: what acted is known, but not when.
    pub(super) late: Matrix6<f64>,
    /// How much of the traces of the force's and of the moment's part of `white` is noise of forces at samples, which both intervals beside one feel.
    pub(super) sampled: [f64; 2],
}

impl WrenchNoise {
    /// Share of the noise that is felt before the sample as well as after it, of forces or of moments, whichever have less; all where there is none.
    pub(super) fn sampled_share(&self) -> f64 {
        let share = |(sampled, all): (f64, f64)| if all > 0.0 { sampled / all } else { 1.0 };
        self.sampled.into_iter().zip(traces(&self.white)).map(share).fold(1.0, f64::min)
    }

    /// With moments about `p` in place of the origin.
    pub(super) fn about(&self, p: DVec3) -> Self {
        let late = if self.late == Matrix6::zeros() { self.late } else { about(&self.late, p) };
        Self { white: about(&self.white, p), late, ..*self }
    }
}

/// A covariance of a force and its moment about the origin, with the moment about `p`.
pub(super) fn about(of: &Matrix6<f64>, p: DVec3) -> Matrix6<f64> {
    let block = |i: usize, j: usize| DMat3::from(of.fixed_view::<3, 3>(i, j).into_owned());
    let (force, mixed, moment) = (block(0, 0), block(3, 0), block(3, 3));
    let across = cross_matrix(p);
    // The moment loses p x f; the transpose of a cross product's matrix is the negative one.
    let with_force = mixed - across * force;
    let moment = moment - across * mixed.transpose() + with_force * across;
    let mut all = *of;
    all.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::from(with_force));
    all.fixed_view_mut::<3, 3>(0, 3).copy_from(&Matrix3::from(with_force.transpose()));
    all.fixed_view_mut::<3, 3>(3, 3).copy_from(&Matrix3::from(moment));
    all
}

impl Add for WrenchNoise {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            white: self.white + other.white,
            late: self.late + other.late,
            sampled: std::array::from_fn(|i| self.sampled[i] + other.sampled[i]),
        }
    }
}

impl AddAssign for WrenchNoise {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Sums of the variances of the three axes of the force and of those of the moment.
pub(super) fn traces(covariance: &Matrix6<f64>) -> [f64; 2] {
    [0, 3].map(|i| covariance.fixed_view::<3, 3>(i, i).trace())
}

/// Sum of the variances of the three axes of the force.
pub(super) fn force_trace(covariance: &Matrix6<f64>) -> f64 {
    traces(covariance)[0]
}
