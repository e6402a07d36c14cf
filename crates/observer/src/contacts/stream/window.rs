//! The motion over a window of the latest samples.

use super::dearer::Dearer;
use super::front::FORGOTTEN;
use super::log::log;
use super::modes::Modes;
use super::others::{ALONE, Followed};
use super::sample::{Raw, StreamPalm};
use super::solution::{Of, Solution};
use crate::contacts::body::{Body, CONSTANTS};
use crate::contacts::cold;
use crate::contacts::estimate::AVERAGED;
use crate::contacts::first::First;
use crate::contacts::flow::Carried;
use crate::contacts::mode_odds::typical;
use crate::contacts::modes::by_ratio;
use crate::contacts::onward::{FOLLOWED, WINDOW};
use crate::contacts::options::ContactOptions;
use crate::contacts::problem::{Beforehand, Problem, Units, Unknowns};
use crate::contacts::record::Record;
use crate::contacts::search::{fine_nodes, fine_within, problem, thinned, whole};
use crate::contacts::solve::Solved;
use crate::contacts::stage::Stage;
use crate::contacts::state::Motion;
use crate::contacts::suspects::Readings;
use crate::contacts::windows::{longest, windows};
use nalgebra::Matrix6;
use object_dynamics::ContactLog;
use std::collections::VecDeque;

/// Longest window in natural times: a body that is held turns by some radians in it, and so shows its inertia.
pub(super) const LONGEST: f64 = WINDOW;
/// Shortest one: a motion of fewer natural times is hardly more than its start.
const SHORTEST: f64 = 5.0;
/// Natural times by which a window is longer before what lies before it is handed on as what it tells of the rest. Not of a body that is stated, whose
/// windows tell all that is left to be known: with a stated inertia 10 % off squares are 15 times their variance in the worst stream where they hand on, and
/// 8 times where they do not.
const HANDED_ON: f64 = 4.0;
/// Natural times that are enough of a motion before a gap over which it is not stated.
const SOON: f64 = 3.0;
/// Natural times over which it is looked what the trapezoidal rule misses, for gaps after a window.
const GAP: f64 = 0.2;

/// What a window is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Asked {
    /// A motion from nothing.
    Search,
    /// The motion of the window before, on later data.
    Follow,
}

/// What came of a window.
#[derive(Debug)]
pub(super) struct Outcome {
    /// Natural time, s, if contacts tell the size.
    pub(super) natural: Option<f64>,
    /// Natural times by which the window is too short to look for a motion.
    pub(super) lacks: Option<f64>,
    pub(super) solution: Option<Solution>,
    /// Beside it, of each palm that sticks somewhere in the window, the motion in which it need not: its slip says something of its mode.
    pub(super) freed: Vec<(usize, Solution)>,
    /// What tells modes, with the first motion, where it is asked for.
    pub(super) modes: Option<Box<Modes>>,
    /// Samples that could not be used.
    pub(super) left_out: usize,
}

/// A solved window, to begin the next one from.
pub(super) struct Before {
    /// Motions at the nodes from which on the next one begins, from the world's origin, by numbers of samples.
    nodes: Vec<(usize, Motion)>,
    body: Body,
    /// What all before these tell, once a window was longer than it need be.
    carried: Option<(First, Beforehand)>,
}

/// The latest samples, and the motion that they were last found to have.
pub(super) struct Window {
    pub(super) palms: Vec<StreamPalm>,
    /// As they were given, and with the noise of contacts as they scatter in the window.
    stated: ContactOptions,
    pub(super) options: ContactOptions,
    sample_rate: f64,
    /// Whether modes are to be told and nothing does yet.
    untold: bool,
    samples: VecDeque<Raw>,
    /// Natural time as it was last told, s.
    natural: f64,
    before: Option<Before>,
    /// Other motions that could not be ruled out, at the same nodes; how many starts others were looked for from, windows for which none
    /// is stated, and how often there was another one, or a better one.
    pub(super) others: Vec<Before>,
    pub(super) looked: usize,
    pub(super) waits: usize,
    pub(super) misled: usize,
    dearer: Dearer,
    /// Whether a motion of this search was relied on.
    pub(super) believed: bool,
}

