//! Two palms hinged at the origin.

use super::error::PalmPairError;
use glam::DVec2;

/// Two palms hinged at the origin: palm 1 at `P1` against world X, palm 2 at `P2 = P1 + phi2`, `0 < phi2 < pi`.
///
/// Sines and cosines are kept, so that everything after construction is algebra without a chart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmPair {
    angles: [f64; 2],
    along: [DVec2; 2],
    sin: f64,
    cos: f64,
}

/// Absolute palm rates `W1 = P1'`, `W2 = P2'` in rad/s. The paper's relative rate of palm 2 is `W2 - W1`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PairRates {
    /// Absolute angular velocities in rad/s.
    pub rates: [f64; 2],
    /// Absolute angular accelerations in rad/s^2.
    pub accelerations: [f64; 2],
}

/// Where the palms are and how they move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmPairState {
    /// Angles.
    pub pair: PalmPair,
    /// Rates and accelerations.
    pub motion: PairRates,
}

impl PalmPair {
    /// From the angle `phi1` of palm 1 against world X and `phi2` of palm 2 against palm 1, rad.
    ///
    /// # Errors
    /// [`PalmPairError::Wedge`] unless `0 < phi2 < pi`; [`PalmPairError::NotFinite`].
    pub fn new(phi1: f64, phi2: f64) -> Result<Self, PalmPairError> {
        for (what, value) in [("phi1", phi1), ("phi2", phi2)] {
            if !value.is_finite() {
                return Err(PalmPairError::NotFinite { what, value });
            }
        }
        // The sine is the divisor of every solve with the two normals: pi itself has sin 1.2e-16 and is refused.
        if !(phi2 > 0.0 && phi2 < std::f64::consts::PI) {
            return Err(PalmPairError::Wedge { phi2 });
        }
        let angles = [phi1, phi1 + phi2];
        let (sin, cos) = phi2.sin_cos();
        Ok(Self { angles, along: angles.map(DVec2::from_angle), sin, cos })
    }

    /// From the absolute angles `P1`, `P2`, rad.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_absolute(p1: f64, p2: f64) -> Result<Self, PalmPairError> {
        Self::new(p1, p2 - p1)
    }

    /// Absolute angles `P1`, `P2` in rad.
    #[must_use]
    pub fn angles(&self) -> [f64; 2] {
        self.angles
    }

    /// Angle between the palms, rad, in `(0, pi)`.
    #[must_use]
    pub fn wedge(&self) -> f64 {
        self.angles[1] - self.angles[0]
    }

    /// `sin phi2`, the divisor of every solve with both normals; at least 1e-16 by construction.
    #[must_use]
    pub fn sin(&self) -> f64 {
        self.sin
    }

    /// `cos phi2`.
    #[must_use]
    pub fn cos(&self) -> f64 {
        self.cos
    }

    /// Unit vectors `u_i` along the palms, away from the hinge, world.
    #[must_use]
    pub fn along(&self) -> [DVec2; 2] {
        self.along
    }

    /// Unit normals `n_1 = (-sin P1, cos P1)`, `n_2 = (sin P2, -cos P2)`, towards the object, world.
    #[must_use]
    pub fn normals(&self) -> [DVec2; 2] {
        [self.along[0].perp(), -self.along[1].perp()]
    }

    /// The vector with `n_1 . x = a` and `n_2 . x = b`: `x = (a u_2 + b u_1) / sin phi2`.
    #[must_use]
    pub fn from_normal_parts(&self, a: f64, b: f64) -> DVec2 {
        (self.along[1] * a + self.along[0] * b) / self.sin
    }

    /// Directions `theta_i` of the outward normals at the contacts in body axes: `P1 - phi0 - pi/2`, `P2 - phi0 + pi/2`.
    #[must_use]
    pub fn contact_directions(&self, phi0: f64) -> [f64; 2] {
        let quarter = std::f64::consts::FRAC_PI_2;
        [self.angles[0] - phi0 - quarter, self.angles[1] - phi0 + quarter]
    }
}

impl PalmPairState {
    /// Palms at rest.
    #[must_use]
    pub fn at_rest(pair: PalmPair) -> Self {
        Self { pair, motion: PairRates::default() }
    }
}
