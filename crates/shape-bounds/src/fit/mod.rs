//! Shapes of few parameters fitted to contacts.
//!
//! A contact gives a point `x` and an outward normal `n`. For a body with support function `h`, `x = grad h(n)`: three
//! equations in the shape's parameters, linear in those of a ball and of spherical harmonics, and free of the search for
//! a foot point that a fit to points alone needs. Both `x` and `n` are measured; the error of the normal enters through
//! the Hessian of `h`, see `solve`.

mod choose;
mod convex;
mod data;
mod error;
mod family;
mod incremental;
pub(crate) mod information;
pub(crate) mod levenberg;
pub(crate) mod nnls;
mod refute;
mod report;
mod solve;
#[cfg(test)]
mod tests;

pub use choose::{COMPARED, Candidate, ShapeChoice};
pub use error::FitError;
pub use family::{SkewEllipsoid, Superquadric};
pub use incremental::IncrementalFit;
pub use refute::SIGNIFICANCE;
pub use report::{FitStatistics, ShapeFit};

use crate::noise::NoisyContact;
use contact_kinematics::{
    CurvatureRadii, Direction, PolynomialSupport, Sphere, SupportFunction, SupportJet, Translated,
};
use data::{Data, Search, ball, check_contact, superquadric};
use family::{EllipsoidModel, HarmonicModel, Model, SphereModel, SuperquadricModel};
use glam::DVec3;
use information::SquareRoot;
use levenberg::Problem;
use solve::{Solution, Spatial, into_error, solve};
use std::fmt;

/// Families of shapes, by what their parameters are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ShapeFamily {
    /// A ball: centre and radius, 4 parameters.
    Sphere,
    /// An ellipsoid, the general bounded quadric: 9 parameters.
    Ellipsoid,
    /// A convex superquadric: 11 parameters.
    Superquadric,
    /// A support function of spherical harmonics up to a degree: `(degree + 1)^2` parameters.
    Harmonics {
        /// The highest degree, 0 to 32; degree 1 is a ball.
        degree: usize,
    },
}

impl fmt::Display for ShapeFamily {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sphere => f.write_str("sphere"),
            Self::Ellipsoid => f.write_str("ellipsoid"),
            Self::Superquadric => f.write_str("superquadric"),
            Self::Harmonics { degree } => write!(f, "harmonics to degree {degree}"),
        }
    }
}

impl ShapeFamily {
    /// Number of parameters.
    #[must_use]
    pub fn parameters(self) -> usize {
        match self {
            Self::Sphere => 4,
            Self::Ellipsoid => 9,
            Self::Superquadric => 11,
            Self::Harmonics { degree } => (degree + 1) * (degree + 1),
        }
    }

    /// The model, or `None` for a degree that is not accepted.
    fn model(self) -> Option<Box<dyn Model>> {
        Some(match self {
            Self::Sphere => Box::new(SphereModel),
            Self::Ellipsoid => Box::new(EllipsoidModel),
            Self::Superquadric => Box::new(SuperquadricModel),
            Self::Harmonics { degree } => Box::new(HarmonicModel::new(degree).ok()?),
        })
    }
}

/// A fitted body.
#[derive(Clone, Debug, PartialEq)]
pub enum FittedBody {
    /// A ball.
    Sphere(Translated<Sphere>),
    /// An ellipsoid.
    Ellipsoid(SkewEllipsoid),
    /// A superquadric.
    Superquadric(Superquadric),
    /// A polynomial support function, certified convex.
    Harmonics(PolynomialSupport),
}

impl FittedBody {
    fn support(&self) -> &dyn SupportFunction {
        match self {
            Self::Sphere(body) => body,
            Self::Ellipsoid(body) => body,
            Self::Superquadric(body) => body,
            Self::Harmonics(body) => body,
        }
    }
}

impl SupportFunction for FittedBody {
    fn jet(&self, n: Direction) -> SupportJet {
        self.support().jet(n)
    }
    fn value(&self, n: Direction) -> f64 {
        self.support().value(n)
    }
    fn curvature_radii(&self) -> CurvatureRadii {
        self.support().curvature_radii()
    }
}

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
                let problem = Spatial { model, contacts, size: data.size };
                solve(&problem, vec![start], |_| true).map_err(|e| into_error(e, model, family, data.size))?
            }
        };
        Self::finish(model, family, contacts, solution, &data)
    }
}

/// Of all covariances of residuals.
fn log_determinants(solution: &Solution) -> f64 {
    solution.system.contacts.iter().map(|c| c.log_determinant).sum()
}

fn undetermined(
    model: &(impl Model + ?Sized),
    family: ShapeFamily,
    root: &SquareRoot,
    size: f64,
) -> FitError {
    let known = root.knowledge(&model.scales(size));
    FitError::Undetermined {
        family,
        rank: known.map_or(0, |k| k.rank),
        parameters: model.count(),
        condition: known.map_or(f64::INFINITY, |k| k.condition),
        weakest: known.map_or_else(String::new, |k| model.name(k.weakest_parameter)),
        deviation: known.map_or(f64::INFINITY, |k| k.weakest_deviation),
    }
}

