//! Whether contacts are as noisy as was stated, and their noise independent from one to the next.

use super::consistency::{FEWEST, binomials};
use super::model::NoisyContact;
use super::quantile;
use crate::median::{OF_NORMAL, median};
use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// Odds of a false alarm of either test, over all curves.
const FALSE_ALARM: f64 = 1e-3;
/// Orders of the differences that the level is judged by, and by which noise that is alike: low ones say more, high ones leave less of
/// a curve, which at a wider spacing is more.
const ORDER: usize = 3;
const ORDER_OF_ALIKE: usize = 5;
/// Share of what differences of an order find that those of a higher one must find: less is the curve, which they take away.
const RESOLVED: f64 = 0.8;
/// Squares of fifth differences at four times the spacing grow by at most so many times as much as those at twice, if noise makes them
/// grow: three times for a random walk, 1025 times for a smooth curve.
const STEEPEST: f64 = 55.0;

/// The same over those of neighbours: four times for a random walk, more only for a curve.
const LARGEST_GROWTH: f64 = 16.0;

/// What is not as was assumed of the noise of contacts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NoiseDoubt {
    /// Contacts of a curve are rougher than the stated noise, by a z-test on the median of their differences.
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
    /// Noise is alike from one contact to the next: differences over every second contact are larger than over every one, by a z-test
    /// on the logarithm of the ratio of their medians.
    Correlated {
        /// How many times larger.
        ratio: f64,
        /// Odds of as much or more from independent noise, at most.
        p_value: f64,
    },
}

/// Parts of the noise: name, values and components of a contact, and the stated deviation.
struct Part {
    what: &'static str,
    value: fn(&NoisyContact) -> DVec3,
    across: bool,
    stated: fn(&NoisyContact) -> f64,
}

const PARTS: [Part; 3] = [
    Part { what: "point across the surface", value: |c| c.contact.point, across: true, stated: across },
    Part { what: "point along the surface", value: |c| c.contact.point, across: false, stated: along },
    Part { what: "normal", value: |c| c.contact.normal.get(), across: false, stated: |c| c.noise.normal },
];

fn across(c: &NoisyContact) -> f64 {
    let n = c.contact.normal.get();
    n.dot(c.noise.point * n).max(0.0).sqrt()
}

fn along(c: &NoisyContact) -> f64 {
    let (a, b) = c.contact.normal.get().any_orthonormal_pair();
    (0.5 * (a.dot(c.noise.point * a) + b.dot(c.noise.point * b))).max(0.0).sqrt()
}

/// `curves` with noise no smaller than they show themselves, and what was stated too small. Curves of fewer than 30 contacts, those
/// that bend too much from one contact to the next, and lists in no order do not tell.
#[must_use]
pub fn with_noise_as_found(curves: &[Vec<NoisyContact>]) -> (Vec<Vec<NoisyContact>>, Vec<NoiseDoubt>) {
    let mut raised = curves.to_vec();
    let mut doubts = Vec::new();
    let each = FALSE_ALARM / (PARTS.len() * curves.len().max(1)) as f64;
    let limit = quantile::normal(each);
    for (curve, contacts) in raised.iter_mut().enumerate().filter(|(_, contacts)| is_traced(contacts)) {
        for part in &PARTS {
            let stated = contacts.iter().map(part.stated).fold(0.0, f64::max);
            let (here, next) =
                (part.deviation(contacts, ORDER, 1), part.deviation(contacts, ORDER_OF_ALIKE, 1));
            let found = here.0.min(next.0);
            let z = (found / stated - 1.0) / here.1.max(next.1);
            if stated > 0.0 && z > limit && next.0 > RESOLVED * here.0 {
                // Above the truth as surely as the alarm is none.
                let level = found * (1.0 + limit * here.1.max(next.1));
                contacts.iter_mut().for_each(|c| part.raise(c, level));
                doubts.push(NoiseDoubt::Level { curve, what: part.what, stated, found, p_value: tail(z) });
            }
        }
    }
    (raised, doubts)
}

