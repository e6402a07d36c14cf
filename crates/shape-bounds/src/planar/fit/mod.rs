//! Outlines of few parameters fitted to contacts: the twin of the fits in space, which say more.
//!
//! A contact gives a point `x` and the direction `theta` of its outward normal. For an outline with radius function `r`,
//! `x = r n + r' n'`: two equations in the shape's parameters. Both are measured; the error of the normal enters through
//! the radius of curvature.

mod convex;
mod error;
mod family;
mod finish;
mod solve;
#[cfg(test)]
mod tests;

pub use error::FitError;
pub use family::{FittedOutline, TurnedEllipse};

use super::noise::{ContactNoise, NoisyContact};
use crate::fit::choose::{Fit, compared};
use crate::fit::levenberg::{ITERATIONS, LINEAR, best_of, iterate};
use crate::fit::refute::coincide;
use crate::fit::{Candidate, FitOptions, FitStatistics, NoiseLevel};
use contact_kinematics::planar::{RadiusBounds, RadiusFunction, RadiusJet};
use family::model;
use glam::DVec2;
use nalgebra::{DMatrix, DVector};
use solve::Plane;
use std::fmt;

/// Families of outlines, by what their parameters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum OutlineFamily {
    /// A disc: centre and radius, 3 parameters.
    Circle,
    /// An ellipse with any axes: 5 parameters.
    Ellipse,
    /// A radius function of waves up to an order: `2 order + 1` parameters.
    Fourier {
        /// The highest order, at least 1; order 1 is a disc.
        order: usize,
    },
}

impl fmt::Display for OutlineFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Circle => f.write_str("circle"),
            Self::Ellipse => f.write_str("ellipse"),
            Self::Fourier { order } => write!(f, "waves to order {order}"),
        }
    }
}

impl OutlineFamily {
    /// Number of parameters.
    #[must_use]
    pub fn parameters(self) -> usize {
        match self {
            Self::Circle => 3,
            Self::Ellipse => 5,
            Self::Fourier { order } => 2 * order.max(1) + 1,
        }
    }

    /// Circle, ellipse and waves of order 2 to 12, as far as there are two equations for each parameter.
    #[must_use]
    pub fn candidates(contacts: usize) -> Vec<Self> {
        let mut families = vec![Self::Circle, Self::Ellipse];
        families.extend((2..=12).map(|order| Self::Fourier { order }));
        families.retain(|family| family.parameters() <= contacts);
        families
    }
}

/// An outline fitted to contacts.
#[derive(Clone, Debug)]
pub struct OutlineFit {
    family: OutlineFamily,
    body: FittedOutline,
    parameters: DVector<f64>,
    covariance: DMatrix<f64>,
    statistics: FitStatistics,
    information_criterion: f64,
    /// Whether the residuals are rounding.
    is_exact: bool,
}

/// The chosen outline and what it was chosen from.
#[derive(Clone, Debug)]
pub struct OutlineChoice {
    /// The fit with the smallest information criterion.
    pub best: OutlineFit,
    /// All families in the order given.
    pub candidates: Vec<Candidate<OutlineFamily, FitError>>,
}

impl OutlineFit {
    /// The outline of a family that the contacts make likeliest, unless they refute it.
    ///
    /// # Errors
    /// [`FitError`] for bad values, too few contacts, contacts that leave a parameter open, no convergence, and an outline
    /// that the contacts refute: see [`crate::fit::ShapeFit::of`].
    pub fn of(
        contacts: &[NoisyContact],
        family: OutlineFamily,
        options: &FitOptions,
    ) -> Result<Self, FitError> {
        let (centre, size) = check(contacts, family, options.noise_level)?;
        let limit = options.smallest_radius.unwrap_or(0.01 * size);
        if !(limit >= 0.0 && limit.is_finite()) {
            return Err(FitError::Radius(limit));
        }
        let model = model(family);
        let mut exact = contacts.to_vec();
        exact.iter_mut().for_each(|c| c.noise.normal = 0.0);
        let plane = |contacts| Plane { model: model.as_ref(), contacts, size };
        let iterations = if let OutlineFamily::Fourier { .. } = family { LINEAR } else { ITERATIONS };
        // Normals as exact first: a smooth problem from any start.
        let solution = best_of(&plane(&exact), vec![model.circle(centre, size)])
            .and_then(|near| iterate(&plane(contacts), near, iterations));
        let solution = solution.map_err(|e| solve::into_error(e, model.as_ref(), family, size))?;
        Self::finish(plane(contacts), family, solution, limit, options.noise_level)
    }

