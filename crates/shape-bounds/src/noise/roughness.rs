//! Contacts that stand out of their own curve.

use super::model::NoisyContact;
use super::polynomial::{Known, Predictor, around, neighbours};
use super::quantile;
use super::traced::{Course, Traced};
use glam::{DMat3, DVec3};

/// Neighbours on both sides: many carry little noise, a high degree follows a curve that bends.
const AROUND: [Predictor; 10] = [
    around(1, 1, 6, 3),
    around(1, 2, 6, 3),
    around(2, 1, 6, 3),
    around(1, 1, 4, 3),
    around(1, 2, 4, 3),
    around(2, 1, 4, 3),
    around(1, 1, 6, 5),
    around(1, 2, 6, 5),
    around(2, 1, 6, 5),
    around(1, 1, 6, 7),
];
/// On one side, the nearest left out or not: places from the first to the last, and degrees. An edge, or a wrong neighbour, spoils
/// what is predicted from the other side alone.
const BESIDE: [(usize, usize, usize); 4] = [(1, 8, 2), (1, 5, 2), (2, 9, 2), (2, 6, 2)];
/// A curve may bend that many times as sharply as one that turns evenly.
const SHARPER: f64 = 1.5;
/// The farthest place of a predictor.
const REACH: usize = 9;

/// Contacts of `curve` whose point or normal departs from what its neighbours predict by more than noise does, with the number of
/// standard deviations, where noise fails to explain as much with probability `alpha` for the whole curve.
///
/// How well a curve is predicted is taken from how well the polynomial fits the neighbours themselves: contacts that are not in any
/// order stand out nowhere. `dimension` is that of space.
pub(super) fn standing_out(curve: &[NoisyContact], alpha: f64, dimension: usize) -> Vec<(usize, f64)> {
    let (mut series, limit) = series(curve, alpha, dimension);
    found_and_left(&mut series, limit, curve.len()).0
}

/// The contacts that do not stand out, and what their points and normals depart by from what their neighbours predict, over the
/// deviation of that where all values have deviation 1.
pub(super) fn departures(
    curve: &[NoisyContact],
    alpha: f64,
    dimension: usize,
) -> (Vec<usize>, [Vec<DVec3>; 2]) {
    let (mut series, limit) = series(curve, alpha, dimension);
    let left = found_and_left(&mut series, limit, curve.len()).1;
    let of = |s: &mut Series| (0..left.len()).map(|k| s.judged(&left, k).vector).collect();
    let departures = series.each_mut().map(of);
    (left, departures)
}

/// Points and normals, and the deviations beyond which one stands out.
fn series(curve: &[NoisyContact], alpha: f64, dimension: usize) -> ([Series; 2], f64) {
    let limit = quantile::length3(alpha / (2 * curve.len().max(1)) as f64);
    let of_normal = |c: &NoisyContact| DMat3::from_diagonal(DVec3::splat(c.noise.normal.powi(2)));
    let points = curve.iter().map(|c| (c.contact.point, c.noise.point)).collect();
    let normals = curve.iter().map(|c| (c.contact.normal.get(), of_normal(c))).collect();
    let Course { size, turn, .. } = Traced { contacts: curve, dimension }.course();
    let of =
        |values, dimension, size| Series { values, dimension, limit, size, turn, known: Known::default() };
    ([of(points, dimension, size), of(normals, dimension - 1, 1.0)], limit)
}

fn found_and_left(series: &mut [Series; 2], limit: f64, count: usize) -> (Vec<(usize, f64)>, Vec<usize>) {
    let mut left: Vec<usize> = (0..count).collect();
    let mut score = |left: &[usize], k: usize| {
        series.iter_mut().map(|s| s.judged(left, k).deviations).fold(0.0, f64::max)
    };
    let mut found = drop_worst(&mut left, limit, &mut score);
    // What only seemed to stand out beside a larger outlier does so no more.
    found.sort_by(|a, b| a.1.total_cmp(&b.1));
    found.retain_mut(|(contact, deviations)| {
        let place = left.partition_point(|k| k < contact);
        left.insert(place, *contact);
        *deviations = score(&left, place);
        let stands_out = *deviations > limit;
        if stands_out {
            left.remove(place);
        }
        stands_out
    });
    (found, left)
}

