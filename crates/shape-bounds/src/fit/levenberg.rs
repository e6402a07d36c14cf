//! Levenberg's and Marquardt's iteration, for contacts in the plane and in space.

use super::information::SquareRoot;
use nalgebra::{DMatrix, DVector};

/// Iterations before a fit is given up; a handful suffices near a solution.
pub(crate) const ITERATIONS: usize = 200;
/// Iterations before contacts are not those of a body that is linear in its parameters, harmonics or waves: only the true
/// normals are not, and right ones are at rest after a handful.
pub(crate) const LINEAR: usize = 30;
/// Iterations with normals taken as exact.
const APPROACH: usize = 15;
/// A step this small, in standard deviations, changes nothing.
const STILL: f64 = 1e-7;
/// A predicted improvement this small, relative to the sum of squares, is rounding of it ...
const FLAT: f64 = 1e-14;
/// ... and this small is so if the step did not bring it about.
const STALLED: f64 = 1e-9;
/// A step this small, relative to the sizes of the parameters, is rounding.
const ROUNDING: f64 = 1e-14;
/// Iterations with equations that leave a combination open before the contacts are blamed, and not the start.
const DEFICIENT: usize = 12;

/// All contacts linearised at the same parameters.
pub(crate) struct System<C> {
    pub(crate) root: SquareRoot,
    pub(crate) contacts: Vec<C>,
    pub(crate) chi_squared: f64,
}

/// A sum of squares over contacts.
pub(crate) trait Problem {
    /// A contact, linearised.
    type Contact;

    /// Linearises all contacts at `theta`, with what is known from `before`; `None` where the parameters are no body.
    fn assemble(
        &self,
        theta: &DVector<f64>,
        before: Option<&System<Self::Contact>>,
    ) -> Option<System<Self::Contact>>;

    /// The parameters after a step.
    fn moved(&self, theta: &DVector<f64>, step: &DVector<f64>) -> DVector<f64>;

    /// Natural sizes of the parameters.
    fn scales(&self) -> DVector<f64>;

    /// Whitened rows of the contacts at a solution, as many to each, with what it leaves of them; `None` where it is no body.
    fn whitened(&self, solution: &Solution<Self::Contact>) -> Option<Whitened>;
}

/// Whitened rows, so many to a contact, and residuals.
pub(crate) struct Whitened {
    pub(crate) dimension: usize,
    pub(crate) rows: DMatrix<f64>,
    pub(crate) residuals: Vec<f64>,
}

/// Where an iteration came to rest.
pub(crate) struct Solution<C> {
    pub(crate) theta: DVector<f64>,
    pub(crate) system: System<C>,
    pub(crate) iterations: usize,
}

/// Why an iteration did not come to rest.
pub(crate) enum Unsolved<C> {
    /// The equations leave a combination open.
    Singular(System<C>),
    /// No rest; where it was after so many iterations, or `None` if the start was no body.
    NotConverged(usize, Option<Solution<C>>),
}

/// Levenberg's and Marquardt's iteration on the likelihood.
pub(crate) fn iterate<P: Problem>(
    problem: &P,
    start: DVector<f64>,
    limit: usize,
) -> Result<Solution<P::Contact>, Unsolved<P::Contact>> {
    let scales = problem.scales();
    let mut theta = start;
    let (mut damping, mut deficient) = (0.0, 0);
    let Some(mut system) = problem.assemble(&theta, None) else {
        return Err(Unsolved::NotConverged(0, None));
    };
    for iterations in 1..=limit {
        if damping > 0.0 || system.root.solve(0.0).is_none() {
            let open = system.root.knowledge(&scales).is_none_or(|known| known.rank < scales.len());
            deficient += usize::from(open);
            if deficient > DEFICIENT {
                return Err(Unsolved::Singular(system));
            }
        }
        let Some(step) = system.root.solve(damping) else {
            damping = (damping * 10.0).max(1e-9);
            continue;
        };
        let deviations = (system.root.triangle() * &step).norm();
        let relative = step.component_div(&scales).amax();
        let improvement = deviations.powi(2) / system.chi_squared.max(f64::MIN_POSITIVE);
        if damping == 0.0 && (deviations <= STILL || relative <= ROUNDING || improvement <= FLAT) {
            return Ok(Solution { theta, system, iterations });
        }
        let next = problem.moved(&theta, &step);
        let renewed = problem
            .assemble(&next, Some(&system))
            .filter(|renewed| renewed.chi_squared <= system.chi_squared * (1.0 + 1e-12) || relative <= 1e-10);
        match renewed {
            Some(renewed) => {
                (theta, system) = (next, renewed);
                damping = if damping < 1e-7 { 0.0 } else { damping * 0.1 };
            }
            None if improvement <= STALLED => return Ok(Solution { theta, system, iterations }),
            None if damping > 1e9 => {
                return Err(Unsolved::NotConverged(iterations, Some(Solution { theta, system, iterations })));
            }
            None => damping = (damping * 10.0).max(1e-6),
        }
    }
    let iterations = limit;
    Err(Unsolved::NotConverged(iterations, Some(Solution { theta, system, iterations })))
}

/// Parameters near the best solution that several starts lead to.
pub(crate) fn best_of<P: Problem>(
    problem: &P,
    starts: Vec<DVector<f64>>,
) -> Result<DVector<f64>, Unsolved<P::Contact>> {
    ends(problem, starts)?.into_iter().next().map(|(theta, _)| theta).ok_or(Unsolved::NotConverged(0, None))
}

/// Parameters with the sum of squares there.
pub(crate) type End = (DVector<f64>, f64);

/// Where several starts lead, with the sums of squares there, the smallest first; an error if none leads anywhere. A start
/// that is not at rest after [`APPROACH`] iterations counts as far as it came: with normals taken as exact, a surface with
/// flats and edges is a rough problem.
pub(crate) fn ends<P: Problem>(
    problem: &P,
    starts: Vec<DVector<f64>>,
) -> Result<Vec<End>, Unsolved<P::Contact>> {
    let mut ends = Vec::with_capacity(starts.len());
    let mut failure = Unsolved::NotConverged(0, None);
    for start in starts {
        match iterate(problem, start, APPROACH) {
            Ok(found) | Err(Unsolved::NotConverged(_, Some(found))) => {
                ends.push((found.theta, found.system.chi_squared));
            }
            Err(other) => failure = other,
        }
    }
    ends.sort_by(|a, b| a.1.total_cmp(&b.1));
    if ends.is_empty() { Err(failure) } else { Ok(ends) }
}
