//! One contact through a whole log: its evidence for each friction, and its modes given one.

use super::bins::Bins;
use super::chain::Chain;
use super::classifier::{ContactOdds, FIRST};
use super::contact::{Force, SlipRead};
use super::doubt::{Left, Told};
use super::foretold::Foretold;
use super::friction::{Cell, SURE, whole_bins};
use super::late::{Brought, Late};
use super::likelihood::{Likelihood, Part};
use super::options::ContactModesOptions;
use super::reading::{ContactReading, ContactSeen, ContactSlip, turned};
use super::steps::{SAME as KIND, Steps, speeds};

/// Logarithm of the odds against a friction at which it is given up: given the model it would come back once in 10^26. They are odds against the
/// largest friction, of which a contact sticks whatever it does: one that looks like a friction for a while, where a ratio stays the same, is
/// far ahead of the true one there, and would have it given up before it fails itself.
const GIVEN_UP: f64 = 60.0;
/// From one friction to the next of those that are tried first, in steps of all; a power of two.
const COARSE: usize = 8;
/// Neighbours nearer to each other foretell what is between them; what is so far below the most probable one is of no account.
const SAME: f64 = 0.1;
const NO_ACCOUNT: f64 = 25.0;
/// Of how many readings of a ratio one next to a friction is enough to try that.
const DWELT: usize = 20;
/// Samples from one look for such frictions to the next.
const LOOKS: usize = 8;

/// Steps in time, each kind once.
pub(super) struct Pace {
    /// A time step of each kind, s.
    kinds: Vec<f64>,
    /// The kind of the step before each sample.
    kind: Vec<usize>,
    /// Duration of the step before each sample, s.
    steps: Vec<f64>,
    /// Power of the density of a slip at each sample: errors that last tell less often.
    weights: Vec<f64>,
    /// Bins of the speed.
    speeds: Bins,
}

impl Pace {
    /// Of the times of samples.
    pub(super) fn new(times: &[f64], options: &ContactModesOptions) -> Self {
        let mut kinds: Vec<f64> = Vec::new();
        let step = |k: usize| if k == 0 { FIRST } else { times[k] - times[k - 1] };
        let steps: Vec<f64> = (0..times.len()).map(step).collect();
        let mut kind = Vec::with_capacity(times.len());
        for dt in &steps {
            let known = kinds.iter().position(|kind| (dt - kind).abs() <= KIND * kind);
            kind.push(known.unwrap_or(kinds.len()));
            if known.is_none() {
                kinds.push(*dt);
            }
        }
        let mut weights: Vec<f64> = steps.iter().map(|dt| options.slip_weight(*dt)).collect();
        if let [first, second, ..] = &mut weights[..] {
            *first = *second;
        }
        Self { kinds, kind, steps, weights, speeds: speeds() }
    }

    /// What happens to a contact with this friction.
    pub(super) fn at(&self, friction: f64) -> AtFriction {
        AtFriction {
            friction,
            steps: self.kinds.iter().map(|dt| Steps::of_friction(*dt, friction)).collect(),
        }
    }

    /// Time for which a contact slid for sure, with its slip read, s.
    pub(super) fn slid(&self, odds: &[ContactOdds], seen: &[ContactSeen]) -> f64 {
        let read =
            |seen: &ContactSeen| matches!(seen, ContactSeen::Read(ContactReading { slip: Some(_), .. }));
        let sure = odds.iter().zip(seen).zip(&self.steps);
        sure.filter(|((odds, seen), _)| odds.slide >= SURE && read(seen)).map(|(_, dt)| dt).sum()
    }
}

impl Pace {
    /// What a contact's modes leave of what was read of it; `friction` where it is known.
    pub(super) fn left(
        &self,
        odds: &[ContactOdds],
        seen: &[ContactSeen],
        friction: Option<f64>,
        options: &ContactModesOptions,
    ) -> Left {
        let at = friction.map(|friction| self.at(friction));
        let speed = options.natural_speed;
        let mut left = Left::new(at.as_ref().map(|at| Late::new(&at.steps[0], speed)));
        let mut foretold = Foretold::default();
        for (k, seen) in seen.iter().enumerate() {
            let reading = seen.reading();
            let mut force = seen.force(options);
            foretold.tell(self.steps[k], &mut force);
            let slip = reading.and_then(|reading| reading.slip.zip(Some(reading.direction())));
            let turned = slip.map(|(slip, (u, _))| turned(&slip.velocity, &slip.covariance, &u, speed));
            let slip = slip.map(|(slip, _)| (slip, self.weights[k]));
            let brought = Brought { dt: self.steps[k], times: 1, force: &force, reading, slip };
            let told = Told { odds: odds[k], friction, slip: turned, brought };
            left.take(&told, at.as_ref().map(|at| &at.steps[self.kind[k]]));
        }
        left
    }
}

