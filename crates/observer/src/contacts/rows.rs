//! Contact conditions of one sample, with what noise of the contact does to them.

use super::body::INERTIA;
use super::equations::Row;
use super::noise::ContactNoiseLevel;
use super::record::Contact;
use super::state::{Motion, Turn};
use crate::rigid::cross_matrix;
use glam::{DMat3, DVec2, DVec3};
use nalgebra::{Matrix3, SVector, Vector3};
use object_dynamics::ContactMode;

/// Conditions of one contact: its normal one where it slides, with that across its friction if it is used, all three where it
/// sticks.
pub(super) struct Rows {
    /// Axes of the conditions, at the adjusted contact.
    pub(super) axes: [DVec3; 3],
    pub(super) count: usize,
    /// Values of the conditions, m/s; zero for those that do not count.
    pub(super) residual: Vector3<f64>,
    /// From the centre of mass to the adjusted contact.
    pub(super) arm: DVec3,
    /// Makes the values independent and of unit variance: lower, rows and columns that do not count are zero.
    whitening: Matrix3<f64>,
    /// From where the contact was read to where it is, for each deviation of each of the independent values, m.
    feet: [DVec3; 3],
}

/// Standard deviations that a contact is moved by at most.
const FARTHEST_FOOT: f64 = 5.0;
/// Angle between friction and slip that is looked over, rad, and the greatest deviation of friction's own angle.
const SLIP_ANGLE: f64 = 0.02;
const BLURRED: f64 = 0.3;

/// Direction across the friction of a contact that slides, and the standard deviation of its angle, rad; none where noise hides it.
fn across_friction(contact: &Contact) -> Option<(DVec3, f64)> {
    if contact.frictionless || contact.planar {
        return None;
    }
    let friction = contact.f.reject_from_normalized(contact.n);
    let angle = contact.f_deviation / friction.length();
    let seen = contact.mode == ContactMode::Slide && angle < BLURRED;
    seen.then(|| (contact.n.cross(friction).normalize_or_zero(), angle.hypot(SLIP_ANGLE)))
}

/// Inverse of the lower factor of the first `count` rows and columns of a covariance, zero elsewhere: it makes their values independent and
/// of unit variance. None where they have no inverse.
fn whitening(covariance: &Matrix3<f64>, count: usize) -> Option<Matrix3<f64>> {
    let (mut factor, mut inverse) = (Matrix3::zeros(), Matrix3::zeros());
    for i in 0..count {
        for k in 0..=i {
            let left: f64 = covariance[(i, k)] - (0..k).map(|m| factor[(i, m)] * factor[(k, m)]).sum::<f64>();
            factor[(i, k)] = if i == k { left.max(0.0).sqrt() } else { left / factor[(k, k)] };
        }
        let own = 1.0 / factor[(i, i)];
        for k in 0..i {
            inverse[(i, k)] = -own * (k..i).map(|m| factor[(i, m)] * inverse[(m, k)]).sum::<f64>();
        }
        inverse[(i, i)] = own;
        if !own.is_finite() {
            return None;
        }
    }
    Some(inverse)
}

impl Rows {
    /// None for a contact that is off.
    pub(super) fn new(
        contact: &Contact,
        motion: &Motion,
        turn: &Turn,
        noise: &ContactNoiseLevel,
        friction: bool,
    ) -> Option<Self> {
        let arm = contact.c - motion.p;
        let slip = motion.v + turn.w.cross(arm) - contact.u;
        let across = if friction { across_friction(contact) } else { None };
        let [t1, t2] = match across {
            Some((across, _)) => [across, contact.n.cross(across)],
            None => contact.tangents(),
        };
        let axes = [contact.n, t1, t2];
        let count = match contact.mode {
            ContactMode::Off => return None,
            ContactMode::Slide => 1 + usize::from(across.is_some()),
            ContactMode::Stick => 1 + contact.freedoms(),
        };
        let sticks = contact.mode == ContactMode::Stick;
        // What a shift of the contact along a tangent does to each condition.
        let turning = turn.w - contact.W;
        let mut covariance = Matrix3::identity() * contact.floor(noise.floor).powi(2);
        let deviation = noise.contact / contact.samples.sqrt();
        let mut shifts = [Vector3::zeros(); 2];
        // In the plane none is across it: a motion that left it would make its conditions worth less.
        for (tangent, stored) in [t1, t2].into_iter().zip(&mut shifts).take(contact.freedoms()) {
            let shift = turning.cross(tangent);
            let bend = if sticks { 0.0 } else { slip.dot(contact.shape * tangent) };
            let column = Vector3::new(shift.dot(axes[0]) + bend, shift.dot(t1), shift.dot(t2)) * deviation;
            covariance.ger(1.0, &column, &column, 1.0);
            *stored = column;
        }
        if let Some((_, angle)) = across {
            covariance[(1, 1)] += (angle * slip.dot(t2)).powi(2);
        }
        let whitening = whitening(&covariance, count)?;
        let residual = Vector3::from_fn(|i, _| if i < count { axes[i].dot(slip) } else { 0.0 });
        let [by1, by2] = shifts.map(|column| whitening * column * -deviation);
        let values = whitening * residual;
        let farthest = FARTHEST_FOOT * deviation;
        let length = DVec2::new(by1.dot(&values), by2.dot(&values)).length();
        let share = if length > farthest { farthest / length } else { 1.0 };
        let feet = std::array::from_fn(|i| (by1[i] * t1 + by2[i] * t2) * share);
        let foot = (0..3).map(|i| feet[i] * values[i]).sum::<DVec3>();
        let mut rows = Self { axes, count, residual, arm: arm + foot, whitening, feet };
        if !sticks {
            rows.axes[0] += contact.shape * foot;
        }
        Some(rows)
    }

