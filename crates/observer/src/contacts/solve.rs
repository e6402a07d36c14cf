//! Levenberg-Marquardt steps on a chain of nodes and the constants that all of them share.

use super::chain::{Chain, Known};
use super::equations::{Equations, Room};
use super::flow::Transition;
use super::problem::{Problem, Unknowns};
use super::state::{MOTION, Tangent};
use super::trial::Trial;
use crate::least_squares::{LARGEST_DAMPING, RAISE, lowered};
use crate::reliability::LARGEST_MISFIT;
use nalgebra::{SMatrix, SVector};

/// First damping, as a share of the conditions' mean information; and where noise is not what they are off by, and their information far more than
/// what the motion needs.
const FIRST_DAMPING: f64 = 1e-3;
const FIRST_DAMPING_OF_EXACT: f64 = 1e-7;
/// A step that gains less than this share of what it promises is bent: links are not linear along it.
const BENT: f64 = 0.5;
/// Fall of chi-squared that an undamped step from the end may still promise: half a standard deviation is left then at most, which
/// makes errors larger by an eighth.
const SETTLED: f64 = 0.25;
/// Steps that are tried for each linearisation, at most on average.
const TRIES: usize = 3;
/// A step shorter than this in natural units is none.
const NO_STEP: f64 = 1e-10;
/// A solution that noise does not explain is given up where so many linearisations leave more than this share of it. Of 255 solutions that came to the
/// right motion in the end none ever left more than half.
const CHECKED_AFTER: usize = 12;
const STALLED: f64 = 0.7;

/// Where an iteration ended.
#[derive(Clone, Debug)]
pub(super) struct Solved<const P: usize> {
    pub(super) unknowns: Unknowns,
    pub(super) equations: Equations<P>,
    pub(super) iterations: usize,
    /// Whether there is no more to gain.
    pub(super) settled: bool,
}

impl<const P: usize> Solved<P> {
    /// Whether there is no more to gain and noise explains what is left.
    pub(super) fn explained(&self) -> bool {
        self.settled && self.misfit() < LARGEST_MISFIT
    }

    /// Chi-squared over the number of conditions.
    pub(super) fn misfit(&self) -> f64 {
        self.equations.misfit()
    }
}

/// A step of all unknowns.
pub(super) struct Step<const P: usize> {
    pub(super) motions: Vec<Tangent>,
    pub(super) body: SVector<f64, P>,
}

impl<const P: usize> Step<P> {
    pub(super) fn scaled(&self, by: f64) -> Self {
        Self { motions: self.motions.iter().map(|of| of * by).collect(), body: self.body * by }
    }
}

/// Covariances of the unknowns.
pub(super) struct Covariances<const P: usize> {
    pub(super) motions: Vec<Known<P>>,
    /// Of each motion with the next one, for given constants.
    pub(super) next: Vec<Transition>,
    pub(super) body: SMatrix<f64, P, P>,
    pub(super) chain: Chain<P>,
    /// Information that was added against rounding, as a share of that of natural units at each node.
    pub(super) mended: f64,
    /// By how much solutions spread farther than a linear model says at each node, where it was looked at.
    pub(super) beyond: Vec<[f64; 4]>,
    /// Errors beside noise, each of which carries the solution by a step.
    pub(super) errors: Vec<Step<P>>,
}

impl<const P: usize> Equations<P> {
    /// Fall of the cost that the linear model promises of a step which solves the damped equations, the damping counted as
    /// a cost.
    fn promised(&self, step: &Step<P>) -> f64 {
        let nodes: f64 = step.motions.iter().zip(&self.nodes).map(|(s, node)| s.dot(&node.gradient)).sum();
        -(nodes + step.body.dot(&self.body_gradient))
    }

    /// Chi-squared over the number of conditions.
    fn misfit(&self) -> f64 {
        self.cost / self.conditions.max(1) as f64
    }

    /// What a unit of chi-squared is worth: what noise does not explain makes all deviations wider.
    fn scale(&self) -> f64 {
        self.misfit().max(1.0)
    }

    /// Whether there is no more to gain than what is left of half a deviation, or than is asked for.
    fn has_settled(&self, enough: f64) -> bool {
        self.left() < SETTLED.max(enough) * self.scale()
    }

    /// The equations with all nodes eliminated, and the share of information that was added to them. `unit` is the information of a node whose deviations are the natural units.
    ///
    /// Where rounding leaves the equations indefinite, as little of it is added as mends them: a deviation then is no larger than a
    /// natural unit over the root of that share of all nodes. None where a hundred of it are not enough.
    pub(super) fn solver(&self, unit: &Tangent) -> Option<(Chain<P>, f64)> {
        let with = |share: f64| Some((self.chain((&(unit * share), 0.0), Chain::default())?, share));
        [0.0, 1e-4, 1e-3, 1e-2, 0.1, 1.0, 10.0, 100.0].into_iter().find_map(with)
    }

    /// Covariance of the constants, as [`Self::solver`].
    pub(super) fn covariance_of_body(&self, unit: &Tangent) -> Option<SMatrix<f64, P, P>> {
        Some(self.solver(unit)?.0.body)
    }

