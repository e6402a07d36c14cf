use super::{ContactError, SurfaceContact, SurfaceState};
use glam::{DMat2, DVec2, DVec3};

/// Largest condition of `1 + H S` (radii of the body times shape of the palm) with which a contact's path over the palm is
/// told: it loses `log10(condition)` digits.
const LARGEST_CONDITION: f64 = 1e10;

/// How a contact moves, at one velocity of body and palm. World axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceRates {
    /// Velocity of the body's material at the contact against the palm's, m/s. Without gap rate: the slip.
    pub slip: DVec3,
    /// Rate of the gap, m/s: `n . slip`.
    pub gap_rate: f64,
    /// Velocity of the palm's material at the contact, m/s.
    pub surface_velocity: DVec3,
    /// Velocity of the contact point, m/s.
    pub p_dot_WC: DVec3,
    /// Rate of the palm's normal at the contact, 1/s.
    pub n_dot: DVec3,
    /// Rate of [`Self::slip`] at `a = alpha = 0`, m/s^2: `slip' = a + alpha x b + slip_bias`.
    pub slip_bias: DVec3,
    /// Second rate of the gap at `a = alpha = 0`, m/s^2: `gap'' = n . (a + alpha x b) + gap_bias`.
    pub gap_bias: f64,
}

impl SurfaceContact {
    /// Rates at the body's velocity (centre of mass, m/s) and angular velocity (rad/s), world axes, and the palm's.
    ///
    /// With `y` the velocity of the contact over the palm: `(1 + H S) y = H ((w - W) x n) + slip` in the tangent plane.
    ///
    /// # Errors
    /// [`ContactError::Matching`] where the curvatures match.
    pub fn rates(
        &self,
        palm: &SurfaceState,
        v_WCm: DVec3,
        w_WO: DVec3,
    ) -> Result<SurfaceRates, ContactError> {
        let surface_velocity = palm.material_velocity(self.p_WC);
        let slip = v_WCm + w_WO.cross(self.b_W) - surface_velocity;
        let gap_rate = self.n.dot(slip);
        let turn = self.in_tangent((w_WO - palm.w_WP).cross(self.n));
        let right = self.body_radii * turn + self.in_tangent(slip);
        let over_palm = if self.palm_shape == DMat2::ZERO {
            right
        } else {
            inverse_of_one_plus(self.body_radii * self.palm_shape)? * right
        };
        let p_dot_WC = surface_velocity + self.along_tangent(over_palm) + gap_rate * self.n;
        let n_dot = palm.w_WP.cross(self.n) + self.along_tangent(self.palm_shape * over_palm);
        let slip_bias = w_WO.cross(p_dot_WC - v_WCm) - palm.material_velocity_rate(self.p_WC, p_dot_WC);
        Ok(SurfaceRates {
            slip,
            gap_rate,
            surface_velocity,
            p_dot_WC,
            n_dot,
            slip_bias,
            gap_bias: n_dot.dot(slip) + self.n.dot(slip_bias),
        })
    }

    /// Components of a vector along the tangent axes.
    #[must_use]
    pub fn in_tangent(&self, x: DVec3) -> DVec2 {
        DVec2::new(self.t[0].dot(x), self.t[1].dot(x))
    }

    /// The vector with the given components along the tangent axes.
    #[must_use]
    pub fn along_tangent(&self, x: DVec2) -> DVec3 {
        x.x * self.t[0] + x.y * self.t[1]
    }
}

/// `(1 + H S)^-1`, where it is worth something.
fn inverse_of_one_plus(product: DMat2) -> Result<DMat2, ContactError> {
    let norm = |m: DMat2| m.x_axis.length().hypot(m.y_axis.length());
    let inverse = (DMat2::IDENTITY + product).inverse();
    // By how much rounding of the two terms grows; both cancel where the curvatures match.
    let condition = (1.0 + norm(product)) * norm(inverse);
    if condition <= LARGEST_CONDITION {
        Ok(inverse)
    } else {
        Err(ContactError::Matching { condition, limit: LARGEST_CONDITION })
    }
}