/// What happens to a contact with some friction: the same for all contacts.
pub(super) struct AtFriction {
    friction: f64,
    /// In a step of each kind.
    steps: Vec<Steps>,
}

/// What a sample says beside the ratio: the force, and log-densities of the slip, where one is read.
struct Said {
    force: Force,
    by_slip: Option<Likelihood>,
    /// What the ratio says in the bins that all frictions have.
    of_all: Option<Part>,
}

/// One contact through a whole log.
pub(super) struct Passage {
    said: Vec<Said>,
}

impl Passage {
    pub(super) fn new(seen: &[ContactSeen], pace: &Pace, options: &ContactModesOptions) -> Self {
        let mut foretold = Foretold::default();
        let bins = whole_bins();
        let one = |(k, seen): (usize, &ContactSeen)| {
            let mut said = Said::new(seen, pace, k, options);
            foretold.tell(pace.steps[k], &mut said.force);
            if let Force::Presses { ratio, foretold, .. } = &said.force {
                let mut of_all = Part::none(bins.count());
                of_all.of_bins(&bins, ratio, foretold);
                said.of_all = Some(of_all);
            }
            said
        };
        let said = seen.iter().enumerate().map(one).collect();
        Self { said }
    }

    /// Logarithm of the density of all that was read, for each friction, which grow evenly; of those that are given up, as little as is of
    /// no account. Few are gone through the log with at first, and more between where their neighbours do not foretell what comes of it.
    pub(super) fn evidence(&self, pace: &Pace, frictions: &[AtFriction]) -> Vec<f64> {
        let last = frictions.len() - 1;
        let mut logs = vec![None; frictions.len()];
        let always = self.looks(pace, &frictions[last]);
        let mut first: Vec<usize> = (0..last).step_by(COARSE).chain([last]).collect();
        first.extend(self.dwelt_at(frictions));
        first.sort_unstable();
        first.dedup();
        self.try_all(pace, frictions, &first, &always, &mut logs);
        let mut stride = COARSE;
        while stride > 1 {
            stride /= 2;
            let between: Vec<usize> = (1..).map(|i| (2 * i - 1) * stride).take_while(|k| *k < last).collect();
            let foretold: Vec<Option<f64>> = between.iter().map(|k| foretold(&logs, *k, stride)).collect();
            let is_open = |(k, log): &(&usize, &Option<f64>)| log.is_none() && logs[**k].is_none();
            let open: Vec<usize> = between.iter().zip(&foretold).filter(is_open).map(|(k, _)| *k).collect();
            self.try_all(pace, frictions, &open, &always, &mut logs);
            for (k, log) in between.into_iter().zip(foretold) {
                logs[k] = logs[k].or(log);
            }
        }
        let most = logs.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
        logs.into_iter().map(|log| log.unwrap_or(f64::NEG_INFINITY).max(most - GIVEN_UP)).collect()
    }

