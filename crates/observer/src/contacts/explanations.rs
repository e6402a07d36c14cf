//! Which of the things that were taken as known is wrong, where a log contradicts them: each alone is let go, and what that explains is weighed
//! against how much it could have explained.
//!
//! The evidence of a hypothesis is the probability that it gave the readings, over all values that it allows (MacKay, Information Theory, Inference,
//! and Learning Algorithms, 28.1): with a constant free the fit is never worse, but its likelihood counts for the share of the constant's range alone in which
//! it is as good (Laplace's approximation). Scores to first order tell what to try; each hypothesis is then solved on a log that has the constant otherwise.

use super::body::CONSTANTS;
use super::problem::{Problem, Unknowns};
use super::solve::{Solved, solve};
use super::suspects::{Scores, Sensors};
use crate::faults::{Assumption, Constant, Explanation, Suspect};
use std::f64::consts::{PI, TAU};

/// Half the width, in natural units, within which half of all wrong constants are: a heavy-tailed distribution, so that what is off by far more is less
/// probable beforehand by the square of that alone.
const USUAL: f64 = 0.03;
/// The same of the logarithm of a factor of the noise.
const USUAL_NOISE: f64 = 1.0;
/// How often each constant is corrected at most, and each of those that explain most then; how many these are.
const ROUNDS: [usize; 2] = [2, 12];
const KEPT: usize = 5;
/// How many are corrected at all: those by most of their deviations to first order.
const TRIED: usize = 8;
/// The share of its deviation that is no correction, and by how much one that made it worse is shortened.
const CORRECTED: f64 = 0.1;
const SHORTER: f64 = 0.3;
/// Natural units up to which a constant may be off.
const FARTHEST: f64 = 1.0;
/// Linearisations of each solution, and what a step of it promises: twice what it may be off by in a logarithm of odds.
const MOST: usize = 30;
const ENOUGH: f64 = 0.1;

/// What is found with the body's mass and inertia free, where they contradict the stated ones.
pub(super) struct FreeBody {
    pub(super) cost: f64,
    /// Factor of the mass less 1.
    pub(super) mass: f64,
    /// Departures and deviations of the logarithms of its mass and of the roots of its second moments.
    pub(super) departures: Vec<(f64, f64)>,
}

/// All that are tried, the most probable first; that nothing is wrong is one of them.
pub(super) fn explanations(
    sensors: &Sensors,
    problem: &Problem,
    solved: &Solved<CONSTANTS>,
    suspects: &[Suspect],
    body: Option<&FreeBody>,
) -> Vec<Explanation> {
    let conditions = solved.equations.conditions.max(1) as f64;
    let stated = solved.equations.cost;
    let mut all =
        vec![Tried { assumption: Assumption::None, value: 0.0, deviation: 0.0, cost: stated, could: 0.0 }];
    all.extend(noise(stated, conditions));
    match body {
        Some(body) => all.push(other_body(body)),
        None => all.extend(suspects.iter().filter_map(|suspect| of_stated_body(suspect, stated))),
    }
    all.extend(wrong_sensors(sensors, problem, solved));
    // What even the best leaves unexplained makes all of them less certain.
    let explains = |tried: &&Tried| tried.assumption != Assumption::Noise;
    let least = all.iter().filter(explains).map(|tried| tried.cost).fold(f64::INFINITY, f64::min);
    let scale = (least / conditions).max(1.0);
    let told = |tried: Tried| Explanation {
        assumption: tried.assumption,
        value: tried.value,
        deviation: tried.deviation * scale.sqrt(),
        misfit: if tried.assumption == Assumption::Noise { 1.0 } else { tried.cost / conditions },
        log_odds: 0.5 * (stated - tried.cost) / scale + tried.could,
    };
    let mut all: Vec<Explanation> = all.into_iter().map(told).collect();
    all.sort_by(|a, b| b.log_odds.total_cmp(&a.log_odds));
    all
}

struct Tried {
    assumption: Assumption,
    value: f64,
    deviation: f64,
    /// Chi-squared that is left; of another noise, minus twice its logarithm of likelihood beside that of the one that was stated.
    cost: f64,
    /// Logarithm of the share of what it allows in which it explains as much.
    could: f64,
}

/// Logarithm of the share of a Cauchy distribution of half width `usual` that lies within a normal one at `value`.
fn share(value: f64, deviation: f64, usual: f64) -> f64 {
    let density = usual / (PI * (usual * usual + value * value));
    (TAU.sqrt() * deviation * density).max(f64::MIN_POSITIVE).ln().min(0.0)
}

/// All readings are noisier by one factor, where they are.
fn noise(cost: f64, conditions: f64) -> Option<Tried> {
    let factor = cost / conditions;
    if factor.is_nan() || factor <= 1.0 {
        return None;
    }
    let deviation = (2.0 / conditions).sqrt();
    Some(Tried {
        assumption: Assumption::Noise,
        value: factor.sqrt() - 1.0,
        deviation: 0.5 * deviation * factor.sqrt(),
        cost: conditions * (1.0 + factor.ln()),
        could: share(factor.ln(), deviation, USUAL_NOISE),
    })
}

