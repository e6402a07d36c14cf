//! Whether the contacts refute a fitted shape, in the plane and in space.

use super::NoiseLevel;
use super::levenberg::Whitened;
use super::misfit::Misfit;
use crate::bounds::PRINTED;
use crate::noise::quantile::normal;
use glam::DVec3;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use thiserror::Error;

/// A shape is refused if contacts of a body of its family would speak against it as much with less than this probability.
pub const SIGNIFICANCE: f64 = 1e-4;
/// Contacts whose nearest neighbours are looked for, which takes the square of their number.
const JUDGED: usize = 2000;

/// By what contacts refute a shape.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Refutation {
    /// Residuals are larger than the stated noise.
    #[error(
        "chi-squared {chi_squared:.1} of {degrees_of_freedom} degrees of freedom, which contacts of such a shape exceed \
         once in {:.0} times; the body is no such shape, or the noise is larger than stated",
        1.0 / SIGNIFICANCE
    )]
    ChiSquared {
        /// Sum of squared residuals in units of the stated noise.
        chi_squared: f64,
        /// Equations minus parameters that no constraint holds.
        degrees_of_freedom: usize,
    },
    /// Harmonics that the family does not have explain more of the residuals than noise lets them.
    #[error(
        "harmonics of degree {degree} take {improvement:.1} of chi-squared for {harmonics} parameters, which of such a shape they do \
         once in {:.0} times; the body is no such shape",
        1.0 / SIGNIFICANCE
    )]
    Departure {
        /// Degree of the harmonics, ...
        degree: usize,
        /// ... their number, ...
        harmonics: usize,
        /// ... and by how much they lower the sum of squared residuals in units of the noise.
        improvement: f64,
    },
    /// Residuals of neighbours are alike, which noise is not.
    #[error(
        "residuals of {residual:.1e} m are alike at neighbouring contacts, as those of another shape and not as noise is \
         (p-value below {SIGNIFICANCE:.0e})"
    )]
    Likeness {
        /// Root mean square of the residuals per axis, in m.
        residual: f64,
    },
}

/// A contact's place on the fitted body and what the fit leaves of it; in the plane without a third coordinate.
///
/// Where the contact was measured to be says something of its error, so contacts that were measured near one another have
/// alike ones. Its likeliest place on the body does not.
pub(crate) struct Leftover {
    /// Where, in m.
    pub(crate) point: DVec3,
    /// Outward unit normal there.
    pub(crate) normal: DVec3,
    /// Residual in units of the noise.
    pub(crate) residual: DVec3,
}

/// What refutes a shape with such a misfit at [`SIGNIFICANCE`], if anything does.
///
/// With stated noise by the chi-squared test. With unknown noise by what is left: residuals of a shape of the family are
/// independent from contact to contact, those of another shape are alike at neighbours. What contacts are printed with says
/// nothing of the shape, whether neighbours have it alike or not.
pub(crate) fn refutation(
    level: NoiseLevel,
    misfit: &Misfit,
    leftovers: impl FnOnce() -> Vec<Leftover>,
) -> Option<Refutation> {
    if misfit.is_exact() {
        return None;
    }
    let Misfit { chi_squared, residual, size, .. } = *misfit;
    let degrees_of_freedom = misfit.degrees_of_freedom();
    match level {
        NoiseLevel::Stated if chi_squared > chi_squared_quantile(degrees_of_freedom) => {
            Some(Refutation::ChiSquared { chi_squared, degrees_of_freedom })
        }
        NoiseLevel::Estimated
            if residual > PRINTED * size && likeness(&leftovers(), size) > normal(SIGNIFICANCE) =>
        {
            Some(Refutation::Likeness { residual })
        }
        _ => None,
    }
}

/// Whether points are one to within the stated noise, from the sum of squares of their distances from their mean in units of it.
///
/// A body of no size then explains them, whatever they were measured on.
pub(crate) fn coincide(level: NoiseLevel, squares: f64, equations: usize) -> bool {
    level == NoiseLevel::Stated && squares <= chi_squared_quantile(equations)
}

