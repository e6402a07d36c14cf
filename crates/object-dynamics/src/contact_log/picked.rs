//! Some samples of a log.

use super::record::{ContactPoints, ForceChannel, PalmRecord, RecordedMotion};
use super::{ContactLog, ContactLogError};

impl ContactLog {
    /// The log with those of its samples, by their numbers in rising order. Impulses are integrals, so that they lose nothing between samples.
    ///
    /// # Errors
    /// Those of a log that is left with less than two samples, or with samples out of order.
    pub fn picked(&self, samples: &[usize]) -> Result<Self, ContactLogError> {
        let palms = self.records().into_iter().map(|palm| of_palm(palm, samples)).collect();
        Self::new(some(&self.times, samples), palms, self.truth().map(|truth| some(truth, samples)))
    }
}

/// Those of `all` at these numbers.
pub(crate) fn some<T: Clone>(all: &[T], samples: &[usize]) -> Vec<T> {
    samples.iter().filter_map(|&k| all.get(k)).cloned().collect()
}

fn of_palm(palm: PalmRecord, samples: &[usize]) -> PalmRecord {
    let channel = |channel: ForceChannel| match channel {
        ForceChannel::Missing => ForceChannel::Missing,
        ForceChannel::Normal(values) => ForceChannel::Normal(some(&values, samples)),
        ForceChannel::Three(vectors) => ForceChannel::Three(some(&vectors, samples)),
    };
    PalmRecord {
        motion: match palm.motion {
            RecordedMotion::Fixed(pose) => RecordedMotion::Fixed(pose),
            RecordedMotion::Poses(poses) => RecordedMotion::Poses(some(&poses, samples)),
            RecordedMotion::Measured(states) => RecordedMotion::Measured(some(&states, samples)),
        },
        contacts: match palm.contacts {
            ContactPoints::World(points) => ContactPoints::World(some(&points, samples)),
            ContactPoints::Palm(points) => ContactPoints::Palm(some(&points, samples)),
        },
        force: channel(palm.force),
        impulse: channel(palm.impulse),
        torque: palm.torque.map(|torque| some(&torque, samples)),
        truth: palm.truth.map(|truth| some(&truth, samples)),
        ..palm
    }
}
