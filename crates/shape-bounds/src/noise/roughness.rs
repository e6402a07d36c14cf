//! Contacts that stand out of their own curve.

use super::model::NoisyContact;
use super::polynomial::Polynomials;
use super::quantile;
use glam::{DMat3, DVec3};
use std::collections::HashMap;
use std::rc::Rc;

/// Neighbours that predict a contact, by their places in the curve counted from it, and the degree of the polynomial.
#[derive(Clone, Copy, Debug)]
struct Predictor {
    before: (usize, usize),
    after: (usize, usize),
    degree: usize,
}

const fn around(before: usize, after: usize, reach: usize, degree: usize) -> Predictor {
    Predictor { before: (before, reach), after: (after, reach), degree }
}

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
/// The farthest place of a predictor.
const REACH: usize = 9;

/// Contacts of `curve` whose point or normal departs from what its neighbours predict by more than noise does, with the number of
/// standard deviations, where noise fails to explain as much with probability `alpha` for the whole curve.
///
/// How well a curve is predicted is taken from how well the polynomial fits the neighbours themselves: contacts that are not in any
/// order stand out nowhere. `dimension` is that of space.
pub(super) fn standing_out(curve: &[NoisyContact], alpha: f64, dimension: usize) -> Vec<(usize, f64)> {
    let limit = quantile::length3(alpha / (2 * curve.len().max(1)) as f64);
    let of_normal = |c: &NoisyContact| DMat3::from_diagonal(DVec3::splat(c.noise.normal.powi(2)));
    let points = curve.iter().map(|c| (c.contact.point, c.noise.point)).collect();
    let normals = curve.iter().map(|c| (c.contact.normal.get(), of_normal(c))).collect();
    let mut series = [
        Series { values: points, dimension, limit, known: HashMap::new() },
        Series { values: normals, dimension: dimension - 1, limit, known: HashMap::new() },
    ];
    let mut left: Vec<usize> = (0..curve.len()).collect();
    let mut score =
        |left: &[usize], k: usize| series.iter_mut().map(|s| s.score(left, k)).fold(0.0, f64::max);
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
    found
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
    /// Polynomials by the neighbours' places and the degree.
    known: HashMap<(Vec<isize>, usize), Rc<Polynomials>>,
}

/// What a value departs from its prediction by.
#[derive(Clone, Copy, Debug)]
struct Departure {
    /// Standard deviation of the departure, by the noise, or by how badly the neighbours are fitted where that is larger.
    deviation: f64,
    /// In as many of these.
    deviations: f64,
    /// Whether the noise explains how badly.
    fitted: bool,
}

impl Series {
    /// Departure of the `k`-th of those `left` from what its neighbours predict, in standard deviations.
    fn score(&mut self, left: &[usize], k: usize) -> f64 {
        let around = self.best(left, k, &AROUND);
        if let Some(Departure { deviations, fitted: true, .. }) = around {
            return deviations;
        }
        let before =
            BESIDE.map(|(first, last, degree)| Predictor { before: (first, last), after: (1, 0), degree });
        let after = before.map(|p| Predictor { before: p.after, after: p.before, ..p });
        let sides = [self.best(left, k, &before), self.best(left, k, &after)];
        // An edge is explained from one side.
        let beside = sides.into_iter().flatten().min_by(|a, b| a.deviations.total_cmp(&b.deviations));
        let both = around.into_iter().chain(beside);
        both.min_by(|a, b| a.deviation.total_cmp(&b.deviation)).map_or(0.0, |d| d.deviations)
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
        let polynomials = self.polynomials(one, others, degree);
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
        let length = vector.length();
        // Along its own direction: never more departures than by the inverse of the covariance, which there may be none of.
        let stated = vector.dot(covariance * vector).max(0.0).sqrt() / length.max(f64::MIN_POSITIVE);
        let deviation = stated.max(seen) + bend / self.limit;
        let deviations = if deviation > 0.0 { length / deviation } else { 0.0 };
        Departure { deviation, deviations, fitted: misfit <= free * noise }
    }

    fn polynomials(&mut self, one: usize, others: &[usize], degree: usize) -> Rc<Polynomials> {
        let places: Vec<isize> = others.iter().map(|j| *j as isize - one as isize).collect();
        let made = |(places, degree): &(Vec<isize>, usize)| {
            let places: Vec<f64> = places.iter().map(|p| *p as f64).collect();
            Rc::new(Polynomials::over(&places, *degree))
        };
        self.known.entry((places, degree)).or_insert_with_key(made).clone()
    }
}

/// The neighbours of the `k`-th of those `left` that a predictor takes, where there are as many.
fn neighbours(left: &[usize], k: usize, of: Predictor) -> Option<Vec<usize>> {
    let Predictor { before: (near_before, far_before), after: (near_after, far_after), .. } = of;
    // At the end of a curve there are fewer on that side, and more on the other.
    let (two_sided, behind) = (near_before <= far_before && near_after <= far_after, left.len() - 1 - k);
    let short = |far: usize, there: usize| if two_sided { far.saturating_sub(there) } else { 0 };
    let (short_before, short_after) = (short(far_before, k), short(far_after, behind));
    let far_before = far_before + short_after - short_before;
    let far_after = far_after + short_before - short_after;
    if far_before > k || far_after > behind {
        return None;
    }
    let before = k - far_before..(k + 1).saturating_sub(near_before);
    let after = k + near_after..k + far_after + 1;
    Some(before.chain(after).map(|j| left[j]).collect())
}
