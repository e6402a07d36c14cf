//! Nonlinear least squares with few unknowns and many residuals, on a manifold if need be.
//!
//! The steps of [`solve_batch`](crate::batch::solve_batch) are damped too, in a loop of its own: there a trial is a whole trajectory that is rolled
//! out and linearised in place, its cost comes with the linearisation, and with process noise full steps are taken without a trial. What the two
//! have in common, "less damping after a gain, more after none", is shorter than an interface that would serve both.
//!
//! ```
//! // The rate of a decay, 2 exp(-b t), from twenty readings.
//! use observer::least_squares::{FitStatus, LeastSquares, LevenbergMarquardt, NormalEquations};
//! struct Decay;
//! impl LeastSquares<1> for Decay {
//!     type Point = f64;
//!     fn linearise(&self, b: &f64) -> Option<NormalEquations<1>> {
//!         let mut normal = NormalEquations::default();
//!         let told = |b: f64, t: f64| 2.0 * (-b * t).exp();
//!         (0..20).map(|k| 0.1 * f64::from(k)).for_each(|t| normal.add(&[-t * told(*b, t)].into(), told(*b, t) - told(1.5, t)));
//!         Some(normal)
//!     }
//!     fn cost(&self, b: &f64) -> Option<f64> { self.linearise(b).map(|normal| normal.cost) }
//!     fn retract(&self, b: &f64, step: &nalgebra::SVector<f64, 1>) -> f64 { b + step[0] }
//! }
//! let fit = LevenbergMarquardt::default().fit(&Decay, 0.5);
//! assert!(fit.status == FitStatus::Converged && (fit.point - 1.5).abs() < 1e-9);
//! ```

use nalgebra::{Cholesky, SMatrix, SVector, SymmetricEigen};

/// Sums that a Gauss-Newton step needs: `J' J`, `J' r` and `r' r`, in scaled unknowns.
#[derive(Clone, Debug)]
pub struct NormalEquations<const P: usize> {
    /// `J' J`.
    pub information: SMatrix<f64, P, P>,
    /// `J' r`.
    pub gradient: SVector<f64, P>,
    /// `r' r`.
    pub cost: f64,
    /// Number of residuals.
    pub count: usize,
}

impl<const P: usize> Default for NormalEquations<P> {
    fn default() -> Self {
        Self { information: SMatrix::zeros(), gradient: SVector::zeros(), cost: 0.0, count: 0 }
    }
}

impl<const P: usize> NormalEquations<P> {
    /// Adds one residual with its derivatives.
    pub fn add(&mut self, row: &SVector<f64, P>, residual: f64) {
        self.information.ger(1.0, row, row, 1.0);
        self.gradient.axpy(residual, row, 1.0);
        self.cost += residual * residual;
        self.count += 1;
    }

    /// Root mean square of the residuals.
    #[must_use]
    pub fn rms(&self) -> f64 {
        if self.count > 0 { (self.cost.max(0.0) / self.count as f64).sqrt() } else { 0.0 }
    }
}

/// A least-squares problem in `P` unknowns. Unknowns are scaled so that 1 is a natural size of each.
pub trait LeastSquares<const P: usize> {
    /// A value of the unknowns, on whatever manifold they live.
    type Point: Clone;

    /// Residuals and derivatives at a point; none where the model cannot be evaluated.
    fn linearise(&self, point: &Self::Point) -> Option<NormalEquations<P>>;

    /// `r' r` alone; none where the model cannot be evaluated.
    fn cost(&self, point: &Self::Point) -> Option<f64>;

    /// The point moved by a step in the scaled unknowns.
    fn retract(&self, point: &Self::Point, step: &SVector<f64, P>) -> Self::Point;
}

/// How a fit ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FitStatus {
    /// A minimum: the linear model promises no lower cost to speak of.
    Converged,
    /// No step lowers the cost, though the linear model promises it: a curved valley, or rounding.
    Stalled,
    /// The iterations ran out.
    OutOfIterations,
    /// The model could not be evaluated at the start.
    Failed,
}

/// Result of a fit.
#[derive(Clone, Debug)]
pub struct Fit<Point, const P: usize> {
    /// The best point found.
    pub point: Point,
    /// Normal equations there.
    pub normal: NormalEquations<P>,
    /// How it ended.
    pub status: FitStatus,
    /// Linearisations used.
    pub iterations: usize,
    /// Damping of the next step, if there were one: with it a fit of few iterations can be continued.
    pub damping: f64,
}

