//! How far readings of a finger may be off.

use crate::confidence::{Confidence, ConfidenceError, Spending};
use shape_bounds::noise::quantile;
use std::f64::consts::PI;

/// How far a touch may be off at most: exactly, or for all readings of a finger together with a stated probability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// Its point, m.
    pub point: f64,
    /// Its normal, rad.
    pub normal: f64,
}

impl Margins {
    /// Of a finger without noise.
    pub const EXACT: Self = Self { point: 0.0, normal: 0.0 };

    /// Of independent normal noise with these standard deviations (of a point per axis, m; of a normal, rad): with probability `level` none of
    /// `readings` is off by more, whichever of them are kept and wherever they were taken.
    ///
    /// # Errors
    /// [`ConfidenceError`].
    pub fn of_noise(deviations: [f64; 2], level: f64, readings: usize) -> Result<Self, ConfidenceError> {
        // Normals are off to either side.
        let half = |share: f64| [quantile::length2(share), quantile::normal(0.5 * share)];
        Self::shared(deviations, level, readings, half)
    }

    /// The same in space, where the deviation of a normal is about each tangent axis, rad.
    ///
    /// # Errors
    /// [`ConfidenceError`].
    pub fn of_noise_in_space(
        deviations: [f64; 2],
        level: f64,
        readings: usize,
    ) -> Result<Self, ConfidenceError> {
        // A normal that is off by a tangent vector is turned by no more than its length.
        let half = |share: f64| [quantile::length3(share), quantile::length2(share)];
        Self::shared(deviations, level, readings, half)
    }

    /// Half of what may go wrong for points and half for normals, by their quantiles.
    fn shared(
        [point, normal]: [f64; 2],
        level: f64,
        readings: usize,
        quantiles: impl Fn(f64) -> [f64; 2],
    ) -> Result<Self, ConfidenceError> {
        let share = Confidence::new(level, Spending::Budget(readings))?.share(1)?;
        let times = |deviation: f64, quantile: f64| if deviation > 0.0 { deviation * quantile } else { 0.0 };
        let [off, turned] = quantiles(0.5 * share);
        Ok(Self { point: times(point, off), normal: times(normal, turned) })
    }

    /// How far the turn from one touch to another may be off, rad: what [`super::Tracing::doubt`] is to be.
    #[must_use]
    pub fn of_turn(&self) -> f64 {
        2.0 * self.normal
    }

    /// How far the centre of a finger of radius `q` (m) may be off as point and normal say it, m.
    #[must_use]
    pub fn of_centre(&self, q: f64) -> f64 {
        q.mul_add(2.0 * (0.5 * self.normal.min(PI)).sin(), self.point)
    }
}