    /// The family of the smallest Bayesian information criterion; see [`crate::fit::ShapeFit::choose`].
    ///
    /// # Errors
    /// [`FitError::NoFamily`] for none, the family's own error if there is but one, and [`FitError::NoneFits`] if none of several
    /// fits.
    pub fn choose(
        contacts: &[NoisyContact],
        families: &[OutlineFamily],
        options: &FitOptions,
    ) -> Result<OutlineChoice, FitError> {
        let (fits, candidates) = compared(families, |family, _| Self::of(contacts, family, options));
        match (fits.into_iter().next(), &candidates[..]) {
            (Some(best), _) => Ok(OutlineChoice { best, candidates }),
            (None, []) => Err(FitError::NoFamily),
            (None, [Candidate { outcome: Err(error), .. }]) => Err(error.clone()),
            (None, _) => Err(FitError::NoneFits { candidates }),
        }
    }

    /// The family.
    #[must_use]
    pub fn family(&self) -> OutlineFamily {
        self.family
    }

    /// The outline; it is a radius function like any other body.
    #[must_use]
    pub fn body(&self) -> &FittedOutline {
        &self.body
    }

    /// What each parameter is called.
    #[must_use]
    pub fn names(&self) -> Vec<String> {
        let model = model(self.family);
        (0..self.parameters.len()).map(|i| model.name(i)).collect()
    }

    /// The parameters in m. Circle: centre, radius. Ellipse: centre, and the rows of the lower triangle `L` with
    /// `r = c . n + |L' n|`. Waves: `a_0, a_1, b_1, a_2, b_2, ...`.
    #[must_use]
    pub fn parameters(&self) -> &DVector<f64> {
        &self.parameters
    }

    /// Covariance of the parameters: the inverse of the Fisher information at the estimate.
    #[must_use]
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Residuals and what the contacts determine.
    #[must_use]
    pub fn statistics(&self) -> &FitStatistics {
        &self.statistics
    }

    /// Bayesian information criterion, smaller is better.
    #[must_use]
    pub fn information_criterion(&self) -> f64 {
        self.information_criterion
    }

    /// Standard deviation of the radius function at the normal direction `theta` (rad), in m.
    #[must_use]
    pub fn radius_deviation(&self, theta: f64) -> f64 {
        let mut columns = vec![DVec2::ZERO; self.parameters.len()];
        if model(self.family).columns(&self.parameters, theta, &mut columns).is_none() {
            return f64::INFINITY;
        }
        let n = DVec2::from_angle(theta);
        let slope = DVector::from_iterator(columns.len(), columns.iter().map(|c| c.dot(n)));
        slope.dot(&(&self.covariance * &slope)).max(0.0).sqrt()
    }
}

impl Fit for OutlineFit {
    type Family = OutlineFamily;
    type Error = FitError;

    fn criterion(&self) -> f64 {
        self.information_criterion
    }
    fn is_exact(&self) -> bool {
        self.is_exact
    }
    fn parameters(family: OutlineFamily) -> usize {
        family.parameters()
    }
    fn needless(family: OutlineFamily, exact: OutlineFamily) -> FitError {
        FitError::Needless { family, exact }
    }
}

impl RadiusFunction for OutlineFit {
    fn jet(&self, theta: f64) -> RadiusJet {
        self.body.jet(theta)
    }
    fn radius_bounds(&self) -> RadiusBounds {
        self.body.radius_bounds()
    }
}

/// Centre and size of usable contacts.
fn check(
    contacts: &[NoisyContact],
    family: OutlineFamily,
    level: NoiseLevel,
) -> Result<(DVec2, f64), FitError> {
    for (index, NoisyContact { contact, noise }) in contacts.iter().enumerate() {
        if !contact.point.is_finite() {
            return Err(FitError::NotFinite { index, point: contact.point });
        }
        let ContactNoise { point, .. } = noise;
        if let Some((name, value)) = noise.defect() {
            return Err(FitError::Noise { index, name, value });
        }
        if noise.pose_translation != 0.0 || noise.pose_rotation != 0.0 {
            return Err(FitError::PoseNoise { index });
        }
        if point.determinant() <= 0.0 {
            return Err(FitError::Noise { index, name: "point", value: point.determinant() });
        }
    }
    let needed = family.parameters().div_ceil(2).max(2);
    if contacts.len() < needed {
        return Err(FitError::TooFew { family, found: contacts.len(), needed });
    }
    let centre = contacts.iter().map(|c| c.contact.point).sum::<DVec2>() / contacts.len() as f64;
    let size = contacts.iter().map(|c| c.contact.point.distance(centre)).fold(0.0, f64::max);
    let squares = contacts.iter().map(|c| {
        let off = c.contact.point - centre;
        off.dot(c.noise.point.inverse() * off)
    });
    let one = coincide(level, squares.sum(), 2 * (contacts.len() - 1));
    if size == 0.0 || !size.is_finite() || one {
        return Err(FitError::NoExtent { found: contacts.len() });
    }
    Ok((centre, size))
}