impl Window {
    pub(super) fn new(palms: Vec<StreamPalm>, options: ContactOptions, sample_rate: f64) -> Self {
        Self {
            palms,
            untold: options.mode_odds,
            stated: options,
            options,
            sample_rate,
            samples: VecDeque::new(),
            natural: f64::INFINITY,
            before: None,
            others: Vec::new(),
            looked: 0,
            waits: 0,
            misled: 0,
            dearer: Dearer::default(),
            believed: false,
        }
    }

    /// Takes later samples and does what is asked for.
    pub(super) fn work(&mut self, fresh: &[Raw], asked: Asked) -> Outcome {
        self.samples.extend(fresh);
        if asked == Asked::Search && self.before.take().is_some() {
            // What spoke against the motion that was followed is not to speak against the next one as well.
            self.drop_older_than(SHORTEST);
        }
        let (log, left_out) = log(&self.palms, &mut self.samples);
        let (natural, solution, freed, modes) = (None, None, Vec::new(), None);
        let mut outcome = Outcome { natural, lacks: Some(0.0), solution, freed, modes, left_out };
        let Some((log, record)) = log.and_then(|log| Record::new(&log, &self.options).map(|r| (log, r)))
        else {
            self.forget_all();
            return outcome;
        };
        let Some(length) = self.options.size.or_else(|| cold::size(&record)) else {
            self.forget_all();
            return outcome;
        };
        let units = cold::units(&record, self.options.gravity, length);
        let natural = length / units.speed;
        self.options = self.stated.roughened(self.stated.rougher(&log), &units).0;
        outcome.natural = Some(natural);
        self.natural = natural;
        outcome.lacks = Some(SHORTEST - log.duration() / natural).filter(|lacks| *lacks > 0.0);
        if outcome.lacks.is_none() {
            let typical = typical(&record);
            let found = self.solution((&log, record), units, asked);
            if self.untold && found.is_some() {
                self.untold = false;
                outcome.modes = Modes::new(&self.palms, &self.options, (&units, typical, self.sample_rate));
            }
            if let Some((solution, freed)) = found {
                (outcome.solution, outcome.freed) = (Some(solution), freed);
            }
        }
        self.forget();
        outcome
    }

    /// Drops what is older than the longest window, and what lies before the node of the latest solution at which the next one begins.
    fn forget(&mut self) {
        match self.before.as_ref().and_then(|before| before.nodes.first()) {
            Some(node) => {
                let dropped = self.samples.partition_point(|raw| raw.number < node.0);
                self.samples.drain(..dropped);
            }
            None => self.drop_older_than(LONGEST),
        }
    }

    /// Drops all but the last two: without a size there is nothing to begin from.
    fn forget_all(&mut self) {
        let most = self.samples.len().saturating_sub(2);
        self.samples.drain(..most);
        self.before = None;
    }

    /// Drops what is older than so many natural times.
    fn drop_older_than(&mut self, times: f64) {
        let Some(last) = self.samples.back().map(|raw| raw.t) else { return };
        let dropped = self.samples.partition_point(|raw| last - raw.t > times * self.natural);
        self.samples.drain(..dropped);
    }

