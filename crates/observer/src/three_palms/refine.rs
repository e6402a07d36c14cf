//! From a fit of the contact conditions to the most probable motion.

use super::cold_start::natural_time;
use super::covariance::NoiseLevel;
use super::momentum::{MomentumProblem, Scales, StartState};
use super::most_probable::most_probable;
use super::random::Normal;
use super::state_space::{Block, Constant, MOTION_STATES, Parameters, ThreePalmModel, block_inputs, blocks};
use super::track::Track;
use crate::core::{BatchSolution, Model, ObserverError, Start, Status};
use nalgebra::SVector;
use object_dynamics::MassProperties;

/// Nodes in one natural time: more of them take time and tell no more.
const NODES_PER_NATURAL_TIME: f64 = 32.0;
/// Natural times over which contacts are smoothed, on either side, where derivatives are taken.
pub(super) const SMOOTHED_NATURAL_TIMES: f64 = 0.125;
/// Deviation of the orientation at the start where a choice of body axes, and no measurement, fixes it: in relative
/// contact noise, so that it is small against what is measured and yet lets sums of both keep their digits.
const CHOSEN: f64 = 0.1;
/// Deviation of a constant that is known, in natural sizes and relative contact noise: likewise.
const KNOWN: f64 = 0.01;

/// The most probable motion with the model that it obeys.
pub(super) struct Refined<const N: usize> {
    pub(super) model: ThreePalmModel<N>,
    pub(super) solution: BatchSolution<N>,
    /// Samples at which the states stand.
    pub(super) nodes: Vec<usize>,
    /// Largest shift of a state at the start by noise, in its deviations; infinite where as much noise again leads
    /// nowhere.
    pub(super) shift: f64,
}

impl<const N: usize> Refined<N> {
    /// Chi-squared over its degrees of freedom.
    pub(super) fn misfit(&self, unknowns: usize) -> f64 {
        self.solution.chi_squared / (self.solution.channels.saturating_sub(unknowns).max(1)) as f64
    }

    /// Motion at the nodes.
    pub(super) fn states(&self) -> Vec<StartState> {
        self.solution.states.iter().map(|x| self.model.motion(x)).collect()
    }

    /// Whether it may be used at all.
    pub(super) fn settled(&self) -> bool {
        matches!(self.solution.report.status, Status::Converged | Status::Inconsistent)
    }
}

/// What the model is made of beside the track.
#[derive(Clone, Copy)]
pub(super) struct Setting<'a> {
    pub(super) scales: Scales,
    pub(super) noise: NoiseLevel,
    pub(super) constants: &'a [Constant],
    /// Prior deviations of the constants; those beyond the end of the list have none.
    pub(super) deviations: &'a [f64],
    /// Whether the shift by noise is wanted: it costs two more estimates.
    pub(super) shift_wanted: bool,
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
    let Setting { scales, noise, constants, deviations, shift_wanted, axes_chosen } = *setting;
    let natural = natural_time(track, scales.length);
    let spacing = track.duration() / (track.len() - 1).max(1) as f64;
    let stride = (natural / NODES_PER_NATURAL_TIME / spacing).round().max(1.0) as usize;
    let cut = blocks(track.len(), stride);
    let inputs = block_inputs(track, &cut, SMOOTHED_NATURAL_TIMES * natural);
    let model = ThreePalmModel::<N>::new(parameters, constants, track.gravity, noise, scales).ok_or(
        ObserverError::Value {
            what: "number of states",
            value: N as f64,
            needed: "that of motion and constants",
        },
    )?;
    let motion = MomentumProblem::new(track, mass, scales, f64::INFINITY).motion(start);
    let nodes: Vec<usize> = cut.iter().map(Block::node).collect();
    let states: Vec<SVector<f64, N>> = nodes
        .iter()
        .map(|&k| {
            let m = &motion[k];
            let L_WO = m.R_WO * (mass.inertia() * (m.R_WO.inverse() * m.w_WO));
            let state = StartState { p_WCm: m.p_WCm, v_WCm: m.v_WCm, L_WO, R_WO: m.R_WO };
            model.state(&state, &parameters)
        })
        .collect();
    let mut prior = Start::guess(states[0]);
    let least = KNOWN * model.relative_noise();
    for (k, (constant, deviation)) in constants.iter().zip(deviations).enumerate() {
        let deviation = deviation.max(least * constant.scale(&scales));
        prior.information[(MOTION_STATES + k, MOTION_STATES + k)] = deviation.powi(-2);
    }
    if axes_chosen {
        for axis in 9..12 {
            prior.information[(axis, axis)] = (CHOSEN * model.relative_noise()).powi(-2);
        }
    }
    let solution = most_probable(&model, &inputs, &states, &prior, SMOOTHED_NATURAL_TIMES * natural)?;
    let mut refined = Refined { model, solution, nodes, shift: 0.0 };
    if shift_wanted && refined.settled() {
        let shift = shift_by_noise(track, &refined, &cut, SMOOTHED_NATURAL_TIMES * natural, &prior, &noise);
        refined.shift = shift.unwrap_or(f64::INFINITY);
    }
    Ok(refined)
}

/// Largest shift of a state at the start, in its deviations, by as much noise again.
///
/// Where noise is much of what there is, the estimate is a curved function of it, and the mean of the estimates is not the
/// truth. Noise of the same size is added once more, in a pair of opposite signs: what is linear in it cancels, and what
/// is left is about what the noise in the data has done already. None where the noise leads nowhere.
fn shift_by_noise<const N: usize>(
    track: &Track,
    refined: &Refined<N>,
    cut: &[Block],
    reach: f64,
    prior: &Start<N>,
    noise: &NoiseLevel,
) -> Option<f64> {
    let states = &refined.solution.states;
    let mut sum = SVector::<f64, N>::zeros();
    for sign in [1.0, -1.0] {
        let inputs = block_inputs(&track.perturbed(noise, sign, 1), cut, reach);
        let moved = most_probable(&refined.model, &inputs, states, prior, reach).ok()?;
        if moved.report.status != Status::Converged && moved.report.status != Status::Inconsistent {
            return None;
        }
        sum += refined.model.difference(&moved.states[0], &states[0]) * 0.5;
    }
    let variances = refined.solution.covariances[0].diagonal();
    Some(sum.iter().zip(variances.iter()).map(|(s, v)| s.abs() / v.sqrt()).fold(0.0, f64::max))
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
