//! How much dearer a stated body makes what is read, window after window.
//!
//! The search asks once whether a body is the one that was stated, of the first window that shows a motion; a longer one tells more, and all of them
//! together most. What a window is dearer with the stated body than with any is chi-squared of four: mass and moments. Of windows without a common
//! sample these add.

use crate::chance::excess;
use crate::contacts::body::{Body, CONSTANTS};
use crate::contacts::onward::FOLLOWED;
use crate::contacts::problem::{Beforehand, Problem};
use crate::contacts::search::fine_within;
use crate::contacts::solve::Solved;
use crate::contacts::verdict::UNEXPLAINED;
use std::ops::Range;

/// Constants that are stated: mass and principal moments.
const STATED: f64 = 4.0;

/// Deviations of a normal variable that it is beyond once in twenty.
const DOUBTFUL: f64 = 1.645;
/// A window is counted again when so much of it, a part in so many, is new. At half, an inertia that was stated 10 % off was 22 deviations off
/// before it was asked a second time.
const DUE: usize = 6;

/// What the windows so far are dearer by.
#[derive(Default)]
pub(super) struct Dearer {
    /// Of the latest one that was counted, and of those before it without a common sample: squares, constants.
    latest: Option<(Range<usize>, f64)>,
    before: (f64, f64),
}

impl Dearer {
    /// Whether a window of those samples has much that was not counted: a share of the one before.
    pub(super) fn is_due(&self, samples: &Range<usize>) -> bool {
        let fresh =
            |(last, _): &(Range<usize>, f64)| DUE * samples.end.saturating_sub(last.end) >= last.len();
        self.latest.as_ref().is_none_or(fresh)
    }

    /// Counts a window of those samples that was solved with the stated body, in place of the latest one if they share some; `free` is what is known
    /// beforehand of any body. `problem` is left as it was solved.
    pub(super) fn count(
        &mut self,
        problem: &mut Problem,
        solved: &Solved<CONSTANTS>,
        free: Beforehand,
        samples: Range<usize>,
    ) {
        let known = problem.cost_of_log(solved);
        let body = solved.unknowns.body;
        let start = solved.unknowns.with(Body::free(body.log_mass, body.inertia()));
        let kept = (std::mem::replace(&mut problem.body, free), std::mem::take(&mut problem.frozen));
        let any = fine_within(problem, start, FOLLOWED);
        let cost = any.as_ref().map(|any| problem.cost_of_log(any));
        (problem.body, problem.frozen) = kept;
        let Some(cost) = cost else { return };
        if let Some((_, squares)) = self.latest.take_if(|(last, _)| samples.start >= last.end) {
            self.before = (self.before.0 + squares, self.before.1 + STATED);
        }
        self.latest = Some((samples, (known - cost).max(0.0) / solved.misfit().max(1.0)));
    }

    /// Whether all windows together speak against what was stated: once in a million by chance.
    pub(super) fn contradicts(&self) -> bool {
        self.excess() > UNEXPLAINED
    }

    /// Whether they do once in twenty by chance, which is not to be while no motion was believed.
    pub(super) fn doubts(&self) -> bool {
        self.excess() > DOUBTFUL
    }

    fn excess(&self) -> f64 {
        let (squares, constants) = self.before;
        let all = |(_, latest): &(Range<usize>, f64)| excess(squares + latest, constants + STATED);
        self.latest.as_ref().map_or(f64::NEG_INFINITY, all)
    }
}
