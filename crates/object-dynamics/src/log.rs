//! What the palms sensed, in memory. File formats live elsewhere.

use crate::BodyState;
use crate::series::{MOST_READING, SeriesError, check_lengths, check_order, is_taken};
use contact_kinematics::{Direction, DirectionError};
use thiserror::Error;

/// A log of three palms: samples in strictly increasing time, at least two of them.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorLog {
    samples: Vec<Sample>,
    truth: Option<Vec<TrueState>>,
}

/// One instant of a log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Time in s.
    pub t: f64,
    /// Readings of palms 1, 2, 3.
    pub palms: [PalmReading; 3],
}

/// What one palm senses at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmReading {
    /// Unit normal towards the object, world axes.
    pub normal: Direction,
    /// Contact `(s1, s2)` in the palm's frame, in m; none while the object does not touch the palm.
    pub contact: Option<[f64; 2]>,
    /// Normal contact force in N, at least zero; none where it was not measured.
    pub force: Option<f64>,
    /// Motor torque about `t1` in N m; none where it was not measured.
    pub torque: Option<f64>,
    /// Rate of rotation about `t1` in rad/s; none where it must be taken from the normals.
    pub rate: Option<f64>,
}

/// True state of the object, where a simulator knows it. Never read by an estimator.
pub type TrueState = BodyState;

/// Why samples are not a log.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum LogError {
    /// Too few samples, out of order, or with truth of another length.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// A time is not a number.
    #[error("t of sample {sample} is {value}; it must be finite")]
    TimeNotFinite {
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
    /// A reading is NaN or infinite.
    #[error("{what} of palm {palm} at sample {sample} (t = {time} s) is {value}; it must be finite")]
    ReadingNotFinite {
        /// Which reading.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given.
        value: f64,
    },
    /// A reading is larger than any.
    #[error(
        "{what} of palm {palm} at sample {sample} (t = {time} s) is {value:.3e}; {MOST_READING:e} is the most that is taken; check its unit"
    )]
    TooLarge {
        /// Which reading.
        what: &'static str,
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given.
        value: f64,
    },
    /// A normal contact force pulls.
    #[error("force of palm {palm} at sample {sample} (t = {time} s) is {value} N; a palm cannot pull")]
    NegativeForce {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Its time in s.
        time: f64,
        /// As given, in N.
        value: f64,
    },
    /// A normal is not a unit vector.
    #[error("normal of palm {palm} at sample {sample}: {source}")]
    Normal {
        /// Palm number from 1.
        palm: usize,
        /// Index from 0.
        sample: usize,
        /// Why.
        source: DirectionError,
    },
}

impl SensorLog {
    /// Checks the samples and takes them.
    ///
    /// A force may be negative by noise; only one that is negative beyond a tenth of the largest is refused.
    ///
    /// # Errors
    /// [`LogError`] names the first sample that cannot be used.
    pub fn new(samples: Vec<Sample>, truth: Option<Vec<TrueState>>) -> Result<Self, LogError> {
        check_lengths(samples.len(), truth.as_ref().map(Vec::len))?;
        let largest_force =
            samples.iter().flat_map(|s| s.palms.iter().filter_map(|p| p.force)).fold(0.0_f64, f64::max);
        for (index, sample) in samples.iter().enumerate() {
            check_sample(index, sample, largest_force)?;
            let previous = index.checked_sub(1).map(|before| samples[before].t);
            check_order(index, previous, sample.t)?;
        }
        Ok(Self { samples, truth })
    }

    /// The samples, in time order.
    #[must_use]
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The true states, one a sample, where they are known.
    #[must_use]
    pub fn truth(&self) -> Option<&[TrueState]> {
        self.truth.as_deref()
    }

    /// Time from the first sample to the last, in s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.samples[self.samples.len() - 1].t - self.samples[0].t
    }

    /// Index of the first sample at which some palm is without contact, with the palm's index from 0.
    ///
    /// A palm that carries no force has lost contact, whatever its contact sensor still says: many hold their last
    /// reading.
    #[must_use]
    pub fn first_contact_loss(&self) -> Option<(usize, usize)> {
        let lost = |palm: &PalmReading| palm.contact.is_none() || palm.force.is_some_and(|f| f <= 0.0);
        let first = |(k, sample): (usize, &Sample)| sample.palms.iter().position(lost).map(|palm| (k, palm));
        self.samples.iter().enumerate().find_map(first)
    }

    /// The log without truth, which is what a robot has, and the truth.
    #[must_use]
    pub fn split_truth(self) -> (Self, Option<Vec<TrueState>>) {
        (Self { samples: self.samples, truth: None }, self.truth)
    }
}

