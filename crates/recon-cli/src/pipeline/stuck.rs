//! Samples at which a sensor is stuck: left out, and named.

use crate::error::CliError;
use recon::object_dynamics::{ContactLog, Stuck, StuckReading, planar};

/// The log without them, and what is to be said of it.
pub(super) fn without_stuck(log: ContactLog) -> (ContactLog, Vec<String>) {
    let stuck = log.stuck();
    if stuck.is_empty() {
        return (log, Vec::new());
    }
    let told = told(&stuck, log.times(), true);
    // What has no two samples without is estimated as it is.
    (log.picked(&Stuck::left(&stuck, log.times().len())).unwrap_or(log), told)
}

/// The same in the plane, of palms of known or unknown friction.
pub(super) fn plane_without_stuck(
    log: planar::ContactLog,
    friction: &[Option<f64>],
) -> Result<(planar::ContactLog, Vec<String>), CliError> {
    let in_space = log.in_space(friction)?;
    let stuck = in_space.stuck();
    if stuck.is_empty() {
        return Ok((log, Vec::new()));
    }
    let told = told(&stuck, in_space.times(), true);
    Ok((log.picked(&Stuck::left(&stuck, log.samples().len())).unwrap_or(log), told))
}

/// What is stuck of a log, each reading of each palm once.
pub(crate) fn stuck_readings(log: &ContactLog) -> Vec<String> {
    told(&log.stuck(), log.times(), false)
}

fn told(stuck: &[Stuck], times: &[f64], left_out: bool) -> Vec<String> {
    let mut seen: Vec<(usize, StuckReading)> = Vec::new();
    let mut all = Vec::new();
    for first in stuck {
        let of = (first.palm, first.reading);
        if seen.contains(&of) {
            continue;
        }
        seen.push(of);
        let same = || stuck.iter().filter(|other| (other.palm, other.reading) == of);
        let samples: usize = same().map(|one| one.samples.len()).sum();
        let [from, to] =
            [first.samples.start, first.samples.end - 1].map(|k| times.get(k).copied().unwrap_or(f64::NAN));
        let more = match same().count() {
            1 => String::new(),
            spans => format!(", and {} times later", spans - 1),
        };
        let (palm, reading) = of;
        let verb = if left_out { "is left out" } else { "cannot be used" };
        all.push(format!(
            "the {reading} of palm {palm} repeats from {from:.4} s to {to:.4} s{more}, {samples} samples, which its noise never lets it: a sensor that is \
             frozen, or at the end of its range; what it says there {verb}"
        ));
    }
    all
}