    /// Inverse covariance of the values, zero for those that do not count.
    pub(super) fn information(&self) -> Matrix3<f64> {
        self.whitening.tr_mul(&self.whitening)
    }

    /// Logarithm of the determinant of the information of the values that count, these in units of `speed`.
    pub(super) fn log_information(&self, speed: f64) -> f64 {
        (0..self.count).map(|i| 2.0 * (self.whitening[(i, i)] * speed).ln()).sum()
    }

    /// Residuals in their deviations, independent; zero for those that do not count.
    pub(super) fn values(&self) -> Vector3<f64> {
        self.whitening * self.residual
    }

    /// Squared residuals in their deviations.
    pub(super) fn cost(&self) -> f64 {
        self.values().norm_squared()
    }

    /// Of each value that is independent: from where the contact was read to where it is, by a deviation of it, and the value.
    pub(super) fn feet(&self) -> impl Iterator<Item = (DVec3, f64)> {
        let values = self.values();
        (0..self.count).map(move |i| (self.feet[i], values[i]))
    }

    /// What noise of the lever that is left once the contact is adjusted adds to the information on the angular velocity;
    /// `deviation` is that of a contact at a sample, m.
    pub(super) fn of_levers(&self, contact: &Contact, deviation: f64) -> Matrix3<f64> {
        let square = |of: DVec3| Matrix3::from(DMat3::from_cols(of * of.x, of * of.y, of * of.z));
        let read = deviation * deviation / contact.samples;
        let along = self.axes[1..].iter().take(contact.freedoms()).map(|axis| square(*axis) * read);
        let told = self.feet.iter().take(self.count).map(|foot| square(*foot));
        let left = along.sum::<Matrix3<f64>>() - told.sum::<Matrix3<f64>>();
        let one = |i: usize| {
            let axis = (0..=i).map(|k| self.axes[k] * self.whitening[(i, k)]).sum();
            let across = Matrix3::from(cross_matrix(axis));
            across * left * across.transpose()
        };
        (0..self.count).map(one).sum()
    }

    /// The conditions, linearised at a motion; `changes` of the angular velocity are those by the constants of the inertia.
    pub(super) fn linear<const P: usize>(
        &self,
        motion: &Motion,
        turn: &Turn,
        changes: &[DVec3; INERTIA],
    ) -> impl ExactSizeIterator<Item = Row<P>> {
        (0..self.count).map(|i| self.along(self.axes[i], self.residual[i], motion, turn, changes))
    }

    /// The same in their deviations, and independent.
    pub(super) fn whitened<const P: usize>(
        &self,
        motion: &Motion,
        turn: &Turn,
        changes: &[DVec3; INERTIA],
    ) -> impl Iterator<Item = Row<P>> {
        (0..self.count).map(|i| {
            let weights = self.whitening.row(i);
            let axis = (0..=i).map(|k| self.axes[k] * weights[k]).sum();
            self.along(axis, weights.transpose().dot(&self.residual), motion, turn, changes)
        })
    }

    /// A condition on the velocity along an axis, or along several with weights.
    fn along<const P: usize>(
        &self,
        e: DVec3,
        value: f64,
        motion: &Motion,
        turn: &Turn,
        changes: &[DVec3; INERTIA],
    ) -> Row<P> {
        let b = self.arm.cross(e);
        let by_L = turn.K * b;
        let by_motion = [-e.cross(turn.w), e, by_L, turn.w.cross(b) + by_L.cross(motion.L)];
        // Constants: logarithm of the mass, of which a condition knows nothing, those of the inertia.
        let by_body = SVector::from_fn(|j, _| if j > 0 { by_L.dot(changes[j - 1]) } else { 0.0 });
        Row { by_motion, by_body, value }
    }
}
