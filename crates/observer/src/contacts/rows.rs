//! Contact conditions of one sample, with what noise of the contact does to them.

use super::body::Body;
use super::noise::ContactNoiseLevel;
use super::record::Contact;
use super::state::{MOTION, Motion, Turn};
use glam::DVec3;
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
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
    /// Information of the conditions: inverse covariance, rows and columns that do not count are zero.
    pub(super) information: Matrix3<f64>,
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

/// The first `count` rows and columns, those of the identity elsewhere.
fn kept(matrix: &Matrix3<f64>, count: usize) -> Matrix3<f64> {
    Matrix3::from_fn(|i, j| match (i < count && j < count, i == j) {
        (true, _) => matrix[(i, j)],
        (false, same) => f64::from(same),
    })
}

/// Inverse of the first `count` rows and columns, zero elsewhere.
fn inverse(covariance: &Matrix3<f64>, count: usize) -> Option<Matrix3<f64>> {
    let mut inverse = kept(covariance, count).cholesky()?.inverse();
    for i in count..3 {
        inverse[(i, i)] = 0.0;
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
        let mut covariance = Matrix3::identity() * (noise.floor * noise.floor);
        let deviation = noise.contact / (contact.samples as f64).sqrt();
        let mut shifts = [Vector3::zeros(); 2];
        for (tangent, stored) in [t1, t2].into_iter().zip(&mut shifts) {
            let shift = turning.cross(tangent);
            let bend = if sticks { 0.0 } else { slip.dot(contact.shape * tangent) };
            let column = Vector3::new(shift.dot(axes[0]) + bend, shift.dot(t1), shift.dot(t2)) * deviation;
            covariance.ger(1.0, &column, &column, 1.0);
            *stored = column;
        }
        if let Some((_, angle)) = across {
            covariance[(1, 1)] += (angle * slip.dot(t2)).powi(2);
        }
        let information = inverse(&covariance, count)?;
        let residual = Vector3::from_fn(|i, _| if i < count { axes[i].dot(slip) } else { 0.0 });
        let mut rows = Self { axes, count, residual, arm, information };
        let pull = information * residual;
        let foot = shifts.map(|column| -(deviation * column.dot(&pull)));
        let farthest = FARTHEST_FOOT * deviation;
        let length = foot[0].hypot(foot[1]);
        let share = if length > farthest { farthest / length } else { 1.0 };
        let foot = (foot[0] * t1 + foot[1] * t2) * share;
        rows.arm += foot;
        if !sticks {
            rows.axes[0] += contact.shape * foot;
        }
        Some(rows)
    }

    /// Logarithm of the determinant of the information.
    pub(super) fn log_information(&self) -> f64 {
        kept(&self.information, self.count).determinant().ln()
    }

    /// Squared residuals in their deviations.
    pub(super) fn cost(&self) -> f64 {
        (self.information * self.residual).dot(&self.residual)
    }

    /// Derivatives by the motion at the sample.
    pub(super) fn by_motion(&self, motion: &Motion, turn: &Turn) -> SMatrix<f64, 3, MOTION> {
        let mut rows = SMatrix::<f64, 3, MOTION>::zeros();
        for (i, e) in self.axes.into_iter().enumerate().take(self.count) {
            let b = self.arm.cross(e);
            let by_L = turn.K * b;
            let by_turn = turn.w.cross(b) + by_L.cross(motion.L);
            let parts = [-e.cross(turn.w), e, by_L, by_turn];
            let row = SVector::<f64, MOTION>::from_fn(|j, _| parts[j / 3][j % 3]);
            rows.set_row(i, &row.transpose());
        }
        rows
    }

    /// Derivatives by the constants of the body at a given motion.
    pub(super) fn by_body<const P: usize>(&self, body: &Body, turn: &Turn) -> SMatrix<f64, 3, P> {
        let mut rows = SMatrix::<f64, 3, P>::zeros();
        if P > 0 {
            let changes = body.by_inertia(turn).map(|change| turn.K * change);
            for (i, e) in self.axes.into_iter().enumerate().take(self.count) {
                let b = self.arm.cross(e);
                for (j, change) in changes.iter().enumerate() {
                    rows[(i, j + 1)] = b.dot(*change);
                }
            }
        }
        rows
    }
}
