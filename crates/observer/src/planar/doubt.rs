//! When the linearised covariance of a start is not to be believed.

use super::force_driven::{ForceDriven, MOTION};
use super::input::PairStage;
use super::scale::NaturalScale;
use super::start::neutral_start;
use crate::{NewtonObserver, Report, Status};
use nalgebra::SVector;

/// Fewest natural times, smallest relative rate (in natural rates), smallest offset (in deviations), smallest sine of the
/// wedge and smallest range of the contacts (in natural lengths) for which the linearised covariance was found true; measured in docs/planar.md.
const SHORTEST_SPAN: f64 = 1.5;
const SLOWEST_RATE: f64 = 0.15;
const ROUNDEST_OFFSET: f64 = 5.0;
const NARROWEST_WEDGE: f64 = 0.3;
const STILLEST_CONTACT: f64 = 0.2;
/// The same for the range of the forces, in weights.
const STILLEST_FORCE: f64 = 0.3;
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
    /// Contacts and forces hardly change: rest, slow rocking, or a disc. A judgement of the readings alone, before any estimate.
    TooStill {
        /// Larger range of both contacts in natural lengths.
        range: f64,
        /// Larger range of both forces in weights.
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

/// Whether a window's linearised covariance is to be believed.
pub(super) fn doubt<const N: usize>(
    newton: &NewtonObserver<ForceDriven<N>, N, 2>,
    report: &Report<N>,
    scale: &NaturalScale,
) -> Option<Doubt> {
    let model = newton.model();
    let (mut span, mut count, mut sine) = (0.0, 0.0, 1.0_f64);
    let (mut rates, mut offsets) = ([0.0; 2], [0.0; 2]);
    let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 4];
    for (k, (x, sample)) in newton.trajectory().zip(newton.samples()).enumerate() {
        let stage = &sample.input.stages[2];
        span += if k > 0 { sample.input.dt } else { 0.0 };
        count += 1.0;
        sine = sine.min(stage.along[0].perp_dot(stage.along[1]));
        let d = model.contact_offsets(x, stage);
        for i in 0..2 {
            rates[i] += (x[4] - stage.rates[i]).powi(2);
            offsets[i] += d[i] * d[i];
            for (slot, value) in [(i, stage.contacts[i]), (2 + i, stage.forces[i])] {
                reach[slot] = [reach[slot][0].min(value), reach[slot][1].max(value)];
            }
        }
    }
    let spans = span / scale.time();
    if spans < SHORTEST_SPAN {
        return Some(Doubt::TooShort { spans });
    }
    if sine < NARROWEST_WEDGE {
        return Some(Doubt::Wedge { sine });
    }
    let [s1, s2, f1, f2] = reach.map(|[low, high]| high - low);
    let weight = model.nominal().mass.mass() * scale.gravity;
    let (range, forces) = (s1.max(s2) / scale.length, f1.max(f2) / weight);
    if range < STILLEST_CONTACT && forces < STILLEST_FORCE {
        return Some(Doubt::TooStill { range, forces });
    }
    let largest = 1.0 + LARGEST_RESIDUAL_DEVIATIONS / f64::sqrt(4.0 * count);
    let inconsistent = report.residual.is_nan() || report.residual > largest;
    if model.nominal().contact_deviation > 0.0 && inconsistent {
        return Some(Doubt::Residual { residual: report.residual });
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
