//! Covariance, statistics and body of a solution, and whether its contacts refute it.

use super::convex;
use super::data::Data;
use super::family::{EllipsoidModel, HarmonicModel, Model, SuperquadricModel};
use super::information::SquareRoot;
use super::lasting::Deviations;
use super::levenberg::Problem;
use super::misfit::Misfit;
use super::refute::{self, Leftover};
use super::solve::{Linearised, Solution, Spatial, undetermined, whitened_rows};
use super::{FitError, FitStatistics, FittedBody, ShapeFamily, ShapeFit};
use contact_kinematics::{Sphere, SupportFunction, Translated};
use glam::DVec3;

/// A solution that is to be made a fit.
struct Unfinished<'a> {
    problem: Spatial<'a, dyn Model + 'a>,
    family: ShapeFamily,
    solution: Solution,
    data: &'a Data,
    /// Constraints that hold the shape.
    held: usize,
}

impl ShapeFit {
    /// Covariance, statistics and body of a solution.
    pub(super) fn finish(
        model: &dyn Model,
        family: ShapeFamily,
        contacts: &[crate::noise::NoisyContact],
        solution: Solution,
        data: &Data,
    ) -> Result<Self, FitError> {
        let problem = Spatial { model, contacts, size: data.size };
        let mut own = Unfinished { problem, family, solution, data, held: 0 };
        let body = own.body()?;
        let misfit = own.misfit(&body);
        let Unfinished { solution, held, .. } = &own;
        let root = &solution.system.root;
        let known = root.knowledge(&model.scales(data.size)).ok_or_else(|| own.open())?;
        let deviations = Deviations::of(&own.problem, solution, &misfit, data.noise_level);
        let Deviations { covariance, noise_factor, correlation, widening } =
            deviations.ok_or_else(|| own.open())?;
        if known.rank < model.count() {
            return Err(own.open());
        }
        // What a wrong family leaves is alike, and makes deviations as wide as it likes.
        let refuted = own.check(&body, &misfit).err();
        if refuted.is_none() && known.weakest_deviation * widening > 1.0 {
            return Err(own.open());
        }
        let refuted = refuted.or_else(|| own.departure(&misfit, widening / noise_factor));
        let statistics = FitStatistics {
            chi_squared: misfit.chi_squared,
            degrees_of_freedom: misfit.degrees_of_freedom(),
            residual: misfit.residual,
            worst: worst(solution),
            noise_factor,
            correlation,
            condition: known.condition,
            weakest_deviation: known.weakest_deviation * widening,
            active_constraints: *held,
            iterations: solution.iterations,
        };
        Ok(Self {
            is_exact: misfit.is_exact(),
            refuted,
            family,
            covariance,
            statistics,
            information_criterion: misfit.criterion(data.noise_level),
            names: (0..model.count()).map(|i| model.name(i)).collect(),
            parameters: own.solution.theta,
            body,
        })
    }
}