/// Whether the noise of contacts is alike from one to the next, along all curves together.
#[must_use]
pub fn correlated_noise(curves: &[Vec<NoisyContact>]) -> Option<NoiseDoubt> {
    let limit = quantile::normal(FALSE_ALARM / PARTS.len() as f64);
    let judged = |part: &Part| {
        let (mut logarithm, mut variance, mut squares) = (0.0, 0.0, [0.0; 3]);
        for contacts in curves.iter().filter(|contacts| is_traced(contacts)) {
            let found = [1, 2, 4].map(|spacing| part.deviation(contacts, ORDER_OF_ALIKE, spacing));
            let next = part.deviation(contacts, ORDER_OF_ALIKE + 1, 1).0;
            // Where the next order takes away more, the curve is left in this one.
            if found.iter().any(|(deviation, _)| *deviation <= 0.0) || next <= RESOLVED * found[0].0 {
                continue;
            }
            let weight = contacts.len() as f64;
            logarithm += weight * (found[1].0 / found[0].0).ln();
            variance += weight * weight * (found[1].1.powi(2) + found[0].1.powi(2));
            squares.iter_mut().zip(&found).for_each(|(sum, (d, _))| *sum += weight * d * d);
        }
        let z = logarithm / variance.sqrt();
        let [one, two, four] = squares;
        let noise = four - one < STEEPEST * (two - one) && four < LARGEST_GROWTH * one;
        (z > limit && noise).then(|| NoiseDoubt::Correlated { ratio: (two / one).sqrt(), p_value: tail(z) })
    };
    PARTS.iter().find_map(judged)
}

/// Whether there are enough contacts, each near the one before: of contacts in no order, neighbours are as far apart as any two, and
/// their differences say nothing of noise.
fn is_traced(contacts: &[NoisyContact]) -> bool {
    let mean = contacts.iter().map(|c| c.contact.point).sum::<DVec3>() / contacts.len().max(1) as f64;
    let mut steps: Vec<f64> =
        contacts.windows(2).map(|pair| pair[0].contact.point.distance(pair[1].contact.point)).collect();
    let mut reach: Vec<f64> = contacts.iter().map(|c| c.contact.point.distance(mean)).collect();
    contacts.len() >= FEWEST && median(&mut steps) < 0.5 * median(&mut reach)
}

/// No less than the tail of a standard normal, for all tests together.
fn tail(z: f64) -> f64 {
    ((-0.5 * z * z).exp() / (z * std::f64::consts::TAU.sqrt())).min(1.0)
}

impl Part {
    /// The deviation that differences of an order over contacts so far apart show, and its own relative deviation.
    fn deviation(&self, contacts: &[NoisyContact], order: usize, spacing: usize) -> (f64, f64) {
        let (weights, overlap) = binomials(order);
        let gain = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let length = order * spacing;
        let mut sizes = Vec::new();
        for first in 0..contacts.len().saturating_sub(length) {
            let terms =
                weights.iter().enumerate().map(|(k, w)| (self.value)(&contacts[first + k * spacing]) * *w);
            let difference: DVec3 = terms.sum();
            let n: Direction = contacts[first + length / 2].contact.normal;
            if self.across {
                sizes.push(n.get().dot(difference).abs());
            } else {
                let (a, b) = n.get().any_orthonormal_pair();
                sizes.extend([a.dot(difference).abs(), b.dot(difference).abs()]);
            }
        }
        let count = sizes.len().max(1) as f64;
        // The variance of a median of normal deviates is 1.36 / n of theirs; overlapping differences say less.
        (median(&mut sizes) / (OF_NORMAL * gain), (1.36 * overlap / count).sqrt())
    }

    /// Raises the noise of a contact to a deviation.
    fn raise(&self, c: &mut NoisyContact, level: f64) {
        let n = c.contact.normal.get();
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        let missing = (level * level - (self.stated)(c).powi(2)).max(0.0);
        match (self.what, self.across) {
            ("normal", _) => c.noise.normal = c.noise.normal.max(level),
            (_, true) => c.noise.point += outer * missing,
            (_, false) => c.noise.point += (DMat3::IDENTITY - outer) * missing,
        }
    }
}