/// Takes out the contact of highest score until none is above the limit.
fn drop_worst(
    left: &mut Vec<usize>,
    limit: f64,
    mut score: impl FnMut(&[usize], usize) -> f64,
) -> Vec<(usize, f64)> {
    let mut found = Vec::new();
    let mut scores: Vec<f64> = (0..left.len()).map(|k| score(left, k)).collect();
    while let Some((k, worst)) = scores.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1)) {
        if worst <= limit {
            break;
        }
        found.push((left.remove(k), worst));
        scores.remove(k);
        // What it predicted is judged anew.
        for near in k.saturating_sub(REACH)..(k + REACH).min(left.len()) {
            scores[near] = score(left, near);
        }
    }
    found
}

/// Values along a curve with their covariances.
struct Series {
    values: Vec<(DVec3, DMat3)>,
    /// In which they vary.
    dimension: usize,
    /// Deviations beyond which one stands out.
    limit: f64,
    /// About what they turn around, and the angle from one to the next, rad: powers of it bound how far a polynomial is off a smooth curve.
    size: f64,
    turn: f64,
    known: Known,
}

/// What a value departs from its prediction by.
#[derive(Clone, Copy, Debug, Default)]
struct Departure {
    /// Over its deviation where all values have deviation 1.
    vector: DVec3,
    /// Standard deviation of the departure, by the noise, or by how badly the neighbours are fitted where that is larger.
    deviation: f64,
    /// In as many of these.
    deviations: f64,
    /// Whether the noise explains how badly.
    fitted: bool,
}

impl Series {
    /// Departure of the `k`-th of those `left` from what its neighbours predict best.
    fn judged(&mut self, left: &[usize], k: usize) -> Departure {
        let around = self.best(left, k, &AROUND);
        if let Some(departure @ Departure { fitted: true, .. }) = around {
            return departure;
        }
        let before =
            BESIDE.map(|(first, last, degree)| Predictor { before: (first, last), after: (1, 0), degree });
        let after = before.map(|p| Predictor { before: p.after, after: p.before, ..p });
        let sides = [self.best(left, k, &before), self.best(left, k, &after)];
        // An edge is explained from one side.
        let beside = sides.into_iter().flatten().min_by(|a, b| a.deviations.total_cmp(&b.deviations));
        let both = around.into_iter().chain(beside);
        both.min_by(|a, b| a.deviation.total_cmp(&b.deviation)).unwrap_or_default()
    }

    /// The departure from the prediction that is known best.
    fn best(&mut self, left: &[usize], k: usize, predictors: &[Predictor]) -> Option<Departure> {
        let mut best: Option<Departure> = None;
        for predictor in predictors {
            let Some(departure) = neighbours(left, k, *predictor)
                .map(|others| self.departure(left[k], &others, predictor.degree))
            else {
                continue;
            };
            if best.is_none_or(|best| departure.deviation < best.deviation) {
                best = Some(departure);
            }
            // Others carry more noise.
            if departure.fitted {
                break;
            }
        }
        best
    }

    fn departure(&mut self, one: usize, others: &[usize], degree: usize) -> Departure {
        let polynomials = self.known.polynomials(one, others, degree);
        let (mut vector, mut covariance) = self.values[one];
        let mut noise = 0.0;
        for (j, w) in others.iter().zip(&polynomials.weights) {
            let (value, own) = self.values[*j];
            vector -= value * *w;
            covariance += own * (w * w);
            noise += (own.x_axis.x + own.y_axis.y + own.z_axis.z) / others.len() as f64;
        }
        let misfit =
            polynomials.misfit(others.iter().map(|j| self.values[*j].0 - self.values[one].0).collect());
        let free = polynomials.free() as f64;
        let seen = (misfit / (free * self.dimension as f64)).sqrt() * polynomials.gain;
        // What the next degree adds explains as much as it leaves beyond the noise.
        let bend = (misfit - free * noise).max(0.0).sqrt() * polynomials.next;
        let beyond = degree as i32 + 1;
        let missed = SHARPER * self.size * (SHARPER * self.turn).powi(beyond) * polynomials.power;
        let length = (vector.length() - missed).max(0.0);
        // Along its own direction: never more departures than by the inverse of the covariance, which there may be none of.
        let stated = vector.dot(covariance * vector).max(0.0).sqrt() / vector.length().max(f64::MIN_POSITIVE);
        let deviation = stated.max(seen) + bend / self.limit;
        let deviations = if deviation > 0.0 { length / deviation } else { 0.0 };
        Departure { vector: vector / polynomials.gain, deviation, deviations, fitted: misfit <= free * noise }
    }
}
