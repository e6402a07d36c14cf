//! The cold start, a step a sample: the search of the batch method on the track as it grows.

use crate::least_squares::{Fit, FitStatus, LeastSquares, LevenbergMarquardt};
use crate::three_palms::cold_start::{COARSE, FIRST, FOLLOWED, GROWTH, ROUNDS, Round};

/// Steps that a candidate gets on each window, at most.
const STEPS: usize = 25;

/// What is searched for: `P` unknowns on the data so far.
pub(super) trait Trial<const P: usize> {
    type Point: Copy;
    type Problem<'a>: LeastSquares<P, Point = Self::Point>
    where
        Self: 'a;

    /// Natural time, s.
    fn natural_time(&self) -> f64;
    /// Time that the data span, s.
    fn duration(&self) -> f64;
    /// Shortest time, in natural ones, from which a motion is taken: below it wrong motions explain the data too.
    fn shortest(&self) -> f64;
    /// Starts of a round.
    fn starts(&self, round: Round, window: f64) -> Vec<Self::Point>;
    /// The fit of the data up to a time.
    fn problem(&self, window: f64) -> Self::Problem<'_>;
    /// Whether a fit of all data leaves noise alone.
    fn explains(&self, fit: &Fit<Self::Point, P>) -> bool;
}

/// A search that is as far as its samples.
pub(super) struct StreamSearch<Point, const P: usize> {
    stage: Stage<Point, P>,
    /// Rounds that were begun.
    rounds: usize,
}

enum Stage<Point, const P: usize> {
    /// Waits for the data of a round's first window.
    Waiting,
    /// Fits the first window.
    First { window: f64, starts: Vec<Point>, fits: Vec<Fit<Point, P>>, work: Option<Work<Point, P>> },
    /// Follows the best as windows grow.
    Following { fits: Vec<Fit<Point, P>>, work: Work<Point, P>, first: f64, window: f64 },
}

/// A candidate under way: its fit, and the steps it had on this window. None before the first.
struct Work<Point, const P: usize> {
    fit: Fit<Point, P>,
    steps: usize,
}

impl<Point, const P: usize> Work<Point, P> {
    fn done(&self) -> bool {
        self.steps >= STEPS || (self.steps > 0 && self.fit.status != FitStatus::OutOfIterations)
    }
}

impl<Point: Copy, const P: usize> StreamSearch<Point, P> {
    pub(super) fn new() -> Self {
        Self { stage: Stage::Waiting, rounds: 0 }
    }

    /// Rounds of starts that were tried.
    pub(super) fn rounds(&self) -> usize {
        self.rounds
    }

    /// One step: at most two linearisations of the data so far. Returns the point that explains them, once there is one.
    pub(super) fn step<T: Trial<P, Point = Point>>(&mut self, trial: &T) -> Option<Point> {
        let (stage, found) = match std::mem::replace(&mut self.stage, Stage::Waiting) {
            Stage::Waiting => (self.begin(trial), None),
            Stage::First { window, starts, fits, work } => (first(trial, window, starts, fits, work), None),
            Stage::Following { fits, work, first, window } => follow(trial, fits, work, first, window),
        };
        self.stage = stage;
        found
    }

    fn begin<T: Trial<P, Point = Point>>(&mut self, trial: &T) -> Stage<Point, P> {
        let natural = trial.natural_time();
        let round = forwards(self.rounds);
        let window = round.window * natural;
        if trial.duration() < window {
            return Stage::Waiting;
        }
        self.rounds += 1;
        let starts = trial.starts(round, window);
        let fits = Vec::with_capacity(starts.len());
        Stage::First { window, starts, fits, work: None }
    }
}

fn first<T: Trial<P>, const P: usize>(
    trial: &T,
    window: f64,
    mut starts: Vec<T::Point>,
    mut fits: Vec<Fit<T::Point, P>>,
    work: Option<Work<T::Point, P>>,
) -> Stage<T::Point, P> {
    let problem = trial.problem(window);
    let work = match work {
        Some(work) if work.done() => {
            fits.push(work.fit);
            None
        }
        Some(work) => Some(Work { fit: one_step(&FIRST, &work.fit).resume(&problem, work.fit), steps: work.steps + 1 }),
        None => None,
    };
    if work.is_some() {
        return Stage::First { window, starts, fits, work };
    }
    if let Some(start) = starts.pop() {
        let fit = LevenbergMarquardt { iterations: 2, ..FIRST }.fit(&problem, start);
        return Stage::First { window, starts, fits, work: Some(Work { fit, steps: 1 }) };
    }
    fits.retain(|fit| fit.status != FitStatus::Failed);
    fits.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
    fits.truncate(FOLLOWED);
    fits.reverse();
    match fits.pop() {
        Some(fit) => Stage::Following { fits, work: Work { fit, steps: STEPS }, first: window, window },
        None => Stage::Waiting,
    }
}

fn follow<T: Trial<P>, const P: usize>(
    trial: &T,
    mut fits: Vec<Fit<T::Point, P>>,
    work: Work<T::Point, P>,
    first: f64,
    window: f64,
) -> (Stage<T::Point, P>, Option<T::Point>) {
    if !work.done() {
        let problem = trial.problem(window);
        let solver = one_step(&COARSE, &work.fit);
        let fit = if work.steps == 0 {
            solver.fit(&problem, work.fit.point)
        } else {
            solver.resume(&problem, work.fit)
        };
        let work = Work { fit, steps: work.steps + 1 };
        return (Stage::Following { fits, work, first, window }, None);
    }
    if window < trial.duration() {
        let window = (window * GROWTH).min(trial.duration());
        return (Stage::Following { fits, work: Work { steps: 0, ..work }, first, window }, None);
    }
    if trial.duration() < trial.shortest() * trial.natural_time() {
        // Waits for more data.
        return (Stage::Following { fits, work, first, window }, None);
    }
    if work.fit.status != FitStatus::Failed && trial.explains(&work.fit) {
        return (Stage::Waiting, Some(work.fit.point));
    }
    match fits.pop() {
        Some(fit) => {
            (Stage::Following { fits, work: Work { fit, steps: STEPS }, first, window: first }, None)
        }
        None => (Stage::Waiting, None),
    }
}

/// Rounds that read the log forwards, over and over.
fn forwards(round: usize) -> Round {
    let rounds = ROUNDS.into_iter().filter(|r| !r.backwards);
    rounds.cycle().nth(round % ROUNDS.len()).unwrap_or(ROUNDS[0])
}

/// The next step of a fit.
fn one_step<Point, const P: usize>(of: &LevenbergMarquardt, fit: &Fit<Point, P>) -> LevenbergMarquardt {
    LevenbergMarquardt { iterations: 2, damping: fit.damping, ..*of }
}