fn other_body(body: &FreeBody) -> Tried {
    let could = body.departures.iter().map(|&(value, deviation)| share(value, deviation, USUAL)).sum();
    let deviation = body.departures.first().map_or(0.0, |(_, deviation)| *deviation);
    Tried { assumption: Assumption::Body, value: body.mass, deviation, cost: body.cost, could }
}

/// One constant of a stated body that nothing else speaks against: to first order, as it is off by little then.
fn of_stated_body(suspect: &Suspect, stated: f64) -> Option<Tried> {
    let Suspect { fault, value, deviation, .. } = *suspect;
    let told = fault.is_of_body() && deviation.is_finite();
    told.then(|| Tried {
        assumption: Assumption::One(fault),
        value,
        deviation,
        cost: stated - suspect.score().powi(2),
        could: share(value, deviation, USUAL),
    })
}

/// Constants of the sensors of which the data tell, each solved for: those that explain most with their first corrections to the end.
fn wrong_sensors(sensors: &Sensors, problem: &Problem, stated: &Solved<CONSTANTS>) -> Vec<Tried> {
    let Some(scores) = Scores::new(sensors, problem, stated) else { return Vec::new() };
    let begun = |fault| {
        let first = scores.of(fault, 0.0)?;
        let begun = Correction {
            fault,
            value: 0.0,
            step: first.value,
            deviation: first.deviation,
            unknowns: stated.unknowns.clone(),
            cost: stated.equations.cost,
            misfit: stated.misfit(),
        };
        first.deviation.is_finite().then_some(begun)
    };
    let mut all: Vec<Correction> = sensors.constants(problem).into_iter().filter_map(begun).collect();
    all.sort_by(|a, b| b.by_deviations().total_cmp(&a.by_deviations()));
    all.truncate(TRIED);
    for rounds in ROUNDS {
        for correction in &mut all {
            (0..rounds).any(|_| correction.goes_on(sensors, problem).is_none());
        }
        all.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        all.truncate(KEPT);
    }
    if let Some(late) = all.iter_mut().find(|correction| correction.fault == Constant::ForceDelay) {
        late.by_samples(sensors, problem);
    }
    all.iter().map(|correction| correction.told(problem)).collect()
}

/// A constant on its way to where it no longer contradicts the log.
struct Correction {
    fault: Constant,
    value: f64,
    /// What it is to be corrected by next.
    step: f64,
    deviation: f64,
    unknowns: Unknowns,
    cost: f64,
    misfit: f64,
}

impl Correction {
    /// What is to be corrected, in its deviations.
    fn by_deviations(&self) -> f64 {
        self.step.abs() / self.deviation
    }

    /// By one correction; none where there is no more to gain.
    fn goes_on(&mut self, sensors: &Sensors, problem: &Problem) -> Option<()> {
        let enough = CORRECTED * self.deviation * self.misfit.max(1.0).sqrt();
        if self.step.abs() < enough {
            return None;
        }
        let next = self.at(self.value + self.step, sensors, problem)?;
        // A first order may promise too much.
        if next.cost > self.cost {
            self.step *= SHORTER
        } else {
            *self = next
        }
        Some(())
    }

    /// By times from sample to sample as long as that explains more. Forces that are late jump from sample to sample, of which their slopes tell nothing.
    fn by_samples(&mut self, sensors: &Sensors, problem: &Problem) {
        let each = sensors.interval();
        for step in [each, -each] {
            while let Some(next) =
                self.at(self.value + step, sensors, problem).filter(|next| next.cost < self.cost)
            {
                *self = next;
            }
        }
    }

    /// With another value.
    fn at(&self, value: f64, sensors: &Sensors, problem: &Problem) -> Option<Self> {
        let fault = self.fault;
        if value.is_nan() || value.abs() > FARTHEST * fault.natural(&problem.units) {
            return None;
        }
        let record = sensors.without(fault, value);
        let own = problem.on(&record);
        let solved = solve::<CONSTANTS>(&own, self.unknowns.clone(), MOST, ENOUGH)?;
        let sensors = sensors.of_body(solved.unknowns.body);
        let score = Scores::new(&sensors, &own, &solved)?.of(fault, value)?;
        let (cost, misfit) = (solved.equations.cost, solved.misfit());
        let (step, deviation) = (score.value, score.deviation);
        deviation.is_finite().then_some(Self {
            fault,
            value,
            step,
            deviation,
            unknowns: solved.unknowns,
            cost,
            misfit,
        })
    }

    fn told(&self, problem: &Problem) -> Tried {
        let Self { fault, value, deviation, cost, .. } = *self;
        let natural = fault.natural(&problem.units);
        let could = share(value / natural, deviation / natural, USUAL);
        Tried { assumption: Assumption::One(fault), value, deviation, cost, could }
    }
}