    /// Frictions next to which ratios dwell. Where forces are good, that at which a contact slides stands alone among others that are given up, and neighbours do not
    /// foretell it.
    fn dwelt_at<'a>(&self, frictions: &'a [AtFriction]) -> impl Iterator<Item = usize> + 'a {
        let mut counts = vec![0; frictions.len()];
        let mut all = 0;
        for said in &self.said {
            let Force::Presses { ratio, .. } = &said.force else { continue };
            all += 1;
            let above = frictions.partition_point(|at| at.friction < ratio.size);
            let near = [above.checked_sub(1), Some(above)].into_iter().flatten();
            near.filter(|k| *k < frictions.len()).for_each(|k| counts[k] += 1);
        }
        let dwells = move |k: &usize| DWELT * counts[*k] > all;
        (0..frictions.len()).filter(dwells)
    }

    /// Logarithm of the density of what was read up to each look, at one friction.
    fn looks(&self, pace: &Pace, at: &AtFriction) -> Vec<f64> {
        let mut tried = Tried::new(at);
        let all = self.said.iter().enumerate().map(|(k, said)| {
            tried.take(pace, k, said);
            tried.log
        });
        all.step_by(LOOKS).collect()
    }

    /// The same of all that was read for some frictions, into `logs`, but for those that fall far behind `always` at some look.
    fn try_all(
        &self,
        pace: &Pace,
        frictions: &[AtFriction],
        some: &[usize],
        always: &[f64],
        logs: &mut [Option<f64>],
    ) {
        for &friction in some {
            let mut tried = Tried::new(&frictions[friction]);
            let lasts = self.said.iter().enumerate().all(|(k, said)| {
                tried.take(pace, k, said);
                k % LOOKS > 0 || tried.log > always[k / LOOKS] - GIVEN_UP
            });
            logs[friction] = Some(if lasts { tried.log } else { f64::NEG_INFINITY });
        }
    }

    /// Adds the modes at all samples given one friction, with a weight; returns where in its cell that is.
    pub(super) fn add(&self, pace: &Pace, friction: f64, weight: f64, sums: &mut [[f64; 3]]) -> Cell {
        let at = pace.at(friction);
        let mut tried = Tried::new(&at);
        let mut before = Vec::with_capacity(self.said.len());
        for (k, said) in self.said.iter().enumerate() {
            let cell = tried.cell;
            tried.take(pace, k, said);
            before.push((tried.chain.clone(), cell));
        }
        let Tried { mut spare, mut likelihood, cell: learned, .. } = tried;
        let steps = &at.steps;
        let mut worth = Chain::even(&steps[0], 1.0);
        for (k, (chain, cell)) in before.iter().enumerate().rev() {
            let modes = chain.times(&worth);
            let all: f64 = modes.iter().sum();
            // Where past and future exclude each other in double precision, the past counts.
            let (modes, all) = match all > 0.0 && all.is_finite() {
                true => (modes, all),
                false => ([chain.off, chain.slides(), chain.sticks()], 1.0),
            };
            sums[k].iter_mut().zip(modes).for_each(|(sum, mode)| *sum += weight * mode / all);
            let steps = &steps[pace.kind[k]];
            self.said[k].of(steps, cell, &mut likelihood);
            worth.unread(&likelihood);
            worth.before(steps, &mut spare);
        }
        learned
    }
}

/// What is between the frictions `k - stride` and `k + stride`, where both sides come to the same or it is of no account.
fn foretold(logs: &[Option<f64>], k: usize, stride: usize) -> Option<f64> {
    let end = |k: Option<usize>| k.and_then(|k| logs.get(k).copied().flatten());
    let [below, above] = [end(k.checked_sub(stride)), end(Some(k + stride)).or(*logs.last()?)];
    let (below, above) = (below?, above?);
    // Between a friction that is too low and one that is not is where a contact slides, however little is thought of both.
    if below.is_finite() != above.is_finite() {
        return None;
    }
    let between = 0.5 * (below + above);
    let on = |near: f64, far: Option<f64>| far.map_or(near, |far| near + 0.5 * (near - far));
    let from = [on(below, end(k.checked_sub(3 * stride))), on(above, end(Some(k + 3 * stride)))];
    let most = logs.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
    let all = [below, above, from[0], from[1]];
    // From two that are given up nothing follows.
    let nothing = all.iter().all(|log| log.is_nan() || *log <= most - NO_ACCOUNT);
    let same = from.iter().chain(&[below, above]).all(|log| (log - between).abs() < SAME);
    if nothing {
        Some(below.min(above))
    } else if same {
        Some(between)
    } else {
        None
    }
}

/// A friction that is tried.
struct Tried<'a> {
    at: &'a AtFriction,
    chain: Chain,
    cell: Cell,
    spare: Chain,
    likelihood: Likelihood,
    /// Logarithm of the density of what was read until now.
    log: f64,
}

impl<'a> Tried<'a> {
    fn new(at: &'a AtFriction) -> Self {
        let first = &at.steps[0];
        let (chain, likelihood) = (Chain::new(first), Likelihood::none(first.ratios.count()));
        Self { at, spare: chain.clone(), chain, cell: Cell::new(at.friction), likelihood, log: 0.0 }
    }

