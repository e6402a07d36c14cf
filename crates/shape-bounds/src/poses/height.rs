use super::PoseError;
use crate::noise::quantile::normal;

/// Height of the plane in the world, and what is known of its error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneHeight {
    /// The height, in m.
    pub z: f64,
    /// Standard deviation of an error common to all runs, in m.
    pub deviation: f64,
    /// Standard deviation of errors that differ from run to run, in m.
    pub run_deviation: f64,
}

impl From<f64> for PlaneHeight {
    /// A height without error.
    fn from(z: f64) -> Self {
        Self { z, deviation: 0.0, run_deviation: 0.0 }
    }
}

impl PlaneHeight {
    /// The confidence that is left for everything else, and how far the plane may be above what is stated, in m.
    ///
    /// The chance of a miss is shared out evenly among the rule and what is uncertain of the height; of errors of runs the
    /// worst of all `runs` counts (union bound).
    pub(super) fn allowance(&self, runs: usize, confidence: f64) -> Result<(f64, f64), PoseError> {
        let parts = [(self.deviation, 1), (self.run_deviation, runs.max(1))];
        for (deviation, _) in parts {
            if !(deviation >= 0.0 && deviation.is_finite()) {
                return Err(PoseError::Deviation(deviation));
            }
        }
        let uncertain = parts.iter().filter(|(deviation, _)| *deviation > 0.0);
        let missed = (1.0 - confidence) / (1 + uncertain.clone().count()) as f64;
        let allowed = uncertain.map(|(deviation, count)| deviation * normal(missed / *count as f64));
        Ok((1.0 - missed, allowed.sum()))
    }
}
