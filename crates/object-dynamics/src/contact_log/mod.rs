//! What palms of any shape, pose and motion sensed, in memory. File formats live elsewhere.

mod build;
mod error;
mod held;
mod motor;
#[cfg(feature = "noise")]
mod noise;
mod palm;
mod picked;
mod record;
mod simulated;
mod stuck;
mod three_planes;
mod twice;
mod twists;

#[cfg(test)]
mod tests;

pub use error::ContactLogError;
pub use held::Held;
pub use motor::PalmHinge;
#[cfg(feature = "noise")]
pub use noise::{ChannelNoise, ContactNoise};
pub use palm::{LoggedPalm, SensedForce, Touch};
pub(crate) use picked::some;
pub use record::{
    ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion, SensedAxes, TrueContact,
    TwistSource,
};
pub use stuck::{RepeatedReading, Stuck, StuckWatch};
pub use three_planes::{NotThreePlanes, ThreePlanes};

use crate::TrueState;
use glam::DVec3;

/// A log of one to five palms: samples in strictly increasing time, at least two of them, each with a reading of every palm.
///
/// World points, normals and the motion of the palms' surfaces are computed once, when the log is made. What every sample
/// has of a palm stands once in [`LoggedPalm`], and channels that a palm lacks take no memory.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactLog {
    times: Vec<f64>,
    palms: Vec<LoggedPalm>,
    truth: Option<Vec<TrueState>>,
}

impl ContactLog {
    /// Checks what the palms recorded at `times` (s), puts contacts on the palms and takes normals and twists.
    ///
    /// A force may pull by noise; only one that pulls by more than a tenth of the log's largest is refused.
    ///
    /// # Errors
    /// [`ContactLogError`] names palm, sample and value.
    pub fn new(
        times: Vec<f64>,
        palms: Vec<PalmRecord>,
        truth: Option<Vec<TrueState>>,
    ) -> Result<Self, ContactLogError> {
        let palms = build::palms(&times, palms, truth.as_ref().map(Vec::len))?;
        Ok(Self { times, palms, truth })
    }

    /// Times of the samples in s, in strictly increasing order.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The palms, each with its readings.
    #[must_use]
    pub fn palms(&self) -> &[LoggedPalm] {
        &self.palms
    }

    /// The true states, one a sample, where they are known.
    #[must_use]
    pub fn truth(&self) -> Option<&[TrueState]> {
        self.truth.as_deref()
    }

    /// Time from the first sample to the last, in s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.times[self.times.len() - 1] - self.times[0]
    }

    /// The log without any truth, which is what a robot has, and the true states.
    #[must_use]
    pub fn split_truth(mut self) -> (Self, Option<Vec<TrueState>>) {
        self.palms.iter_mut().for_each(LoggedPalm::forget_truth);
        (Self { truth: None, ..self }, self.truth)
    }

    /// The log with all that it tells of moved by `by`, world, m.
    #[must_use]
    pub fn shifted(mut self, by: DVec3) -> Self {
        self.palms.iter_mut().for_each(|palm| palm.shift(by));
        self.truth.iter_mut().flatten().for_each(|state| state.p_WCm += by);
        self
    }

    /// What the log would have been made from: points of contact in the world, as they were put on the palms.
    #[must_use]
    pub fn records(&self) -> Vec<PalmRecord> {
        self.palms.iter().map(LoggedPalm::record).collect()
    }

    /// Memory that one sample takes, bytes: 8 for the time, 104 for the true state, and for each palm 56 for the contact, 24
    /// (three axes) or 8 (one) for the force and for the impulse, 104 for the motion of a palm that moves, 16 for a torque and
    /// 24 for the true contact.
    #[must_use]
    pub fn bytes_per_sample(&self) -> usize {
        let truth = self.truth.as_ref().map_or(0, |_| size_of::<TrueState>());
        size_of::<f64>() + truth + self.palms.iter().map(LoggedPalm::bytes_per_sample).sum::<usize>()
    }
}
