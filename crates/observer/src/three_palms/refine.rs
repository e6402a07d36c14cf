//! From a fit of the contact conditions to the most probable motion.

use super::cold_start::natural_time;
use super::covariance::NoiseLevel;
use super::momentum::{MomentumProblem, Scales, StartState};
use super::most_probable::{MostProbable, PASSES, most_probable};
use super::prior::Beforehand;
use super::random::Normal;
use super::state_space::{Block, Constant, Parameters, ThreePalmModel, block_inputs, blocks};
use super::track::Track;
use crate::core::{BatchSolution, Model, ObserverError, Start, Status};
use nalgebra::SVector;
use object_dynamics::MassProperties;

/// Nodes in one natural time: more of them take time and tell no more.
const NODES_PER_NATURAL_TIME: f64 = 32.0;
/// Samples at a node, at least, as long as there are so many nodes in a natural time. The force of a sample acts half before it
/// and half after: between single samples its noise would count as that of two forces, of which it has half the variance, and
/// chi-squared would be too small, most of all for wrong motions.
const SAMPLES_PER_NODE: f64 = 3.0;
const LEAST_PER_NATURAL_TIME: f64 = 12.0;
/// Natural times over which contacts are smoothed, on either side, where derivatives are taken.
pub(super) const SMOOTHED_NATURAL_TIMES: f64 = 0.125;
/// Pairs of noise that the covariance is widened by, where one pair says that it is too narrow.
const PAIRS: u64 = 4;
/// Shift by one pair of noise, in deviations, below which the covariance stands: its square is what a number's variance
/// would grow by.
const NEGLIGIBLE_SHIFT: f64 = 0.1;

/// The most probable motion with the model that it obeys.
pub(super) struct Refined<const N: usize> {
    pub(super) model: ThreePalmModel<N>,
    pub(super) solution: BatchSolution<N>,
    /// Minus twice the logarithm of the probability mass about the motion, up to a constant that all motions of a log share.
    pub(super) improbability: f64,
    /// What chi-squared lacks of its expectation, since turning rates are uncertain.
    shortfall: f64,
    /// Samples at which the states stand.
    pub(super) nodes: Vec<usize>,
    /// Largest shift of a state at the start by noise, in its deviations; infinite where as much noise again leads
    /// nowhere.
    pub(super) shift: f64,
    /// Shifts of all states by pairs of noise, where the covariances are widened by them.
    pub(super) shifts: Vec<Vec<SVector<f64, N>>>,
    cut: Vec<Block>,
    reach: f64,
    prior: Start<N>,
}

impl<const N: usize> Refined<N> {
    /// Chi-squared over its degrees of freedom.
    pub(super) fn misfit(&self, unknowns: usize) -> f64 {
        self.solution.chi_squared / (self.solution.channels.saturating_sub(unknowns).max(1)) as f64
    }

    /// What it costs to correct the data and the prior for this motion, in squared deviations. Their expectation is the same for
    /// all motions that noise explains.
    pub(super) fn cost(&self) -> f64 {
        self.solution.chi_squared + self.shortfall + self.solution.prior_cost
    }

    /// Motion at the nodes.
    pub(super) fn states(&self) -> Vec<StartState> {
        self.solution.states.iter().map(|x| self.model.motion(x)).collect()
    }

    /// Whether it may be used at all.
    pub(super) fn settled(&self) -> bool {
        usable(self.solution.report.status)
    }

    /// Widens the covariances by what noise does beyond first order, and notes how much that is.
    ///
    /// Where noise is much of what there is, the estimate is a curved function of it. Noise of the same size is added once
    /// more, in pairs of opposite signs: what is linear in it cancels from the mean of a pair, and what is left, `q`, is about
    /// what the noise in the data has done already. The mean of `q q'` is the square of the bias and the variance of what is
    /// quadratic in the noise: what the covariance of the linearised estimate lacks.
    pub(super) fn widen(&mut self, track: &Track, noise: &NoiseLevel) {
        if !self.settled() {
            return;
        }
        let mut found = Vec::new();
        for seed in 1..=PAIRS {
            let Some(means) = self.mean_of_pair(track, noise, seed) else { break };
            found.push(means);
            if seed == 1 {
                self.shift = self.largest_shift(&found);
                if self.shift < NEGLIGIBLE_SHIFT {
                    return;
                }
            }
        }
        if found.len() < PAIRS as usize {
            self.shift = f64::INFINITY;
            return;
        }
        self.shift = self.largest_shift(&found);
        for means in &found {
            for (covariance, q) in self.solution.covariances.iter_mut().zip(means) {
                covariance.ger(1.0 / PAIRS as f64, q, q, 1.0);
            }
        }
        self.shifts = found;
    }

    /// Root mean square over pairs of the shift of a state at the start, in its deviations: the largest.
    fn largest_shift(&self, found: &[Vec<SVector<f64, N>>]) -> f64 {
        let variances = self.solution.covariances[0].diagonal();
        let squares = found.iter().map(|means| means[0].component_mul(&means[0])).sum::<SVector<f64, N>>();
        let mean = squares / found.len() as f64;
        mean.iter().zip(variances.iter()).map(|(s, v)| (s / v).sqrt()).fold(0.0, f64::max)
    }

