//! Steiner's formula: what the measures of a convex body become when a ball is added to it.

use std::f64::consts::PI;

/// Measures of a convex body, all of which a ball added to it changes by a polynomial of its radius.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConvexMeasures {
    /// In m^3.
    pub volume: f64,
    /// Surface area in m^2; twice the area of a plate.
    pub area: f64,
    /// Integral of the mean curvature over the surface in m: half the sum of length times exterior angle over the edges of a
    /// polytope, `4 pi r` for a ball, and `2 pi` times the mean width in general.
    pub mean_curvature: f64,
}

impl ConvexMeasures {
    /// Measures of all points within `r` of the body (Steiner).
    #[must_use]
    pub fn grown(&self, r: f64) -> Self {
        let Self { volume, area, mean_curvature } = *self;
        Self {
            volume: volume + r * (area + r * (mean_curvature + r * 4.0 / 3.0 * PI)),
            area: area + r * (2.0 * mean_curvature + r * 4.0 * PI),
            mean_curvature: mean_curvature + r * 4.0 * PI,
        }
    }
}
