//! Functions on the sphere by least squares and energy: through data, or smoother than these by as much as they ask for.

use super::envelope::{Envelope, Factor};
use super::lattice::Lattice;
use nalgebra::SVector;

/// Weight of the energy beside data that are to be interpolated, where these count one each, on a lattice of one cell: it falls as the
/// energy of the waves that fit into a cell, over their number, grows. So few rounds are left on any lattice. At the least weight the
/// equations keep four of their digits where there are no data.
const STIFFNESS: f64 = 1e-5;
const LEAST_STIFFNESS: f64 = 1e-12;
/// Rounds in which what is missed is asked for again.
const ROUNDS: usize = 6;
/// Data that are left out in turn, at most.
const LEFT_OUT: usize = 200;
/// Powers of ten by which the energy weighs less than the data, from the stiffest on.
const DECADES: std::ops::Range<i32> = -2..8;
const HALF_DECADE: f64 = 3.162_277_660_168_379_5;

/// A linear condition on a function: the sum over its coefficients, by their numbers, and what it should be, both times a weight.
#[derive(Clone, Debug)]
pub(super) struct Row {
    terms: Vec<(usize, f64)>,
    target: f64,
}

/// What was smoothed, and how.
pub(super) struct Smoothed {
    pub(super) coefficients: Vec<f64>,
    /// Weight of the energy.
    pub(super) stiffness: f64,
    /// Mean share of itself that a datum has in the function at its place: over all data, how many parameters were used.
    pub(super) share: f64,
}

/// The equations for functions on one lattice.
#[derive(Clone, Debug)]
pub(super) struct Smoother<const D: usize> {
    pub(super) lattice: Lattice<D>,
    energy: Envelope,
}

impl<const D: usize> Smoother<D> {
    pub(super) fn new(half: usize) -> Self {
        let lattice = Lattice::new(half);
        let energy = lattice.energy();
        Self { lattice, energy }
    }

    /// The condition that the value at `u` is `target`.
    pub(super) fn value(&self, u: &SVector<f64, D>, target: f64, weight: f64) -> Row {
        let mut terms = Vec::with_capacity(4_usize.pow(D as u32));
        self.lattice.each_at(u, |number, value, _| terms.push((number, weight * value)));
        Row { terms, target: weight * target }
    }

    /// The condition that the derivative at `u` along a tangent is `target`.
    pub(super) fn slope(
        &self,
        u: &SVector<f64, D>,
        along: &SVector<f64, D>,
        target: f64,
        weight: f64,
    ) -> Row {
        let mut terms = Vec::with_capacity(4_usize.pow(D as u32));
        self.lattice.each_at(u, |number, _, gradient| terms.push((number, weight * gradient.dot(along))));
        Row { terms, target: weight * target }
    }

    fn equations(&self, rows: &[Row], stiffness: f64) -> Option<Factor> {
        let mut matrix = self.energy.times(stiffness);
        for row in rows {
            for (k, (i, a)) in row.terms.iter().enumerate() {
                row.terms[..=k].iter().for_each(|(j, b)| matrix.add(*i, *j, a * b));
            }
        }
        matrix.factor()
    }

    fn right(&self, rows: &[Row], targets: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut right = vec![0.0; self.lattice.count()];
        for (row, target) in rows.iter().zip(targets) {
            row.terms.iter().for_each(|(i, a)| right[*i] += a * target);
        }
        right
    }

    /// The coefficients of least energy of all functions that meet the rows; where no function of the lattice does, those of least
    /// squares. `None` where the rows do not fix one function.
    ///
    /// Method of multipliers (Hestenes 1969): each round asks for what the one before missed, once more.
    pub(super) fn through(&self, rows: &[Row]) -> Option<Vec<f64>> {
        let stiffness = STIFFNESS * (self.lattice.half() as f64).powi(D as i32 - 7);
        let factor = self.equations(rows, stiffness.max(LEAST_STIFFNESS))?;
        let mut asked: Vec<f64> = rows.iter().map(|row| row.target).collect();
        let mut coefficients = factor.solve(self.right(rows, asked.iter().copied()));
        for _ in 0..ROUNDS {
            for (asked, row) in asked.iter_mut().zip(rows) {
                *asked += row.missed(&coefficients);
            }
            coefficients = factor.solve(self.right(rows, asked.iter().copied()));
        }
        Some(coefficients)
    }

    /// The function of least squares and energy of this weight.
    pub(super) fn smooth(&self, rows: &[Row], stiffness: f64) -> Option<Smoothed> {
        let factor = self.equations(rows, stiffness)?;
        let coefficients = factor.solve(self.right(rows, rows.iter().map(|row| row.target)));
        let shares: Vec<f64> = strided(rows).map(|row| self.share(&factor, row)).collect();
        let share = shares.iter().sum::<f64>() / shares.len() as f64;
        Some(Smoothed { coefficients, stiffness, share })
    }

    /// The same with the weight that the data ask for: of the smallest mean square of what each of them misses the function of all
    /// others by, or, where the standard deviation of the noise is stated, of the smallest expected error (Mallows' `C_p`). Looked
    /// for in decades, or beside a weight from before, and at last in halves of them.
    pub(super) fn chosen(&self, rows: &[Row], noise: Option<f64>, before: Option<f64>) -> Option<Smoothed> {
        // In units of what the data weigh, so that it does not matter what these are in.
        let weight: f64 = rows.iter().flat_map(|row| &row.terms).map(|(_, a)| a * a).sum();
        let decades = || DECADES.map(|power| weight * 10_f64.powi(-power)).collect();
        let tried: Vec<f64> = before.map_or_else(decades, |stiffness| vec![stiffness]);
        let best = |tried: &[f64]| {
            let scored = tried.iter().filter_map(|stiffness| self.scored(rows, *stiffness, noise));
            scored.filter(|(score, _)| score.is_finite()).min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let (score, found) = best(&tried)?;
        let beside = best(&[found.stiffness / HALF_DECADE, found.stiffness * HALF_DECADE]);
        Some(beside.filter(|(other, _)| *other < score).map_or(found, |(_, other)| other))
    }

    fn scored(&self, rows: &[Row], stiffness: f64, noise: Option<f64>) -> Option<(f64, Smoothed)> {
        let factor = self.equations(rows, stiffness)?;
        let coefficients = factor.solve(self.right(rows, rows.iter().map(|row| row.target)));
        let (mut score, mut shares, mut count) = (0.0, 0.0, 0.0);
        for row in strided(rows) {
            let (missed, share) = (row.missed(&coefficients), self.share(&factor, row));
            score += match noise {
                None => (missed / (1.0 - share)).powi(2),
                Some(sd) => missed * missed + 2.0 * sd * sd * share,
            };
            shares += share;
            count += 1.0;
        }
        Some((score, Smoothed { coefficients, stiffness, share: shares / count }))
    }

    /// By how much the function at a row's place would follow its datum.
    fn share(&self, factor: &Factor, row: &Row) -> f64 {
        let half = factor.half(self.right(std::slice::from_ref(row), std::iter::once(1.0)));
        half.iter().map(|z| z * z).sum()
    }
}

impl Row {
    /// What is missing to the target.
    pub(super) fn missed(&self, coefficients: &[f64]) -> f64 {
        self.target - self.terms.iter().map(|(i, a)| a * coefficients[*i]).sum::<f64>()
    }
}

/// Some rows, spread evenly.
fn strided(rows: &[Row]) -> impl Iterator<Item = &Row> {
    rows.iter().step_by(rows.len().div_ceil(LEFT_OUT).max(1))
}
