//! When the linearised covariance of a start is not to be believed.

use super::force_driven::{ForceDriven, MOTION};
use super::input::PairStage;
use super::scale::NaturalScale;
use super::start::neutral_start;
use crate::{NewtonObserver, Report, Status};
use nalgebra::SVector;

/// Fewest natural times, smallest relative rate (in natural rates), smallest offset (in deviations) and smallest sine of the
/// wedge for which the linearised covariance was found true; measured in docs/planar.md.
const SHORTEST_SPAN: f64 = 1.5;
const SLOWEST_RATE: f64 = 0.15;
const ROUNDEST_OFFSET: f64 = 5.0;
const NARROWEST_WEDGE: f64 = 0.3;
/// The same for the spread of the contacts (in natural lengths) and of the forces beyond those of rest (in weights): root mean
/// square about the mean. At rest, in slow rocking and for discs the forces spread by less than 0.004, for a disc with its
/// centre of mass 5 % off, which still finds wrong minima, by up to 0.01.
const STILLEST_CONTACT: f64 = 0.07;
const STILLEST_FORCE: f64 = 0.014;
/// Standard deviations of the spread's own scatter that noise may pretend.
const SPREAD_DEVIATIONS: f64 = 4.0;
/// Residual above one, in its own standard deviations `1 / sqrt(2 n)` for `n` readings, beyond which noise does not explain it.
const LARGEST_RESIDUAL_DEVIATIONS: f64 = 5.0;

/// Why an estimate of the motion is not believed although the linearised information looks sufficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Doubt {
    /// The samples span too few natural times.
    TooShort {
        /// Span in natural times.
        spans: f64,
    },
    /// Contacts and forces hardly change beyond noise: rest, slow rocking, or a disc. A judgement of the readings alone, before
    /// any estimate.
    TooStill {
        /// Larger spread of both contacts in natural lengths, root mean square about the mean, noise taken out.
        contacts: f64,
        /// Larger spread of both forces, less those of rest between the palms as they stand, in weights.
        forces: f64,
    },
    /// The object hardly turns against a palm: the contact offset `d_i` is divided by that rate.
    TooSlow {
        /// 1 or 2.
        palm: usize,
        /// Root mean square of `z_i` in natural rates.
        rate: f64,
    },
    /// The contact offsets are not distinguished from zero: the object may be a disc, whose turn does not show.
    TooRound {
        /// Largest of both root mean square offsets in their standard deviations.
        offset: f64,
    },
    /// The palms are nearly parallel or nearly flat.
    Wedge {
        /// Sine of the angle between the palms.
        sine: f64,
    },
    /// Residuals are larger than the noise: the fit may sit in a wrong minimum.
    Residual {
        /// Root mean square residual in standard deviations.
        residual: f64,
    },
}

/// Forces less those that hold an object at rest between the palms where they are.
fn excess_forces(stage: &PairStage, weight: f64) -> [f64; 2] {
    let [u1, u2] = stage.along;
    // sin phi2, positive for any pair of palms.
    let sine = u1.perp_dot(u2);
    [stage.forces[0] - weight * u2.y / sine, stage.forces[1] - weight * u1.y / sine]
}

/// A report that claims no more than the natural size of things: the estimate may be as wrong as it is far from a disc at rest.
pub(super) fn doubtful<const N: usize>(
    mut report: Report<N>,
    state: &SVector<f64, N>,
    stage: &PairStage,
    scale: &NaturalScale,
) -> Report<N> {
    report.status = Status::NotObservable;
    let neutral = neutral_start(stage, scale.length, 0.0);
    for (i, deviation) in prior_deviations(scale).iter().enumerate() {
        report.covariance[(i, i)] += deviation * deviation + (state[i] - neutral[i]).powi(2);
    }
    report
}

/// How far the truth may be from a disc of the natural size at rest.
pub(super) fn prior_deviations(scale: &NaturalScale) -> [f64; MOTION] {
    let (length, speed) = (0.5 * scale.length, scale.speed());
    [length, length, speed, speed, 3.0 * scale.rate()]
}

/// Spread of readings: sums of value and square, from which mean and variance follow.
#[derive(Clone, Copy, Default)]
struct Spread {
    first: f64,
    sum: f64,
    squares: f64,
    count: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        if self.count == 0.0 {
            self.first = value;
        }
        // About the first value, so that the square of a large mean does not cancel.
        let away = value - self.first;
        self.sum += away;
        self.squares += away * away;
        self.count += 1.0;
    }

    /// Standard deviation beyond noise of the given one, and whether it exceeds `smallest` by more than noise may pretend.
    fn beyond(&self, noise: f64, smallest: f64) -> (f64, bool) {
        let mean = self.sum / self.count;
        let excess = self.squares / self.count - mean * mean - noise * noise;
        let pretended = SPREAD_DEVIATIONS * noise * noise * (2.0 / self.count).sqrt();
        (excess.max(0.0).sqrt(), excess > smallest * smallest + pretended)
    }
}