fn check_sample(index: usize, sample: &Sample, largest_force: f64) -> Result<(), LogError> {
    let time = sample.t;
    if !time.is_finite() {
        return Err(LogError::TimeNotFinite { sample: index, value: time });
    }
    for (i, palm) in sample.palms.iter().enumerate() {
        let readings = [
            ("s1", palm.contact.map(|s| s[0])),
            ("s2", palm.contact.map(|s| s[1])),
            ("force", palm.force),
            ("torque", palm.torque),
            ("rate", palm.rate),
        ];
        for (what, reading) in readings {
            let (palm, sample) = (i + 1, index);
            if let Some(value) = reading.filter(|value| !is_taken(*value)) {
                return Err(if value.is_finite() {
                    LogError::TooLarge { what, palm, sample, time, value }
                } else {
                    LogError::ReadingNotFinite { what, palm, sample, time, value }
                });
            }
        }
        if let Some(value) = palm.force.filter(|&f| f < -0.1 * largest_force) {
            return Err(LogError::NegativeForce { palm: i + 1, sample: index, time, value });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(t: f64, force: f64) -> Sample {
        let palm = PalmReading {
            normal: Direction::X,
            contact: Some([0.1, 0.2]),
            force: Some(force),
            torque: None,
            rate: None,
        };
        Sample { t, palms: [palm; 3] }
    }

    #[test]
    fn bad_logs_are_named() {
        assert!(matches!(
            SensorLog::new(vec![], None),
            Err(LogError::Series(SeriesError::TooShort { found: 0 }))
        ));
        assert!(matches!(
            SensorLog::new(vec![sample(0.0, 1.0)], None),
            Err(LogError::Series(SeriesError::TooShort { found: 1 }))
        ));
        let repeated = vec![sample(0.0, 1.0), sample(0.0, 1.0)];
        assert!(matches!(
            SensorLog::new(repeated, None),
            Err(LogError::Series(SeriesError::TimeNotIncreasing { sample: 1, .. }))
        ));
        let nanoseconds = vec![sample(1.7e18, 1.0), sample(1.7e18 + 1e6, 1.0)];
        assert!(matches!(
            SensorLog::new(nanoseconds, None),
            Err(LogError::Series(SeriesError::TimeOutOfRange { sample: 0, .. }))
        ));
        let not_a_number = vec![sample(0.0, 1.0), sample(f64::NAN, 1.0)];
        assert!(matches!(SensorLog::new(not_a_number, None), Err(LogError::TimeNotFinite { sample: 1, .. })));
        let force = vec![sample(0.0, 1.0), sample(1.0, f64::INFINITY)];
        assert!(matches!(SensorLog::new(force, None), Err(LogError::ReadingNotFinite { what: "force", .. })));
        let large = vec![sample(0.0, 1.0), sample(1.0, 1e300)];
        assert!(matches!(
            SensorLog::new(large, None),
            Err(LogError::TooLarge { what: "force", sample: 1, .. })
        ));
        let pull = vec![sample(0.0, 1.0), sample(1.0, -0.5)];
        assert!(matches!(
            SensorLog::new(pull, None),
            Err(LogError::NegativeForce { palm: 1, sample: 1, .. })
        ));
        let truth = SensorLog::new(vec![sample(0.0, 1.0), sample(1.0, 1.0)], Some(vec![]));
        assert!(matches!(truth, Err(LogError::Series(SeriesError::TruthLength { expected: 2, found: 0 }))));
    }

    #[test]
    fn contact_loss_is_found() {
        let mut samples: Vec<_> = (0..5).map(|k| sample(f64::from(k), 1.0)).collect();
        samples[3].palms[1].contact = None;
        let log = SensorLog::new(samples, None).unwrap();
        assert_eq!(log.first_contact_loss(), Some((3, 1)));
        let mut held = log.samples().to_vec();
        held[2].palms[2].force = Some(0.0);
        assert_eq!(SensorLog::new(held, None).unwrap().first_contact_loss(), Some((2, 2)));
        assert_eq!(log.duration(), 4.0);
    }
}
