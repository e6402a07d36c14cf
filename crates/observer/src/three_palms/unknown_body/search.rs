//! A start that needs no guess, for a body of which nothing is known.
//!
//! The mean force carries the weight, static balance places the centre of mass, and the inertia begins as a ball's: the
//! orientation is no unknown, so that there is nothing else to try but heights, spins and first windows.

use super::problem::{BODY_UNKNOWNS, BodyPoint, BodyProblem};
use crate::least_squares::{Fit, FitStatus, LeastSquares, LevenbergMarquardt, Observability};
use crate::three_palms::clean::information_inverse;
use crate::three_palms::cold_start::{
    EXPLAINED, GROWTH, SAMPLES_PER_NATURAL_TIME, SEARCHED_PER_NATURAL_TIME, continuing, from_normal_speeds,
    natural_time, next_to_nothing, rest_state, sampling, scales, stride,
};
use crate::three_palms::covariance::{NoiseLevel, Sampling, propagate};
use crate::three_palms::inertia::numbers_of_inertia;
use crate::three_palms::momentum::{MomentumProblem, Scales};
use crate::three_palms::polish::polish;
use crate::three_palms::track::Track;
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::MassProperties;

/// Families of starts, tried in this order until one explains the data: first window in natural times, heights as shares
/// of the one that static balance suggests, and spin in natural units.
const ROUNDS: [(f64, &[f64], f64); 6] = [
    (2.0, &[1.0, 0.8, 1.2], 0.0),
    (4.0, &[1.0, 0.8, 1.2], 0.0),
    (1.0, &[1.0, 0.8, 1.2], 0.0),
    (2.0, &[1.0, 0.8, 1.2], 0.4),
    (4.0, &[1.0], 0.4),
    (2.0, &[1.0], 0.8),
];
/// Mean squared radius of gyration of the ball that the inertia begins with, in squared natural lengths.
const BALL: f64 = 0.4;
/// Share of the mean information that holds the unknowns while the windows grow.
const PRIOR: f64 = 1e-3;
const COARSE: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 10, step_tolerance: 1e-6, damping: 1e-2, prior: PRIOR };
/// Steps of the last fit of a search, with nothing held.
const STEPS: usize = 60;

/// The mass that the mean force carries, kg: the momentum changes little against the weight's impulse.
pub(crate) fn mass_of_weight(track: &Track) -> Option<f64> {
    let g = track.gravity;
    let impulse = track.integrals.last()?.impulse;
    let mass = -impulse.dot(g) / (g.length_squared() * track.duration());
    (mass > 0.0 && mass.is_finite()).then_some(mass)
}

/// The best fits of a thinned track found, best first.
///
/// All starts of a round are fitted to its first window; then they are followed, the best first, until one explains the data.
pub(super) fn search(track: &Track, scales: Scales, noise: NoiseLevel) -> Vec<Fit<BodyPoint, BODY_UNKNOWNS>> {
    let natural = natural_time(track, scales.length);
    let per_node = stride(track, natural, SAMPLES_PER_NATURAL_TIME);
    let sampling = sampling(per_node);
    let thin = track.thinned(per_node);
    let coarse = track.thinned(stride(track, natural, SEARCHED_PER_NATURAL_TIME));
    let mut found: Vec<Fit<BodyPoint, BODY_UNKNOWNS>> = Vec::new();
    for (window, heights, spin) in ROUNDS {
        let first = (window * natural).min(track.duration());
        let problem = BodyProblem::new(&coarse, scales, first);
        let spins = spins(spin * scales.velocity / scales.length);
        let starts = heights.iter().flat_map(|&height| spins.iter().map(move |&w_WO| (height, w_WO)));
        let mut candidates: Vec<_> = starts
            .map(|(height, w_WO)| COARSE.fit(&problem, begin(&coarse, scales, first, height, w_WO)))
            .filter(|fit| fit.status != FitStatus::Failed)
            .collect();
        candidates.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
        for candidate in candidates {
            found.extend(follow(&coarse, &thin, scales, first, candidate));
            found.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
            if found.first().is_some_and(|best| explains(&thin, scales, &noise, sampling, best)) {
                return found;
            }
        }
    }
    found
}

