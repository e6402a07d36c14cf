//! Bias by noise: the estimate is a nonlinear function of the data, and noise in impulses and contacts shifts its mean.
//!
//! Found by adding noise of the same size once more. It comes in pairs of opposite sign, so that what is linear in it
//! cancels exactly and only the shift is left; as noise of the same size was in the data already, it has already
//! shifted the estimate by about as much, and by more where noise is most of what there is.

use super::covariance::NoiseLevel;
use super::momentum::{MomentumProblem, Row, Scales, StartState};
use super::random::Normal;
use super::track::Track;
use crate::least_squares::{FitStatus, LevenbergMarquardt};
use glam::DVec3;
use object_dynamics::MassProperties;

/// Pairs of draws.
const PAIRS: u64 = 5;
/// Fits on the thinned track, from the estimate: a few steps away.
const SOLVER: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 15, step_tolerance: 1e-6, damping: 1e-6, prior: 0.0 };

/// Shift of the scaled unknowns by noise; none where as much noise again leads nowhere.
pub(super) fn noise_bias(
    track: &Track,
    mass: &MassProperties,
    scales: &Scales,
    estimate: &StartState,
    noise: &NoiseLevel,
    stride: usize,
) -> Option<Row> {
    let fit = |thin: &Track, start: &StartState| {
        let fit = SOLVER.fit(&MomentumProblem::new(thin, mass, *scales, f64::INFINITY), *start);
        (fit.status != FitStatus::Failed).then_some(fit.point)
    };
    let base = fit(&track.thinned(stride), estimate)?;
    let mut shift = Row::zeros();
    for pair in 0..PAIRS {
        for sign in [1.0, -1.0] {
            let moved = fit(&track.perturbed(noise, sign, pair).thinned(stride), &base)?;
            shift += difference(&moved, &base, scales) * (0.5 / PAIRS as f64);
        }
    }
    Some(shift)
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