impl Unfinished<'_> {
    fn open(&self) -> FitError {
        self.blame(&self.solution.system.root)
    }

    fn blame(&self, root: &SquareRoot) -> FitError {
        undetermined(self.problem.model, self.family, root, self.data.size)
    }

    /// The body of the solution, which is renewed where another of the family is meant: with positive axes, or held convex.
    fn body(&mut self) -> Result<FittedBody, FitError> {
        Ok(match self.family {
            ShapeFamily::Sphere => {
                let theta = &self.solution.theta;
                let offset = DVec3::new(theta[0], theta[1], theta[2]);
                FittedBody::Sphere(Translated { body: Sphere::new(theta[3])?, offset })
            }
            ShapeFamily::Ellipsoid => {
                let theta = EllipsoidModel::with_positive_diagonal(&self.solution.theta);
                if theta != self.solution.theta {
                    self.renew(theta)?;
                }
                FittedBody::Ellipsoid(EllipsoidModel::body(&self.solution.theta)?)
            }
            ShapeFamily::Superquadric => {
                FittedBody::Superquadric(SuperquadricModel::body(&self.solution.theta)?)
            }
            ShapeFamily::Harmonics { degree } => self.held_convex(degree)?,
        })
    }

    fn held_convex(&mut self, degree: usize) -> Result<FittedBody, FitError> {
        let farthest = if self.data.refusing {
            // A shape that is refuted before it is held is so after.
            let free = FittedBody::Harmonics(HarmonicModel::body(&self.solution.theta)?);
            let misfit = self.misfit(&free);
            self.check(&free, &misfit)?;
            refute::farthest(&misfit, self.data.noise_level)
        } else {
            f64::INFINITY
        };
        let (theta, root) = (&self.solution.theta, &self.solution.system.root);
        let held = convex::hold(degree, theta, root, self.data.smallest_radius, farthest)?;
        if held.active > 0 {
            self.held = held.active;
            self.renew(held.theta)?;
        }
        Ok(FittedBody::Harmonics(held.body))
    }

    fn renew(&mut self, theta: nalgebra::DVector<f64>) -> Result<(), FitError> {
        self.solution.system = self.problem.assemble(&theta, None).ok_or_else(|| self.open())?;
        self.solution.theta = theta;
        Ok(())
    }

    fn check(&self, body: &FittedBody, misfit: &Misfit) -> Result<(), FitError> {
        let contacts = &self.solution.system.contacts;
        let leftover = |own: &Linearised| Leftover {
            point: body.point(own.normal),
            normal: own.normal.get(),
            residual: DVec3::new(own.residual.x, own.residual.y, own.residual.z),
        };
        let leftovers = || contacts.iter().map(leftover).collect();
        let by = refute::refutation(self.data.noise_level, misfit, leftovers);
        by.map_or(Ok(()), |by| Err(FitError::Refuted { family: self.family, by }))
    }

    /// Whether harmonics of the first degree that the family lacks explain what noise does not.
    fn departure(&self, misfit: &Misfit, lasting: f64) -> Option<FitError> {
        let degree = match self.family {
            ShapeFamily::Sphere => 2,
            ShapeFamily::Ellipsoid | ShapeFamily::Superquadric => 3,
            ShapeFamily::Harmonics { degree } => degree + 1,
        };
        if misfit.is_exact() || self.held > 0 {
            return None;
        }
        let model = HarmonicModel::new(degree).ok()?;
        let harmonics = 2 * degree + 1;
        let contacts = &self.solution.system.contacts;
        let beyond = whitened_rows(&model, &self.solution.theta, contacts, model.count() - harmonics)?;
        let whitened = self.problem.whitened(&self.solution)?;
        let improvement = refute::departure(self.data.noise_level, &whitened, &beyond, lasting)?;
        let by = refute::Refutation::Departure { degree, harmonics, improvement };
        Some(FitError::Refuted { family: self.family, by })
    }

    fn misfit(&self, body: &FittedBody) -> Misfit {
        let square: f64 = self
            .problem
            .contacts
            .iter()
            .zip(&self.solution.system.contacts)
            .map(|(c, own)| c.contact.point.distance_squared(body.point(own.normal)))
            .sum();
        let residual = (square / (3 * self.problem.contacts.len().max(1)) as f64).sqrt();
        Misfit { residual, held: self.held, ..misfit(&self.solution, self.data) }
    }
}

/// The misfit of a solution, all but the residual, for which a body is needed.
pub(super) fn misfit(solution: &Solution, data: &Data) -> Misfit {
    let contacts = &solution.system.contacts;
    Misfit {
        chi_squared: solution.system.chi_squared,
        equations: 3 * contacts.len(),
        parameters: solution.theta.len(),
        held: 0,
        weight: contacts.iter().map(|c| c.whitening.norm_squared()).sum(),
        log_determinants: contacts.iter().map(|c| c.log_determinant).sum(),
        residual: f64::INFINITY,
        size: data.size,
    }
}

fn worst(solution: &Solution) -> (usize, f64) {
    let squares = solution.system.contacts.iter().map(|c| c.residual.norm_squared());
    squares.enumerate().fold((0, 0.0), |worst, own| if own.1 > worst.1 { own } else { worst })
}