    fn take(&mut self, pace: &Pace, k: usize, said: &Said) {
        let steps = &self.at.steps[pace.kind[k]];
        if k > 0 {
            self.chain.predict(steps, &mut self.spare);
        }
        said.of(steps, &self.cell, &mut self.likelihood);
        self.log += self.chain.weigh(&self.likelihood, &mut self.spare);
        if let Force::Presses { ratio, .. } = &said.force {
            self.cell.learn(ratio, self.chain.at_friction());
        }
    }
}

impl Said {
    fn new(seen: &ContactSeen, pace: &Pace, k: usize, options: &ContactModesOptions) -> Self {
        let by_slip = seen.reading().and_then(|reading| {
            let ContactSlip { velocity, covariance } = reading.slip?;
            let (u, turn) = reading.direction();
            let slip = turned(&velocity, &covariance, &u, options.natural_speed);
            let mut by_slip = Likelihood::none(1);
            by_slip.of_slip(&SlipRead { slip, turn, weight: pace.weights[k] }, &pace.speeds);
            Some(by_slip)
        });
        Self { force: seen.force(options), by_slip, of_all: None }
    }

    /// Log-densities of all that is read, in each cell; the factor that all modes that touch have in common is the same for all frictions.
    fn of(&self, steps: &Steps, cell: &Cell, likelihood: &mut Likelihood) {
        likelihood.of_force(steps, &self.force, cell, self.of_all.as_ref());
        if let (Some(by_slip), false) = (&self.by_slip, matches!(self.force, Force::Off)) {
            likelihood.add_slip(by_slip);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::ContactSlip;
    use super::super::friction::values;
    use super::*;
    use crate::random::Normal;
    use nalgebra::{Matrix2, Vector2};

    /// What few frictions foretell is what all of them come to, of contacts that slide, that stick and that do both.
    #[test]
    fn few_frictions_tell_what_all_do() {
        let options = ContactModesOptions::new(0.6, 0.01, 1.0);
        let times: Vec<f64> = (0..200).map(|k| 1e-3 * f64::from(k)).collect();
        let pace = Pace::new(&times, &options);
        let at: Vec<AtFriction> = values().iter().map(|friction| pace.at(*friction)).collect();
        for (case, [begin, end, slips, noise]) in
            [[0.3, 0.3, 1.0, 0.02], [0.1, 0.25, 0.0, 0.02], [0.2, 0.5, 0.5, 0.01], [0.47, 0.47, 1.0, 2e-3]]
                .iter()
                .enumerate()
        {
            let mut normal = Normal::seeded(case as u64);
            let seen: Vec<ContactSeen> = (0..times.len())
                .map(|k| {
                    let s = k as f64 / times.len() as f64;
                    let slip = if s > 1.0 - slips { 0.1 } else { 0.0 };
                    let ratio = if slip > 0.0 { *end } else { begin + (end - begin) * s };
                    let mut draw = || Vector2::new(normal.draw(), normal.draw());
                    let friction = Vector2::new(ratio, 0.0) + draw() * *noise;
                    let velocity = Vector2::new(-slip, 0.0) + draw() * 2e-3;
                    let slip = Some(ContactSlip { velocity, covariance: Matrix2::identity() * 4e-6 });
                    let (normal_force, force_deviation) = (1.0 + noise * draw().x, *noise);
                    ContactSeen::Read(ContactReading {
                        normal_force,
                        friction,
                        force_deviation,
                        slip,
                        touches: true,
                    })
                })
                .collect();
            let passage = Passage::new(&seen, &pace, &options);
            let few = passage.evidence(&pace, &at);
            let mut all = vec![None; at.len()];
            let every: Vec<usize> = (0..at.len()).collect();
            passage.try_all(&pace, &at, &every, &[f64::NEG_INFINITY; 30], &mut all);
            let most = all.iter().flatten().copied().fold(f64::NEG_INFINITY, f64::max);
            let counts = all.iter().flatten().zip(&few).filter(|(log, _)| **log > most - 0.5 * NO_ACCOUNT);
            let off = counts.map(|(log, few)| (log - few).abs()).fold(0.0, f64::max);
            assert!(off < 0.5 * SAME, "{case}: {off}");
            assert!(few.iter().all(|few| *few < most + 0.5 * SAME), "{case}");
        }
    }
}
