//! Shapes of few parameters fitted to contacts.
//!
//! A contact gives a point `x` and an outward normal `n`. For a body with support function `h`, `x = grad h(n)`: three
//! equations in the shape's parameters, linear in those of a ball and of spherical harmonics, and free of the search for
//! a foot point that a fit to points alone needs. Both `x` and `n` are measured; the error of the normal enters through
//! the Hessian of `h`, see `solve`.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::fit::{FitOptions, ShapeFamily, ShapeFit};
//! use shape_bounds::noise::{ContactNoise, NoisyContact};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A ball of 50 mm about (10, 0, 0) mm, touched at the corners of a cube.
//! let corner = |i: u32| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64) * 2.0 - DVec3::ONE;
//! let normals = (0..8).map(|i| corner(i).normalize());
//! let contacts = ContactSample::from_raw(normals.map(|n| (DVec3::X * 0.01 + n * 0.05, n)))?;
//! let noise = ContactNoise::isotropic(1e-4, 1e-2);
//! let noisy: Vec<_> = contacts.iter().map(|&contact| NoisyContact { contact, noise }).collect();
//! let choice = ShapeFit::choose(&noisy, &ShapeFamily::candidates(noisy.len()), &FitOptions::default())?;
//! assert_eq!(choice.best.family(), ShapeFamily::Sphere);
//! let radius = choice.best.parameters()[3];
//! let deviation = choice.best.covariance()[(3, 3)].sqrt();
//! assert!((radius - 0.05).abs() < 1e-9 && deviation < 1e-3);
//! # Ok(())
//! # }
//! ```

pub(crate) mod choose;
mod convex;
mod data;
mod error;
mod family;
mod finish;
mod incremental;
pub(crate) mod information;
pub(crate) mod lasting;
pub(crate) mod levenberg;
pub(crate) mod misfit;
pub(crate) mod nnls;
pub(crate) mod refute;
mod report;
mod search;
mod solve;
#[cfg(test)]
mod tests;

pub use choose::{COMPARED, Candidate, ShapeChoice};
pub use error::FitError;
pub use family::{FittedBody, ShapeFamily, SkewEllipsoid, Superquadric};
pub use incremental::IncrementalFit;
pub use refute::{Refutation, SIGNIFICANCE};
pub use report::{FitStatistics, ShapeFit};

use crate::noise::NoisyContact;
use data::{Data, ball};
use levenberg::{ITERATIONS, LINEAR};
use search::{Search, superquadric};
use solve::{Effort, Spatial, into_error, solve};

/// Whether the stated noise is known, or only how it is shared out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NoiseLevel {
    /// Standard deviations are as stated.
    #[default]
    Stated,
    /// Standard deviations are right but for one common factor, which is estimated from the residuals.
    Estimated,
}

/// What a fit is asked to keep to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FitOptions {
    /// Whether the noise is known.
    pub noise_level: NoiseLevel,
    /// Lower limit of the radii of curvature of a harmonic shape in m; `None` for a hundredth of the size of the data
    /// (the largest distance of a contact from their mean).
    pub smallest_radius: Option<f64>,
}

impl ShapeFit {
    /// The shape of a family that the contacts make likeliest, unless they refute it.
    ///
    /// # Errors
    /// [`FitError`] for bad values, too few contacts, contacts that leave a parameter open (all normals in one plane, one
    /// short arc), no convergence, and a shape that the contacts refute at [`SIGNIFICANCE`]: by the chi-squared test
    /// where the noise is stated, by the likeness of neighbours' residuals where it is not.
    pub fn of(
        contacts: &[NoisyContact],
        family: ShapeFamily,
        options: &FitOptions,
    ) -> Result<Self, FitError> {
        Self::likeliest(contacts, family, options, Search::Thorough)?.unrefuted()
    }

    fn unrefuted(self) -> Result<Self, FitError> {
        match &self.refuted {
            Some(refuted) => Err(refuted.clone()),
            None => Ok(self),
        }
    }

    /// The likeliest shape of a family though the contacts may refute it, where the nearest such shape is wanted whatever the body is.
    ///
    /// # Errors
    /// Those of [`Self::of`] but for the last.
    pub fn nearest(
        contacts: &[NoisyContact],
        family: ShapeFamily,
        options: &FitOptions,
    ) -> Result<Self, FitError> {
        Self::likeliest(contacts, family, options, Search::Nearest)
    }

    /// The likeliest shape, which knows whether it is refuted.
    fn likeliest(
        contacts: &[NoisyContact],
        family: ShapeFamily,
        options: &FitOptions,
        search: Search,
    ) -> Result<Self, FitError> {
        let refusing = search != Search::Nearest;
        let data = Data { refusing, ..Data::check(contacts, options)? };
        let model = data.model(family, contacts.len())?;
        let model = model.as_ref();
        let solution = match family {
            ShapeFamily::Superquadric => superquadric(model, contacts, &data, search)?,
            _ => {
                let start = ball(model, contacts, &data);
                let iterations = if refusing { iterations(family) } else { ITERATIONS };
                let effort = Effort { iterations, ..Effort::default() };
                let problem = Spatial { model, contacts, size: data.size };
                solve(&problem, vec![start], effort, |_| true)
                    .map_err(|e| into_error(e, model, family, data.size))?
            }
        };
        Self::finish(model, family, contacts, solution, &data)
    }
}

/// Iterations after which the contacts are not those of a shape of the family.
fn iterations(family: ShapeFamily) -> usize {
    match family {
        ShapeFamily::Harmonics { .. } => LINEAR,
        _ => ITERATIONS,
    }
}
