//! Whether what is left of the readings is alike from sample to sample: noise that lasts says less than white noise of the same size.

use super::body::CONSTANTS;
use super::equations::Equations;
use super::problem::{Problem, Unknowns};
use super::solve::Solved;
use nalgebra::Vector3;
use object_dynamics::MOST_PALMS;

/// Standard deviations of a correlation of white noise that are taken for chance.
const CHANCE: f64 = 2.0;
/// Correlation from which on noise is not to be told from a constant.
const MOST: f64 = 0.97;

impl Solved<CONSTANTS> {
    /// Correlation of what is left of conditions and links with what is left of them one sample and one link later, less what chance makes of it; zero
    /// where noise is not what is left.
    ///
    /// Least squares share noise between a condition and the links beside it: of white noise what is left of conditions alternates and what is
    /// left of links lasts, each for itself (-0.4 and 0.5 where they share alike), and both together are white (-0.3 to 0.05 in the scenes that were
    /// tried). Of noise that lasts the sum tells its correlation.
    pub(super) fn correlation(&self, problem: &Problem) -> f64 {
        let Equations { cost, conditions, .. } = self.equations;
        if problem.exact || conditions == 0 || cost.is_nan() || cost <= 0.0 {
            return 0.0;
        }
        let chance = CHANCE / (conditions as f64).sqrt();
        let all = problem.products_of_conditions(&self.unknowns) + products_of_links(&self.equations);
        (all / cost - chance).clamp(0.0, MOST)
    }
}

/// Of what is left of each link and the one after it, in deviations.
fn products_of_links<const P: usize>(equations: &Equations<P>) -> f64 {
    let links = equations.links.windows(2);
    links.map(|pair| (pair[0].information * pair[0].left).dot(&pair[1].left)).sum()
}

impl Problem<'_> {
    /// Of the conditions of each palm at each sample and the one after it, in deviations.
    fn products_of_conditions(&self, at: &Unknowns) -> f64 {
        let mut before: [Option<(usize, Vector3<f64>)>; MOST_PALMS] = [None; MOST_PALMS];
        let mut all = 0.0;
        self.visit_conditions(at, |k, palm, values| {
            let last = before[palm].replace((k, values)).filter(|(last, _)| last + 1 == k);
            all += last.map_or(0.0, |(_, last)| last.dot(&values));
        });
        all
    }
}
