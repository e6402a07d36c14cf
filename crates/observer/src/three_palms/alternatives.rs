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
use super::estimate::EstimateError;
use super::momentum::StartState;
use super::most_probable::{FIRST_PASS, PASSES};
use super::orientations::{equivalent_orientations, nearest_to_identity, nearest_turn};
use super::refine::{Refined, Setting, refine, refine_along};
use super::state_space::Parameters;
use super::track::Track;
use super::verdict::LARGEST_MISFIT;
use crate::core::Model;
use nalgebra::SVector;
use object_dynamics::MassProperties;

/// Motions that are refined to the end, at most.
const MOST_REFINED: usize = 4;
/// Deviation of a state, in natural sizes, from which on other motions may explain a log. Where they did it was 0.055 and
/// more.
const ROOM_FOR_OTHERS: f64 = 0.03;
/// Largest difference of a state, in its deviations, between two solutions that are one motion.
const SAME_MOTION: f64 = 1.0;

/// A motion that explains a log beside the one that was taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherMotion {
    /// Motion at the first sample; of the orientations that no data can tell apart the one nearest to the motion taken.
    pub start: StartState,
    /// By how much more data and prior must be corrected for it, in squared deviations.
    pub corrections: f64,
    /// Logarithm of how many times less probable it is; below zero where it is the more probable one.
    pub log_odds: f64,
}

/// The motion taken of some.
pub(super) struct Chosen<const N: usize> {
    pub(super) refined: Refined<N>,
    /// The others, those that need the smallest corrections first.
    pub(super) others: Vec<OtherMotion>,
    /// Whether it is not the one that the search came to.
    pub(super) replaced: bool,
}

impl<const N: usize> Chosen<N> {
    /// Logarithm of how many times more probable it is than the most probable of the others; infinite without others.
    pub(super) fn log_odds(&self) -> f64 {
        self.others.iter().map(|other| other.log_odds).fold(f64::INFINITY, f64::min)
    }
}

/// The most probable motion that a start, or others where the log leaves room for them, leads to.
pub(super) fn refine_best<const N: usize>(
    track: &Track,
    mass: &MassProperties,
    setting: &Setting<'_>,
    start: &StartState,
) -> Result<Chosen<N>, EstimateError> {
    let start = StartState { R_WO: nearest_to_identity(mass, start.R_WO), ..*start };
    let first =
        refine::<N>(track, mass, Parameters::new(mass), &start, setting).map_err(|_| EstimateError::NoFit)?;
    let mut chosen = if leaves_room(&first, N) {
        let same = |a: &Refined<N>, b: &Refined<N>| are_one(mass, a, b);
        let others = other_motions(track, mass, setting, same);
        let others = others
            .iter()
            .filter_map(|path| refine_along(track, Parameters::new(mass), path, setting, PASSES).ok());
        least_corrected(mass, first, others)
    } else {
        Chosen { refined: first, others: Vec::new(), replaced: false }
    };
    chosen.refined.widen(track, &setting.noise);
    Ok(chosen)
}

/// Whether other motions may explain a log as well as this one, or better.
fn leaves_room<const N: usize>(refined: &Refined<N>, unknowns: usize) -> bool {
    let (variances, sizes) = (refined.solution.covariances[0].diagonal(), refined.model.scales());
    let loose = |(v, s): (&f64, &f64)| v.is_nan() || *v > (ROOM_FOR_OTHERS * s).powi(2);
    let misfit = refined.misfit(unknowns);
    !refined.settled()
        || misfit.is_nan()
        || misfit > LARGEST_MISFIT
        || variances.iter().zip(&sizes).any(loose)
}

/// The motion that needs the smallest corrections, and those that are others than it.
fn least_corrected<const N: usize>(
    mass: &MassProperties,
    first: Refined<N>,
    others: impl Iterator<Item = Refined<N>>,
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
    rivals.sort_by(|a, b| a.cost().total_cmp(&b.cost()));
    let mut distinct: Vec<&Refined<N>> = Vec::new();
    for rival in &rivals {
        if !are_one(mass, &best, rival) && !distinct.iter().any(|other| are_one(mass, other, rival)) {
            distinct.push(rival);
        }
    }
    let others = distinct
        .into_iter()
        .map(|rival| OtherMotion {
            start: nearest_to(mass, &best, rival),
            corrections: rival.cost() - best.cost(),
            log_odds: 0.5 * (rival.improbability - best.improbability),
        })
        .collect();
    Chosen { refined: best, others, replaced }
}

/// Start of a motion, of its equivalent orientations the one nearest to that of another.
fn nearest_to<const N: usize>(mass: &MassProperties, best: &Refined<N>, rival: &Refined<N>) -> StartState {
    let start = |refined: &Refined<N>| refined.model.motion(&refined.solution.states[0]);
    let (to, from) = (start(best), start(rival));
    StartState { R_WO: from.R_WO * nearest_turn(mass, from.R_WO, to.R_WO), ..from }
}

/// Whether two solutions are one motion, with the body's axes turned or not.
fn are_one<const N: usize>(mass: &MassProperties, a: &Refined<N>, b: &Refined<N>) -> bool {
    let (x, at) = (&a.solution.states[0], &b.solution.states[0]);
    let (to, parameters) = (b.model.motion(at), b.model.parameters(at));
    equivalent_orientations(mass).into_iter().any(|turn| {
        let turned = b.model.state(&StartState { R_WO: to.R_WO * turn, ..to }, &parameters);
        is_small(a, &a.model.difference(&turned, x))
    })
}

/// Whether a difference of states at the start is within what noise does.
fn is_small<const N: usize>(refined: &Refined<N>, difference: &SVector<f64, N>) -> bool {
    let variances = refined.solution.covariances[0].diagonal();
    difference.iter().zip(&variances).all(|(d, v)| d * d <= SAME_MOTION * SAME_MOTION * v)
}

/// Other motions of a known body, at the nodes: what the ways to lie that an unknown body leaves lead to in a first pass, one of
/// each, at most [`MOST_REFINED`], those first that need the data corrected least.
fn other_motions<const N: usize>(
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
