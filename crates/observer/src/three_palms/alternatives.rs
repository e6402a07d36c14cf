//! Other motions that explain a noisy log, and the choice among them.
//!
//! Where noise is much of what there is, the contact conditions have several minima that noise explains, and the search
//! stops at the first. The others are found by another way ([`motions_by_body`]) and refined.
//!
//! Two yardsticks compare them. Squared corrections of the data (chi-squared, and the prior's) do not depend on what a contact
//! could have been before it was measured, but scatter: each motion feels noise of another direction. The probability mass
//! about a motion (Laplace) counts how sharp its predictions are too; to do so it must say how contacts are spread before
//! they are measured, and as every sample adds to that, a motion that turns faster can win by it. The motion that needs
//! the smallest corrections is taken, and relied on only where the mass about it is the largest too, by far.

use super::by_body::motions_by_body;
use super::estimate::LARGEST_MISFIT;
use super::momentum::StartState;
use super::most_probable::FIRST_PASS;
use super::refine::{Refined, Setting, refine_along};
use super::state_space::Parameters;
use super::track::Track;
use crate::core::Model;
use object_dynamics::MassProperties;

/// Motions that are refined to the end, at most.
const MOST_REFINED: usize = 4;
/// Deviation of a state, in natural sizes, from which on other motions may explain a log. Where they did it was 0.055 and
/// more.
const ROOM_FOR_OTHERS: f64 = 0.03;
/// Largest difference of a state, in its deviations, between two solutions that are one motion.
const SAME_MOTION: f64 = 1.0;

/// The motion taken of some.
pub(super) struct Chosen<const N: usize> {
    pub(super) refined: Refined<N>,
    /// Logarithm of how many times more probable it is than the most probable of the others; infinite without others.
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

/// The motion that needs the smallest corrections, and how probable it is beside those that are not the `same`.
pub(super) fn least_corrected<const N: usize>(
    first: Refined<N>,
    others: impl Iterator<Item = Refined<N>>,
    same: impl Fn(&Refined<N>, &Refined<N>) -> bool,
) -> Chosen<N> {
    let (mut best, mut replaced) = (first, false);
    let mut rivals: Vec<Refined<N>> = Vec::new();
    for other in others {
        let better = other.cost() < best.cost() || best.cost().is_nan();
        if better {
            rivals.push(std::mem::replace(&mut best, other));
            replaced = true;
        } else if other.cost().is_finite() {
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

/// Other motions of a known body, at the nodes: what the ways to lie that an unknown body leaves lead to in a first pass, one of
/// each, at most [`MOST_REFINED`], those first that need the data corrected least.
pub(super) fn other_motions<const N: usize>(
    track: &Track,
    mass: &MassProperties,
    setting: &Setting<'_>,
    same: impl Fn(&Refined<N>, &Refined<N>) -> bool,
) -> Vec<Vec<StartState>> {
    let mut found: Vec<Refined<N>> = motions_by_body(track, mass, setting.noise)
        .iter()
        .filter_map(|path| refine_along(track, Parameters::new(mass), path, setting, FIRST_PASS).ok())
        .filter(|refined| refined.cost().is_finite())
        .collect();
    found.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    let mut kept: Vec<Refined<N>> = Vec::new();
    for refined in found {
        if kept.len() < MOST_REFINED && !kept.iter().any(|other| same(other, &refined)) {
            kept.push(refined);
        }
    }
    kept.iter().map(Refined::states).collect()
}
