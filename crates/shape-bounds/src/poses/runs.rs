//! Runs that contradict the others.

use super::level::{FEWEST, consistent_level};
use super::{Observation, PoseError, PoseRule, intersect};
use std::collections::BTreeSet;

/// Planes further from the bound than this share of the size cannot matter when one run is left out.
const NEAR: f64 = 0.05;
/// So many other runs must say that a run is wrong: one alone may be wrong itself.
const ACCUSERS: usize = 2;
/// A level of this share of the size is no noise of a tracker. Where less than [`REAL`] of the touching poses are consistent
/// there, what holds the body is not the plane alone.
const NO_NOISE: f64 = 0.1;
const REAL: f64 = 0.9;
/// Share of the runs that may be wrong where most touches are right.
const WRONG: f64 = 0.05;
/// Leaving runs out must make the level smaller by this factor, or the runs are not what is wrong.
const BETTER: f64 = 0.5;
/// Share of the poses taken for touching that do touch even where a body is propped, and this many levels at which they are
/// consistent are noise that others may have: the least level of a propped body, where smooth sides contradict nothing.
const SURE: f64 = 0.5;
const LEAST: f64 = 2.0;
/// Halvings of the bracket for the level of a propped body, in its logarithm.
const HALVINGS: usize = 4;

/// The rule for a body that something else than the plane props up or pushes, so that what seems to touch need not:
/// `trusted` is the share of the runs, not of the poses, that do not contradict the others at the level.
///
/// The form and the factors come from the even-numbered tosses of the real elbow of `docs/bounds.md`, twenty hundreds of them;
/// the odd-numbered ones check it.
pub(super) const PROPPED: PoseRule =
    PoseRule { kink: 1.0, gap: 0.0, trusted: 0.8, factors: [1.4, 2.0], scarcity: 0.57 };

/// What is left when runs that contradict the others are left out.
pub(super) struct Agreed {
    pub(super) kept: Vec<Observation>,
    /// Noise at which it agrees, in m.
    pub(super) level: f64,
    pub(super) left_out: Vec<ContradictingRun>,
    pub(super) propped: bool,
}

/// Leaves out runs as long as the rest agrees much better without them.
pub(super) fn agreed(
    observations: Vec<Observation>,
    runs: usize,
    rule: &PoseRule,
) -> Result<Agreed, PoseError> {
    let most = (WRONG * runs as f64) as usize;
    let mut known = Agreed {
        level: consistent_level(&observations, rule)?,
        kept: observations,
        left_out: Vec::new(),
        propped: false,
    };
    while known.left_out.len() < most {
        // Where nothing is left at half of the level, or a side is open without the runs, leaving them out is no help.
        let Some(found) =
            harmless(contradicting(&known.kept, BETTER * known.level, most - known.left_out.len()))?
        else {
            break;
        };
        let rest = without(&known.kept, &found);
        if found.is_empty() || rest.iter().filter(|o| o.touching).count() < FEWEST {
            break;
        }
        let Some(level) =
            harmless(consistent_level(&rest, rule))?.filter(|level| *level <= BETTER * known.level)
        else {
            break;
        };
        known.left_out.extend(found);
        known = Agreed { kept: rest, level, ..known };
    }
    let of_most = consistent_level(&known.kept, &PoseRule { trusted: rule.trusted.min(REAL), ..*rule })?;
    let size = size(&known.kept, of_most)?;
    let propped = if of_most > NO_NOISE * size { propped(&known.kept, runs, size)? } else { None };
    Ok(match propped {
        Some(of_runs) => Agreed { left_out: [known.left_out, of_runs.left_out].concat(), ..of_runs },
        None => known,
    })
}

/// A result, or none where the half-spaces close around nothing.
fn harmless<T>(result: Result<T, PoseError>) -> Result<Option<T>, PoseError> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(PoseError::Open { .. } | PoseError::HalfSpaces(_)) => Ok(None),
        Err(error) => Err(error),
    }
}

/// The largest distance of a corner of the bound from the origin, in m.
fn size(observations: &[Observation], level: f64) -> Result<f64, PoseError> {
    Ok(intersect(observations, level)?.vertices().iter().map(|v| v.length()).fold(0.0, f64::max))
}

