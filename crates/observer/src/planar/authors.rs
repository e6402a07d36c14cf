//! The paper's own state space: radius functions, angular velocity, sensor values and palm angles.

use super::error::PlanarEstimateError;
use contact_kinematics::planar::{PairContact, PalmPair, PalmPairState};
use glam::DVec2;
use nalgebra::SVector;
use object_dynamics::planar::PlanarMass;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The paper's state `q = (r_1, r_2, omega0, s_1, s_2, phi_1, phi_2)`, section 3.
pub type AuthorsState = SVector<f64, 7>;

/// `q' = f(q) + tau_1 g_1(q) + tau_2 g_2(q)`, equation (1), for palms that turn at constant rates.
///
/// The paper names the fields and leaves them to a report; they are written out here. Torques enter as measurements of
/// the contact forces, `f_1 = tau_1 / s_1`, `f_2 = -tau_2 / s_2` (both counter-clockwise), so `f` has no part in `omega0'`.
/// Singular where a contact stands still on the object (`z_i = 0`) or reaches the hinge; the regular coordinates of
/// [`estimate_plane`](super::estimate_plane) are not. The flow under given torques is exponentially unstable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AuthorsFields {
    /// Mass and moment of inertia.
    pub mass: PlanarMass,
    /// Gravity in m/s^2.
    pub gravity: f64,
    /// Absolute palm rates `W_1`, `W_2`, rad/s.
    pub palm_rates: [f64; 2],
}

/// What the fields are computed in: numbers, and numbers with derivatives.
pub(super) trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    fn constant(value: f64) -> Self;
    fn sin_cos(self) -> (Self, Self);
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        Self::sin_cos(self)
    }
}

impl AuthorsFields {
    /// Drift `f`, which includes gravity.
    ///
    /// # Errors
    /// [`PlanarEstimateError::Singular`] names the divisor that is zero, [`PlanarEstimateError::Palms`] a closed wedge.
    pub fn drift(&self, q: &AuthorsState) -> Result<AuthorsState, PlanarEstimateError> {
        self.check(q)?;
        let [drift, ..] = self.at(&(*q).into());
        Ok(drift.into())
    }

    /// Input fields `g_1`, `g_2`.
    ///
    /// # Errors
    /// As [`Self::drift`].
    pub fn inputs(&self, q: &AuthorsState) -> Result<[AuthorsState; 2], PlanarEstimateError> {
        self.check(q)?;
        let [_, first, second] = self.at(&(*q).into());
        Ok([first.into(), second.into()])
    }

    /// `f`, `g_1` and `g_2` at a state that is not singular.
    pub(super) fn at<S: Scalar>(&self, q: &[S; 7]) -> [[S; 7]; 3] {
        let [r1, r2, omega0, s1, s2, phi1, phi2] = *q;
        let c = S::constant;
        let [w1, w2] = self.palm_rates.map(c);
        let (z1, z2) = (omega0 - w1, omega0 - w2);
        let ((sin, cos), (cos1, cos2)) = (phi2.sin_cos(), (phi1.sin_cos().1, (phi1 + phi2).sin_cos().1));
        let (p1, p2) = ((r1 * cos + r2) / sin, (r1 + r2 * cos) / sin);
        let (d1, d2) = (p1 - s1, s2 - p2);
        let (r1_rate, r2_rate, opening) = (d1 * z1, d2 * z2, w2 - w1);
        let p1_rate = (r1_rate * cos + r2_rate - opening * p2) / sin;
        let p2_rate = (r1_rate + r2_rate * cos - opening * p1) / sin;
        // Second derivatives of r_i without contact forces.
        let (gravity, two) = (c(self.gravity), c(2.0));
        let free1 = -gravity * cos1 - two * w1 * p1_rate + w1 * w1 * r1;
        let free2 = gravity * cos2 + two * w2 * p2_rate + w2 * w2 * r2;
        let (mass, inertia) = (c(self.mass.mass()), c(self.mass.inertia()));
        let (b1, b2) = (-d1 / (inertia * s1), d2 / (inertia * s2));
        let (a1, a2, none) = (c(1.0) / (mass * s1), c(1.0) / (mass * s2), c(0.0));
        [
            [r1_rate, r2_rate, none, p1_rate - free1 / z1, p2_rate + free2 / z2, w1, opening],
            [none, none, b1, -(a1 - d1 * b1) / z1, (-(cos * a1) - d2 * b1) / z2, none, none],
            [none, none, b2, -(cos * a2 - d1 * b2) / z1, (-a2 - d2 * b2) / z2, none, none],
        ]
    }

