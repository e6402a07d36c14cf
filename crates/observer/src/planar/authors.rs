//! The paper's own state space: radius functions, angular velocity, sensor values and palm angles.

use super::error::PlanarEstimateError;
use contact_kinematics::planar::{PairContact, PalmPair, PalmPairState};
use glam::DVec2;
use nalgebra::SVector;
use object_dynamics::planar::PlanarMass;

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

/// What all fields need at one state.
struct Terms {
    pair: PalmPair,
    d: [f64; 2],
    z: [f64; 2],
    s: [f64; 2],
    p_rates: [f64; 2],
    r_rates: [f64; 2],
    r: [f64; 2],
}

impl AuthorsFields {
    /// Drift `f`, which includes gravity.
    ///
    /// # Errors
    /// [`PlanarEstimateError::Singular`] names the divisor that is zero, [`PlanarEstimateError::Palms`] a closed wedge.
    pub fn drift(&self, q: &AuthorsState) -> Result<AuthorsState, PlanarEstimateError> {
        let Terms { pair, z, p_rates, r_rates, r, .. } = self.terms(q)?;
        let [w1, w2] = self.palm_rates;
        let [u1, u2] = pair.along();
        // Second derivatives of r_i without contact forces.
        let free1 = -self.gravity * u1.x - 2.0 * w1 * p_rates[0] + w1 * w1 * r[0];
        let free2 = self.gravity * u2.x + 2.0 * w2 * p_rates[1] + w2 * w2 * r[1];
        Ok(AuthorsState::from([
            r_rates[0],
            r_rates[1],
            0.0,
            p_rates[0] - free1 / z[0],
            p_rates[1] + free2 / z[1],
            w1,
            w2 - w1,
        ]))
    }

    /// Input fields `g_1`, `g_2`.
    ///
    /// # Errors
    /// As [`Self::drift`].
    pub fn inputs(&self, q: &AuthorsState) -> Result<[AuthorsState; 2], PlanarEstimateError> {
        let Terms { pair, d, z, s, .. } = self.terms(q)?;
        let (mass, inertia) = (self.mass.mass(), self.mass.inertia());
        let c = pair.cos();
        let (b1, b2) = (-d[0] / (inertia * s[0]), d[1] / (inertia * s[1]));
        let mut g1 = AuthorsState::zeros();
        g1[2] = b1;
        g1[3] = -(1.0 / (mass * s[0]) - d[0] * b1) / z[0];
        g1[4] = (-c / (mass * s[0]) - d[1] * b1) / z[1];
        let mut g2 = AuthorsState::zeros();
        g2[2] = b2;
        g2[3] = -(c / (mass * s[1]) - d[0] * b2) / z[0];
        g2[4] = (-1.0 / (mass * s[1]) - d[1] * b2) / z[1];
        Ok([g1, g2])
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

    fn terms(&self, q: &AuthorsState) -> Result<Terms, PlanarEstimateError> {
        let pair = pair(q)?;
        let (r, s) = ([q[0], q[1]], [q[3], q[4]]);
        for (what, value) in [("s1", s[0]), ("s2", s[1])] {
            if value == 0.0 || !value.is_finite() {
                return Err(PlanarEstimateError::Singular { what, value });
            }
        }
        let z = relative_rates(q[2], self.palm_rates)?;
        let (sin, c) = (pair.sin(), pair.cos());
        let p = [(r[0] * c + r[1]) / sin, (r[0] + r[1] * c) / sin];
        let d = [p[0] - s[0], s[1] - p[1]];
        let r_rates = [d[0] * z[0], d[1] * z[1]];
        let opening = self.palm_rates[1] - self.palm_rates[0];
        let p_rates = [
            (r_rates[0] * c + r_rates[1] - opening * p[1]) / sin,
            (r_rates[0] + r_rates[1] * c - opening * p[0]) / sin,
        ];
        Ok(Terms { pair, d, z, s, p_rates, r_rates, r })
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
