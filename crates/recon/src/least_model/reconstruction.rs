//! The cheapest estimate of a motion whose stated bound is below the wanted accuracy.

mod told;

use super::left_out::{is_frictionless, is_planar, out_of_balance};
use super::thinned::one_of;
use super::{Accuracy, Alternative, Choice, Decision, Evidence, Model, Question};
use glam::DVec3;
use object_dynamics::{ContactLog, SensedAxes};
use observer::contacts::{ContactEstimate, ContactEstimateError, ContactOptions, estimate_contacts};
use std::time::Instant;

/// What the root mean square of errors, each normally distributed, stays below with a probability of 97.5 %, over the root of their mean variance:
/// of all weighted sums of squares with one mean a single one goes farthest (Szekely and Bakirov 2003), so that it is the
/// 0.9875 quantile of a normal number. Of position and orientation both stay below with 95 %.
const QUANTILE: f64 = 2.2414;
/// Samples in a natural time that are left: with twice as many cost grows with their number, with fewer contacts are no longer averaged where they
/// are noisy, which takes five times as long.
const DENSE: f64 = 125.0;
/// How much better than predicted a bound is asked for, as the one at another thinning scatters.
const MARGIN: f64 = 1.15;
/// What a known body makes of a bound, at best: 0.2 was seen.
const BETTER_KNOWN: f64 = 0.2;
/// Estimates at most.
const TRIALS: usize = 6;

/// A motion and the model that it was estimated by.
#[derive(Clone, Debug)]
pub struct LeastEstimate {
    /// The estimate, at the samples that it was made from.
    pub estimate: ContactEstimate,
    /// One of so many samples of the log.
    pub every: usize,
    /// What the estimator was told.
    pub options: ContactOptions,
    /// Why.
    pub choice: Choice,
}

/// Natural size of a body by its contacts: root mean square of the distance of contacts from the mean of those at the same time, m.
#[must_use]
pub fn contact_size(log: &ContactLog) -> f64 {
    let (mut squares, mut count) = (0.0, 0.0_f64);
    for k in 0..log.times().len() {
        let contacts: Vec<DVec3> =
            log.palms().iter().filter_map(|palm| palm.touch(k)).map(|touch| touch.p_WC).collect();
        let mean = contacts.iter().sum::<DVec3>() / contacts.len().max(1) as f64;
        squares += contacts.iter().map(|c| c.distance_squared(mean)).sum::<f64>();
        count += contacts.len() as f64;
    }
    (squares / count.max(1.0)).sqrt()
}

/// The accuracy that an estimate states of itself: with a probability of 95 % errors are below, root mean square over all samples, of the centre of
/// mass in sizes and of the turn since the first sample in rad.
#[must_use]
pub fn stated_accuracy(found: &ContactEstimate, size: f64) -> f64 {
    let mean = |i: usize| {
        found.deviations.iter().map(|of| of[i].length_squared()).sum::<f64>()
            / found.deviations.len().max(1) as f64
    };
    QUANTILE * (mean(0).sqrt() / size).max(mean(3).sqrt())
}

/// What is modelled.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Setting {
    planar: bool,
    frictionless: bool,
    known: bool,
    every: usize,
}

/// What came of it.
struct Trial {
    setting: Setting,
    seconds: f64,
    /// Accuracy that it states; none where it came to an error.
    accuracy: Option<f64>,
    reliable: bool,
}

/// The cheapest estimate of a log that states an accuracy as good as `wanted`, or the best there is: begun with what costs least (mass and
/// inertia unknown, some hundreds of samples in a natural time, no friction and no third dimension where tests find neither), and going on to
/// what costs more where the stated accuracy is not enough or the estimate is not to be relied on. `options.body` is the body as it is stated, if it is.
///
/// # Errors
/// Those of the estimator where no model leads to an estimate.
pub fn least_estimate(
    log: &ContactLog,
    options: &ContactOptions,
    wanted: Accuracy,
) -> Result<LeastEstimate, ContactEstimateError> {
    let clock = Instant::now();
    let mut search = Search::new(log, options, wanted);
    let mut setting = search.first();
    let mut best: Option<(ContactEstimate, usize)> = None;
    let mut failed = None;
    for _ in 0..TRIALS {
        match search.run(setting) {
            Ok(found) => {
                let last = search.trials.len() - 1;
                if best.as_ref().is_none_or(|(_, other)| search.is_better(last, *other)) {
                    best = Some((found, last));
                }
            }
            Err(error) => failed = Some(error),
        }
        match search.next() {
            Some(next) => setting = next,
            None => break,
        }
    }
    let Some((estimate, chosen)) = best else {
        return Err(failed.unwrap_or(ContactEstimateError::Singular));
    };
    let choice = search.choice(chosen, &estimate, clock.elapsed().as_secs_f64());
    let setting = search.trials[chosen].setting;
    Ok(LeastEstimate { estimate, every: setting.every, options: search.options_of(setting), choice })
}

struct Search<'a> {
    log: &'a ContactLog,
    options: &'a ContactOptions,
    wanted: Accuracy,
    /// m.
    size: f64,
    /// Samples in a natural time.
    density: f64,
    planar: Evidence,
    frictionless: Evidence,
    trials: Vec<Trial>,
}