/// What columns beyond a family's own take of the residuals' sum of squares, if noise lets them take so much once in
/// `1 / SIGNIFICANCE` times only: the score test (Rao 1948). With noise of an unknown level of what is left, and of noise that lasts less by the square
/// of what it makes deviations wider by. `None` also where they cannot be told from the family's own.
pub(crate) fn departure(
    level: NoiseLevel,
    whitened: &Whitened,
    beyond: &DMatrix<f64>,
    lasting: f64,
) -> Option<f64> {
    let residuals = DVector::from_column_slice(&whitened.residuals);
    let all = DMatrix::from_columns(
        &[whitened.rows.column_iter().collect::<Vec<_>>(), beyond.column_iter().collect()].concat(),
    );
    let left = (all.nrows()).checked_sub(all.ncols()).filter(|left| *left > 0)?;
    let scaled = DMatrix::from_columns(
        &all.column_iter().map(|c| c / c.norm().max(f64::MIN_POSITIVE)).collect::<Vec<_>>(),
    );
    let right = scaled.tr_mul(&residuals);
    let squares = residuals.norm_squared();
    let explained = (scaled.tr_mul(&scaled)).cholesky()?.solve(&right).dot(&right);
    let scale = match level {
        NoiseLevel::Stated => 1.0,
        NoiseLevel::Estimated => (squares - explained) / left as f64,
    };
    let improvement = explained / scale / lasting.powi(2);
    (improvement > chi_squared_quantile(beyond.ncols())).then_some(improvement)
}

/// Whether the sum of squares is one that contacts of such a shape leave; with unknown noise, whether it is next to none.
pub(crate) fn is_likely(level: NoiseLevel, misfit: &Misfit) -> bool {
    misfit.chi_squared
        <= match level {
            NoiseLevel::Stated => chi_squared_quantile(misfit.degrees_of_freedom()),
            NoiseLevel::Estimated => misfit.rounding(),
        }
}

/// How far in its standard deviations an estimate may be moved to where the truth is: noise takes it no further.
pub(crate) fn farthest(misfit: &Misfit, level: NoiseLevel) -> f64 {
    chi_squared_quantile(misfit.parameters).sqrt() * misfit.noise_factor(level)
}

/// What chi-squared exceeds with a probability of [`SIGNIFICANCE`], by the cube root's approximation (Wilson and Hilferty 1931),
/// which is right to a hundredth from three degrees of freedom on.
fn chi_squared_quantile(degrees_of_freedom: usize) -> f64 {
    let count = degrees_of_freedom.max(1) as f64;
    let variance = 2.0 / (9.0 * count);
    count * (1.0 - variance + normal(SIGNIFICANCE) * variance.sqrt()).powi(3)
}

/// The sum of the cosines between neighbours' residuals in its standard deviations, which takes nothing of their distribution
/// but symmetry: about normal for independent ones. Pairs of nearest neighbours close no ring, so their signs are independent.
fn likeness(leftovers: &[Leftover], size: f64) -> f64 {
    let step = leftovers.len().div_ceil(JUDGED).max(1);
    let some: Vec<&Leftover> = leftovers.iter().step_by(step).collect();
    let far = |a: &Leftover, b: &Leftover| {
        a.point.distance_squared(b.point) / (size * size) + a.normal.distance_squared(b.normal)
    };
    let nearest = |k: usize| {
        let others = (0..some.len()).filter(|j| *j != k).map(|j| (far(some[k], some[j]), j));
        others.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j)| j)
    };
    let neighbours: BTreeMap<usize, usize> = (0..some.len()).filter_map(|k| Some((k, nearest(k)?))).collect();
    let (mut sum, mut squares) = (0.0, 0.0);
    for (k, j) in &neighbours {
        // A pair of nearest neighbours counts once.
        if k > j && neighbours.get(j) == Some(k) {
            continue;
        }
        let [a, b] = [k, j].map(|k| some[*k].residual);
        let cosine = a.dot(b) / (a.length() * b.length()).max(f64::MIN_POSITIVE);
        sum += cosine;
        squares += cosine * cosine;
    }
    if squares > 0.0 { sum / squares.sqrt() } else { 0.0 }
}
