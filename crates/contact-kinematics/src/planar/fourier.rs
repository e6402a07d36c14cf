//! Bodies whose radius function is a trigonometric polynomial, with a proof of convexity.

use super::error::ShapeError;
use super::radius::{RadiusBounds, RadiusFunction, RadiusJet};

/// Finest grid of the convexity proof. Its slack, `h^2 max|rho''| / 8`, is then below `2e-9 max|rho''|`.
const FINEST_GRID: usize = 1 << 15;

/// `r(theta) = a_0 + sum_k (a_k cos k theta + b_k sin k theta)`, checked to be strictly convex.
///
/// Order 1 is the offset of the centre of mass; it does not enter the curvature.
#[derive(Clone, Debug, PartialEq)]
pub struct FourierBody {
    cosines: Vec<f64>,
    sines: Vec<f64>,
    bounds: RadiusBounds,
}

impl FourierBody {
    /// From coefficients in m, index = order; `sines[0]` has no effect.
    ///
    /// Convexity is proved, not sampled: on a grid of spacing `h` the radius of curvature between grid points stays
    /// within `h^2 max|rho''| / 8` of its grid values' range, and the grid is refined until that slack is small
    /// against the smallest value found.
    ///
    /// # Errors
    /// [`ShapeError::NotConvex`] with the place, [`ShapeError::Unproved`] on the edge of convexity, and for
    /// unusable numbers [`ShapeError::NotFinite`] or [`ShapeError::Coefficients`].
    pub fn new(cosines: &[f64], sines: &[f64]) -> Result<Self, ShapeError> {
        if cosines.is_empty() || cosines.len() != sines.len() {
            return Err(ShapeError::Coefficients { cosines: cosines.len(), sines: sines.len() });
        }
        for (what, list) in [("cosine coefficient", cosines), ("sine coefficient", sines)] {
            if let Some(index) = list.iter().position(|v| !v.is_finite()) {
                return Err(ShapeError::NotFinite { what, index, value: list[index] });
            }
        }
        let bounds = RadiusBounds { min: 0.0, max: 0.0 };
        let mut body = Self { cosines: cosines.to_vec(), sines: sines.to_vec(), bounds };
        body.bounds = body.prove_convex()?;
        Ok(body)
    }

    /// Cosine coefficients in m, index = order.
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// Sine coefficients in m, index = order.
    #[must_use]
    pub fn sines(&self) -> &[f64] {
        &self.sines
    }

    fn prove_convex(&self) -> Result<RadiusBounds, ShapeError> {
        let second_derivative: f64 = (1..self.cosines.len())
            .map(|k| {
                let square = (k * k) as f64;
                square * (square - 1.0) * self.cosines[k].hypot(self.sines[k])
            })
            .sum();
        let mut count = 64;
        loop {
            let step = std::f64::consts::TAU / count as f64;
            let slack = step * step * second_derivative / 8.0;
            let (mut min, mut max, mut place) = (f64::INFINITY, f64::NEG_INFINITY, 0.0);
            for i in 0..count {
                let theta = i as f64 * step;
                let rho = self.jet(theta).rho;
                max = max.max(rho);
                if rho < min {
                    (min, place) = (rho, theta);
                }
            }
            if min <= 0.0 {
                return Err(ShapeError::NotConvex { theta: place, rho: min });
            }
            if slack <= 1e-3 * min {
                return Ok(RadiusBounds { min: min - slack, max: max + slack });
            }
            if count >= FINEST_GRID {
                return Err(ShapeError::Unproved { bound: min - slack });
            }
            count *= 2;
        }
    }
}

impl RadiusFunction for FourierBody {
    fn jet(&self, theta: f64) -> RadiusJet {
        let mut jet = RadiusJet { r: self.cosines[0], d: 0.0, rho: self.cosines[0] };
        let (sin1, cos1) = theta.sin_cos();
        let (mut sin, mut cos) = (sin1, cos1);
        for (k, (a, b)) in self.cosines.iter().zip(&self.sines).enumerate().skip(1) {
            let order = k as f64;
            let wave = a * cos + b * sin;
            jet.r += wave;
            jet.d += order * (a * sin - b * cos);
            jet.rho += (1.0 - order * order) * wave;
            (sin, cos) = (sin * cos1 + cos * sin1, cos * cos1 - sin * sin1);
        }
        jet
    }

    fn radius_bounds(&self) -> RadiusBounds {
        self.bounds
    }
}
