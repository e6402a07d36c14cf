//! Other motions that explain a noisy log, and the choice among them.
//!
//! Where noise is much of what there is, the contact conditions have several minima that noise explains, and the search
//! stops at the first. All that further rounds of it find are refined, and the most probable one is taken; how much more
//! probable it is than the next tells whether the log decides at all.

use super::cold_start::{
    COARSE, FIRST, FOLLOWED_IN_ALL, GROWTH, ROUNDS, Round, SAMPLES_PER_NATURAL_TIME, Search, natural_time,
    sampling, scales, sort, stride,
};
use super::covariance::NoiseLevel;
use super::estimate::{LARGEST_MISFIT, equivalent_orientations};
use super::momentum::{Scales, StartState, UNKNOWNS};
use super::refine::Refined;
use super::track::Track;
use crate::core::Model;
use crate::least_squares::{Fit, LeastSquares};
use glam::DQuat;
use object_dynamics::MassProperties;

/// Rounds of the search that are gone through for other motions: bodies near rest, forwards and backwards.
const ROUNDS_FOR_OTHERS: usize = 4;
/// Windows, as a share of the log, whose minima count.
const LATER_WINDOWS: f64 = 0.4;
/// Starts that are refined, at most. The truth was among the first six where it was there at all.
const MOST_REFINED: usize = 8;
/// Difference of two states, in natural sizes, below which candidates of a window go on as one.
const MET: f64 = 0.02;
/// The same for starts of which one is refined.
const DISTINCT: f64 = 0.15;
/// Deviation of a state, in natural sizes, from which on other motions may explain a log. Where they did it was 0.055 and
/// more.
const ROOM_FOR_OTHERS: f64 = 0.03;
/// Largest difference of a state, in its deviations, between two solutions that are one motion.
const SAME_MOTION: f64 = 1.0;

/// The most probable of some motions.
pub(super) struct Chosen<const N: usize> {
    pub(super) refined: Refined<N>,
    /// Logarithm of how many times more probable it is than the next; infinite without one.
    pub(super) log_odds: f64,
    /// Whether it is not the first of them.
    pub(super) replaced: bool,
}

/// Whether other motions may explain a log as well as this one, or better.
pub(super) fn leaves_room<const N: usize>(refined: &Refined<N>, unknowns: usize) -> bool {
    let (variances, sizes) = (refined.solution.covariances[0].diagonal(), refined.model.scales());
    let loose = |(v, s): (&f64, &f64)| v.is_nan() || *v > (ROOM_FOR_OTHERS * s).powi(2);
    let misfit = refined.misfit(unknowns);
    !refined.settled()
        || misfit.is_nan()
        || misfit > LARGEST_MISFIT
        || variances.iter().zip(&sizes).any(loose)
}

/// The most probable of the motions, beside the next that is not the `same`.
pub(super) fn most_credible<const N: usize>(
    first: Refined<N>,
    others: impl Iterator<Item = Refined<N>>,
    same: impl Fn(&Refined<N>, &Refined<N>) -> bool,
) -> Chosen<N> {
    let (mut best, mut replaced) = (first, false);
    let mut rivals: Vec<Refined<N>> = Vec::new();
    for other in others {
        // What is not a number is no rival.
        if other.improbability < best.improbability || best.improbability.is_nan() {
            rivals.push(std::mem::replace(&mut best, other));
            replaced = true;
        } else if other.improbability.is_finite() {
            rivals.push(other);
        }
    }
    let next = rivals
        .iter()
        .filter(|rival| !same(&best, rival))
        .map(|rival| rival.improbability - best.improbability)
        .fold(f64::INFINITY, f64::min);
    Chosen { refined: best, log_odds: 0.5 * next, replaced }
}

/// Whether a difference of states at the start is within what noise does.
pub(super) fn is_small<const N: usize>(refined: &Refined<N>, difference: &nalgebra::SVector<f64, N>) -> bool {
    let variances = refined.solution.covariances[0].diagonal();
    difference.iter().zip(&variances).all(|(d, v)| d * d <= SAME_MOTION * SAME_MOTION * v)
}

