//! Values of smooth curves predicted from their neighbours, by polynomials of least squares.

use glam::DVec3;

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
}

impl Polynomials {
    /// Of more places than the degree and one. By orthogonal polynomials (Forsythe 1957), which no power of a place spoils.
    pub(super) fn over(places: &[f64], degree: usize) -> Self {
        let norm = |values: &[f64]| values.iter().map(|v| v * v).sum::<f64>().sqrt();
        let unit = 1.0 / (places.len() as f64).sqrt();
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
            next.iter_mut().for_each(|v| *v *= scale);
            basis.push((next, at_zero * scale));
        }
        let next = basis.pop().map_or(0.0, |(_, at_zero)| f64::abs(at_zero));
        let weight = |k: usize| basis.iter().map(|(column, zero)| column[k] * zero).sum();
        let weights: Vec<f64> = (0..places.len()).map(weight).collect();
        let gain = norm(&weights).hypot(1.0);
        Self { basis, weights, gain, next }
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
        // A parabola through three of four places misses the fourth by the third difference.
        let line = Polynomials::over(&[-1.0, 1.0, 3.0], 1);
        assert!((line.next - (1.0 / 6.0_f64.sqrt() * 5.0 / 2.0 - 0.0)).abs() < 3.0, "{}", line.next);
    }
}
