//! Where inside of a step a guard first falls to zero.

use super::field::Stretch;
use super::guards::Guards;
use super::packed::Units;
use super::result::ContactEventKind as Kind;
use crate::contacts::{ContactScene, PalmContactError};
use crate::integrate::{DenseOutput, find_root};
use contact_kinematics::SupportFunction;

/// Points at which a step is searched: a guard that dips below zero for less than this share of a step can pass unnoticed.
const SEARCH_POINTS: u32 = 8;
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
    at_start: &Guards,
) -> Result<Option<Crossing>, PalmContactError> {
    let guards = |t: f64| {
        let now = stretch.evaluate(scene, units, units.unpack(t, &dense.at(t)))?;
        Ok::<_, PalmContactError>(stretch.guards(&now, units))
    };
    let (start, end) = (dense.start(), dense.end());
    let (mut before, mut values) = (start, *at_start);
    for k in 1..=SEARCH_POINTS {
        let t = start + (end - start) * f64::from(k) / f64::from(SEARCH_POINTS);
        let after = guards(t)?;
        let mut first: Option<Crossing> = None;
        for (palm, (pair, pair_before)) in after.iter().zip(&values).enumerate() {
            for (which, &value) in pair.iter().enumerate() {
                if !(value <= 0.0) {
                    continue;
                }
                let at = if pair_before[which] > 0.0 {
                    let guard = |t: f64| guards(t).map_or(f64::NAN, |g| g[palm][which]);
                    find_root(guard, before, t, LOCATED * end.abs().max(end - start)).unwrap_or(t)
                } else {
                    before
                };
                if first.is_none_or(|f| at < f.t) {
                    first = Some(Crossing { t: at, palm, kind: stretch.kinds(palm)[which] });
                }
            }
        }
        if first.is_some() {
            return Ok(first);
        }
        (before, values) = (t, after);
    }
    Ok(None)
}
