//! Palms that may not be where they are said to be, and contacts not where they are felt: a score test for each constant, and what the motion follows it by.

use super::problem::{DIFFERENCE, Guess, Row, TouchProblem, UNKNOWNS};
use super::series::{Nodes, Palms};
use crate::doubted;
use crate::faults::{Constant, Suspect};
use contact_kinematics::{PalmFrame, PalmTriple};
use glam::DQuat;
use nalgebra::{DMatrix, DVector, SMatrix};
use object_dynamics::Instant;

/// What of the information on a constant must be left when all numbers have followed it, for the data to tell of it.
const LEAST_LEFT: f64 = 1e-6;

/// Suspects with the errors of the numbers that go with them.
#[derive(Default)]
pub(super) struct Doubts {
    pub(super) suspects: Vec<Suspect>,
    /// Those that may be wrong.
    pub(super) errors: Vec<Wrong>,
}

/// A constant that may be wrong, by an error of one deviation.
pub(super) struct Wrong {
    fault: Constant,
    /// In natural sizes.
    by: f64,
    /// What the numbers are off by with it, in natural sizes.
    pub(super) numbers: Row,
}

/// Scores at a minimum, where a block mean is known to `deviation` m and the numbers have the covariance `of_noise`, both by noise and what it does not
/// explain. None where steps next to it make no motion.
pub(super) fn doubts(
    problem: &TouchProblem,
    point: &Guess,
    deviation: f64,
    of_noise: &SMatrix<f64, UNKNOWNS, UNKNOWNS>,
) -> Option<Doubts> {
    let column = |ahead: &[f64], behind: &[f64]| {
        DVector::from_iterator(
            ahead.len(),
            ahead.iter().zip(behind).map(|(a, b)| (a - b) / (2.0 * DIFFERENCE)),
        )
    };
    let residuals = problem.residuals(point)?;
    let slopes = problem.slopes(point, &residuals)?.into_iter().map(DVector::from_vec).collect::<Vec<_>>();
    let (slopes, residuals) = (DMatrix::from_columns(&slopes), DVector::from_vec(residuals));
    let information = of_noise / (deviation * deviation);
    let (mut suspects, mut follows) = (Vec::new(), Vec::new());
    for fault in constants() {
        let by = |h: f64| problem.with_nodes(&changed(problem, fault, h)?).residuals(point);
        let own = column(&by(DIFFERENCE)?, &by(-DIFFERENCE)?);
        // All numbers follow the constant: what is left of its slope tells of it.
        let numbers: Row = -(information * Row::from_iterator(slopes.tr_mul(&own).iter().copied()));
        let left = &own + &slopes * numbers;
        let information = left.norm_squared();
        let told = information > LEAST_LEFT * own.norm_squared();
        let (value, error) = match told {
            true => (-left.dot(&residuals) / information, deviation / information.sqrt()),
            false => (0.0, f64::INFINITY),
        };
        let units = unit(problem, fault);
        let most = (0..UNKNOWNS).map(|i| numbers[i].abs() / of_noise[(i, i)].sqrt()).fold(0.0, f64::max);
        suspects.push(Suspect {
            fault,
            value: value * units,
            deviation: error * units,
            tolerated: units / most,
        });
        follows.push((units, numbers));
    }
    let off =
        doubted::errors(&suspects).into_iter().zip(&suspects).zip(follows).filter(|((off, _), _)| *off > 0.0);
    let wrong = |((off, suspect), (units, numbers)): ((f64, &Suspect), (f64, Row))| {
        let by = off / units;
        Wrong { fault: suspect.fault, by, numbers: numbers * by }
    };
    let errors = off.map(wrong).collect();
    Some(Doubts { suspects, errors })
}

impl Wrong {
    /// The motion if so much of it is wrong: a body that follows, between palms that stand elsewhere.
    pub(super) fn motion(
        &self,
        problem: &TouchProblem,
        point: &Guess,
        share: f64,
        nodes: usize,
    ) -> Option<Vec<Instant>> {
        let changed = changed(problem, self.fault, share * self.by)?;
        problem.with_nodes(&changed).motion(&problem.retract_by(point, &(self.numbers * share)), nodes)
    }
}

/// Tilts of each palm, and offsets of what it feels.
fn constants() -> impl Iterator<Item = Constant> {
    let both = |palm: usize| [0, 1].map(move |axis| (palm, axis));
    (1..=3)
        .flat_map(both)
        .flat_map(|(palm, axis)| [Constant::PalmTilt { palm, axis }, Constant::ContactOffset { palm, axis }])
}

/// Natural size of a constant.
fn unit(problem: &TouchProblem, fault: Constant) -> f64 {
    if let Constant::ContactOffset { .. } = fault { problem.length } else { 1.0 }
}

/// Readings with a constant that is so much in natural sizes.
fn changed(problem: &TouchProblem, fault: Constant, by: f64) -> Option<Nodes> {
    let mut nodes = problem.nodes.clone();
    match fault {
        Constant::PalmTilt { palm, axis } => {
            for palms in &mut nodes.palms {
                *palms = tilted(palms, palm - 1, axis, by)?;
            }
        }
        Constant::ContactOffset { palm, axis } => {
            nodes.means.iter_mut().for_each(|means| means[palm - 1][axis] -= by * problem.length);
        }
        _ => return None,
    }
    Some(nodes)
}

/// Palms of which one is turned about one of its axes through the origin.
fn tilted((states, _): &Palms, palm: usize, axis: usize, by: f64) -> Option<Palms> {
    let mut states = *states;
    let PalmFrame { t1, t2, n } = states[palm].frame;
    let turn = DQuat::from_axis_angle([t1, t2][axis], by);
    states[palm].frame = PalmFrame { t1: turn * t1, t2: turn * t2, n: turn * n };
    let triple = PalmTriple::new(states.map(|state| state.frame.n)).ok()?;
    Some((states, triple))
}