/// Starts of other motions of a known body, at most [`MOST_REFINED`]: what further rounds of the search lead to, those first
/// that leave least of the contact conditions.
pub(super) fn further_starts(track: &Track, mass: &MassProperties, noise: NoiseLevel) -> Vec<StartState> {
    let scales = scales(track, mass);
    let stride = stride(track, natural_time(track, scales.length), SAMPLES_PER_NATURAL_TIME);
    let sampling = sampling(stride);
    let natural = natural_time(track, scales.length).min(0.25 * track.duration());
    let thin = track.thinned(stride);
    let reversed = thin.reversed();
    let search = |track| Search { track, mass, scales, noise, sampling };
    let (forwards, backwards) = (search(&thin), search(&reversed));
    let problem = forwards.problem(f64::INFINITY);
    let mut found: Vec<(f64, StartState)> = Vec::new();
    for round in &ROUNDS[..ROUNDS_FOR_OTHERS] {
        let searched = if round.backwards { &backwards } else { &forwards };
        for fit in searched.minima(*round, (round.window * natural).min(track.duration())) {
            let start = if round.backwards { searched.reversed_end(&fit.point) } else { fit.point };
            found.extend(problem.cost(&start).map(|cost| (cost, start)));
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut starts: Vec<StartState> = Vec::new();
    for (_, start) in found {
        if starts.len() < MOST_REFINED && !starts.iter().any(|other| forwards.alike(&start, other, DISTINCT))
        {
            starts.push(start);
        }
    }
    starts
}

impl Search<'_> {
    /// Minima that the starts of a round lead to, on the later windows too: noise of the forces adds up in a longer one, so
    /// that a shorter one may have a minimum by the truth where the whole has none. Candidates that meet go on as one.
    fn minima(&self, round: Round, first: f64) -> Vec<Fit<StartState, UNKNOWNS>> {
        let problem = self.problem(first);
        let starts = self.starts(first, round).into_iter();
        let mut fits = self.one_of_each(starts.map(|start| FIRST.fit(&problem, start)).collect());
        fits.truncate(FOLLOWED_IN_ALL);
        let mut found = Vec::new();
        let mut window = first;
        while window < self.track.duration() {
            window = (window * GROWTH).min(self.track.duration());
            let problem = self.problem(window);
            fits = fits.into_iter().map(|fit| COARSE.fit(&problem, fit.point)).collect();
            fits = self.one_of_each(fits);
            if window >= LATER_WINDOWS * self.track.duration() {
                found.extend(fits.iter().cloned());
            }
        }
        found
    }

    /// The best of the fits that are alike.
    fn one_of_each(&self, mut fits: Vec<Fit<StartState, UNKNOWNS>>) -> Vec<Fit<StartState, UNKNOWNS>> {
        sort(&mut fits);
        let mut kept: Vec<Fit<StartState, UNKNOWNS>> = Vec::new();
        for fit in fits {
            if !kept.iter().any(|other| self.alike(&fit.point, &other.point, MET)) {
                kept.push(fit);
            }
        }
        kept
    }

    /// Whether two states differ by less than so much of their natural sizes, with the body's axes turned or not.
    fn alike(&self, a: &StartState, b: &StartState, tolerance: f64) -> bool {
        let Scales { length, velocity, momentum } = self.scales;
        let parts =
            [(a.p_WCm - b.p_WCm) / length, (a.v_WCm - b.v_WCm) / velocity, (a.L_WO - b.L_WO) / momentum];
        let turned = |turn: &DQuat| 2.0 * (a.R_WO.inverse() * b.R_WO * *turn).xyz().length();
        parts.iter().all(|part| part.length() < tolerance)
            && equivalent_orientations(self.mass).iter().any(|turn| turned(turn) < tolerance)
    }
}