/// The smallest level at which few enough runs contradict the others, but no less than what touches that are sure ask for;
/// `None` if it is no noise of a tracker either.
fn propped(observations: &[Observation], runs: usize, size: f64) -> Result<Option<Agreed>, PoseError> {
    let rough = |o: &Observation| Observation { kink: PROPPED.kink * o.roughness, gap: 0.0, ..*o };
    let all: Vec<Observation> = observations.iter().map(rough).collect();
    let most = ((1.0 - PROPPED.trusted) * runs as f64) as usize;
    let few = |level: f64| contradicting(&all, level, most).ok().filter(|found| found.len() <= most);
    let mut high = NO_NOISE * size;
    let mut low = LEAST * consistent_level(&all, &PoseRule { trusted: SURE, ..PROPPED })?;
    if low >= high {
        return Ok(None);
    }
    let Some(mut left_out) = few(high) else { return Ok(None) };
    if let Some(found) = few(low) {
        (high, left_out) = (low, found);
    } else {
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            match few(middle) {
                Some(found) => (high, left_out) = (middle, found),
                None => low = middle,
            }
        }
    }
    Ok(Some(Agreed { kept: without(&all, &left_out), level: high, left_out, propped: true }))
}

fn without(observations: &[Observation], runs: &[ContradictingRun]) -> Vec<Observation> {
    observations.iter().filter(|o| runs.iter().all(|r| r.run != o.at.0)).copied().collect()
}

/// A run that contradicts others, and which.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ContradictingRun {
    /// The run.
    pub run: usize,
    /// Runs that touch the plane where the body cannot be if this run is right.
    pub against: Vec<usize>,
}

/// Runs whose half-spaces, moved out by `level` and what the kinks add, cut off what several other runs touched, each found
/// when those before it are left out; at most `most` of them, and one more if there are more.
///
/// Touches are judged one by one: a pose that is taken for touching but is propped up by something else contradicts many
/// runs at once, so that leaving out any one of them does not help, and accuses none.
pub(super) fn contradicting(
    observations: &[Observation],
    level: f64,
    most: usize,
) -> Result<Vec<ContradictingRun>, PoseError> {
    let mut kept: Vec<Observation> = observations.to_vec();
    let mut found: Vec<ContradictingRun> = Vec::new();
    while found.len() <= most {
        let worst = accused(&kept, level)?;
        if worst.is_empty() {
            break;
        }
        // Several at once where different runs accuse them.
        let mut heard = BTreeSet::new();
        for (run, against) in worst {
            let fresh = against.iter().filter(|a| !heard.contains(*a)).count();
            if fresh >= ACCUSERS {
                kept.retain(|o| o.at.0 != run);
                heard.extend(against.iter().copied());
                found.push(ContradictingRun { run, against });
            }
        }
    }
    Ok(found)
}

/// Runs with those that accuse them, the most accused first.
fn accused(kept: &[Observation], level: f64) -> Result<Vec<(usize, Vec<usize>)>, PoseError> {
    let bound = intersect(kept, level)?;
    let size = bound.vertices().iter().map(|v| v.length()).fold(0.0, f64::max);
    let mut caps = bound.caps();
    // How far a touching pose is beyond what noise of that level explains.
    let excess = |o: &Observation, height: f64| -height - level - o.gap;
    let doubted: Vec<&Observation> = kept
        .iter()
        .filter(|o| o.touching && (0.0..NEAR * size).contains(&excess(o, caps.height(&o.half_space))))
        .collect();
    let near: Vec<Observation> =
        kept.iter().filter(|o| -caps.height(&o.moved(level)) < NEAR * size).copied().collect();
    let owners: BTreeSet<usize> = bound.face_sources().iter().map(|k| kept[*k as usize].at.0).collect();
    let mut all = Vec::new();
    for run in owners {
        let others: Vec<Observation> = near.iter().filter(|o| o.at.0 != run).copied().collect();
        // Without the run a side may be open, which contradicts nothing.
        let Ok(wider) = intersect(&others, level) else { continue };
        let mut caps = wider.caps();
        let helped = |o: &&&Observation| o.at.0 != run && excess(o, caps.height(&o.half_space)) <= 0.0;
        let against: BTreeSet<usize> = doubted.iter().filter(helped).map(|o| o.at.0).collect();
        if against.len() >= ACCUSERS {
            all.push((run, against.into_iter().collect::<Vec<_>>()));
        }
    }
    all.sort_by_key(|(_, against)| std::cmp::Reverse(against.len()));
    Ok(all)
}
