//! Bias by noise: the estimate is a nonlinear function of the data, and noise in impulses and contacts shifts its mean.
//!
//! A sum of squares over noisy data is, on average, the sum over exact data plus what the noise adds; the latter is
//! found by adding noise of the same size once more, and is taken out. How far the minimum moves by that is the bias.
//! The noise comes in pairs of opposite sign, so that what is linear in it cancels exactly.

use super::covariance::NoiseLevel;
use super::momentum::{MomentumProblem, Row, Scales, StartState, UNKNOWNS};
use super::random::Normal;
use super::track::Track;
use crate::least_squares::{FitStatus, LeastSquares, LevenbergMarquardt, NormalEquations};
use glam::DVec3;
use object_dynamics::MassProperties;

/// Pairs of draws.
const PAIRS: u64 = 4;
/// Fits on the thinned track, from the estimate: a few steps away.
const SOLVER: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 15, step_tolerance: 1e-6, damping: 1e-4, prior: 0.0 };

/// Shift of the scaled unknowns by noise; none where the sum without what noise adds has no minimum in reach, so that
/// the data hold more noise than motion.
pub(super) fn noise_bias(
    track: &Track,
    mass: &MassProperties,
    scales: &Scales,
    estimate: &StartState,
    noise: &NoiseLevel,
    stride: usize,
) -> Option<Row> {
    let mut tracks = vec![track.thinned(stride)];
    for pair in 0..PAIRS {
        tracks.extend([1.0, -1.0].map(|sign| track.perturbed(noise, sign, pair).thinned(stride)));
    }
    let mut problems = tracks.iter().map(|track| MomentumProblem::new(track, mass, *scales, f64::INFINITY));
    let plain = problems.next()?;
    let base = SOLVER.fit(&plain, *estimate);
    let corrected = SOLVER.fit(&Corrected { plain, noisy: problems.collect() }, base.point);
    let settled = base.status == FitStatus::Converged && corrected.status == FitStatus::Converged;
    settled.then(|| difference(&base.point, &corrected.point, scales))
}

/// The plain sum less what one more helping of noise adds to it.
struct Corrected<'a> {
    plain: MomentumProblem<'a>,
    noisy: Vec<MomentumProblem<'a>>,
}

impl LeastSquares<UNKNOWNS> for Corrected<'_> {
    type Point = StartState;

    fn linearise(&self, point: &StartState) -> Option<NormalEquations<UNKNOWNS>> {
        let mut sum = self.plain.linearise(point)?;
        let plain = sum.clone();
        for problem in &self.noisy {
            let noisy = problem.linearise(point)?;
            let share = 1.0 / self.noisy.len() as f64;
            sum.information -= (noisy.information - plain.information) * share;
            sum.gradient -= (noisy.gradient - plain.gradient) * share;
            sum.cost -= (noisy.cost - plain.cost) * share;
        }
        Some(sum)
    }

    fn cost(&self, point: &StartState) -> Option<f64> {
        let plain = self.plain.cost(point)?;
        let noisy = self.noisy.iter().map(|p| p.cost(point)).sum::<Option<f64>>()?;
        Some(2.0 * plain - noisy / self.noisy.len() as f64)
    }

    fn retract(&self, point: &StartState, step: &Row) -> StartState {
        self.plain.retract(point, step)
    }
}

fn difference(a: &StartState, b: &StartState, scales: &Scales) -> Row {
    let turn = a.R_WO * b.R_WO.inverse();
    let parts = [
        (a.p_WCm - b.p_WCm) / scales.length,
        (a.v_WCm - b.v_WCm) / scales.velocity,
        (a.L_WO - b.L_WO) / scales.momentum,
        DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum(),
    ];
    Row::from_fn(|i, _| parts[i / 3][i % 3])
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
