//! What a fit leaves of its contacts in sum, in the plane and in space.

use super::NoiseLevel;
use glam::DVec3;

/// Standard deviations of a correlation of independent residuals that are taken for chance.
const CHANCE: f64 = 2.0;
/// Correlation from which on noise is not to be told from a constant.
const MOST_ALIKE: f64 = 0.97;

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
    /// Correlation of the residuals of contacts that follow each other, beyond what chance makes of it.
    pub(crate) correlation: f64,
}

/// The correlation of residuals, in units of the noise, with the next ones, less what chance makes of it.
pub(crate) fn correlation(residuals: impl Iterator<Item = DVec3>, dimension: usize) -> f64 {
    let (mut products, mut squares, mut count) = (0.0, 0.0, 0.0);
    let mut before = DVec3::ZERO;
    for residual in residuals {
        products += before.dot(residual);
        squares += residual.length_squared();
        count += dimension as f64;
        before = residual;
    }
    if squares > 0.0 { (products / squares - CHANCE / f64::sqrt(count)).clamp(0.0, MOST_ALIKE) } else { 0.0 }
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

    /// What stated standard deviations are to be multiplied by.
    pub(crate) fn noise_factor(&self, level: NoiseLevel) -> f64 {
        match level {
            NoiseLevel::Stated => 1.0,
            NoiseLevel::Estimated => (self.chi_squared / self.degrees_of_freedom().max(1) as f64).sqrt(),
        }
    }

    /// What standard deviations are to be multiplied by: of residuals that are alike fewer count as independent (those of a first-order autoregressive
    /// process).
    pub(crate) fn widening(&self, level: NoiseLevel) -> f64 {
        let alike = if self.is_exact() { 0.0 } else { self.correlation };
        self.noise_factor(level) * ((1.0 + alike) / (1.0 - alike)).sqrt()
    }

    /// Schwarz's information criterion: see [`crate::ShapeFit::choose`].
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;

    /// Residuals of which each is so much of the one before, and fresh noise.
    fn alike(by: f64) -> f64 {
        let (mut source, mut held) = (Source::new(1), DVec3::ZERO);
        let residuals: Vec<DVec3> = (0..400)
            .map(|_| {
                held = by * held + (1.0 - by * by).sqrt() * source.normal3();
                held
            })
            .collect();
        correlation(residuals.into_iter(), 3)
    }

    #[test]
    fn residuals_that_are_alike_are_told_from_chance() {
        assert_eq!(alike(0.0), 0.0);
        for by in [0.3, 0.6, 0.9] {
            let told = alike(by) + CHANCE / 1200.0_f64.sqrt();
            assert!((told - by).abs() < 0.1, "{by}: {told}");
        }
        assert_eq!(correlation([DVec3::ZERO; 3].into_iter(), 3), 0.0);
    }
}