/// Levenberg-Marquardt with damping by a multiple of the identity in the scaled unknowns, which follows the share of the
/// promised gain that a step has brought.
///
/// Stops when an undamped step is shorter than `step_tolerance` (in units of the natural sizes), when one so short brings no
/// gain, or when an undamped step would move the unknowns by less than a thousandth of the deviation that the residuals leave
/// them. It ends at a local minimum: whether that is the right one is the caller's business.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LevenbergMarquardt {
    /// Most linearisations.
    pub iterations: usize,
    /// Length of a step at which to stop.
    pub step_tolerance: f64,
    /// First damping, as a share of the mean information.
    pub damping: f64,
    /// Information of a prior that holds the unknowns at the start, as a share of the mean information; 0 for none.
    pub prior: f64,
}

impl Default for LevenbergMarquardt {
    fn default() -> Self {
        Self { iterations: 50, step_tolerance: 1e-12, damping: 1e-3, prior: 0.0 }
    }
}

/// Squared length of an undamped step, in deviations, at which there is nothing more to gain.
const NOTHING_TO_GAIN: f64 = 1e-6;
/// Share of the cost that an undamped step may promise at a minimum: rounding alone promises about unknowns over
/// residuals.
pub(crate) const STILL_A_MINIMUM: f64 = 0.01;
/// Damping at which a step is too short to matter.
pub(crate) const LARGEST_DAMPING: f64 = 1e12;
/// Least damping, below which a step is undamped in double precision, and factor of the first raise; each raise in a row is
/// twice the one before.
pub(crate) const LEAST_DAMPING: f64 = 1e-15;
pub(crate) const RAISE: f64 = 4.0;

/// Damping after a step that gained a share of what the linear model promised: a tenth where the model is good, and the
/// same where it is not (Nielsen's rule, with a larger fall).
pub(crate) fn lowered(damping: f64, share: f64) -> f64 {
    let factor = if share > 0.75 {
        0.1
    } else if share > 0.25 {
        0.3
    } else {
        2.0
    };
    (damping * factor).max(LEAST_DAMPING)
}

/// Whether an undamped step would move the unknowns by next to nothing of the deviation that the residuals leave them.
pub(crate) fn nothing_to_gain<const P: usize>(normal: &NormalEquations<P>) -> bool {
    decrement(normal) * normal.count as f64 <= NOTHING_TO_GAIN * normal.cost.abs()
}

impl LevenbergMarquardt {
    /// Minimises the cost from `start`.
    pub fn fit<const P: usize, L: LeastSquares<P>>(&self, problem: &L, start: L::Point) -> Fit<L::Point, P> {
        match problem.linearise(&start) {
            Some(normal) => {
                let (status, damping) = (FitStatus::OutOfIterations, self.damping);
                self.resume(problem, Fit { point: start, normal, status, iterations: 1, damping })
            }
            None => {
                let normal = NormalEquations::default();
                let (status, damping) = (FitStatus::Failed, self.damping);
                Fit { point: start, normal, status, iterations: 1, damping }
            }
        }
    }

