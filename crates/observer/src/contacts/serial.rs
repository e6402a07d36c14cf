//! Whether what is left of the readings is alike from sample to sample: noise that lasts says less than white noise of the same size.

use super::body::CONSTANTS;
use super::equations::LinkEquation;
use super::problem::{Problem, Unknowns};
use super::solve::Solved;
use super::state::MOTION;
use crate::chance::lasting;
use object_dynamics::MOST_PALMS;

/// Standard deviations of a correlation of white noise that are taken for chance.
const CHANCE: f64 = 2.0;

impl Solved<CONSTANTS> {
    /// How many times the variance of independent noise that of a mean of what is left is: 1 of white noise, and where noise is not what is left.
    ///
    /// Least squares share noise between a condition and the links beside it: of white noise what is left of conditions alternates and what is
    /// left of links lasts, each for itself (correlations of -0.4 and 0.5 where they share alike), and both together are white (-0.3 to 0.05 in the
    /// scenes that were tried, where chance makes 0.06). Of noise that lasts both together tell the correlation.
    pub(super) fn lasting(&self, problem: &Problem) -> f64 {
        let conditions = self.equations.conditions;
        if problem.exact || conditions == 0 {
            return 1.0;
        }
        let mut series = problem.conditions_left(&self.unknowns);
        series.extend(links_left(&self.equations.links));
        lasting(&series, CHANCE / (conditions as f64).sqrt())
    }
}

/// What is left of links in independent deviations, each number a series.
fn links_left<const P: usize>(links: &[LinkEquation<P>]) -> Vec<Vec<f64>> {
    let mut series = vec![vec![0.0; links.len()]; MOTION];
    for (j, link) in links.iter().enumerate() {
        let Some(factor) = link.information.cholesky() else { continue };
        let left = factor.l().tr_mul(&link.left);
        series.iter_mut().zip(left.iter()).for_each(|(series, left)| series[j] = *left);
    }
    series
}

impl Problem<'_> {
    /// What is left of the conditions of each palm in independent deviations, each number a series; zero where there is none.
    pub(super) fn conditions_left(&self, at: &Unknowns) -> Vec<Vec<f64>> {
        let mut series = vec![vec![0.0; self.record.times.len()]; 3 * MOST_PALMS];
        self.visit_conditions(at, |k, palm, values| {
            series[3 * palm..].iter_mut().zip(values.iter()).for_each(|(series, left)| series[k] = *left);
        });
        series
    }
}
