//! Estimates: the chosen model beside all.

use super::logs::{Logged, logged};
use super::{Failure, Outcome};
use cpu_time::ProcessTime;
use recon::least_model::{Accuracy, Pose, least_estimate, one_of, stated_accuracy};
use recon::observer::contacts::{ContactEstimate, ContactOptions, estimate_contacts};
use recon_tests::Random;

/// Scenes by turns: without friction, in a plane, with little friction.
const KINDS: [usize; 3] = [0, 2, 3];
/// Thinnings that are tried.
const EVERY: [usize; 3] = [1, 4, 16];
/// Samples that must be left in a natural time.
const LEFT: f64 = 30.0;
/// Over the best that a log allows, the wanted accuracy is at least.
const ABOVE: f64 = 1.2;
/// Over the cheapest, time of a model from which on it is not thinned.
const DEAR: f64 = 10.0;
/// Loosest accuracy that is wanted.
const LOOSEST: f64 = 0.05;

/// An estimate by one model.
struct Tried {
    ms: f64,
    stated: Option<f64>,
    name: String,
}

/// Of the scene that a seed draws, of the kind whose turn it is.
pub(super) fn one(turn: usize, seed: u64) -> Result<Option<Outcome>, Failure> {
    logged(KINDS[turn % KINDS.len()], seed)?.map_or(Ok(None), |of| judged(&of, seed))
}

/// None where no model comes to an estimate that is relied on, or none better than the loosest accuracy.
fn judged(of: &Logged, seed: u64) -> Result<Option<Outcome>, Failure> {
    let tried = all(of)?;
    let best = tried.iter().filter_map(|of| of.stated).fold(f64::INFINITY, f64::min) * ABOVE;
    if best >= LOOSEST {
        return Ok(None);
    }
    let share = Random::new(seed ^ 0xACC).within(0.0, 1.0);
    let wanted = Accuracy::new(best * (LOOSEST / best).powf(share))?;
    let clock = ProcessTime::now();
    let found = least_estimate(&of.log, &of.options, wanted)?;
    let total = 1e3 * clock.elapsed().as_secs_f64();
    let (own, _) = timed(of, &found.options, found.every)?;
    let serves = tried.iter().filter(|of| of.stated.is_some_and(|stated| stated <= wanted.get()));
    let cheapest = serves.min_by(|a, b| a.ms.total_cmp(&b.ms));
    let what = name(&found.options, found.every);
    let (ms, cheapest) = cheapest.map_or((f64::INFINITY, String::new()), |of| (of.ms, of.name.clone()));
    let (ms, cheapest) = if own < ms { (own, what.clone()) } else { (ms, cheapest) };
    Ok(Some(Outcome {
        kind: of.kind.to_owned(),
        wanted: wanted.get(),
        error: error(of, &found.estimate, found.every),
        stated: found.choice.reached,
        is_reached: found.choice.is_reached,
        chosen: own,
        all: total,
        cheapest: ms,
        what: [format!("{what} ({:.0} a natural time)", of.density), cheapest],
    }))
}

fn name(options: &ContactOptions, every: usize) -> String {
    let space = if options.planar { "planar" } else { "spatial" };
    let friction = if options.friction == Some(0.0) { "frictionless" } else { "any friction" };
    let body = if options.body.is_some() { "known" } else { "unknown" };
    format!("{space}, {friction}, {body}, one of {every}")
}

/// Every model: in the plane and in space, without friction and with any, of a known body and an unknown, thinned. The one that is true of the log
/// and of a known body comes first; where it is not relied on, or states nothing near enough, there is no more.
fn all(of: &Logged) -> Result<Vec<Tried>, Failure> {
    let mut all: Vec<Tried> = Vec::new();
    let frictions = if of.rubs { [None, Some(0.0)] } else { [Some(0.0), None] };
    let planes: &[bool] = if of.is_planar { &[true, false] } else { &[false] };
    for &planar in planes {
        for friction in frictions {
            for body in [of.options.body, None] {
                for every in EVERY.into_iter().filter(|k| *k == 1 || of.density / *k as f64 >= LEFT) {
                    let options = ContactOptions { planar, friction, body, ..of.options };
                    let (ms, stated) = timed(of, &options, every)?;
                    let serves = stated.is_some_and(|stated| stated * ABOVE < LOOSEST);
                    if all.is_empty() && !serves {
                        return Ok(all);
                    }
                    all.push(Tried { ms, stated, name: name(&options, every) });
                    // Fewer samples are not enough where all are not, and what takes ten times as long as another is not the cheapest.
                    let cheapest = all.iter().map(|of| of.ms).fold(f64::INFINITY, f64::min);
                    if stated.is_none() || ms > DEAR * cheapest {
                        break;
                    }
                }
            }
        }
    }
    Ok(all)
}

/// Processor time, ms, and the stated accuracy where it is relied on.
fn timed(of: &Logged, options: &ContactOptions, every: usize) -> Result<(f64, Option<f64>), Failure> {
    let clock = ProcessTime::now();
    let found = estimate_contacts(&one_of(&of.log, every)?, None, options);
    let ms = 1e3 * clock.elapsed().as_secs_f64();
    let found = found.ok().filter(|found| found.reliability.is_reliable());
    Ok((ms, found.map(|found| stated_accuracy(&found, of.size))))
}

/// Root mean square errors of place, in sizes, and turn since the first sample, rad: the larger one.
fn error(of: &Logged, found: &ContactEstimate, every: usize) -> f64 {
    let truth: Vec<_> = of.truth.iter().step_by(every).collect();
    let (Some(first), Some(own)) = (truth.first(), found.states.first()) else { return f64::INFINITY };
    let (mut place, mut turn) = (0.0, 0.0);
    for (state, truth) in found.states.iter().zip(&truth) {
        place += (state.p_WCm.distance(truth.p_WCm) / of.size).powi(2);
        let pose = |R_WO| Pose { p_WCm: glam::DVec3::ZERO, R_WO };
        let turned = pose(state.R_WO * own.R_WO.inverse());
        turn += turned.off(&pose(truth.R_WO * first.R_WO.inverse()), 1.0).powi(2);
    }
    let count = found.states.len().max(1) as f64;
    (place / count).sqrt().max((turn / count).sqrt())
}