    /// Goes on from where a fit of the same problem ended, with as many linearisations again.
    pub fn resume<const P: usize, L: LeastSquares<P>>(
        &self,
        problem: &L,
        from: Fit<L::Point, P>,
    ) -> Fit<L::Point, P> {
        let Fit { mut point, mut normal, mut damping, .. } = from;
        // The prior pulls towards the start: `travelled` is where the point is from it, in the scaled unknowns.
        let mut travelled = SVector::<f64, P>::zeros();
        let mut iterations = 1;
        while iterations < self.iterations {
            let mean = normal.information.trace() / P as f64;
            let weight = self.prior * mean;
            let gradient = normal.gradient + travelled * weight;
            let cost = normal.cost + weight * travelled.norm_squared();
            if self.prior == 0.0 && nothing_to_gain(&normal) {
                return Fit { point, normal, status: FitStatus::Converged, iterations, damping };
            }
            let mut accepted = false;
            let mut raise = RAISE;
            while damping < LARGEST_DAMPING {
                let shift = (damping + self.prior) * mean + f64::MIN_POSITIVE;
                let Some(step) = solve_shifted(&normal.information, shift, &gradient) else {
                    damping = (damping * raise).max(LEAST_DAMPING);
                    continue;
                };
                let moved = problem.retract(&point, &step);
                let arrived = travelled + step;
                let trial = problem.cost(&moved).map(|c| c + weight * arrived.norm_squared());
                let gain = trial.map_or(f64::NEG_INFINITY, |trial| cost - trial);
                // What the linear model promises: -(2 g + (A + w) s) . s with (A + w + damping) s = -g.
                let promised = damping * mean * step.norm_squared() - gradient.dot(&step);
                let small = step.norm() < self.step_tolerance;
                if gain > 0.0 {
                    (point, travelled, accepted) = (moved, arrived, true);
                    damping = lowered(damping, gain / promised);
                }
                // A step may be short because it is damped: then there is more to come.
                let last = || solve_shifted(&normal.information, weight + f64::MIN_POSITIVE, &gradient);
                if small && (!accepted || last().is_some_and(|step| step.norm() < self.step_tolerance)) {
                    return self.finish(problem, point, normal, iterations, damping);
                }
                if accepted {
                    break;
                }
                damping = (damping * raise).max(LEAST_DAMPING);
                raise *= 2.0;
            }
            if !accepted {
                return self.finish(problem, point, normal, iterations, damping);
            }
            let Some(next) = problem.linearise(&point) else { break };
            normal = next;
            iterations += 1;
        }
        Fit { point, normal, status: FitStatus::OutOfIterations, iterations, damping }
    }

    fn finish<const P: usize, L: LeastSquares<P>>(
        &self,
        problem: &L,
        point: L::Point,
        last: NormalEquations<P>,
        iterations: usize,
        damping: f64,
    ) -> Fit<L::Point, P> {
        let normal = problem.linearise(&point).unwrap_or(last);
        let arrived = undamped(&normal).is_some_and(|step| {
            step.norm() < self.step_tolerance
                || -step.dot(&normal.gradient) <= STILL_A_MINIMUM * normal.cost.abs()
        });
        let minimum = self.prior > 0.0 || arrived;
        let status = if minimum { FitStatus::Converged } else { FitStatus::Stalled };
        Fit { point, normal, status, iterations: iterations + 1, damping }
    }
}

/// The undamped step; none where the information is singular in double precision.
pub(crate) fn undamped<const P: usize>(normal: &NormalEquations<P>) -> Option<SVector<f64, P>> {
    let shift = normal.information.trace() * f64::EPSILON;
    solve_shifted(&normal.information, shift, &normal.gradient)
}

/// Fall of the cost that an undamped step promises.
pub(crate) fn decrement<const P: usize>(normal: &NormalEquations<P>) -> f64 {
    undamped(normal).map_or(f64::INFINITY, |step| -step.dot(&normal.gradient))
}

pub(crate) fn solve_shifted<const P: usize>(
    information: &SMatrix<f64, P, P>,
    shift: f64,
    gradient: &SVector<f64, P>,
) -> Option<SVector<f64, P>> {
    let mut matrix = *information;
    for i in 0..P {
        matrix[(i, i)] += shift;
    }
    let step = -Cholesky::new(matrix)?.solve(gradient);
    step.iter().all(|v| v.is_finite()).then_some(step)
}

/// What the data say about the unknowns at a point: eigenvalues of the information in the scaled unknowns.
#[derive(Clone, Debug)]
pub struct Observability<const P: usize> {
    /// Eigenvalues of `J' J`, ascending; scaled unknowns.
    pub eigenvalues: SVector<f64, P>,
    /// Unit eigenvectors in the same order, as columns.
    pub directions: SMatrix<f64, P, P>,
}

impl<const P: usize> Observability<P> {
    /// Of an information matrix in scaled unknowns.
    #[must_use]
    pub fn new(information: &SMatrix<f64, P, P>) -> Self {
        let symmetric =
            SymmetricEigen::new(nalgebra::DMatrix::from_column_slice(P, P, information.as_slice()));
        let mut order: Vec<usize> = (0..P).collect();
        order.sort_by(|&a, &b| symmetric.eigenvalues[a].total_cmp(&symmetric.eigenvalues[b]));
        let eigenvalues = SVector::from_fn(|i, _| symmetric.eigenvalues[order[i]]);
        let directions = SMatrix::from_fn(|row, column| symmetric.eigenvectors[(row, order[column])]);
        Self { eigenvalues, directions }
    }
}
