//! What steps from sample to sample miss in a log as good as exact, counted in its deviations.
//!
//! Where samples are few, conditions are met by a motion that errors of the steps have carried along, and what is left of them tells nothing of it.
//! Steps over every other sample tell: they miss what the steps over all miss, sixteen times as much a step of twice the length. How the solution
//! follows is linear.

use super::body::CONSTANTS;
use super::flow::Carried;
use super::problem::Problem;
use super::record::Record;
use super::solve::{Covariances, Solved};
use super::state::Tangent;

/// What two steps miss, as a share of what one step over both misses beyond them: they are of order 4.
const SHARE: f64 = 1.0 / 15.0;

impl Covariances<CONSTANTS> {
    /// Widened by how far what steps miss carries the solution, as one error beside that of noise. The same where impulses are read, or the equations are singular.
    pub(super) fn with_steps(self, log: &Record, problem: &Problem, solved: &Solved<CONSTANTS>) -> Self {
        let Some(missed) = missed(log, problem, solved) else { return self };
        let Some((solver, _)) = solved.equations.solver(&problem.natural_information()) else { return self };
        let step = solver.step(&solved.equations.gradient_of(&missed));
        self.with_errors([step])
    }
}

/// What the steps over the samples of each link miss of the motion. None where no steps of twice the length are to be had.
fn missed(log: &Record, problem: &Problem, solved: &Solved<CONSTANTS>) -> Option<Vec<Tangent>> {
    let long = log.every_other(&problem.noise)?;
    let at = &solved.unknowns;
    let nodes = problem.node_samples();
    let mut missed = vec![Tangent::zeros(); nodes.len() - 1];
    let mut carried = Carried::<0>::new(*at.motions.first()?, &at.body);
    let mut link = 0;
    for (i, interval) in long.iter().enumerate() {
        let from = 2 * i;
        while link + 1 < missed.len() && nodes[link + 1] <= from {
            link += 1;
        }
        let mut whole = carried;
        whole.step(interval, [&log.wrenches[from], &log.wrenches[from + 2]], &at.body, problem.gravity);
        for k in from..from + 2 {
            let ends = [&log.wrenches[k], &log.wrenches[k + 1]];
            carried.step(&log.intervals[k], ends, &at.body, problem.gravity);
        }
        missed[link] += carried.motion.from(&whole.motion) * SHARE;
    }
    Some(missed)
}
