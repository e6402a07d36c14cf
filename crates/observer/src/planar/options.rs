//! How the planar observer works.

use super::error::PlanarEstimateError;
use crate::Arrival;

/// Where a [`PlanarObserver`](super::PlanarObserver) starts: `(cm, v, omega0)` at the first sample, in SI units.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PlanarStartFrom {
    /// No guess: the velocity residuals from nine neutral starts, then a batch fit.
    #[default]
    Nothing,
    /// A guess of any quality: the velocity residuals from there, then a batch fit.
    Guess([f64; 5]),
    /// A motion that is nearly right: Newton steps begin there.
    Motion([f64; 5]),
}

/// How a [`PlanarObserver`](super::PlanarObserver) works; the default needs no guess and chooses its window from the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarObserverOptions {
    /// Length of the window in s; none for six natural times.
    pub window: Option<f64>,
    /// Time in s before the first estimate; none for the length of the window.
    pub settle: Option<f64>,
    /// Newton steps a sample.
    pub steps: usize,
    /// What becomes of samples that leave the window.
    pub arrival: Arrival,
    /// Where it starts.
    pub start: PlanarStartFrom,
    /// Standard deviation of each estimated constant before the first sample, in its own unit; none for its
    /// natural size (a factor of 2.7 of mass and inertia, a gain of one, a bias of the weight, an offset of the size).
    pub constant_deviation: Option<f64>,
    /// Moments of inertia of the palms about the hinge, kg m^2, for logs with torques in place of forces.
    pub palm_inertias: [f64; 2],
}

impl Default for PlanarObserverOptions {
    fn default() -> Self {
        Self {
            window: None,
            settle: None,
            steps: 1,
            arrival: Arrival::Carry(1.0),
            start: PlanarStartFrom::Nothing,
            constant_deviation: None,
            palm_inertias: [0.0; 2],
        }
    }
}

impl PlanarObserverOptions {
    /// Refuses numbers that cannot be used.
    pub(super) fn check(&self) -> Result<(), PlanarEstimateError> {
        for (what, value) in [("window", self.window), ("settling time", self.settle)] {
            if let Some(value) = value.filter(|v| !(*v > 0.0 && v.is_finite())) {
                return Err(PlanarEstimateError::Value { what, value, needed: "positive and finite" });
            }
        }
        for value in self.palm_inertias {
            if !(value >= 0.0 && value.is_finite()) {
                let needed = "finite and at least 0";
                return Err(PlanarEstimateError::Value { what: "palm inertia", value, needed });
            }
        }
        Ok(())
    }
}
