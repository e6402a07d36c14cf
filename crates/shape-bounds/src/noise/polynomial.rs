//! Values of smooth curves predicted from their neighbours, by polynomials of least squares.

use glam::DVec3;
use std::collections::HashMap;
use std::rc::Rc;

/// Neighbours that predict a contact, by their places in the curve counted from it, and the degree of the polynomial.
#[derive(Clone, Copy, Debug)]
pub(super) struct Predictor {
    pub(super) before: (usize, usize),
    pub(super) after: (usize, usize),
    pub(super) degree: usize,
}

pub(super) const fn around(before: usize, after: usize, reach: usize, degree: usize) -> Predictor {
    Predictor { before: (before, reach), after: (after, reach), degree }
}

/// The neighbours of the `k`-th of those `left` that a predictor takes, where there are as many.
pub(super) fn neighbours(left: &[usize], k: usize, of: Predictor) -> Option<Vec<usize>> {
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

/// Polynomials of a degree over some places, none of them 0.
#[derive(Clone, Debug)]
pub(super) struct Polynomials {
    /// An orthonormal basis at the places, and at 0.
    basis: Vec<(Vec<f64>, f64)>,
    /// By which values at the places give that of the nearest polynomial at 0.
    pub(super) weights: Vec<f64>,
    /// Deviation of a value at 0 from its prediction, where all values have deviation 1.
    pub(super) gain: f64,
    /// By how much what one degree more would add is missed at 0, over the root of the sum of squares that it leaves.
    pub(super) next: f64,
    /// The same of the power of the place that is one degree more, over the factorial of that degree.
    pub(super) power: f64,
}

impl Polynomials {
    /// Of more places than the degree and one. By orthogonal polynomials (Forsythe 1957), which no power of a place spoils.
    pub(super) fn over(places: &[f64], degree: usize) -> Self {
        let norm = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let unit = 1.0 / (places.len() as f64).sqrt();
        // Of the power of a place that is the degree: what lower ones leave of it, over the last of the basis.
        let mut leading = 1.0 / unit;
        let mut basis = vec![(vec![unit; places.len()], unit)];
        while basis.len() <= degree + 1 {
            let last = &basis[basis.len() - 1];
            let mut next: Vec<f64> = places.iter().zip(&last.0).map(|(t, v)| t * v).collect();
            let mut at_zero = 0.0;
            for (column, zero) in basis.iter().rev().take(2) {
                let share: f64 = column.iter().zip(&next).map(|(a, b)| a * b).sum();
                next.iter_mut().zip(column).for_each(|(v, c)| *v -= share * c);
                at_zero -= share * zero;
            }
            let scale = 1.0 / norm(&next);
            leading /= scale * basis.len() as f64;
            next.iter_mut().for_each(|v| *v *= scale);
            basis.push((next, at_zero * scale));
        }
        let next = basis.pop().map_or(0.0, |(_, at_zero)| f64::abs(at_zero));
        let power = next * leading;
        let weight = |k: usize| basis.iter().map(|(column, zero)| column[k] * zero).sum();
        let weights: Vec<f64> = (0..places.len()).map(weight).collect();
        let gain = norm(&weights).hypot(1.0);
        Self { basis, weights, gain, next, power }
    }

    /// The sum of squares that the nearest polynomial leaves of `values` at the places.
    pub(super) fn misfit(&self, mut values: Vec<DVec3>) -> f64 {
        for (column, _) in &self.basis {
            let share: DVec3 = column.iter().zip(&values).map(|(c, v)| *v * *c).sum();
            values.iter_mut().zip(column).for_each(|(v, c)| *v -= share * *c);
        }
        values.iter().map(|v| v.length_squared()).sum()
    }

    /// Values less those of the polynomial: how many are free.
    pub(super) fn free(&self) -> usize {
        self.weights.len() - self.basis.len()
    }
}

/// Polynomials by the neighbours' places, counted from the one that they predict, and the degree.
#[derive(Debug, Default)]
pub(super) struct Known(HashMap<(Vec<isize>, usize), Rc<Polynomials>>);

impl Known {
    pub(super) fn polynomials(&mut self, one: usize, others: &[usize], degree: usize) -> Rc<Polynomials> {
        let places: Vec<isize> = others.iter().map(|j| *j as isize - one as isize).collect();
        let made = |(places, degree): &(Vec<isize>, usize)| {
            let places: Vec<f64> = places.iter().map(|p| *p as f64).collect();
            Rc::new(Polynomials::over(&places, *degree))
        };
        self.0.entry((places, degree)).or_insert_with_key(made).clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_predicted_exactly_and_leave_nothing() {
        let places = [-4.0, -3.0, -1.0, 1.0, 2.0, 5.0, 6.0];
        for degree in 0..5 {
            let polynomials = Polynomials::over(&places, degree);
            for power in 0..=degree {
                let values = places.map(|t| f64::powi(t, power as i32));
                let found: f64 = values.iter().zip(&polynomials.weights).map(|(v, w)| v * w).sum();
                assert!((found - f64::from(power == 0)).abs() < 1e-11, "{degree} {power}: {found}");
                let left = polynomials.misfit(values.map(DVec3::splat).to_vec());
                assert!(left.sqrt() < 1e-14 * values[6].abs().max(1.0) * 10.0, "{degree} {power}: {left}");
            }
        }
        let mean = Polynomials::over(&places, 0);
        assert!(mean.weights.iter().all(|w| (w - 1.0 / 7.0).abs() < 1e-15) && mean.free() == 6);
        // Of a line through four places, what a parabola bends by is missed at 0 by the ratio of both.
        let line = Polynomials::over(&[-2.0, -1.0, 1.0, 2.0], 1);
        let parabola = [-2.0_f64, -1.0, 1.0, 2.0].map(|t| DVec3::X * (t * t));
        let missed = line.weights.iter().zip(parabola).map(|(w, v)| w * v.x).sum::<f64>();
        assert!((missed.abs() - line.next * line.misfit(parabola.to_vec()).sqrt()).abs() < 1e-14);
        assert!((missed.abs() - 2.0 * line.power).abs() < 1e-14, "the second power over two");
        let cubic = Polynomials::over(&places, 3);
        let missed = places.iter().zip(&cubic.weights).map(|(t, w)| w * t.powi(4)).sum::<f64>();
        assert!((missed.abs() - 24.0 * cubic.power).abs() < 1e-10, "{missed} {}", cubic.power);
    }
}
