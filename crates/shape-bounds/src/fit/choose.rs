//! Which family: no more parameters than the contacts call for.

use super::search::Search;
use super::solve::thinned;
use super::{FitError, FitOptions, ShapeFamily, ShapeFit};
use crate::noise::NoisyContact;
use std::fmt;

/// A family that was tried, of shapes in space or of outlines in the plane.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate<F = ShapeFamily, E = FitError> {
    /// The family.
    pub family: F,
    /// Its information criterion, or why it has no fit.
    pub outcome: Result<f64, E>,
}

/// Why each candidate has no fit.
pub(crate) fn reasons<F, E: fmt::Display>(candidates: &[Candidate<F, E>]) -> String {
    let reason = |c: &Candidate<F, E>| c.outcome.as_ref().err().map(ToString::to_string);
    candidates.iter().filter_map(reason).collect::<Vec<_>>().join("; ")
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
        let (fits, mut candidates) = compared(families, |family, none_yet| {
            // Where a smaller family fits, what a hard search would find is not wanted.
            let search = if none_yet { Search::Thorough } else { Search::Quick };
            Self::likeliest(&few, family, options, search)?.unrefuted()
        });
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

/// A fit that may be chosen.
pub(crate) trait Fit {
    /// Its families.
    type Family: Copy;
    /// Why a family has no fit.
    type Error;

    fn criterion(&self) -> f64;
    fn is_exact(&self) -> bool;
    fn parameters(family: Self::Family) -> usize;
    /// What is said of a family that is not tried because one of no more parameters is exact.
    fn needless(family: Self::Family, exact: Self::Family) -> Self::Error;
}

impl Fit for ShapeFit {
    type Family = ShapeFamily;
    type Error = FitError;

    fn criterion(&self) -> f64 {
        self.information_criterion
    }
    fn is_exact(&self) -> bool {
        self.is_exact
    }
    fn parameters(family: ShapeFamily) -> usize {
        family.parameters()
    }
    fn needless(family: ShapeFamily, exact: ShapeFamily) -> FitError {
        FitError::Needless { family, exact }
    }
}

/// All families with the outcome of each.
type Candidates<F> = Vec<Candidate<<F as Fit>::Family, <F as Fit>::Error>>;

/// Fits of all families that have one, the smallest criterion first. A family is fitted with the word whether none fits yet.
pub(crate) fn compared<F: Fit>(
    families: &[F::Family],
    mut fit: impl FnMut(F::Family, bool) -> Result<F, F::Error>,
) -> (Vec<F>, Candidates<F>) {
    let mut fits: Vec<F> = Vec::new();
    let mut candidates = Vec::with_capacity(families.len());
    let mut exact: Option<F::Family> = None;
    for &family in families {
        let needless = exact.filter(|exact| F::parameters(*exact) <= F::parameters(family));
        let fitted = match needless {
            Some(exact) => Err(F::needless(family, exact)),
            None => fit(family, fits.is_empty()),
        };
        let outcome = fitted.map(|fit| {
            if fit.is_exact() {
                exact = Some(family);
            }
            let criterion = fit.criterion();
            fits.push(fit);
            criterion
        });
        candidates.push(Candidate { family, outcome });
    }
    fits.sort_by(|a, b| a.criterion().total_cmp(&b.criterion()));
    (fits, candidates)
}