    /// `q'` under motor torques (N m, counter-clockwise, of palms without inertia).
    ///
    /// # Errors
    /// As [`Self::drift`].
    pub fn rate(&self, q: &AuthorsState, torques: [f64; 2]) -> Result<AuthorsState, PlanarEstimateError> {
        let [g1, g2] = self.inputs(q)?;
        Ok(self.drift(q)? + g1 * torques[0] + g2 * torques[1])
    }

    /// Output function: the sensor readings `y = (s_1, s_2, phi_1, phi_2)`, equation (2).
    #[must_use]
    pub fn output(q: &AuthorsState) -> SVector<f64, 4> {
        SVector::<f64, 4>::new(q[3], q[4], q[5], q[6])
    }

    /// The state of a known contact.
    #[must_use]
    pub fn state_of(contact: &PairContact, palms: &PalmPair, omega0: f64) -> AuthorsState {
        let [p1, p2] = palms.angles();
        let [j1, j2] = contact.jets;
        AuthorsState::from([j1.r, j2.r, omega0, contact.s[0], contact.s[1], p1, p2 - p1])
    }

    /// To the regular coordinates `(cm, v, omega0)`.
    ///
    /// # Errors
    /// [`PlanarEstimateError::Palms`] for a closed wedge; this direction has no other singularity.
    pub fn to_motion(&self, q: &AuthorsState) -> Result<SVector<f64, 5>, PlanarEstimateError> {
        let pair = pair(q)?;
        let cm = pair.from_normal_parts(q[0], q[1]);
        let [u1, u2] = pair.along();
        let (d1, d2) = (u1.dot(cm) - q[3], q[4] - u2.dot(cm));
        let v = pair
            .from_normal_parts(d1 * q[2] + q[3] * self.palm_rates[0], d2 * q[2] - q[4] * self.palm_rates[1]);
        Ok(SVector::<f64, 5>::new(cm.x, cm.y, v.x, v.y, q[2]))
    }

    /// From the regular coordinates `(cm, v, omega0)` between given palms.
    ///
    /// # Errors
    /// [`PlanarEstimateError::Singular`] where a contact stands still on the object.
    pub fn from_motion(
        &self,
        x: &SVector<f64, 5>,
        palms: &PalmPairState,
    ) -> Result<AuthorsState, PlanarEstimateError> {
        let (cm, v) = (DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3]));
        let ([u1, u2], [n1, n2]) = (palms.pair.along(), palms.pair.normals());
        let [z1, z2] = relative_rates(x[4], self.palm_rates)?;
        let [w1, w2] = self.palm_rates;
        let (p1, p2) = (u1.dot(cm), u2.dot(cm));
        let (d1, d2) = ((n1.dot(v) - w1 * p1) / z1, (n2.dot(v) + w2 * p2) / z2);
        let [a1, a2] = palms.pair.angles();
        Ok(AuthorsState::from([n1.dot(cm), n2.dot(cm), x[4], p1 - d1, p2 + d2, a1, a2 - a1]))
    }

    /// Names what the fields would divide by zero.
    fn check(&self, q: &AuthorsState) -> Result<(), PlanarEstimateError> {
        pair(q)?;
        for (what, value) in [("s1", q[3]), ("s2", q[4])] {
            if value == 0.0 || !value.is_finite() {
                return Err(PlanarEstimateError::Singular { what, value });
            }
        }
        relative_rates(q[2], self.palm_rates).map(|_| ())
    }
}

fn pair(q: &AuthorsState) -> Result<PalmPair, PlanarEstimateError> {
    PalmPair::new(q[5], q[6]).map_err(|source| PlanarEstimateError::Palms { t: f64::NAN, source })
}

fn relative_rates(omega0: f64, palm_rates: [f64; 2]) -> Result<[f64; 2], PlanarEstimateError> {
    let z = palm_rates.map(|w| omega0 - w);
    for (what, value) in [("z1 = omega0 - W1", z[0]), ("z2 = omega0 - W2", z[1])] {
        if value == 0.0 || !value.is_finite() {
            return Err(PlanarEstimateError::Singular { what, value });
        }
    }
    Ok(z)
}
