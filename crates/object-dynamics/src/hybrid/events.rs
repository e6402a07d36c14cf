//! Where inside of a step a guard first falls to zero.

use super::field::Stretch;
use super::gaps::{Gaps, dips};
use super::guards::Guards;
use super::packed::Units;
use super::result::ContactEventKind as Kind;
use crate::contacts::{ContactScene, PalmContactError};
use crate::integrate::{DenseOutput, find_root};
use contact_kinematics::SupportFunction;

/// Points at which a step is searched: a force or slip that falls below zero for less than this share of a step can pass unnoticed.
const SEARCH_POINTS: u32 = 8;
/// Share of the size of the body by which a gap that closes and opens again between two of these points must have fallen below zero: less is
/// rounding where a contact has just been left.
const GRAZES: f64 = 1e-12;
/// To what share of the time an event is located; below rounding of the state.
const LOCATED: f64 = 1e-14;

/// A guard that has fallen to zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Crossing {
    pub(super) t: f64,
    pub(super) palm: usize,
    pub(super) kind: Kind,
}

/// The first crossing of a step, if there is one.
pub(super) fn first_crossing<S: SupportFunction, const N: usize>(
    stretch: &Stretch,
    scene: &ContactScene<S>,
    units: &Units,
    dense: &DenseOutput<N>,
    (guards_at_start, gaps_at_start): (Guards, Gaps),
) -> Result<Option<Crossing>, PalmContactError> {
    let seen = |t: f64| {
        let now = stretch.evaluate(scene, units, units.unpack(t, &dense.at(t)))?;
        Ok::<_, PalmContactError>((stretch.guards(&now, units), stretch.gaps(&now)))
    };
    let (start, end) = (dense.start(), dense.end());
    let located = LOCATED * end.abs().max(end - start);
    let (mut before, mut values, mut gaps) = (start, guards_at_start, gaps_at_start);
    for k in 1..=SEARCH_POINTS {
        let t = start + (end - start) * f64::from(k) / f64::from(SEARCH_POINTS);
        let (after, gaps_after) = seen(t)?;
        let mut first: Option<Crossing> = None;
        let mut keep = |found: Crossing| {
            if first.is_none_or(|f| found.t < f.t) {
                first = Some(found);
            }
        };
        for (palm, (pair, pair_before)) in after.iter().zip(&values).enumerate() {
            for (which, &value) in pair.iter().enumerate() {
                if value.is_nan() || value > 0.0 {
                    continue;
                }
                let at = if pair_before[which] > 0.0 {
                    let guard = |t: f64| seen(t).map_or(f64::NAN, |(guards, _)| guards[palm][which]);
                    find_root(guard, before, t, located).unwrap_or(t)
                } else {
                    before
                };
                keep(Crossing { t: at, palm, kind: stretch.kinds(palm)[which] });
            }
            if let (Some(open), Some(ends)) = (gaps[palm], gaps_after[palm])
                && dips(open, ends, t - before)
            {
                let gap = |t: f64| seen(t).map_or([f64::NAN; 2], |(_, gaps)| gaps[palm].unwrap_or(open));
                let closed = closes(gap, [before, t], GRAZES * units.length, located);
                closed.into_iter().for_each(|t| keep(Crossing { t, palm, kind: stretch.kinds(palm)[0] }));
            }
        }
        if first.is_some() {
            return Ok(first);
        }
        (before, values, gaps) = (t, after, gaps_after);
    }
    Ok(None)
}

/// When a gap, told with its rate, closes that is open and narrows at the first of two times and widens at the other one; none where all that is
/// left of it stays above zero, or falls no deeper than `grazes`.
fn closes(gap: impl Fn(f64) -> [f64; 2], [from, to]: [f64; 2], grazes: f64, located: f64) -> Option<f64> {
    let least = find_root(|t| gap(t)[1], from, to, located).ok()?;
    if gap(least)[0] >= -grazes {
        return None;
    }
    find_root(|t| gap(t)[0], from, least, located).ok()
}
