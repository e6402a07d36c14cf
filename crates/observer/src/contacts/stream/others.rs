//! Motions beside the one that is followed, which explain a window about as well.
//!
//! A search looks for them once. Of a body whose inertia, or how it lies, is hardly known the readings may speak for another motion later on, far
//! from the one that is followed: each window of such a body is tried from one other start, and what that leads to is followed as well until the
//! readings rule one of them out. As long as there are several none is stated. Where there was one there are likely to be more: none is stated for
//! some windows then, and for twice as many each time that this was not enough. Once a motion was alone for that long, another one is news: it costs as few windows as the first did.

use super::window::Window;
use crate::contacts::body::CONSTANTS;
use crate::contacts::first::First;
use crate::contacts::problem::{Beforehand, Problem};
use crate::contacts::record::Record;
use crate::contacts::rivals::{another, goes_on_beside, is_unsure};
use crate::contacts::solve::Solved;
use nalgebra::SVector;

/// How many are followed at most.
const MOST: usize = 2;
/// Windows that must show no other motion before one is stated, after a search and after there was another one.
pub(super) const ALONE: usize = 6;
/// How often that doubles at most.
const MOST_DOUBLED: usize = 9;
/// Fall of chi-squared by which another one must be the better one to take its place.
const BETTER: f64 = 1.0;

/// A solution, and what the problem was when it was solved.
pub(super) struct Followed {
    pub(super) solved: Solved<CONSTANTS>,
    body: Beforehand,
    frozen: Vec<SVector<f64, CONSTANTS>>,
    first: First,
}

impl Followed {
    pub(super) fn of(problem: &Problem, solved: Solved<CONSTANTS>) -> Self {
        let Problem { body, frozen, first, .. } = problem;
        Self { solved, body: *body, frozen: frozen.clone(), first: *first }
    }

    pub(super) fn put(&self, problem: &mut Problem) {
        problem.body = self.body;
        problem.frozen.clone_from(&self.frozen);
        problem.first = self.first;
    }
}

impl Window {
    /// The most probable of the motions that are followed, of which `first` was until now, and the others that cannot be ruled out. `problem` is left as
    /// the first of them was solved.
    pub(super) fn most_probable(
        &mut self,
        record: &Record,
        problem: &mut Problem,
        first: Solved<CONSTANTS>,
        free: Beforehand,
    ) -> (Followed, Vec<Followed>) {
        if self.believed && self.waits == 0 {
            // What misled the search that led to a motion says nothing of one that was alone for long since.
            self.misled = 0;
        }
        let misled = self.misled;
        let mut best = Followed::of(problem, first);
        let mut all = Vec::new();
        for before in &self.others {
            problem.body = free;
            let solved = self.followed(record, problem, before);
            all.extend(solved.map(|solved| Followed::of(problem, solved)));
        }
        best.put(problem);
        let alone = !problem.planar && !problem.exact && record.frictionless() && all.len() < MOST;
        let unsure = is_unsure(problem, &best.solved);
        self.waits = if unsure { self.waits.saturating_sub(1) } else { 0 };
        if alone && unsure {
            self.looked += 1;
            let other = another(problem, &best.solved, self.looked);
            if self.believed && other.is_some() {
                self.waits = self.waits.max(ALONE);
            } else {
                self.misled += usize::from(other.is_some());
            }
            all.extend(other.map(|solved| Followed::of(problem, solved)));
        }
        for other in &mut all {
            if other.solved.equations.cost < best.solved.equations.cost - BETTER {
                std::mem::swap(&mut best, other);
                self.misled += 1;
            }
        }
        best.put(problem);
        all.retain(|other| goes_on_beside(problem, &best.solved, &other.solved));
        if self.misled > misled {
            self.waits = ALONE << (self.misled - 1).min(MOST_DOUBLED);
        }
        (best, all)
    }
}
