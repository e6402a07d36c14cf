//! One of so many samples of a log.

use object_dynamics::{ContactLog, ContactLogError, ContactPoints, ForceChannel, PalmRecord, RecordedMotion};

/// The log with its first sample and every `every`-th one after it. Impulses are integrals, so that they lose nothing between samples.
///
/// # Errors
/// Those of a log that is left with less than two samples.
pub fn one_of(log: &ContactLog, every: usize) -> Result<ContactLog, ContactLogError> {
    if every <= 1 {
        return Ok(log.clone());
    }
    let times = some(log.times(), every);
    let palms = log.records().into_iter().map(|palm| of_palm(palm, every)).collect();
    ContactLog::new(times, palms, log.truth().map(|truth| some(truth, every)))
}

fn some<T: Clone>(all: &[T], every: usize) -> Vec<T> {
    all.iter().step_by(every).cloned().collect()
}

fn of_palm(palm: PalmRecord, every: usize) -> PalmRecord {
    let channel = |channel: ForceChannel| match channel {
        ForceChannel::Missing => ForceChannel::Missing,
        ForceChannel::Normal(values) => ForceChannel::Normal(some(&values, every)),
        ForceChannel::Three(vectors) => ForceChannel::Three(some(&vectors, every)),
    };
    PalmRecord {
        motion: match palm.motion {
            RecordedMotion::Fixed(pose) => RecordedMotion::Fixed(pose),
            RecordedMotion::Poses(poses) => RecordedMotion::Poses(some(&poses, every)),
            RecordedMotion::Measured(states) => RecordedMotion::Measured(some(&states, every)),
        },
        contacts: match palm.contacts {
            ContactPoints::World(points) => ContactPoints::World(some(&points, every)),
            ContactPoints::Palm(points) => ContactPoints::Palm(some(&points, every)),
        },
        force: channel(palm.force),
        impulse: channel(palm.impulse),
        torque: palm.torque.map(|torque| some(&torque, every)),
        truth: palm.truth.map(|truth| some(&truth, every)),
        ..palm
    }
}
