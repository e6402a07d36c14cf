//! What the data speak against of a stated body: a score test of its mass, and one of each of its principal moments.
//!
//! Constants of a known body are held where they were stated by information as of a tiny deviation. If one of them was stated otherwise, what holds it would
//! pull elsewhere: the cost changes with that as with a constant of the sensors, with motion and axes following it.

use super::body::CONSTANTS;
use super::chain::Chain;
use super::equations::Gradient;
use super::levers::Levers;
use super::plane;
use super::problem::Problem;
use super::solve::{Covariances, Solved, Step};
use super::state::Tangent;
use super::suspects::Score;
use crate::faults::Constant;
use nalgebra::{SMatrix, SVector};

/// Constants of a stated body, at a solution.
pub(super) struct StatedBody<'a> {
    problem: &'a Problem<'a>,
    solved: &'a Solved<CONSTANTS>,
    /// What noise of the spins adds to the information on the body, and that of the levers to that on the motion; nothing in the plane, where the one
    /// axis is known.
    spurious: SMatrix<f64, CONSTANTS, CONSTANTS>,
    levers: Levers,
}

/// All of them.
pub(super) const CONSTANTS_OF_BODY: [Constant; 4] = [
    Constant::Mass,
    Constant::Moment { axis: 0 },
    Constant::Moment { axis: 1 },
    Constant::Moment { axis: 2 },
];

impl<'a> StatedBody<'a> {
    /// None of a body that is not a stated one.
    pub(super) fn new(
        problem: &'a Problem<'a>,
        solved: &'a Solved<CONSTANTS>,
        covariances: &Covariances<CONSTANTS>,
    ) -> Option<Self> {
        let stated = if problem.planar { plane::is_known(&problem.body) } else { problem.body.0.is_turned() };
        if !stated {
            return None;
        }
        let spurious = if problem.planar {
            SMatrix::zeros()
        } else {
            covariances.spurious(&solved.equations, &solved.unknowns)
        };
        Some(Self { problem, solved, spurious, levers: Levers::new(problem, &solved.unknowns) })
    }

    /// The score of one of them, by a `solver` of the equations and the step that `followed` from what is left of them, since no fit settles to the last
    /// digit. None of a constant that the body does not have.
    pub(super) fn score(
        &self,
        constant: Constant,
        solver: &Chain<CONSTANTS>,
        followed: &Step<CONSTANTS>,
    ) -> Option<Score> {
        let Self { problem, solved, spurious, levers } = self;
        let by = direction(problem, constant)?;
        let pull = problem.body.1 * by;
        let departure = solved.unknowns.body.from(&problem.body.0);
        let mixed = Gradient { motions: vec![Tangent::zeros(); solved.unknowns.motions.len()], body: -pull };
        let follows = solver.step(&mixed);
        let held = pull.dot(&by);
        let left = held + mixed.dot(&follows);
        let slope = mixed.dot(followed) - pull.dot(&departure);
        // What gives way where data tell as much as holds it is told by them too; rounding alone is no less than that.
        let whole = held / (held - left).max(f64::EPSILON * held);
        // Noise poses as information on what motion and axes follow by, and takes nothing from it.
        let of_levers = levers.added(&levers.turned(&follows)).0;
        let of_spins = (spurious * follows.body).dot(&follows.body).max(0.0);
        let spurious = of_spins + of_levers;
        Some(Score::of(slope * whole, [left, left, spurious].map(|of| of * whole), follows))
    }
}

/// How the constants of the body change with one of them.
fn direction(problem: &Problem, constant: Constant) -> Option<SVector<f64, CONSTANTS>> {
    match constant {
        Constant::Mass => Some(SVector::from_fn(|i, _| if i == 0 { 1.0 } else { 0.0 })),
        // Of a lamina the one about its normal is the largest.
        Constant::Moment { axis } if problem.planar => (axis == 2).then(plane::by_moment),
        Constant::Moment { axis } => problem.body.0.by_moment(axis),
        _ => None,
    }
}
