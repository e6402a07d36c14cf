//! Covariance, statistics and outline of a solution, and whether its contacts refute it: the twin of `fit::finish`.

use super::family::{self, AnyWaves};
use super::solve::{self, Linearised, Plane};
use super::{FitError, OutlineFamily, OutlineFit, convex};
use crate::fit::lasting::Deviations;
use crate::fit::levenberg::{Problem, Solution};
use crate::fit::misfit::Misfit;
use crate::fit::refute;
use crate::fit::{FitStatistics, NoiseLevel};
use contact_kinematics::planar::RadiusFunction;

/// A solution that is to be made a fit.
struct Unfinished<'a> {
    problem: Plane<'a>,
    family: OutlineFamily,
    solution: Solution<Linearised>,
    level: NoiseLevel,
    /// Constraints that hold the outline.
    held: usize,
}

impl OutlineFit {
    pub(super) fn finish(
        problem: Plane<'_>,
        family: OutlineFamily,
        solution: Solution<Linearised>,
        limit: f64,
        level: NoiseLevel,
    ) -> Result<Self, FitError> {
        let mut own = Unfinished { problem, family, solution, level, held: 0 };
        if let OutlineFamily::Fourier { .. } = family {
            own.hold_convex(limit)?;
        }
        let body = family::outline(family, &own.solution.theta)?;
        let misfit = solve::misfit(&body, &own.solution, &own.problem, own.held);
        let root = &own.solution.system.root;
        let known = root.knowledge(&own.problem.scales()).ok_or_else(|| own.open())?;
        let deviations = Deviations::of(&own.problem, &own.solution, &misfit, level);
        let Deviations { covariance, noise_factor, correlation, widening } =
            deviations.ok_or_else(|| own.open())?;
        if known.rank < misfit.parameters {
            return Err(own.open());
        }
        // What a wrong family leaves is alike, and makes deviations as wide as it likes.
        own.check(&body, &misfit)?;
        if known.weakest_deviation * widening > 1.0 {
            return Err(own.open());
        }
        Ok(Self {
            family,
            covariance,
            statistics: FitStatistics {
                chi_squared: misfit.chi_squared,
                degrees_of_freedom: misfit.degrees_of_freedom(),
                residual: misfit.residual,
                worst: solve::worst(&own.solution),
                noise_factor,
                correlation,
                condition: known.condition,
                weakest_deviation: known.weakest_deviation * widening,
                active_constraints: own.held,
                iterations: own.solution.iterations,
            },
            information_criterion: misfit.criterion(level),
            is_exact: misfit.is_exact(),
            parameters: own.solution.theta,
            body,
        })
    }
}

impl Unfinished<'_> {
    fn open(&self) -> FitError {
        let root = &self.solution.system.root;
        solve::undetermined(self.problem.model, self.family, root, self.problem.size)
    }

    fn hold_convex(&mut self, limit: f64) -> Result<(), FitError> {
        // Waves that are refuted before they are held are so after.
        let free = AnyWaves::of(&self.solution.theta);
        let misfit = solve::misfit(&free, &self.solution, &self.problem, 0);
        self.check(&free, &misfit)?;
        let farthest = refute::farthest(&misfit, self.level);
        let (theta, root) = (&self.solution.theta, &self.solution.system.root);
        let (theta, held) = convex::hold(self.family, theta, root, limit, farthest)?;
        if held > 0 {
            self.solution.system = self.problem.assemble(&theta, None).ok_or_else(|| self.open())?;
            self.solution.theta = theta;
            self.held = held;
        }
        Ok(())
    }

    fn check(&self, body: &dyn RadiusFunction, misfit: &Misfit) -> Result<(), FitError> {
        let leftovers = || solve::leftovers(body, &self.solution);
        let by = refute::refutation(self.level, misfit, leftovers);
        by.map_or(Ok(()), |by| Err(FitError::Refuted { family: self.family, by }))
    }
}