/// The fit of the thinned track from a point that is near.
pub(super) fn fit_near(
    track: &Track,
    scales: Scales,
    near: BodyPoint,
) -> Option<Fit<BodyPoint, BODY_UNKNOWNS>> {
    let thin = track.thinned(stride(track, natural_time(track, scales.length), SAMPLES_PER_NATURAL_TIME));
    let all = BodyProblem::new(&thin, scales, f64::INFINITY);
    polish(&all, &all, 1, near, STEPS)
}

pub(crate) fn spins(rate: f64) -> Vec<DVec3> {
    if rate == 0.0 {
        return vec![DVec3::ZERO];
    }
    [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis * rate, axis * -rate]).collect()
}

pub(crate) fn begin(track: &Track, scales: Scales, window: f64, height: f64, w_WO: DVec3) -> BodyPoint {
    let mut start = rest_state(track, window);
    start.p_WCm.z *= height;
    let inertia = DMat3::from_diagonal(DVec3::splat(BALL * track.mass * scales.length * scales.length));
    let node = &track.nodes[0];
    let carried = |i: usize| w_WO.dot(node.palms[i].frame.n.cross(node.p_WC[i] - start.p_WCm)) - node.lift[i];
    start.v_WCm = from_normal_speeds(node, DVec3::new(carried(0), carried(1), carried(2)));
    start.L_WO = inertia * w_WO;
    start.R_WO = DQuat::IDENTITY;
    BodyPoint { start, log_mass: track.mass.ln(), inertia: numbers_of_inertia(inertia) }
}

/// The fit of all nodes of `thin` to which a fit of the first window leads as the windows grow.
fn follow(
    coarse: &Track,
    thin: &Track,
    scales: Scales,
    first: f64,
    candidate: Fit<BodyPoint, BODY_UNKNOWNS>,
) -> Option<Fit<BodyPoint, BODY_UNKNOWNS>> {
    let mut fit = candidate;
    let mut window = first;
    while window < coarse.duration() {
        window = (window * GROWTH).min(coarse.duration());
        fit = continuing(COARSE, &fit).fit(&BodyProblem::new(coarse, scales, window), fit.point);
        if fit.status == FitStatus::Failed {
            return None;
        }
    }
    let all = BodyProblem::new(thin, scales, f64::INFINITY);
    polish(&all, &all, 1, fit.point, STEPS)
}

/// Whether what is left of the data is noise, or next to nothing.
fn explains(
    track: &Track,
    scales: Scales,
    noise: &NoiseLevel,
    sampling: Sampling,
    fit: &Fit<BodyPoint, BODY_UNKNOWNS>,
) -> bool {
    let explained = || explained(track, scales, noise, sampling, fit);
    next_to_nothing(fit, &scales) || explained().is_some_and(|e| fit.normal.rms() < EXPLAINED * e)
}

/// Residual that noise explains, m/s; none for a body that cannot be.
fn explained(
    track: &Track,
    scales: Scales,
    noise: &NoiseLevel,
    sampling: Sampling,
    fit: &Fit<BodyPoint, BODY_UNKNOWNS>,
) -> Option<f64> {
    let mass = fit.point.mass()?;
    let track = track.of_mass(mass.mass());
    let problem = MomentumProblem::new(&track, &mass, scales, f64::INFINITY);
    let normal = problem.linearise(&fit.point.start)?;
    let inverse = information_inverse(&Observability::new(&normal.information));
    Some(propagate(&problem, &fit.point.start, &inverse, noise, sampling).residual)
}

/// The ball that the inertia begins with.
pub(crate) fn ball(mass: f64, length: f64) -> Option<MassProperties> {
    MassProperties::from_principal(mass, DVec3::splat(BALL * mass * length * length)).ok()
}

/// Natural sizes for a body whose mass is that of its weight.
pub(crate) fn scales_of_ball(track: &Track) -> Option<Scales> {
    let length = scales(track, &ball(track.mass, 1.0)?).length;
    Some(scales(track, &ball(track.mass, length)?))
}
