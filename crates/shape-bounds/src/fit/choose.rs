//! Which family: no more parameters than the contacts call for.

use super::solve::{Solution, thinned};
use super::{
    Data, FitError, FitOptions, NoiseLevel, Search, ShapeFamily, ShapeFit, log_determinants, refute,
};
use crate::noise::NoisyContact;

/// A family that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// The family.
    pub family: ShapeFamily,
    /// Its information criterion, or why it has no fit.
    pub outcome: Result<f64, FitError>,
}

/// The chosen shape and what it was chosen from.
#[derive(Clone, Debug)]
pub struct ShapeChoice {
    /// The fit with the smallest information criterion.
    pub best: ShapeFit,
    /// All families in the order given.
    pub candidates: Vec<Candidate>,
}

impl ShapeFamily {
    /// Sphere, ellipsoid, superquadric and harmonics of degree 2 to 8, as far as there are three equations for each
    /// parameter.
    #[must_use]
    pub fn candidates(contacts: usize) -> Vec<Self> {
        let mut families = vec![Self::Sphere, Self::Ellipsoid, Self::Superquadric];
        families.extend((2..=8).map(|degree| Self::Harmonics { degree }));
        families.retain(|family| family.parameters() <= contacts);
        families
    }
}

impl ShapeFit {
    /// The family of the smallest Bayesian information criterion (Schwarz 1978):
    /// `-2 ln L + p ln(3 N)` for `p` parameters and `3 N` equations.
    ///
    /// Schwarz's and not Akaike's criterion, because the question is which description is true and no larger than need
    /// be: as contacts come in, the chance of choosing a family with needless parameters goes to zero with the former
    /// and stays at a constant with the latter. `L` is the likelihood of the points given the measured normals, with the
    /// determinants of the covariances, so that a family is not rewarded for strong curvature, through which errors of
    /// normals could explain any residual.
    ///
    /// ```
    /// use glam::DVec3;
    /// use shape_bounds::{ContactNoise, ContactSample, FitOptions, NoisyContact, ShapeFamily, ShapeFit};
    ///
    /// # fn main() -> Result<(), Box<dyn std::error::Error>> {
    /// // A ball of 50 mm about (10, 0, 0) mm, touched at the corners of a cube.
    /// let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
    /// let normals = (0..8).map(|i| corner(i).normalize());
    /// let contacts = ContactSample::from_raw(normals.map(|n| (DVec3::X * 0.01 + n * 0.05, n)))?;
    /// let noise = ContactNoise::isotropic(1e-4, 1e-2);
    /// let noisy: Vec<_> = contacts.iter().map(|&contact| NoisyContact { contact, noise }).collect();
    /// let choice = ShapeFit::choose(&noisy, &ShapeFamily::candidates(noisy.len()), &FitOptions::default())?;
    /// assert_eq!(choice.best.family(), ShapeFamily::Sphere);
    /// let radius = choice.best.parameters()[3];
    /// let deviation = choice.best.covariance()[(3, 3)].sqrt();
    /// assert!((radius - 0.05).abs() < 1e-9 && deviation < 1e-3);
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// Families that cannot be fitted, or that the contacts refute, are reported and left out, and so are those of more
    /// parameters once one fits exactly. Of more than [`COMPARED`] contacts so many, spread evenly, say in which order families
    /// are fitted to all; the first that all do not refute is the best.
    ///
    /// # Errors
    /// [`FitError::NoFamily`] for none, the family's own error if there is but one, and [`FitError::NoneFits`] if none of several
    /// fits.
    pub fn choose(
        contacts: &[NoisyContact],
        families: &[ShapeFamily],
        options: &FitOptions,
    ) -> Result<ShapeChoice, FitError> {
        let few = thinned(contacts, COMPARED);
        let (mut fits, mut candidates) = compared(&few, families, options);
        fits.sort_by(|a, b| a.information_criterion.total_cmp(&b.information_criterion));
        for fit in fits {
            if few.len() == contacts.len() {
                return Ok(ShapeChoice { best: fit, candidates });
            }
            match Self::of(contacts, fit.family, options) {
                Ok(best) => return Ok(ShapeChoice { best, candidates }),
                Err(error) => {
                    let own = candidates.iter_mut().find(|c| c.family == fit.family);
                    own.into_iter().for_each(|c| c.outcome = Err(error.clone()));
                }
            }
        }
        Err(match &candidates[..] {
            [] => FitError::NoFamily,
            [Candidate { outcome: Err(error), .. }] => error.clone(),
            _ => FitError::NoneFits { candidates },
        })
    }
}

/// Contacts that families are compared on, at most.
pub const COMPARED: usize = 600;

/// Fits of all families that are not refuted, and the outcome of each.
fn compared(
    contacts: &[NoisyContact],
    families: &[ShapeFamily],
    options: &FitOptions,
) -> (Vec<ShapeFit>, Vec<Candidate>) {
    let mut fits: Vec<ShapeFit> = Vec::new();
    let mut candidates = Vec::with_capacity(families.len());
    let mut exact: Option<ShapeFamily> = None;
    // Where a smaller family fits, what a hard search would find is not wanted.
    let search = |none_yet: bool| if none_yet { Search::Thorough } else { Search::Quick };
    for &family in families {
        let needless = exact.filter(|e| e.parameters() <= family.parameters());
        let fitted = match needless {
            Some(exact) => Err(FitError::Needless { family, exact }),
            None => ShapeFit::likeliest(contacts, family, options, search(fits.is_empty()))
                .and_then(ShapeFit::unrefuted),
        };
        let outcome = fitted.map(|fit| {
            if fit.is_exact {
                exact = Some(family);
            }
            let criterion = fit.information_criterion;
            fits.push(fit);
            criterion
        });
        candidates.push(Candidate { family, outcome });
    }
    (fits, candidates)
}

pub(super) fn criterion(solution: &Solution, data: &Data, parameters: usize) -> f64 {
    let equations = (3 * solution.system.contacts.len()) as f64;
    let chi_squared = solution.system.chi_squared;
    let misfit = match data.noise_level {
        NoiseLevel::Stated => chi_squared,
        // The factor of the noise is fitted as well, which profiles the likelihood. Exact data would make it zero.
        NoiseLevel::Estimated => {
            equations * (chi_squared.max(refute::rounding(solution, data)) / equations).ln()
        }
    };
    misfit + log_determinants(solution) + parameters as f64 * equations.ln()
}