    /// Mean shifts of all states by a pair of opposite noise. None where the noise leads nowhere.
    fn mean_of_pair(&self, track: &Track, noise: &NoiseLevel, seed: u64) -> Option<Vec<SVector<f64, N>>> {
        let states = &self.solution.states;
        let mut mean = vec![SVector::<f64, N>::zeros(); states.len()];
        for sign in [1.0, -1.0] {
            let inputs = block_inputs(&track.perturbed(noise, sign, seed), &self.cut, self.reach);
            let moved =
                most_probable(&self.model, &inputs, states, &self.prior, self.reach, PASSES).ok()?.solution;
            if !usable(moved.report.status) {
                return None;
            }
            for (mean, (to, from)) in mean.iter_mut().zip(moved.states.iter().zip(states)) {
                *mean += self.model.difference(to, from) * 0.5;
            }
        }
        Some(mean)
    }
}

fn usable(status: Status) -> bool {
    matches!(status, Status::Converged | Status::Inconsistent)
}

/// What the model is made of beside the track.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) scales: Scales,
    pub(super) noise: NoiseLevel,
    pub(super) constants: &'a [Constant],
    /// Prior deviations of the constants; those beyond the end of the list have none.
    pub(super) deviations: &'a [f64],
    /// Whether the body axes are chosen, so that the orientation at the start is.
    pub(super) axes_chosen: bool,
}

/// Refines a motion that starts with `start`. `mass` and `parameters` belong to it; constants among the states may change.
pub(super) fn refine<const N: usize>(
    track: &Track,
    mass: &MassProperties,
    parameters: Parameters,
    start: &StartState,
    setting: &Setting<'_>,
) -> Result<Refined<N>, ObserverError> {
    let motion = MomentumProblem::new(track, mass, setting.scales, f64::INFINITY).motion(start);
    let path: Vec<_> = cut(track, &setting.scales)
        .iter()
        .map(|block| {
            let m = &motion[block.node()];
            let L_WO = m.R_WO * (mass.inertia() * (m.R_WO.inverse() * m.w_WO));
            StartState { p_WCm: m.p_WCm, v_WCm: m.v_WCm, L_WO, R_WO: m.R_WO }
        })
        .collect();
    refine_along(track, parameters, &path, setting, PASSES)
}

/// Refines a motion that is given at the nodes.
pub(super) fn refine_along<const N: usize>(
    track: &Track,
    parameters: Parameters,
    path: &[StartState],
    setting: &Setting<'_>,
    passes: usize,
) -> Result<Refined<N>, ObserverError> {
    let Setting { scales, noise, constants, deviations, axes_chosen } = *setting;
    let reach = SMOOTHED_NATURAL_TIMES * natural_time(track, scales.length);
    let cut = cut(track, &scales);
    let inputs = block_inputs(track, &cut, reach);
    let model = ThreePalmModel::<N>::new(parameters, constants, track.gravity, noise, scales).ok_or(
        ObserverError::Value {
            what: "number of states",
            value: N as f64,
            needed: "that of motion and constants",
        },
    )?;
    let nodes: Vec<usize> = cut.iter().map(Block::node).collect();
    let states: Vec<SVector<f64, N>> = path.iter().map(|state| model.state(state, &parameters)).collect();
    let Some(first) = states.first() else {
        return Err(ObserverError::TooFewSamples { found: 0, needed: nodes.len() });
    };
    let known = Beforehand { track, scales, constants, deviations, axes_chosen };
    let prior = known.prior(&model, first, &parameters);
    let MostProbable { solution, improbability, shortfall } =
        most_probable(&model, &inputs, &states, &prior, reach, passes)?;
    Ok(Refined {
        model,
        solution,
        improbability,
        shortfall,
        nodes,
        shift: 0.0,
        shifts: Vec::new(),
        cut,
        reach,
        prior,
    })
}

/// The blocks of samples, each with a node in it.
fn cut(track: &Track, scales: &Scales) -> Vec<Block> {
    let spacing = track.duration() / (track.len() - 1).max(1) as f64;
    let natural = natural_time(track, scales.length);
    let samples = natural / spacing;
    let least = SAMPLES_PER_NODE.min(samples / LEAST_PER_NATURAL_TIME);
    let stride = (samples / NODES_PER_NATURAL_TIME).max(least).round().max(1.0);
    blocks(track.len(), stride as usize)
}

impl Track {
    /// The track with white noise added to contacts and forces; the same seed and opposite signs give opposite noise.
    fn perturbed(&self, noise: &NoiseLevel, sign: f64, seed: u64) -> Self {
        let mut random = Normal::seeded(seed);
        let mut draw = |deviation: f64| sign * deviation * random.draw();
        let mut nodes = self.nodes.clone();
        for node in &mut nodes {
            for i in 0..3 {
                let (s1, s2) = (draw(noise.contact), draw(noise.contact));
                let frame = node.palms[i].frame;
                node.p_WC[i] += s1 * frame.t1 + s2 * frame.t2;
                node.lift[i] -= s2 * node.palms[i].rate;
                node.forces[i] += draw(noise.force);
            }
        }
        self.with_nodes(nodes)
    }
}