impl<'a> Search<'a> {
    fn new(log: &'a ContactLog, options: &'a ContactOptions, wanted: Accuracy) -> Self {
        let size = options.size.unwrap_or_else(|| contact_size(log));
        let natural = (size / options.gravity).sqrt();
        let density = (log.times().len() - 1) as f64 / log.duration() * natural;
        let given =
            |stated: bool, test: &dyn Fn() -> Evidence| if stated { Evidence::Stated } else { test() };
        let planar = given(options.planar, &|| is_planar(log, &options.noise));
        let all_known = log.palms().iter().all(|palm| palm.friction().or(options.friction).is_some());
        let frictionless = given(all_known, &|| is_frictionless(log, &options.noise));
        Self { log, options, wanted, size, density, planar, frictionless, trials: Vec::new() }
    }

    fn first(&self) -> Setting {
        // Where noise does not limit, what happens between samples does, which thinning makes worse by high powers.
        let noisy = self.options.noise.contact > 0.0 && !self.is_exact();
        let every = if noisy { (self.density / DENSE) as usize } else { 1 };
        Setting {
            planar: self.options.planar || self.planar.is_passed_test(),
            frictionless: self.frictionless.is_passed_test(),
            known: false,
            every: every.max(1),
        }
    }

    /// Whether noise of contacts is below what conditions are off by beside it.
    fn is_exact(&self) -> bool {
        let noise = &self.options.noise;
        noise.contact <= noise.floor * (self.size / self.options.gravity).sqrt()
    }

    fn options_of(&self, setting: Setting) -> ContactOptions {
        ContactOptions {
            planar: setting.planar,
            friction: if setting.frictionless { Some(0.0) } else { self.options.friction },
            body: self.options.body.filter(|_| setting.known),
            ..*self.options
        }
    }

    fn run(&mut self, setting: Setting) -> Result<ContactEstimate, ContactEstimateError> {
        let clock = Instant::now();
        let options = self.options_of(setting);
        let found = match one_of(self.log, setting.every) {
            Ok(log) => estimate_contacts(&log, None, &options),
            Err(_) => Err(ContactEstimateError::Short { samples: self.log.times().len() / setting.every }),
        };
        let accuracy = found.as_ref().ok().map(|found| stated_accuracy(found, self.size));
        let reliable = found.as_ref().is_ok_and(|found| found.reliability.is_reliable());
        let accuracy = accuracy.filter(|of| of.is_finite());
        self.trials.push(Trial { setting, seconds: clock.elapsed().as_secs_f64(), accuracy, reliable });
        found
    }

    fn serves(&self, trial: &Trial) -> bool {
        trial.reliable && trial.accuracy.is_some_and(|of| of <= self.wanted.get())
    }

    /// Whether one trial is to be preferred to another: relied on, then nearer.
    fn is_better(&self, one: usize, other: usize) -> bool {
        let rank = |i: usize| {
            let trial = &self.trials[i];
            (!trial.reliable, trial.accuracy.unwrap_or(f64::INFINITY))
        };
        rank(one) < rank(other)
    }

    /// What to try after the last trial; none where that serves, or nothing is left.
    fn next(&self) -> Option<Setting> {
        let last = self.trials.last()?;
        if self.serves(last) {
            return None;
        }
        let of = last.setting;
        let tried = |setting: &Setting| self.trials.iter().any(|trial| trial.setting == *setting);
        let found = match last.accuracy.filter(|_| last.reliable) {
            // What was left out may be what it suffers from.
            None => self.richer(of),
            Some(accuracy) => self.nearer(of, accuracy),
        };
        found.filter(|setting| !tried(setting))
    }

    /// What else could be known or modelled, the likeliest first.
    fn richer(&self, of: Setting) -> Option<Setting> {
        if self.options.body.is_some() && !of.known {
            Some(Setting { known: true, ..of })
        } else if of.frictionless {
            Some(Setting { frictionless: false, ..of })
        } else if of.planar && !self.options.planar {
            Some(Setting { planar: false, ..of })
        } else {
            (of.every > 1).then_some(Setting { every: 1, ..of })
        }
    }

    /// What is known better, by the body as it is stated where that may be enough, else by more samples.
    fn nearer(&self, of: Setting, accuracy: f64) -> Option<Setting> {
        let wanted = self.wanted.get();
        // White noise: a bound goes with the root of the time between samples.
        let short = MARGIN * accuracy / wanted;
        let needed = (of.every as f64 / (short * short)) as usize;
        let known = self.options.body.is_some() && !of.known;
        let of_all = accuracy / (of.every as f64).sqrt();
        let worth = 2 * needed < of.every && BETTER_KNOWN * of_all <= wanted;
        // With all samples there is nothing else, even if only to tell what can be reached.
        if known && (worth || of.every == 1) {
            return Some(Setting { known: true, ..of });
        }
        (of.every > 1).then(|| Setting { every: needed.clamp(1, of.every - 1), ..of })
    }

    fn choice(&self, chosen: usize, estimate: &ContactEstimate, seconds: f64) -> Choice {
        let trial = &self.trials[chosen];
        Choice {
            wanted: self.wanted,
            reached: trial.accuracy.unwrap_or(f64::MAX),
            is_reached: self.serves(trial),
            decisions: self.decisions(chosen, estimate),
            seconds,
        }
    }
}
