//! Other motions that explain a log as well: a covariance tells of what is near the one that was found, and of no other.
//!
//! Readings that hardly change (at rest, of a disc, over a short time) are explained by motions far from each other. They are looked for
//! from starts of their own, bodies that turn at a constant rate or not at all; one that is about as probable and farther away than
//! deviations reach says that the log does not tell.

use super::body::CONSTANTS;
use super::cold;
use super::noise::ContactNoiseLevel;
use super::problem::{Problem, Units};
use super::record::{Contact, Record};
use super::search::fine_within;
use super::solve::{Covariances, Solved};
use crate::three_palms::Reason;
use glam::DVec3;
use object_dynamics::MOST_PALMS;

/// Rates of the starts, in natural ones.
const RATES: [f64; 3] = [0.0, 1.0, -1.0];
/// Linearisations that each may take.
const MOST: usize = 40;
/// Fall of chi-squared that makes one motion the more probable one: odds of a thousand to one.
const MORE_PROBABLE: f64 = 13.8;
/// Deviations from which on another motion is one that they do not reach.
const BEYOND: f64 = 5.0;

/// Spread of the contacts along their palms in natural lengths, and of the whole force about its mean in weights, below which a log of the plane
/// tells nothing of a motion: at rest, in slow rocking and for discs forces spread by less than 0.004, for a disc with its centre of mass
/// 5 % off by up to 0.01.
const STILLEST: [f64; 2] = [0.07, 0.014];
/// Standard deviations of the spread's own scatter that noise may pretend.
const PRETENDED: f64 = 4.0;

/// Whether contacts and forces hardly change beyond noise: a judgement of the readings alone.
pub(super) fn still(record: &Record, noise: &ContactNoiseLevel, units: &Units) -> Option<Reason> {
    let mut places = [Spread::default(); MOST_PALMS];
    let mut forces = [Spread::default(); 2];
    let (mut variance, mut samples) = (0.0, 0.0_f64);
    let mut first: [Option<Contact>; MOST_PALMS] = [None; MOST_PALMS];
    for contacts in record.contacts.iter().filter(|contacts| !contacts.is_empty()) {
        let whole: DVec3 = contacts.iter().map(|contact| contact.f).sum();
        forces[0].add(whole.x);
        forces[1].add(whole.z);
        variance += contacts.iter().map(|contact| contact.f_deviation.powi(2)).sum::<f64>();
        samples += 1.0;
        for contact in contacts {
            let from = first[contact.palm].get_or_insert(*contact);
            // Along the palm, from where it was touched first.
            places[contact.palm].add(contact.tangents()[0].dot(contact.c - from.c));
        }
    }
    let weight = units.mass * units.speed * units.speed / units.length;
    let place = places.map(|of| of.beyond(noise.contact, STILLEST[0] * units.length));
    let force = forces.map(|of| of.beyond((variance / samples.max(1.0)).sqrt(), STILLEST[1] * weight));
    let changes = place.iter().chain(&force).any(|(_, beyond)| *beyond);
    let most = |of: &[(f64, bool)], unit: f64| of.iter().map(|(spread, _)| spread / unit).fold(0.0, f64::max);
    (!changes)
        .then(|| Reason::Unchanging { contacts: most(&place, units.length), forces: most(&force, weight) })
}

/// Spread of readings: sums of value and square, about the first one, so that the square of a large mean does not cancel.
#[derive(Clone, Copy, Default)]
struct Spread {
    first: Option<f64>,
    sum: f64,
    squares: f64,
    count: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        let away = value - *self.first.get_or_insert(value);
        self.sum += away;
        self.squares += away * away;
        self.count += 1.0;
    }

    /// Standard deviation beyond noise of the given one, and whether it exceeds `least` by more than noise may pretend.
    fn beyond(&self, noise: f64, least: f64) -> (f64, bool) {
        let count = self.count.max(1.0);
        let mean = self.sum / count;
        let excess = self.squares / count - mean * mean - noise * noise;
        let pretended = PRETENDED * noise * noise * (2.0 / count).sqrt();
        (excess.max(0.0).sqrt(), excess > least * least + pretended)
    }
}

/// The most probable of the motions that are found in the plane with its covariances, and whether another one cannot be ruled out. None where
/// the equations are singular.
pub(super) fn decided(
    problem: &mut Problem,
    found: Solved<CONSTANTS>,
) -> Option<(Solved<CONSTANTS>, Covariances<CONSTANTS>, Option<Reason>)> {
    let rate = problem.units.speed / problem.units.length;
    let (frozen, body) = (problem.frozen.clone(), found.unknowns.body);
    let mut all = vec![(found, frozen)];
    for turns in RATES {
        let start = cold::turning(problem, body, -DVec3::Y * (turns * rate));
        if let Some(other) = fine_within(problem, start, MOST) {
            all.push((other, problem.frozen.clone()));
        }
    }
    let cost = |(solved, _): &(Solved<CONSTANTS>, _)| solved.equations.cost;
    let best = (0..all.len()).min_by(|&a, &b| cost(&all[a]).total_cmp(&cost(&all[b])))?;
    // What was found first stays unless another one is clearly better: the best of several is no better for a share of a deviation.
    let best = if cost(&all[0]) < cost(&all[best]) + 1.0 { 0 } else { best };
    let (solved, frozen) = all.swap_remove(best);
    problem.frozen = frozen;
    let covariances = solved.covariances(problem)?;
    let likely =
        |(other, _): &&(Solved<CONSTANTS>, _)| other.equations.cost < solved.equations.cost + MORE_PROBABLE;
    let farthest = all.iter().filter(likely).map(|(other, _)| apart(&solved, other, &covariances));
    let apart = farthest.fold(0.0, f64::max);
    Some((solved, covariances, (apart > BEYOND).then_some(Reason::Ambiguous { apart })))
}

/// Largest difference of velocities and positions of two motions, in deviations of the first.
fn apart(of: &Solved<CONSTANTS>, other: &Solved<CONSTANTS>, covariances: &Covariances<CONSTANTS>) -> f64 {
    let inertia = of.unknowns.body.inertia().y_axis.y;
    let spin = |solved: &Solved<CONSTANTS>, j: usize| {
        let motion = &solved.unknowns.motions[j];
        solved.unknowns.body.turn(motion.q, motion.L).w.y
    };
    let one = |j: usize| {
        let deviations = covariances.deviations(&covariances.motions[j]);
        // In the plane: positions and velocities along x and z, the spin about y by the momentum.
        let by = other.unknowns.motions[j].from(&of.unknowns.motions[j]);
        let spun = (spin(other, j) - spin(of, j)) * inertia / deviations[7];
        [0, 2, 3, 5].into_iter().map(|i| (by[i] / deviations[i]).abs()).fold(spun.abs(), f64::max)
    };
    (0..of.unknowns.motions.len()).map(one).fold(0.0, f64::max)
}