impl ShapeFit {
    /// Covariance, statistics and body of a solution.
    fn finish(
        model: &dyn Model,
        family: ShapeFamily,
        contacts: &[NoisyContact],
        mut solution: Solution,
        data: &Data,
    ) -> Result<Self, FitError> {
        let open = |root: &SquareRoot| undetermined(model, family, root, data.size);
        let problem = Spatial { model, contacts, size: data.size };
        let mut active_constraints = 0;
        let degrees_of_freedom = 3 * contacts.len() - model.count();
        let body = match family {
            ShapeFamily::Sphere => {
                let theta = &solution.theta;
                let offset = DVec3::new(theta[0], theta[1], theta[2]);
                FittedBody::Sphere(Translated { body: Sphere::new(theta[3])?, offset })
            }
            ShapeFamily::Ellipsoid => {
                let theta = EllipsoidModel::with_positive_diagonal(&solution.theta);
                if theta != solution.theta {
                    solution.system =
                        problem.assemble(&theta, None).ok_or_else(|| open(&solution.system.root))?;
                    solution.theta = theta;
                }
                FittedBody::Ellipsoid(EllipsoidModel::body(&solution.theta)?)
            }
            ShapeFamily::Superquadric => FittedBody::Superquadric(SuperquadricModel::body(&solution.theta)?),
            ShapeFamily::Harmonics { degree } => {
                let farthest = if data.refusing {
                    // A shape that is refuted before it is held is so after.
                    let free = HarmonicModel::body(&solution.theta)?;
                    let left = residual(&FittedBody::Harmonics(free), &solution, contacts);
                    refute::check(family, contacts, &solution, data, (left, degrees_of_freedom))?;
                    // The truth is a convex body: a projection is no further than noise takes the estimate from it.
                    refute::chi_squared_quantile(model.count()).sqrt()
                        * noise_factor(&solution, data, degrees_of_freedom)
                } else {
                    f64::INFINITY
                };
                let (theta, root) = (&solution.theta, &solution.system.root);
                let held = convex::hold(degree, theta, root, data.smallest_radius, farthest)?;
                if held.active > 0 {
                    active_constraints = held.active;
                    solution.system =
                        problem.assemble(&held.theta, None).ok_or_else(|| open(&solution.system.root))?;
                    solution.theta = held.theta;
                }
                FittedBody::Harmonics(held.body)
            }
        };
        let root = &solution.system.root;
        let known = root.knowledge(&model.scales(data.size)).ok_or_else(|| open(root))?;
        let covariance = root.covariance().ok_or_else(|| open(root))?;
        let noise_factor = noise_factor(&solution, data, degrees_of_freedom);
        if known.rank < model.count() || known.weakest_deviation * noise_factor > 1.0 {
            return Err(open(root));
        }
        let residual = residual(&body, &solution, contacts);
        Ok(Self {
            is_exact: refute::is_exact(residual, data),
            refuted: refute::check(family, contacts, &solution, data, (residual, degrees_of_freedom)).err(),
            family,
            covariance: covariance * noise_factor.powi(2),
            statistics: FitStatistics {
                chi_squared: solution.system.chi_squared,
                degrees_of_freedom,
                residual,
                worst: worst(&solution),
                noise_factor,
                condition: known.condition,
                weakest_deviation: known.weakest_deviation * noise_factor,
                active_constraints,
                iterations: solution.iterations,
            },
            information_criterion: choose::criterion(&solution, data, model.count()),
            names: (0..model.count()).map(|i| model.name(i)).collect(),
            parameters: solution.theta,
            body,
        })
    }
}

/// What stated standard deviations are to be multiplied by.
fn noise_factor(solution: &Solution, data: &Data, degrees_of_freedom: usize) -> f64 {
    match data.noise_level {
        NoiseLevel::Stated => 1.0,
        NoiseLevel::Estimated => (solution.system.chi_squared / degrees_of_freedom.max(1) as f64).sqrt(),
    }
}

/// Root mean square of `x^ - x(n)` per axis.
fn residual(body: &FittedBody, solution: &Solution, contacts: &[NoisyContact]) -> f64 {
    let square: f64 = contacts
        .iter()
        .zip(&solution.system.contacts)
        .map(|(c, own)| c.contact.point.distance_squared(body.point(own.normal)))
        .sum();
    (square / (3 * contacts.len().max(1)) as f64).sqrt()
}

fn worst(solution: &Solution) -> (usize, f64) {
    let squares = solution.system.contacts.iter().map(|c| c.residual.norm_squared());
    squares.enumerate().fold((0, 0.0), |worst, own| if own.1 > worst.1 { own } else { worst })
}
