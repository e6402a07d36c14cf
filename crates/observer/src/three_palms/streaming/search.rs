//! The cold start, a step a sample: the search of the batch method on the track as it grows.

use crate::least_squares::{Fit, FitStatus, LeastSquares, LevenbergMarquardt};
use crate::three_palms::cold_start::{COARSE, FIRST, FOLLOWED, GROWTH, ROUNDS, Round};

/// Steps that a candidate gets on each window, at most.
const STEPS: usize = 25;

/// Share of the cost below which another step is not worth it.
const SMALL_GAIN: f64 = 1e-3;

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
    Following(Following<Point, P>),
    /// The best so far was handed out.
    Handed(Following<Point, P>),
}

/// Where a step leads, and the point that it hands out.
type Outcome<Point, const P: usize> = (Stage<Point, P>, Option<Point>);

/// Candidates that are followed, one after the other.
struct Following<Point, const P: usize> {
    fits: Vec<Fit<Point, P>>,
    work: Work<Point, P>,
    /// First window, s.
    first: f64,
    /// Window of the work, s.
    window: f64,
    /// Length of the data, s, before which the window does not grow.
    until: f64,
}

/// A candidate under way: its fit, and the steps it had on this window. None before the first.
struct Work<Point, const P: usize> {
    fit: Fit<Point, P>,
    steps: usize,
    /// Share of the cost that the last step saved.
    gain: f64,
}

impl<Point, const P: usize> Work<Point, P> {
    fn done(&self) -> bool {
        let small = self.gain < SMALL_GAIN || self.fit.status != FitStatus::OutOfIterations;
        self.steps >= STEPS || (self.steps > 0 && small)
    }

    /// Of a candidate that is not to be worked on before the window grows.
    fn rested(fit: Fit<Point, P>) -> Self {
        Self { fit, steps: STEPS, gain: 0.0 }
    }

    /// After the next step.
    fn stepped(self, solver: &LevenbergMarquardt, problem: &impl LeastSquares<P, Point = Point>) -> Self
    where
        Point: Clone,
    {
        let solver = LevenbergMarquardt { iterations: 2, damping: self.fit.damping, ..*solver };
        let before = self.fit.normal.cost;
        if self.steps == 0 {
            let fit = solver.fit(problem, self.fit.point);
            return Self { fit, steps: 1, gain: 1.0 };
        }
        let fit = solver.resume(problem, self.fit);
        Self { gain: 1.0 - fit.normal.cost / before.max(f64::MIN_POSITIVE), fit, steps: self.steps + 1 }
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

    /// One step: at most two linearisations of the data so far. Returns a fit of all of them; a further step, after one, says
    /// that it was not the right one.
    pub(super) fn step<T: Trial<P, Point = Point>>(&mut self, trial: &T) -> Option<Point> {
        let (stage, found) = match std::mem::replace(&mut self.stage, Stage::Waiting) {
            Stage::Waiting => (self.begin(trial), None),
            Stage::First { window, starts, fits, work } => (first(trial, window, starts, fits, work), None),
            Stage::Following(following) => follow(trial, following),
            Stage::Handed(Following { fits, first, .. }) => (next(fits, first), None),
        };
        self.stage = stage;
        found
    }

    /// Keeps the fit that was handed out, to look at it again when there are more data by that factor.
    pub(super) fn keep(&mut self, growth: f64) {
        self.stage = match std::mem::replace(&mut self.stage, Stage::Waiting) {
            Stage::Handed(following) => {
                Stage::Following(Following { until: growth * following.window, ..following })
            }
            other => other,
        };
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
        Some(work) => Some(work.stepped(&FIRST, &problem)),
        None => None,
    };
    if work.is_some() {
        return Stage::First { window, starts, fits, work };
    }
    if let Some(start) = starts.pop() {
        let fit = LevenbergMarquardt { iterations: 2, ..FIRST }.fit(&problem, start);
        return Stage::First { window, starts, fits, work: Some(Work { fit, steps: 1, gain: 1.0 }) };
    }
    fits.retain(|fit| fit.status != FitStatus::Failed);
    fits.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
    fits.truncate(FOLLOWED);
    fits.reverse();
    next(fits, window)
}

fn follow<T: Trial<P>, const P: usize>(trial: &T, following: Following<T::Point, P>) -> Outcome<T::Point, P> {
    let Following { fits, work, first, window, until } = following;
    let duration = trial.duration();
    if !work.done() {
        let work = work.stepped(&COARSE, &trial.problem(window));
        return (Stage::Following(Following { fits, work, first, window, until }), None);
    }
    if duration < until {
        // Waits for more data.
        return (Stage::Following(Following { fits, work, first, window, until }), None);
    }
    if duration > window {
        let window = (window * GROWTH).min(duration);
        let work = Work { steps: 0, ..work };
        return (Stage::Following(Following { fits, work, first, window, until }), None);
    }
    if duration < trial.shortest() * trial.natural_time() {
        // Waits for more data.
        return (Stage::Following(Following { fits, work, first, window, until }), None);
    }
    if work.fit.status == FitStatus::Failed {
        return (next(fits, first), None);
    }
    let found = work.fit.point;
    (Stage::Handed(Following { fits, work, first, window, until }), Some(found))
}

/// The next candidate of those that are left.
fn next<Point, const P: usize>(mut fits: Vec<Fit<Point, P>>, first: f64) -> Stage<Point, P> {
    match fits.pop() {
        Some(fit) => {
            Stage::Following(Following { fits, work: Work::rested(fit), first, window: first, until: 0.0 })
        }
        None => Stage::Waiting,
    }
}

/// Rounds that read the log forwards, over and over.
fn forwards(round: usize) -> Round {
    let rounds = ROUNDS.into_iter().filter(|r| !r.backwards);
    rounds.cycle().nth(round % ROUNDS.len()).unwrap_or(ROUNDS[0])
}