/// Whether a window's linearised covariance is to be believed.
pub(super) fn doubt<const N: usize>(
    newton: &NewtonObserver<ForceDriven<N>, N, 2>,
    report: &Report<N>,
    scale: &NaturalScale,
) -> Option<Doubt> {
    let model = newton.model();
    let nominal = model.nominal();
    let weight = nominal.mass.mass() * scale.gravity;
    let (mut span, mut count, mut sine) = (0.0, 0.0, 1.0_f64);
    let (mut rates, mut offsets) = ([0.0; 2], [0.0; 2]);
    let (mut contacts, mut forces) = ([Spread::default(); 2], [Spread::default(); 2]);
    for (k, (x, sample)) in newton.trajectory().zip(newton.samples()).enumerate() {
        let stage = &sample.input.stages[2];
        span += if k > 0 { sample.input.dt } else { 0.0 };
        count += 1.0;
        sine = sine.min(stage.along[0].perp_dot(stage.along[1]));
        let d = model.contact_offsets(x, stage);
        let excess = excess_forces(stage, weight);
        for i in 0..2 {
            rates[i] += (x[4] - stage.rates[i]).powi(2);
            offsets[i] += d[i] * d[i];
            contacts[i].add(stage.contacts[i] / scale.length);
            forces[i].add(excess[i] / weight);
        }
    }
    let spans = span / scale.time();
    if spans < SHORTEST_SPAN {
        return Some(Doubt::TooShort { spans });
    }
    if sine < NARROWEST_WEDGE {
        return Some(Doubt::Wedge { sine });
    }
    let contacts = contacts.map(|s| s.beyond(nominal.contact_deviation / scale.length, STILLEST_CONTACT));
    let forces = forces.map(|s| s.beyond(nominal.force_deviation / weight, STILLEST_FORCE));
    if contacts.iter().chain(&forces).all(|(_, moves)| !moves) {
        let larger = |[a, b]: [(f64, bool); 2]| a.0.max(b.0);
        return Some(Doubt::TooStill { contacts: larger(contacts), forces: larger(forces) });
    }
    if let Some(reason) = unexplained(newton, report) {
        return Some(reason);
    }
    let rates = rates.map(|sum| f64::sqrt(sum / count) / scale.rate());
    if let Some(i) = rates.iter().position(|&r| r.is_nan() || r < SLOWEST_RATE) {
        return Some(Doubt::TooSlow { palm: i + 1, rate: rates[i] });
    }
    let last = newton.estimate()?;
    let stage = &newton.samples().last()?.input.stages[2];
    let deviations = model.offset_deviations(&last.state, stage, &report.covariance);
    let significance = [0, 1].map(|i| f64::sqrt(offsets[i] / count) / deviations[i].max(f64::MIN_POSITIVE));
    let offset = significance[0].max(significance[1]);
    (offset.is_nan() || offset < ROUNDEST_OFFSET).then_some(Doubt::TooRound { offset })
}

/// What can go wrong later where all of the past is carried along: a wedge that closes or opens, and readings that the
/// estimate does not explain any more. Rest, slow motion and roundness cannot deceive it then: they only bring no information.
/// Costs nothing beside the report.
pub(super) fn doubt_along<const N: usize>(
    newton: &NewtonObserver<ForceDriven<N>, N, 2>,
    report: &Report<N>,
) -> Option<Doubt> {
    let [u1, u2] = newton.samples().last()?.input.stages[2].along;
    let sine = u1.perp_dot(u2);
    if sine < NARROWEST_WEDGE { Some(Doubt::Wedge { sine }) } else { unexplained(newton, report) }
}

/// Residuals beyond noise, where there is noise.
fn unexplained<const N: usize>(
    newton: &NewtonObserver<ForceDriven<N>, N, 2>,
    report: &Report<N>,
) -> Option<Doubt> {
    let largest = 1.0 + LARGEST_RESIDUAL_DEVIATIONS / f64::sqrt(4.0 * newton.samples().count() as f64);
    let noisy = newton.model().nominal().contact_deviation > 0.0;
    let inconsistent = report.residual.is_nan() || report.residual > largest;
    (noisy && inconsistent).then_some(Doubt::Residual { residual: report.residual })
}
