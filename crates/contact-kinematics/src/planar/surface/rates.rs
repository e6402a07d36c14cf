use super::{ContactError, SurfaceContact, SurfaceState};
use glam::DVec2;

/// Largest condition `1 / |1 + H S|` (radius of the body times curvature of the palm) with which the contact's path over
/// the palm is told: it loses `log10(condition)` digits.
const LARGEST_CONDITION: f64 = 1e10;

/// How a contact moves, at one velocity of body and palm. World axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceRates {
    /// Velocity of the body's material at the contact against the palm's, m/s. Without gap rate: the slip.
    pub slip: DVec2,
    /// Rate of the gap, m/s: `n . slip`.
    pub gap_rate: f64,
    /// Velocity of the palm's material at the contact, m/s.
    pub surface_velocity: DVec2,
    /// Velocity of the contact point, m/s.
    pub p_dot_WC: DVec2,
    /// Rate of the palm's normal at the contact, 1/s.
    pub n_dot: DVec2,
    /// Rate of [`Self::slip`] at `a = alpha = 0`, m/s^2: `slip' = a + alpha x b + slip_bias`.
    pub slip_bias: DVec2,
    /// Second rate of the gap at `a = alpha = 0`, m/s^2: `gap'' = n . (a + alpha x b) + gap_bias`.
    pub gap_bias: f64,
}

impl SurfaceContact {
    /// Velocity of the body's material at the contact against the palm's, m/s. Its part along `n` is the gap's rate.
    #[must_use]
    pub fn slip(&self, palm: &SurfaceState, v_WCm: DVec2, omega0: f64) -> DVec2 {
        v_WCm + omega0 * self.b_W.perp() - palm.material_velocity(self.p_WC)
    }

    /// Rates at the body's velocity (centre of mass, m/s) and angular velocity (rad/s), and the palm's.
    ///
    /// With `y` the velocity of the contact over the palm along `t`: `(1 + rho k) y = t . slip - rho (omega0 - W)`, `k` the
    /// palm's curvature.
    ///
    /// # Errors
    /// [`ContactError::Matching`] where the curvatures match.
    pub fn rates(
        &self,
        palm: &SurfaceState,
        v_WCm: DVec2,
        omega0: f64,
    ) -> Result<SurfaceRates, ContactError> {
        let surface_velocity = palm.material_velocity(self.p_WC);
        let slip = self.slip(palm, v_WCm, omega0);
        let gap_rate = self.n.dot(slip);
        let stiffness = 1.0 + self.jet.rho * self.palm_curvature;
        let condition = 1.0 / stiffness.abs();
        if condition.is_nan() || condition > LARGEST_CONDITION {
            return Err(ContactError::Matching { condition, limit: LARGEST_CONDITION });
        }
        let over_palm = (self.t.dot(slip) - self.jet.rho * (omega0 - palm.w_WP)) / stiffness;
        let p_dot_WC = surface_velocity + over_palm * self.t + gap_rate * self.n;
        let n_dot = (self.palm_curvature * over_palm - palm.w_WP) * self.t;
        let slip_bias = omega0 * (p_dot_WC - v_WCm).perp() - palm.material_velocity_rate(self.p_WC, p_dot_WC);
        let gap_bias = n_dot.dot(slip) + self.n.dot(slip_bias);
        Ok(SurfaceRates { slip, gap_rate, surface_velocity, p_dot_WC, n_dot, slip_bias, gap_bias })
    }
}
