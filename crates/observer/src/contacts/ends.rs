//! Motions of a body in the plane that has another spin, most of all at an end of its log: where else it may be, and how far a linear model of it reaches.
//!
//! A spin is told by how conditions change along a log, least at its ends, and conditions are the better the slower a body turns against a palm. Both make
//! what a log tells of it bent: to one side the spin may be off by six deviations at what three cost, on another branch of the motion before a turn-back
//! it may cost next to nothing.

use super::body::CONSTANTS;
use super::chain::Chain;
use super::equations::{Equations, Gradient};
use super::problem::{Problem, Unknowns};
use super::redrawn::{SOLVED, departure};
use super::samples::{Deviations, at_nodes};
use super::solve::{Covariances, Solved, Step, solve};
use super::state::Tangent;
use contact_kinematics::at_once;
use nalgebra::SVector;

/// Deviations at which a spin is held to see what that costs: as many as an error is silent from; and, where it costs less than a share of their square, once
/// more farther off, so often.
const HELD_AT: [f64; 2] = [5.0, -5.0];
const CHEAP: f64 = 0.8;
const ROUNDS: usize = 3;
/// Deviations by which the spin at an end is off in other starts.
const STARTS_AT: [f64; 2] = [12.0, -12.0];
/// Information on a spin that is held, in units of what the log tells of it.
const HELD: f64 = 1e4;
/// The angular momentum about y among the numbers of a motion.
const MOMENTUM: usize = 7;

/// An angular momentum about y at a node.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    node: usize,
    momentum: f64,
    information: f64,
}

impl Held {
    fn off(&self, at: &Unknowns) -> f64 {
        at.motions[self.node].L.y - self.momentum
    }

    pub(super) fn cost(&self, at: &Unknowns) -> f64 {
        self.information * self.off(at).powi(2)
    }

    /// Adds what is held to equations.
    pub(super) fn add<const P: usize>(&self, at: &Unknowns, all: &mut Equations<P>) {
        let node = &mut all.nodes[self.node];
        node.own[(MOMENTUM, MOMENTUM)] += self.information;
        node.gradient[MOMENTUM] += self.information * self.off(at);
    }
}

/// The spin at a node, and what follows from another one.
struct SpinAt {
    node: usize,
    /// Of the angular momentum there.
    deviation: f64,
    /// What is most probable where that is one deviation larger, by a linear model.
    step: Step<CONSTANTS>,
}

impl SpinAt {
    fn new(chain: &Chain<CONSTANTS>, node: usize, count: usize) -> Self {
        let mut pull = Gradient { motions: vec![Tangent::zeros(); count], body: SVector::zeros() };
        pull.motions[node][MOMENTUM] = -1.0;
        let step = chain.step(&pull);
        let deviation = step.motions[node][MOMENTUM].max(f64::MIN_POSITIVE).sqrt();
        Self { node, deviation, step: step.scaled(deviation.recip()) }
    }

    /// Where a linear model has the motion that is so many deviations off.
    fn led(&self, problem: &Problem, from: &Solved<CONSTANTS>, off: f64) -> Option<Unknowns> {
        Some(problem.trial(&from.unknowns, &self.step.scaled(off), &from.equations)?.unknowns)
    }

    /// The most probable one of those, and by how much dearer it is.
    fn held(&self, problem: &Problem, from: &Solved<CONSTANTS>, off: f64) -> Option<(Unknowns, f64)> {
        let momentum = from.unknowns.motions[self.node].L.y + off * self.deviation;
        let held = Held { node: self.node, momentum, information: HELD / self.deviation.powi(2) };
        let mut own = problem.on(problem.record);
        own.held = Some(held);
        let start = self.led(problem, from, off)?;
        let found = solve::<CONSTANTS>(&own, start, SOLVED.0, SOLVED.1)?;
        let dearer = found.equations.cost - held.cost(&found.unknowns) - from.equations.cost;
        Some((found.unknowns, dearer))
    }
}

/// Other starts of a motion in the plane, of which this is the chain of equations.
pub(super) fn starts(
    problem: &Problem,
    found: &Solved<CONSTANTS>,
    chain: &Chain<CONSTANTS>,
) -> Vec<Unknowns> {
    let count = found.unknowns.motions.len();
    let ends = [0, count - 1].map(|node| SpinAt::new(chain, node, count));
    ends.iter().flat_map(|spin| STARTS_AT.map(|off| spin.led(problem, found, off))).flatten().collect()
}

/// How much farther than their deviations the numbers of a solution reach.
struct Reach {
    motions: Vec<[f64; 4]>,
    body: SVector<f64, CONSTANTS>,
}

impl Reach {
    fn larger(mut self, other: &Self) -> Self {
        for (own, other) in self.motions.iter_mut().flatten().zip(other.motions.iter().flatten()) {
            *own = own.max(*other);
        }
        Self { body: self.body.sup(&other.body), ..self }
    }
}

impl Covariances<CONSTANTS> {
    /// Widened to what motions in the plane reach whose spin is held off at an end or where it is known best, where that is farther than deviations say.
    ///
    /// Where a model is linear, a motion that costs as much as `c` more has no number that is more than `sqrt(c)` deviations off.
    pub(super) fn reaching(mut self, problem: &Problem, solved: &Solved<CONSTANTS>) -> Self {
        let Unknowns { motions, body } = &solved.unknowns;
        let count = motions.len();
        let known = at_nodes(motions, body, &self);
        let of_node = |node: usize| {
            let at = SpinAt::new(&self.chain, node, count);
            let mut reach = Reach { motions: vec![[1.0; 4]; count], body: SVector::repeat(1.0) };
            for side in HELD_AT {
                let mut off = side;
                for _ in 0..ROUNDS {
                    let Some((other, dearer)) = at.held(problem, solved, off) else { break };
                    // A unit more: what is left where a solution ends.
                    let dearer = dearer.max(0.0) + 1.0;
                    reach = reach.larger(&self.reached(&solved.unknowns, &other, &known, dearer.sqrt()));
                    if dearer > CHEAP * side * side {
                        break;
                    }
                    off *= (side * side / dearer).sqrt().min(2.0);
                }
            }
            reach
        };
        let spin = |j: &usize| known[*j][2].y;
        let best = (0..count).min_by(|a, b| spin(a).total_cmp(&spin(b))).unwrap_or(0);
        let inside = (1..count - 1).contains(&best);
        let (first, last) = at_once(
            || if inside { of_node(0).larger(&of_node(best)) } else { of_node(0) },
            || of_node(count - 1),
        );
        let Reach { motions, body } = first.larger(&last);
        self.widen_body(&body);
        self.beyond = motions;
        self
    }

    /// By how many times the deviations `known`, times what is allowed, other unknowns are off.
    fn reached(&self, from: &Unknowns, to: &Unknowns, known: &[Deviations], allowed: f64) -> Reach {
        let share = |off: f64, of: f64| if of > 0.0 { off.abs() / (of * allowed) } else { 0.0 };
        let of = |(j, known): (usize, &Deviations)| {
            let off = departure(from, to, j);
            std::array::from_fn(|i| {
                (0..3).map(|axis| share(off[i][axis], known[i][axis])).fold(0.0, f64::max)
            })
        };
        let body = to.body.from(&from.body);
        Reach {
            motions: known.iter().enumerate().map(of).collect(),
            body: SVector::from_fn(|i, _| share(body[i], self.body[(i, i)].max(0.0).sqrt())),
        }
    }
}
