//! The samples of a window as a log.

use super::sample::{ForceReading, PalmSensed, Raw, StreamPalm};
use object_dynamics::{ContactLog, ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion};
use std::collections::VecDeque;

/// Samples that are left out at most because a window cannot be read with them.
pub(super) const LEFT_OUT: usize = 8;

/// The samples as a log, without those that cannot be read in it, and how many those are.
pub(super) fn log(palms: &[StreamPalm], samples: &mut VecDeque<Raw>) -> (Option<ContactLog>, usize) {
    for left_out in 0..=LEFT_OUT {
        let times = samples.iter().map(|raw| raw.t).collect();
        let records = (0..palms.len()).map(|i| record(i, palms[i], samples)).collect();
        match ContactLog::new(times, records, None) {
            Ok(log) => return (Some(log), left_out),
            Err(error) => match error.sample() {
                Some(sample) if sample < samples.len() => {
                    samples.remove(sample);
                }
                _ => return (None, left_out),
            },
        }
    }
    (None, LEFT_OUT)
}

fn record(i: usize, palm: StreamPalm, samples: &VecDeque<Raw>) -> PalmRecord {
    let StreamPalm { surface, friction } = palm;
    let sensed = || samples.iter().filter_map(move |raw| raw.palms[i]);
    let measured = |s: PalmSensed| s.twist.map(|[v_WP, w_WP]| MeasuredMotion { pose: s.pose, v_WP, w_WP });
    let motion = match sensed().map(measured).collect::<Option<Vec<_>>>() {
        Some(states) => RecordedMotion::Measured(states),
        None => RecordedMotion::Poses(sensed().map(|s| s.pose).collect()),
    };
    let normal = |s: PalmSensed| match s.force {
        ForceReading::Normal(f) => Some(f),
        ForceReading::Three(_) => None,
    };
    let three = |s: PalmSensed| match s.force {
        ForceReading::Normal(_) => None,
        ForceReading::Three(f) => Some(f),
    };
    let (forces, vectors): (Option<Vec<_>>, Option<Vec<_>>) =
        (sensed().map(normal).collect(), sensed().map(three).collect());
    let missing = ForceChannel::Missing;
    PalmRecord {
        surface,
        friction,
        motion,
        contacts: ContactPoints::World(sensed().map(|s| s.contact).collect()),
        force: forces.map(ForceChannel::Normal).or(vectors.map(ForceChannel::Three)).unwrap_or(missing),
        impulse: ForceChannel::Missing,
        torque: None,
        hinge: None,
        truth: None,
        largest_offset: f64::INFINITY,
    }
}
