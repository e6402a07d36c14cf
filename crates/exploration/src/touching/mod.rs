//! Planners of touches, in the plane and in space alike. All begin with the same few touches, and close the upper bound if those have not.

mod gaussian;
mod greedy;
mod opening;
mod path;
mod random;
mod sweep;
mod width;

pub(crate) use opening::{Stage, stage};
pub use {
    gaussian::GaussianVariance,
    greedy::{HausdorffGreedy, VolumeGreedy},
    path::PathAware,
    random::RandomTouches,
    sweep::FixedSweep,
};

use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::limits::Limits;
use crate::planner::{PlanError, Proposal, Reason};
use crate::random::Source;

/// What is known of a body that is touched where a planner says.
pub(crate) trait Touching: Knowledge {
    /// Both bounds, the upper one closed.
    type Closed<'a>: Copy
    where
        Self: 'a;

    /// Name of the greedy planner.
    const GREEDY: &'static str;

    /// Rays along which a Gaussian process looks at the surface.
    const RAYS: usize;

    /// Where the bounds are.
    fn stand(&self) -> Stand<'_, Self>;

    /// Outward normals of the contacts.
    fn normals(&self) -> impl Iterator<Item = Self::Heading>;

    /// The middle of directions; none where they cancel.
    fn middle(of: &[Self::Heading]) -> Option<Self::Heading>;

    /// Direction `k` of a sequence that is spread evenly however much of it is taken.
    fn in_sequence(k: usize) -> Self::Heading;

    /// Any direction, all alike.
    fn drawn(source: &mut Source) -> Self::Heading;

    /// Where a Gaussian process of the contacts has its surface along a ray from their middle: the normal there, and the variance.
    fn variance(&self) -> impl Fn(Self::Heading) -> Option<(Self::Heading, f64)>;

    /// By how much noise moves both bounds apart at the next touch, m.
    fn margin(&self) -> f64;

    /// Volume (area) of the upper bound, and a length across it, m.
    fn sizes(closed: Self::Closed<'_>) -> [f64; 2];

    /// All candidates with their scores.
    fn candidates(
        &self,
        closed: Self::Closed<'_>,
        score: Score,
        limits: &Limits<Self::Heading>,
    ) -> CandidatesOf<Self>;

    /// At least the one where the bounds are farthest apart, with their distance.
    fn farthest(&self, closed: Self::Closed<'_>, limits: &Limits<Self::Heading>) -> CandidatesOf<Self> {
        self.candidates(closed, Score::Distance, limits)
    }
}

/// Where bounds are.
pub(crate) enum Stand<'a, K: Touching + ?Sized + 'a> {
    /// Too few contacts, or noise leaves nothing certain.
    Nothing,
    /// The upper bound has no end along these.
    Open(&'a [K::Heading]),
    /// Both.
    Closed(K::Closed<'a>),
}

/// What is scored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Score {
    /// Expected loss of volume (area) between the bounds.
    Volume,
    /// Distance of a corner of the upper bound from the lower one.
    Distance,
}

/// A touch that may be made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Candidate<H, P> {
    pub(crate) along: H,
    /// From the upper bound to a point within the lower one: not to its nearest point, which may be a contact, that a ray would only meet again.
    pub(crate) ray: [P; 2],
    /// Expected loss of volume (area) between the bounds in m^3 (m^2), or length of the gap in m.
    pub(crate) score: f64,
}

/// Candidates within reach, in a fixed order, and the best ones out of reach.
pub(crate) struct Candidates<H, P> {
    pub(crate) within: Vec<Candidate<H, P>>,
    pub(crate) out_of_reach: Vec<Candidate<H, P>>,
}

type CandidateOf<K> = Candidate<<K as Knowledge>::Heading, <K as Knowledge>::Point>;
type CandidatesOf<K> = Candidates<<K as Knowledge>::Heading, <K as Knowledge>::Point>;

/// Directions out of reach that are named.
const NAMED: usize = 8;
/// What a touch is found to remove over what was expected, in the median.
const OVERESTIMATE: f64 = 0.8;
/// Scores below this share of the largest that there can be are rounding.
const NOTHING: f64 = 1e-12;
/// Corners of a bound that are closer in height than this, relative to their coordinates, may be at one place.
pub(crate) const LEVEL: f64 = 1e-13;
/// Scores closer than this, relative, are a tie, which goes to the first: never to rounding.
const TIE: f64 = 1e-9;

/// The highest of `count` corners of a bound, by climbing from `start` to those `around`; with how large the coordinates of one are.
pub(crate) fn climbed<const N: usize>(
    count: usize,
    start: usize,
    around: impl Fn(usize) -> [usize; N],
    height: impl Fn(usize) -> f64,
    size: impl Fn(usize) -> f64,
) -> usize {
    let higher = |a: &usize, b: &usize| height(*a).total_cmp(&height(*b));
    let mut here = start;
    loop {
        let Some(next) = around(here).into_iter().max_by(higher) else { return here };
        if height(next) > height(here) {
            here = next;
        } else if height(here) - height(next) > LEVEL * size(here) {
            return here;
        } else {
            // Where more lines or planes meet than make a corner several are at one place, and a climb ends there: all are looked at.
            return (0..count).max_by(higher).unwrap_or(here);
        }
    }
}

impl<H: Heading, P: Copy> Candidates<H, P> {
    pub(crate) fn none() -> Self {
        Self { within: Vec::new(), out_of_reach: Vec::new() }
    }

    /// Directions that would pay and cannot be had, the best first.
    fn named_out_of_reach(&self) -> Vec<Vec<f64>> {
        let mut lost: Vec<&Candidate<H, P>> = self.out_of_reach.iter().collect();
        lost.sort_by(|a, b| b.score.total_cmp(&a.score));
        lost.iter().take(NAMED).map(|c| c.along.coordinates()).collect()
    }

    /// The first of the candidates with the largest score; an error where none is above `least`.
    fn best(&self, least: f64) -> Result<Candidate<H, P>, PlanError> {
        let mut best: Option<&Candidate<H, P>> = None;
        for candidate in &self.within {
            if best.is_none_or(|b| candidate.score > b.score * (1.0 + TIE)) {
                best = Some(candidate);
            }
        }
        match best {
            Some(best) if best.score > least => Ok(*best),
            _ if self.out_of_reach.iter().any(|c| c.score > least) => {
                Err(PlanError::Unreachable { directions: self.named_out_of_reach() })
            }
            _ => Err(PlanError::NothingToGain),
        }
    }
}

fn proposal<K: Knowledge>(candidate: CandidateOf<K>, reason: Reason) -> Proposal<K> {
    let Candidate { along, ray, score } = candidate;
    Proposal { along, ray: Some(ray), expected: Some(OVERESTIMATE * score), reason }
}