    fn solution(
        &mut self,
        (log, mut record): (&ContactLog, Record),
        units: Units,
        asked: Asked,
    ) -> Option<(Solution, Vec<(usize, Solution)>)> {
        let natural = units.time();
        record.mark_blows(&units, self.options.gravity);
        let modes = by_ratio(&record, AVERAGED * natural);
        record.set_modes(&modes);
        let longest = longest(&record, &self.options.noise, &units);
        let open = record.with_gaps_open(natural);
        let record = open.as_ref().unwrap_or(&record);
        let windows = windows(record, longest);
        let averaged = record.averaged_over(&windows);
        let thinned = thinned(&averaged, &self.options, &units);
        let mut problem = problem(thinned.as_ref().unwrap_or(&averaged), &self.options, units);
        let free = problem.body;
        let (mut problem, best, others, against) = match asked {
            Asked::Search => {
                let (problem, solved, against) = self.found(problem)?;
                let best = Followed::of(&problem, solved);
                (problem, best, Vec::new(), against)
            }
            Asked::Follow => {
                let solved = self.followed(record, &mut problem, self.before.as_ref()?)?;
                let (best, others) = self.most_probable(record, &mut problem, solved, free);
                (problem, best, others, false)
            }
        };
        let kept = self.kept(&mut problem, &best, &others);
        let solved = best.solved;
        let samples = problem.node_samples();
        let number = |k: Option<&usize>| k.and_then(|k| self.samples.get(*k)).map_or(0, |raw| raw.number);
        let over = number(samples.first())..number(samples.last());
        // As of whole logs constants are judged by noise, and not by what steps from sample to sample miss.
        let judged = self.options.body.is_some() && !problem.planar && !problem.exact;
        if judged && (!self.believed || self.dearer.is_due(&over)) {
            self.dearer.count(&mut problem, &solved, free, over);
        }
        let against = against || self.dearer.contradicts();
        // Not those of noise drawn once more, as for whole logs: few draws a window differ from one to the next by as much as they tell, and
        // motions were lost by that three times as often, while errors over their deviations stayed what they are.
        let covariances = solved.covariances(&problem)?;
        // To wait a little costs less than a motion that is stated and wrong.
        let doubted = !self.believed && self.dearer.doubts();
        let open = !others.is_empty() || self.waits > 0 || doubted;
        let lasting = solved.lasting(&problem);
        let unresolved = if problem.exact { 0.0 } else { record.unresolved().sqrt() };
        let (problem, solved) = (&problem, &solved);
        let mut of = Of { problem, solved, covariances, against, open, lasting, unresolved };
        if self.options.suspects && !problem.exact && thinned.is_none() && of.is_sound() {
            let told = (&self.options.noise, &units);
            let readings = Readings::new(log, told, [record, problem.record], &windows);
            of.doubt(record, &readings);
        }
        let solution = self.taken(&of, kept, (GAP * natural, record.missed_in_world(GAP * natural)));
        let freed = match self.options.mode_odds && solution.explained && solution.settled {
            true => self.freed(record, (&modes, longest), &of, &solution),
            false => Vec::new(),
        };
        Some((solution, freed))
    }

