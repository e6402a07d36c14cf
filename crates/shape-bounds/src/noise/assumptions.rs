//! Whether contacts are as noisy as was stated, and their noise independent from one to the next.

use super::levels::{Rough, rougher};
use super::model::NoisyContact;
use super::quantile;
use super::traced::{Part, Traced};

/// Odds of a false alarm of either test, over all curves.
const FALSE_ALARM: f64 = 1e-3;
/// Odds that the level of a run of contacts that is rougher than stated is above what it is raised to.
const RAISED: f64 = 0.05;
/// Odds that a test which counts as one misses noise that is a random walk.
const MISSED: f64 = 0.05;
/// Orders of the differences that noise that is alike is judged by: low ones say more, high ones leave less of a curve, which at a wider
/// spacing is more.
const ORDERS_OF_ALIKE: std::ops::RangeInclusive<usize> = 3..=7;
/// Share of what differences of an order find that those of a higher one must find: less is the curve, which they take away.
pub(super) const RESOLVED: f64 = 0.8;
/// Differences over every second contact are at most so many times as large as over every one, if noise makes them so: the root of 2
/// for a random walk, of 8 for the sum of one; 8 times and more for a smooth curve.
const SMOOTHEST: f64 = 3.0;

/// What is not as was assumed of the noise of contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseDoubt {
    /// Contacts of a curve are rougher than the stated noise, by a chi-squared test of what their neighbours do not predict.
    Level {
        /// Which curve.
        curve: usize,
        /// Which noise: "point across the surface", "point along the surface" or "normal".
        what: &'static str,
        /// As stated, m or rad.
        stated: f64,
        /// As found.
        found: f64,
        /// Odds of as much or more from the stated noise, at most.
        p_value: f64,
    },
    /// A part of a curve is, while the whole is not.
    Changing {
        /// Which curve.
        curve: usize,
        /// From which contact.
        first: usize,
        /// To which one.
        last: usize,
        /// Which noise, as above.
        what: &'static str,
        /// As stated, m or rad.
        stated: f64,
        /// As found.
        found: f64,
        /// Odds of as much or more from the stated noise, at most.
        p_value: f64,
    },
    /// Noise is alike from one contact to the next: differences over every second contact are larger than over every one, by a z-test
    /// on the logarithm of the ratio of their medians.
    Correlated {
        /// How many times larger.
        ratio: f64,
        /// Odds of as much or more from independent noise, at most.
        p_value: f64,
    },
}

/// `curves` with noise no smaller than they show themselves, as a whole or in part, and what was stated too small. Curves of fewer
/// than 30 contacts, those that bend too much from one contact to the next, and lists in no order do not tell.
#[must_use]
pub fn with_noise_as_found(curves: &[Vec<NoisyContact>]) -> (Vec<Vec<NoisyContact>>, Vec<NoiseDoubt>) {
    as_found(curves, 3)
}

/// The same in a space of two or three dimensions.
pub(crate) fn as_found(
    curves: &[Vec<NoisyContact>],
    dimension: usize,
) -> (Vec<Vec<NoisyContact>>, Vec<NoiseDoubt>) {
    let mut raised = curves.to_vec();
    let mut doubts = Vec::new();
    let odds = FALSE_ALARM / curves.len().max(1) as f64;
    for (curve, contacts) in curves.iter().enumerate() {
        let traced = Traced { contacts, dimension };
        if !traced.is_traced() {
            continue;
        }
        let rough = rougher(&traced, odds, RAISED);
        for run in &rough {
            for k in run.contacts.clone() {
                let level = run.part.stated(&contacts[k], dimension) * run.at_most;
                run.part.raise(&mut raised[curve][k], dimension, level);
            }
        }
        doubts.extend(Part::ALL.iter().filter_map(|part| {
            let of_part = rough.iter().filter(|run| run.part == *part && run.resolved);
            let worst = of_part.min_by(|a, b| b.whole.cmp(&a.whole).then(a.p_value.total_cmp(&b.p_value)))?;
            Some(doubt(curve, worst, part.stated(&contacts[worst.contacts.start], dimension)))
        }));
    }
    (raised, doubts)
}

