//! How far readings of a finger may be off.

use crate::confidence::{Confidence, ConfidenceError, Spending};
use shape_bounds::noise::quantile;

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
    pub fn of_noise([point, normal]: [f64; 2], level: f64, readings: usize) -> Result<Self, ConfidenceError> {
        let share = Confidence::new(level, Spending::Budget(readings))?.share(1)?;
        let times = |deviation: f64, quantile: f64| if deviation > 0.0 { deviation * quantile } else { 0.0 };
        // Half of what may go wrong for points and half for normals, which are off to either side.
        Ok(Self {
            point: times(point, quantile::length2(0.5 * share)),
            normal: times(normal, quantile::normal(0.25 * share)),
        })
    }

    /// How far the turn from one touch to another may be off, rad: what [`super::Tracing::doubt`] is to be.
    #[must_use]
    pub fn of_turn(&self) -> f64 {
        2.0 * self.normal
    }
}