    /// From nothing, and whether the body is another one than was stated. None where the window leaves it open which of several motions it is.
    fn found<'a>(&mut self, mut problem: Problem<'a>) -> Option<(Problem<'a>, Solved<CONSTANTS>, bool)> {
        self.others.clear();
        self.waits = ALONE;
        let ended = whole(&mut problem)?;
        let mut stage = Stage::at(problem, ended);
        if stage.problem.exact {
            stage = stage.stated()?;
        } else if stage.is_in_noise() {
            stage = stage.decided()?;
        }
        if let Some(mass) = &self.options.body {
            stage = stage.of_certain_axes(mass)?;
        }
        let Stage { problem, solved, against, open, .. } = stage;
        (self.dearer, self.believed) = (Dearer::default(), false);
        open.is_none().then_some((problem, solved, against.is_some()))
    }

    /// From the window before, whose axes go on.
    pub(super) fn followed(
        &self,
        record: &Record,
        problem: &mut Problem,
        before: &Before,
    ) -> Option<Solved<CONSTANTS>> {
        if let Some(mass) = &self.options.body {
            problem.take_known(mass, before.body.orientation(mass));
        }
        if let Some((_, body)) = before.carried {
            problem.body = body;
        }
        problem.nodes = fine_nodes(problem);
        let nodes = problem.node_samples();
        let mut motions = Vec::with_capacity(nodes.len());
        let (mut known, mut nodes) = (before.nodes.iter().peekable(), nodes.into_iter().peekable());
        let mut carried: Option<Carried<0>> = None;
        for (k, raw) in self.samples.iter().enumerate() {
            while let Some((_, motion)) = known.next_if(|node| node.0 <= raw.number) {
                let from_origin = Motion { p: motion.p - record.origin, ..*motion };
                carried = Some(Carried::new(from_origin, &before.body));
            }
            let carried = carried.as_mut()?;
            if nodes.next_if_eq(&k).is_some() {
                motions.push(carried.motion);
            }
            if let Some(interval) = record.intervals.get(k) {
                let ends = [&record.wrenches[k], &record.wrenches[k + 1]];
                carried.step(interval, ends, &before.body, problem.gravity);
            }
        }
        let of_axes = First::of_axes(motions.first()?.q);
        problem.first = before.carried.map_or(of_axes, |(first, _)| first);
        fine_within(problem, Unknowns { motions, body: before.body }, FOLLOWED)
    }

    /// What the next window begins from, by the motion that is followed and by each of the others. `problem` is left as the first was solved.
    fn kept(&self, problem: &mut Problem, best: &Followed, others: &[Followed]) -> Vec<Before> {
        let mut one = |followed: &Followed| {
            followed.put(problem);
            self.kept_of(problem, &followed.solved)
        };
        let mut all = vec![one(best)];
        all.extend(others.iter().map(one));
        best.put(problem);
        all
    }

    fn kept_of(&self, problem: &Problem, solved: &Solved<CONSTANTS>) -> Before {
        let record = problem.record;
        let known = self.options.body.is_some();
        let long = problem.lasts() > if known { LONGEST } else { LONGEST + HANDED_ON };
        let from = if long { next_begins(problem) } else { 0 };
        let carried = match from {
            _ if known => None,
            0 => problem.first.is_handed_on().then_some((problem.first, problem.body)),
            _ => First::at(problem, solved, from),
        };
        let node = |(motion, k): (&Motion, usize)| {
            let number = self.samples.get(k).map_or(0, |raw| raw.number);
            (number, Motion { p: motion.p + record.origin, ..*motion })
        };
        let nodes = solved.unknowns.motions.iter().zip(problem.node_samples()).skip(from).map(node).collect();
        Before { nodes, body: solved.unknowns.body, carried }
    }

    /// Keeps what the next window begins from.
    fn taken(&mut self, of: &Of, kept: Vec<Before>, missed: (f64, Matrix6<f64>)) -> Solution {
        let last = of.problem.node_samples().last().and_then(|&k| self.samples.get(k));
        let at = last.map_or((0, f64::NAN), |raw| (raw.number, raw.t));
        let solution = Solution::new(of, at, self.options.body.as_ref(), missed);
        let sound = solution.explained && solution.settled;
        self.believed |= sound && solution.relied_on;
        if sound {
            let mut kept = kept.into_iter();
            self.before = kept.next();
            self.others = kept.collect();
        }
        solution
    }
}

/// The node at which the next window begins, of one that is long enough: the longest window before the last, or after a gap that is soon after that.
/// Little is known of a motion that a gap ends soon, and iterations hardly settle there.
fn next_begins(problem: &Problem) -> usize {
    let Problem { nodes, record, .. } = problem;
    let (at, natural) = (|j: usize| record.times[nodes[j]], problem.units.time());
    let last = nodes.len() - 1;
    let begin = at(last) - LONGEST * natural;
    let from = nodes.partition_point(|&k| record.times[k] <= begin).saturating_sub(1);
    let soon = |j: &usize| at(*j) < at(from) + SOON * natural;
    let ended = |j: &usize| at(j + 1) - at(*j) > FORGOTTEN * GAP * natural;
    (from..last).take_while(soon).filter(ended).last().map_or(from, |j| j + 1)
}
