//! Both contacts of an object in the wedge: positions and velocities.

use super::palms::{PalmPair, PalmPairState};
use super::radius::{RadiusFunction, RadiusJet};
use glam::DVec2;

/// The object in contact with both palms, at one orientation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairContact {
    /// Radius functions at the contacts.
    pub jets: [RadiusJet; 2],
    /// Centre of mass in the world, m.
    pub p_WCm: DVec2,
    /// Distances of the contacts from the hinge along the palms (the sensor values `s1`, `s2`), m.
    pub s: [f64; 2],
}

/// Velocities of an object that keeps both contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairVelocity {
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec2,
    /// Rates of the sensor values, m/s.
    pub s_rates: [f64; 2],
    /// Speeds `v_i = rho_i z_i` of the contact points on the object, along `t_i`, m/s.
    pub contact_speeds: [f64; 2],
    /// `z_i = omega0 - W_i`: rotation of the object against palm `i`, rad/s.
    pub relative_rates: [f64; 2],
}

impl PairContact {
    /// Contacts of `shape` at orientation `phi0` (rad) between the palms.
    ///
    /// Both palms pass through the hinge, hence `n_i . cm = r_i`, `cm = (r_1 u_2 + r_2 u_1) / sin phi2`, and
    /// `s_1 = u_1 . cm - d_1`, `s_2 = u_2 . cm + d_2`.
    #[must_use]
    pub fn new(shape: &impl RadiusFunction, palms: &PalmPair, phi0: f64) -> Self {
        let jets = palms.contact_directions(phi0).map(|theta| shape.jet(theta));
        let p_WCm = palms.from_normal_parts(jets[0].r, jets[1].r);
        let [u1, u2] = palms.along();
        Self { jets, p_WCm, s: [u1.dot(p_WCm) - jets[0].d, u2.dot(p_WCm) + jets[1].d] }
    }

    /// Velocities at the angular velocity `omega0` (rad/s) of the object.
    ///
    /// `n_1 . v = d_1 omega0 + s_1 W_1`, `n_2 . v = d_2 omega0 - s_2 W_2`; the contact points move on the object at
    /// `v_i = rho_i z_i` and `s_1' = p_1' - v_1 + r_1 z_1`, `s_2' = p_2' + v_2 - r_2 z_2`, with `p_i = u_i . cm` so that
    /// `p_i' = u_i . v + W_i (u_i rotated by a quarter) . cm`.
    #[must_use]
    pub fn velocity(&self, palms: &PalmPairState, omega0: f64) -> PairVelocity {
        let [j1, j2] = self.jets;
        let [w1, w2] = palms.motion.rates;
        let v = palms.pair.from_normal_parts(j1.d * omega0 + self.s[0] * w1, j2.d * omega0 - self.s[1] * w2);
        let [u1, u2] = palms.pair.along();
        let relative_rates = [omega0 - w1, omega0 - w2];
        let [z1, z2] = relative_rates;
        let contact_speeds = [j1.rho * z1, j2.rho * z2];
        let s_rates = [
            u1.dot(v) + w1 * j1.r - contact_speeds[0] + j1.r * z1,
            u2.dot(v) - w2 * j2.r + contact_speeds[1] - j2.r * z2,
        ];
        PairVelocity { v_WCm: v, s_rates, contact_speeds, relative_rates }
    }
}
