//! What a fit leaves of its contacts in sum, in the plane and in space.

use super::NoiseLevel;

/// Residuals below this share of the size are rounding, of the numbers given or of the iteration: the fit is exact.
const EXACT: f64 = 1e-9;

/// Sums over the contacts of a fit.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Misfit {
    /// Of squared residuals in units of the noise.
    pub(crate) chi_squared: f64,
    /// Of equations.
    pub(crate) equations: usize,
    /// Parameters of the family, ...
    pub(crate) parameters: usize,
    /// ... and constraints on them that hold the shape.
    pub(crate) held: usize,
    /// Of squares of the whitening's entries, in 1 / m^2.
    pub(crate) weight: f64,
    /// Of the logarithms of the determinants of the residuals' covariances.
    pub(crate) log_determinants: f64,
    /// Root mean square of the residuals, in m per axis.
    pub(crate) residual: f64,
    /// Size of the data in m.
    pub(crate) size: f64,
}

impl Misfit {
    /// Equations minus parameters that no constraint holds.
    pub(crate) fn degrees_of_freedom(&self) -> usize {
        (self.equations + self.held).saturating_sub(self.parameters)
    }

    /// Whether the residuals are rounding.
    pub(crate) fn is_exact(&self) -> bool {
        self.residual <= EXACT * self.size
    }

    /// The sum of squares of residuals that are rounding.
    pub(crate) fn rounding(&self) -> f64 {
        self.weight * (EXACT * self.size).powi(2)
    }

    /// What stated standard deviations are to be multiplied by, where noise is independent.
    pub(crate) fn noise_factor(&self, level: NoiseLevel) -> f64 {
        match level {
            NoiseLevel::Stated => 1.0,
            NoiseLevel::Estimated => (self.chi_squared / self.degrees_of_freedom().max(1) as f64).sqrt(),
        }
    }

    /// Schwarz's information criterion: see [`crate::fit::ShapeFit::choose`].
    pub(crate) fn criterion(&self, level: NoiseLevel) -> f64 {
        let equations = self.equations as f64;
        let misfit = match level {
            NoiseLevel::Stated => self.chi_squared,
            // The factor of the noise is fitted as well, which profiles the likelihood. Exact data would make it zero.
            NoiseLevel::Estimated => equations * (self.chi_squared.max(self.rounding()) / equations).ln(),
        };
        misfit + self.log_determinants + self.parameters as f64 * equations.ln()
    }
}
