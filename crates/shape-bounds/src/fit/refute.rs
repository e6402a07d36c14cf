//! Whether the contacts refute a fitted shape.

use super::solve::Solution;
use super::{Data, FitError, NoiseLevel, ShapeFamily};
use crate::bounds::PRINTED;
use crate::noise::NoisyContact;
use crate::noise::quantile::normal;
use std::collections::BTreeMap;

/// A shape is refused if contacts of a body of its family would speak against it as much with less than this probability.
pub const SIGNIFICANCE: f64 = 1e-4;
/// Contacts whose nearest neighbours are looked for, which takes the square of their number.
const JUDGED: usize = 2000;
/// Residuals below this share of the size are rounding, of the numbers given or of the iteration: the fit is exact.
pub(super) const EXACT: f64 = 1e-9;

/// Whether the residuals are rounding.
pub(super) fn is_exact(residual: f64, data: &Data) -> bool {
    residual <= EXACT * data.size
}

/// Refuses a shape that its contacts refute at [`SIGNIFICANCE`].
///
/// With stated noise by the chi-squared test. With unknown noise by what is left: residuals of a shape of the family are
/// independent from contact to contact, those of another shape are alike at neighbours. What contacts are printed with says
/// nothing of the shape, whether neighbours have it alike or not.
pub(super) fn check(
    family: ShapeFamily,
    contacts: &[NoisyContact],
    solution: &Solution,
    data: &Data,
    (residual, degrees_of_freedom): (f64, usize),
) -> Result<(), FitError> {
    if is_exact(residual, data) {
        return Ok(());
    }
    let chi_squared = solution.system.chi_squared;
    match data.noise_level {
        NoiseLevel::Stated if chi_squared > chi_squared_quantile(degrees_of_freedom) => {
            Err(FitError::Refuted { family, chi_squared, degrees_of_freedom })
        }
        NoiseLevel::Estimated
            if residual > PRINTED * data.size
                && likeness(contacts, solution, data.size) > normal(SIGNIFICANCE) =>
        {
            Err(FitError::Unlike { family, residual })
        }
        _ => Ok(()),
    }
}

/// Whether the sum of squares is one that contacts of such a shape leave; with unknown noise, whether it is next to none.
pub(super) fn is_likely(solution: &Solution, data: &Data, degrees_of_freedom: usize) -> bool {
    let chi_squared = solution.system.chi_squared;
    match data.noise_level {
        NoiseLevel::Stated => chi_squared <= chi_squared_quantile(degrees_of_freedom),
        NoiseLevel::Estimated => chi_squared <= rounding(solution, data),
    }
}

/// The sum of squares of residuals that are rounding.
pub(super) fn rounding(solution: &Solution, data: &Data) -> f64 {
    let weight: f64 = solution.system.contacts.iter().map(|c| c.whitening.norm_squared()).sum();
    weight * (EXACT * data.size).powi(2)
}

/// What chi-squared exceeds with a probability of [`SIGNIFICANCE`], by the cube root's approximation (Wilson and Hilferty 1931),
/// which is right to a hundredth from three degrees of freedom on.
pub(super) fn chi_squared_quantile(degrees_of_freedom: usize) -> f64 {
    let count = degrees_of_freedom.max(1) as f64;
    let variance = 2.0 / (9.0 * count);
    count * (1.0 - variance + normal(SIGNIFICANCE) * variance.sqrt()).powi(3)
}

/// The sum of the cosines between neighbours' residuals in its standard deviations, which takes nothing of their distribution
/// but symmetry: about normal for independent ones.
fn likeness(contacts: &[NoisyContact], solution: &Solution, size: f64) -> f64 {
    let step = contacts.len().div_ceil(JUDGED).max(1);
    let some: Vec<usize> = (0..contacts.len()).step_by(step).collect();
    let far = |a: usize, b: usize| {
        let (a, b) = (&contacts[a].contact, &contacts[b].contact);
        a.point.distance_squared(b.point) / (size * size) + a.normal.get().distance_squared(b.normal.get())
    };
    let nearest = |k: usize| {
        let others = some.iter().copied().filter(|j| *j != k).map(|j| (far(k, j), j));
        others.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j)| j)
    };
    let neighbours: BTreeMap<usize, usize> = some.iter().filter_map(|k| Some((*k, nearest(*k)?))).collect();
    let (mut sum, mut squares) = (0.0, 0.0);
    for (k, j) in &neighbours {
        // A pair of nearest neighbours counts once.
        if k > j && neighbours.get(j) == Some(k) {
            continue;
        }
        let [a, b] = [k, j].map(|k| solution.system.contacts[*k].residual);
        let cosine = a.dot(&b) / (a.norm() * b.norm()).max(f64::MIN_POSITIVE);
        sum += cosine;
        squares += cosine * cosine;
    }
    if squares > 0.0 { sum / squares.sqrt() } else { 0.0 }
}
