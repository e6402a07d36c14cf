//! The cold start, a step a sample: the search of the batch method on the track as it grows.

use crate::least_squares::{Fit, FitStatus, LevenbergMarquardt};
use crate::three_palms::cold_start::{COARSE, FIRST, FOLLOWED, GROWTH, ROUNDS, Round, Search, scales, sort};
use crate::three_palms::covariance::{NoiseLevel, Sampling};
use crate::three_palms::momentum::{StartState, UNKNOWNS};
use crate::three_palms::track::{Track, smoothing_variance};
use crate::three_palms::{cold_start, momentum};
use object_dynamics::MassProperties;

/// Steps that a candidate gets on each window, at most.
const STEPS: usize = 25;
/// Shortest track that a motion is taken from, in natural times: below it wrong motions explain the data too.
const SHORTEST: f64 = 3.0;

type Candidate = Fit<StartState, UNKNOWNS>;

/// A search that is as far as its samples.
#[derive(Debug)]
pub(super) struct StreamSearch {
    stage: Stage,
    /// Rounds that were begun.
    rounds: usize,
    scales: Option<momentum::Scales>,
}

#[derive(Debug)]
enum Stage {
    /// Waits for the data of a round's first window.
    Waiting,
    /// Fits the first window.
    First { window: f64, starts: Vec<StartState>, fits: Vec<Candidate>, work: Option<Work> },
    /// Follows the best as windows grow.
    Following { fits: Vec<Candidate>, work: Work, window: f64 },
}

/// A candidate under way.
#[derive(Clone, Debug)]
struct Work {
    fit: Candidate,
    steps: usize,
}

/// What a search works on.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scene<'a> {
    pub(super) track: &'a Track,
    pub(super) mass: &'a MassProperties,
    pub(super) noise: NoiseLevel,
    pub(super) stride: usize,
}

impl StreamSearch {
    pub(super) fn new() -> Self {
        Self { stage: Stage::Waiting, rounds: 0, scales: None }
    }

    /// Rounds of starts that were tried.
    pub(super) fn rounds(&self) -> usize {
        self.rounds
    }

    /// Natural sizes, once the search has begun.
    pub(super) fn scales(&self) -> Option<momentum::Scales> {
        self.scales
    }

    /// One step: at most two linearisations of the track so far. Returns the motion at the start of the track once one
    /// explains it.
    pub(super) fn step(&mut self, scene: &Scene<'_>) -> Option<StartState> {
        let stage = std::mem::replace(&mut self.stage, Stage::Waiting);
        let (stage, found) = match stage {
            Stage::Waiting => (self.begin(scene), None),
            Stage::First { window, starts, fits, work } => {
                (self.first(scene, window, starts, fits, work), None)
            }
            Stage::Following { fits, work, window } => self.follow(scene, fits, work, window),
        };
        self.stage = stage;
        found
    }

    fn begin(&mut self, scene: &Scene<'_>) -> Stage {
        if scene.track.len() < 8 {
            return Stage::Waiting;
        }
        let scales = scales(scene.track, scene.mass);
        let natural = cold_start::natural_time(scene.track, scales.length);
        let round = forwards(self.rounds);
        let window = round.window * natural;
        if scene.track.duration() < window.max(SHORTEST * natural) {
            return Stage::Waiting;
        }
        self.scales = Some(scales);
        self.rounds += 1;
        let starts = search(scene, scales).starts(window, round);
        let fits = Vec::with_capacity(starts.len());
        Stage::First { window, starts, fits, work: None }
    }

    fn first(
        &mut self,
        scene: &Scene<'_>,
        window: f64,
        mut starts: Vec<StartState>,
        mut fits: Vec<Candidate>,
        work: Option<Work>,
    ) -> Stage {
        let Some(scales) = self.scales else { return Stage::Waiting };
        let search = search(scene, scales);
        let point = match work {
            Some(work) if work.steps >= STEPS || work.fit.status == FitStatus::Converged => {
                fits.push(work.fit);
                None
            }
            Some(work) => Some((work.fit.point, work.steps, work.fit.damping)),
            None => None,
        };
        let next = point.or_else(|| starts.pop().map(|start| (start, 0, FIRST.damping)));
        let Some((point, steps, damping)) = next else {
            sort(&mut fits);
            fits.truncate(FOLLOWED);
            fits.reverse();
            return match fits.pop() {
                Some(fit) => Stage::Following { fits, work: Work { fit, steps: STEPS }, window },
                None => Stage::Waiting,
            };
        };
        let fit = one_step(&FIRST, damping).fit(&search.problem(window), point);
        Stage::First { window, starts, fits, work: Some(Work { fit, steps: steps + 1 }) }
    }

    fn follow(
        &mut self,
        scene: &Scene<'_>,
        mut fits: Vec<Candidate>,
        work: Work,
        window: f64,
    ) -> (Stage, Option<StartState>) {
        let Some(scales) = self.scales else { return (Stage::Waiting, None) };
        let search = search(scene, scales);
        let round = forwards(self.rounds.saturating_sub(1));
        let first = round.window * cold_start::natural_time(scene.track, scales.length);
        let done = work.steps >= STEPS || work.fit.status == FitStatus::Converged;
        let whole = window >= scene.track.duration();
        if !done {
            let fit = one_step(&COARSE, work.fit.damping).fit(&search.problem(window), work.fit.point);
            let work = Work { fit, steps: work.steps + 1 };
            return (Stage::Following { fits, work, window }, None);
        }
        if !whole {
            let window = (window * GROWTH).min(scene.track.duration());
            return (Stage::Following { fits, work: Work { steps: 0, ..work }, window }, None);
        }
        if work.fit.status != FitStatus::Failed && search.explains(&work.fit) {
            return (Stage::Waiting, Some(work.fit.point));
        }
        match fits.pop() {
            Some(fit) => {
                (Stage::Following { fits, work: Work { fit, steps: STEPS }, window: first }, None)
            }
            None => (Stage::Waiting, None),
        }
    }
}

/// Rounds that read the log forwards, over and over.
fn forwards(round: usize) -> Round {
    let mut rounds = ROUNDS.into_iter().filter(|r| !r.backwards).cycle();
    let first = ROUNDS[0];
    rounds.nth(round % ROUNDS.len()).unwrap_or(first)
}

/// A fit that ends after its first step.
fn one_step(of: &LevenbergMarquardt, damping: f64) -> LevenbergMarquardt {
    LevenbergMarquardt { iterations: 2, damping, ..*of }
}

fn search<'a>(scene: &Scene<'a>, scales: momentum::Scales) -> Search<'a> {
    let direct = smoothing_variance(scene.stride / 2);
    let sampling = Sampling { per_node: scene.stride as f64, weight: 1.0, direct };
    Search { track: scene.track, mass: scene.mass, scales, noise: scene.noise, sampling }
}
