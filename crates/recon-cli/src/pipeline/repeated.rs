//! Readings that repeat: what is stuck and what is held is left out, and named.

use crate::error::CliError;
use recon::contact_kinematics::at_once;
use recon::object_dynamics::{ContactLog, Held, RepeatedReading, Stuck, planar};

/// Share of the new readings of what is held most that must be left where none of what is held is told again.
const ENOUGH: f64 = 0.5;

/// A log without what repeats, and what is to be said of it.
pub(super) fn without_repeated(log: ContactLog) -> (ContactLog, Vec<String>) {
    let (left, told) = left(&log);
    let picked = left.and_then(|left| log.picked(&left).ok());
    (picked.unwrap_or(log), told)
}

/// The same in the plane, of palms of known or unknown friction.
pub(super) fn plane_without_repeated(
    log: planar::ContactLog,
    friction: &[Option<f64>],
) -> Result<(planar::ContactLog, Vec<String>), CliError> {
    let (left, told) = left(&log.in_space(friction)?);
    let picked = left.and_then(|left| log.picked(&left).ok());
    Ok((picked.unwrap_or(log), told))
}

/// What repeats in a log, each reading of each palm once.
pub(crate) fn repeated(log: &ContactLog) -> Vec<String> {
    left(log).1
}

/// Numbers of the samples that are left, where some are left out, and what is to be said of them.
fn left(log: &ContactLog) -> (Option<Vec<usize>>, Vec<String>) {
    let ((stuck, held), count) = (at_once(|| log.stuck(), || log.held()), log.times().len());
    let mut told = of_stuck(&stuck, log.times());
    let unstuck = Stuck::left(&stuck, count);
    let fewest = held.iter().map(|held| count - held.again.len()).min().unwrap_or(count);
    let new = |k: &usize| held.iter().all(|held| held.again.binary_search(k).is_err());
    let fresh: Vec<usize> = unstuck.iter().copied().filter(new).collect();
    let enough = fresh.len() as f64 >= ENOUGH * fewest as f64;
    told.extend(held.iter().map(|held| of_held(held, enough)));
    let left = if enough { fresh } else { unstuck };
    ((left.len() < count).then_some(left), told)
}

fn of_held(held: &Held, is_left_out: bool) -> String {
    let Held { palm, reading, samples, .. } = held;
    let late = samples - 1.0;
    let end = if is_left_out {
        "samples between are left out".to_owned()
    } else {
        format!(
            "what repeats comes late, as much as {late:.1} rows, and is taken for new: give a log with a row for each of its readings"
        )
    };
    format!(
        "the {reading}s of palm {palm} repeat to the last digit until there is a new one, over {samples:.1} rows on average: a sensor that measures less \
         often than the log has rows; {end}"
    )
}

fn of_stuck(stuck: &[Stuck], times: &[f64]) -> Vec<String> {
    let mut seen: Vec<(usize, RepeatedReading)> = Vec::new();
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
        all.push(format!(
            "the {reading} of palm {palm} repeats from {from:.4} s to {to:.4} s{more}, {samples} samples, which its noise never lets it: a sensor that is \
             frozen, or at the end of its range; these samples are left out"
        ));
    }
    all
}
