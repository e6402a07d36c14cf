//! Ellipse with its centre anywhere against the centre of mass.

use super::circle::{check_length, check_point};
use super::error::ShapeError;
use super::radius::{RadiusBounds, RadiusFunction, RadiusJet, point_jet};
use glam::DVec2;

/// An ellipse with semi-axes along the body axes whose centre lies at `centre` from the centre of mass:
/// `r = sqrt(a^2 cos^2 + b^2 sin^2) + centre . n`, `rho = a^2 b^2 / (a^2 cos^2 + b^2 sin^2)^(3/2)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    a: f64,
    b: f64,
    centre: DVec2,
}

impl Ellipse {
    /// From the semi-axes along body x and y, and the centre (m, body axes from the centre of mass).
    ///
    /// # Errors
    /// [`ShapeError::Length`] or [`ShapeError::NotFinite`].
    pub fn new(a: f64, b: f64, centre: DVec2) -> Result<Self, ShapeError> {
        check_length("semi-axis a", a)?;
        check_length("semi-axis b", b)?;
        check_point("centre coordinate", centre)?;
        Ok(Self { a, b, centre })
    }
}

impl RadiusFunction for Ellipse {
    fn jet(&self, theta: f64) -> RadiusJet {
        let (sin, cos) = theta.sin_cos();
        let (a, b) = (self.a, self.b);
        // Positive because the semi-axes are and sin, cos do not vanish together.
        let r = (a * cos).hypot(b * sin);
        let own = RadiusJet { r, d: (a - b) * (a + b) * sin * cos / r, rho: (a * b / r).powi(2) / r };
        own + point_jet(self.centre, theta)
    }

    fn radius_bounds(&self) -> RadiusBounds {
        let (small, large) = (self.a.min(self.b), self.a.max(self.b));
        RadiusBounds { min: small * small / large, max: large * large / small }
    }
}