fn doubt(curve: usize, run: &Rough, stated: f64) -> NoiseDoubt {
    let (what, found, p_value) = (run.part.name(), stated * run.ratio, run.p_value);
    if run.whole {
        return NoiseDoubt::Level { curve, what, stated, found, p_value };
    }
    let (first, last) = (run.contacts.start, run.contacts.end - 1);
    NoiseDoubt::Changing { curve, first, last, what, stated, found, p_value }
}

/// Whether the noise of contacts is alike from one to the next, along all curves together.
#[must_use]
pub fn correlated_noise(curves: &[Vec<NoisyContact>]) -> Option<NoiseDoubt> {
    correlated(curves, 3)
}

/// The same in a space of two or three dimensions.
pub(crate) fn correlated(curves: &[Vec<NoisyContact>], dimension: usize) -> Option<NoiseDoubt> {
    let of_part = |part: &Part| {
        let Growth { logarithm, deviation } = growth(curves, dimension, *part)?;
        let z = logarithm / deviation;
        (z > limit()).then(|| NoiseDoubt::Correlated { ratio: logarithm.exp(), p_value: tail(z) })
    };
    Part::ALL.iter().find_map(of_part)
}

/// Whether [`correlated_noise`] would find a random walk, over every second contact the root of 2 times as large as over every one, in
/// 95 % of cases: of few contacts, and of curves that bend more from one to the next than noise does, it may find nothing.
#[must_use]
pub fn independence_is_tested(curves: &[Vec<NoisyContact>]) -> bool {
    tested(curves, 3)
}

/// The same in a space of two or three dimensions.
pub(crate) fn tested(curves: &[Vec<NoisyContact>], dimension: usize) -> bool {
    let needed = limit() + quantile::normal(MISSED);
    let found = |growth: Growth| needed * growth.deviation < 0.5 * std::f64::consts::LN_2;
    Part::ALL.iter().any(|part| growth(curves, dimension, *part).is_some_and(found))
}

/// Deviations of the growth of differences beyond which noise is alike.
fn limit() -> f64 {
    quantile::normal(FALSE_ALARM / Part::ALL.len() as f64)
}

/// The logarithm of how many times as large differences are over every second contact as over every one, and its own deviation.
struct Growth {
    logarithm: f64,
    deviation: f64,
}

/// Over all curves together; none where each of them bends too much.
fn growth(curves: &[Vec<NoisyContact>], dimension: usize, part: Part) -> Option<Growth> {
    let traced = curves.iter().map(|contacts| Traced { contacts, dimension }).filter(Traced::is_traced);
    let (mut logarithm, mut variance, mut weights) = (0.0, 0.0, 0.0);
    for curve in traced {
        let found = |order: usize| [1, 2].map(|spacing| curve.deviation(part, order, spacing));
        // Where the next order takes away more, the curve is left in this one.
        let resolved = |order: &usize| {
            let (here, next) = (found(*order), found(order + 1));
            here.iter().zip(&next).all(|(a, b)| a.0 > 0.0 && b.0 > RESOLVED * a.0)
        };
        // Of the orders that leave none of it the one of the smallest growth: what is left of the curve grows more than noise.
        let ratio = |[one, two]: &[(f64, f64); 2]| two.0 / one.0;
        let resolved = ORDERS_OF_ALIKE.filter(resolved).map(found);
        let Some([one, two]) = resolved.min_by(|a, b| ratio(a).total_cmp(&ratio(b))) else { continue };
        if two.0 > SMOOTHEST * one.0 {
            continue;
        }
        let weight = curve.contacts.len() as f64;
        logarithm += weight * (two.0 / one.0).ln();
        variance += weight * weight * (two.1.powi(2) + one.1.powi(2));
        weights += weight;
    }
    (weights > 0.0).then(|| Growth { logarithm: logarithm / weights, deviation: variance.sqrt() / weights })
}

/// No less than the tail of a standard normal, for all tests together.
fn tail(z: f64) -> f64 {
    ((-0.5 * z * z).exp() / (z * std::f64::consts::TAU.sqrt())).min(1.0)
}