    /// As [`Self::solver`].
    pub(super) fn covariances(&self, unit: &Tangent) -> Option<Covariances<P>> {
        let (chain, mended) = self.solver(unit)?;
        let (motions, next) = chain.covariances();
        let (beyond, errors) = (Vec::new(), Vec::new());
        Some(Covariances { motions, next, body: chain.body, chain, mended, beyond, errors })
    }
}

impl<const P: usize> Covariances<P> {
    /// By how much solutions spread farther than a linear model says at node `j`: centre of mass, velocity, angular velocity, turn.
    pub(super) fn beyond(&self, j: usize) -> [f64; 4] {
        self.beyond.get(j).copied().unwrap_or([1.0; 4])
    }

    /// Makes deviations of the body's constants larger by factors.
    pub(super) fn widen_body(&mut self, by: &SVector<f64, P>) {
        let wider = SMatrix::from_diagonal(by);
        self.body = wider * self.body * wider;
    }

    /// Whether they are not those of a linear model of noise alone.
    pub(super) fn are_wider(&self) -> bool {
        !self.beyond.is_empty() || !self.errors.is_empty()
    }

    /// Of the numbers of one of the motions.
    pub(super) fn deviations(&self, (own, follows): &Known<P>) -> Tangent {
        (own + follows * self.body * follows.transpose())
            .diagonal()
            .map(|variance| variance.max(f64::MIN_POSITIVE).sqrt())
    }
}

/// Minimises the cost from `start` by at most so many linearisations, until a step promises to lower it by less than
/// `enough` deviations squared. None where the problem cannot be evaluated at the start.
pub(super) fn solve<const P: usize>(
    problem: &Problem,
    start: Unknowns,
    most: usize,
    enough: f64,
) -> Option<Solved<P>> {
    let mut unknowns = start;
    let (mut room, mut spare) = (Room::<P>::default(), Chain::default());
    let mut equations = problem.linearise_in(&unknowns, &mut room)?;
    let unit = problem.natural_information();
    let mean =
        problem.condition_information() * equations.conditions as f64 / (problem.nodes.len() * MOTION) as f64;
    let first = if problem.exact { FIRST_DAMPING_OF_EXACT } else { FIRST_DAMPING };
    let (mut damping, mut raise, mut iterations) = (first, RAISE, 1);
    let (mut done, mut tries) = (false, 0);
    let mut checked = (iterations, equations.cost);
    while iterations < most && tries < TRIES * most && !done && damping < LARGEST_DAMPING {
        tries += 1;
        if iterations >= checked.0 + CHECKED_AFTER {
            if !problem.patient && equations.misfit() > LARGEST_MISFIT && equations.cost > STALLED * checked.1
            {
                break;
            }
            checked = (iterations, equations.cost);
        }
        let damped = (&(unit * (damping * mean)), damping * mean);
        let chain = equations.chain(damped, std::mem::take(&mut spare));
        let step = chain.as_ref().map(|chain| chain.step(&equations.gradient()));
        let promised = step.as_ref().map_or(f64::INFINITY, |step| equations.promised(step));
        let both = chain.as_ref().zip(step.as_ref());
        let trial = both.and_then(|(chain, step)| tried(problem, &unknowns, &equations, chain, step));
        spare = chain.unwrap_or_default();
        let short = step.as_ref().is_some_and(|step| length(step, &unit) < NO_STEP);
        // A heavily damped step promises little anywhere: what counts is what all of the step would gain.
        let little = promised < enough * equations.scale() || short;
        done = little && equations.has_settled(enough);
        if little && !done {
            damping = lowered(damping, 1.0);
        }
        match trial.filter(|trial| trial.cost < equations.cost) {
            Some(trial) => {
                damping = lowered(damping, (equations.cost - trial.cost) / promised);
                raise = RAISE;
                unknowns = trial.unknowns;
                room.whole = equations;
                equations = problem.linearise_in(&unknowns, &mut room)?;
                iterations += 1;
            }
            None => {
                damping *= raise;
                raise *= 2.0;
            }
        }
    }
    let settled = equations.has_settled(enough);
    Some(Solved { unknowns, equations, iterations, settled })
}

/// Where a step leads. If it gains less than it should, also where it leads with what links depart by from their linear prediction
/// taken back, whichever is better.
fn tried<const P: usize>(
    problem: &Problem,
    at: &Unknowns,
    equations: &Equations<P>,
    chain: &Chain<P>,
    step: &Step<P>,
) -> Option<Trial> {
    let first = problem.trial(at, step, equations)?;
    if equations.cost - first.cost > BENT * equations.promised(step) {
        return Some(first);
    }
    let back = chain.step(&equations.gradient_of(&first.departures));
    let motions = step.motions.iter().zip(&back.motions).map(|(step, back)| step + back).collect();
    let second = problem.trial(at, &Step { motions, body: step.body + back.body }, equations);
    Some(second.filter(|second| second.cost < first.cost).unwrap_or(first))
}

/// Longest step of a node or of the constants, in natural units.
fn length<const P: usize>(step: &Step<P>, unit: &Tangent) -> f64 {
    let squares = step.motions.iter().map(|s| s.component_mul(s).dot(unit));
    squares.fold(step.body.norm_squared(), f64::max).sqrt()
}
