use super::width::width_touch;
use super::{CandidateOf, CandidatesOf, NOTHING, OVERESTIMATE, Score, Stage, TIE, Touching, proposal, stage};
use crate::goal::Goal;
use crate::heading::Heading;
use crate::planner::{PlanError, Planner, Proposal, Reason, Situation};

/// Of all touches that pay nearly as much as the best one, takes that which pays most for its way: little more than half the way of a greedy planner in
/// space, and three quarters in the plane, for as many touches. Where few more are expected to reach the goal it takes none that makes them more.
///
/// The score is that of the goal: expected loss of volume (area) for a gap, the distance of the bounds for a Hausdorff distance, and the two
/// directions of a width. This is the planner to start with.
#[derive(Clone, Debug)]
pub struct PathAware<H> {
    start: Vec<H>,
    share: f64,
}

/// Share of the best score that is enough. In space on 150 bodies 0.57 of the way of a greedy planner (medians) for 1.01 of its touches (means).
const SHARE: f64 = 0.45;
/// Power of the share where distances are scored: what is nearly the largest is most of what there is to touch, and all of it must be
/// touched in the end. 0.88 of the largest is enough then.
const OF_DISTANCE: f64 = 0.16;
/// Way that any touch takes beside that to it, rad: the less, the more the nearest of all is worth.
const TURN: f64 = 0.2;
/// Touches that are looked ahead at most, and from which angle on, rad, two leave each other what they pay.
const AHEAD: usize = 12;
const APART: f64 = 0.4;

impl<H> PathAware<H> {
    /// With these first touches and a share of 0.45.
    #[must_use]
    pub fn new(start: Vec<H>) -> Self {
        Self { start, share: SHARE }
    }

    /// With another share of the best score that is enough, in [0, 1]: 1 is greedy, 0.3 where motion is dear.
    #[must_use]
    pub fn with_share(self, share: f64) -> Self {
        Self { share: share.clamp(0.0, 1.0), ..self }
    }
}

impl<K: Touching> Planner<K> for PathAware<K::Heading> {
    fn name(&self) -> &'static str {
        "path-aware"
    }

    fn next(&mut self, situation: &Situation<'_, K>) -> Result<Proposal<K>, PlanError> {
        let closed = match stage(&self.start, situation)? {
            Stage::Due(proposal) => return Ok(proposal),
            Stage::Closed(closed) => closed,
        };
        let ([volume, length], share) = (K::sizes(closed), self.share);
        let (score, share, least) = match situation.goal {
            Goal::Gap(_) => (Score::Volume, share, NOTHING * volume),
            Goal::Hausdorff(_) => (Score::Distance, share.powf(OF_DISTANCE), NOTHING * length),
            Goal::Width { along, .. } => return width_touch(situation, *along),
        };
        let found = situation.known.candidates(closed, score, situation.limits);
        let best = found.best(least)?;
        let ahead = Ahead::<K>::new(&found, left(situation, volume));
        let worth = |one: &CandidateOf<K>, here: K::Heading| one.score / (one.along.angle_to(here) + TURN);
        // Of those as good as the best to rounding the first is it, as for a greedy planner.
        let enough = share * best.score * (1.0 + TIE);
        let good = || found.within.iter().filter(|one| one.score >= enough && ahead.keeps(one));
        // The first of several that are worth as much.
        let worthiest = |here| good().rev().max_by(|a, b| worth(a, here).total_cmp(&worth(b, here))).copied();
        let chosen = situation.here.and_then(worthiest).unwrap_or(best);
        let reason = if chosen == best { Reason::Best } else { Reason::Near };
        Ok(proposal(chosen, reason))
    }
}

/// The score that is expected to reach the goal, of one touch or of several; infinite where the score is not in the unit of the goal.
fn left<K: Touching>(situation: &Situation<'_, K>, upper: f64) -> f64 {
    match situation.goal {
        Goal::Gap(goal) => (situation.known.measures().gap() - goal) * upper / OVERESTIMATE,
        _ => f64::INFINITY,
    }
}

/// The fewest touches that are expected to reach the goal.
struct Ahead<'a, K: Touching> {
    /// Candidates that leave each other what they pay, the best first.
    best: Vec<&'a CandidateOf<K>>,
    /// How many of them reach the goal, and the score that does; none where it takes more of them.
    fewest: Option<usize>,
    left: f64,
}

impl<'a, K: Touching> Ahead<'a, K> {
    fn new(found: &'a CandidatesOf<K>, left: f64) -> Self {
        let mut all: Vec<&CandidateOf<K>> = found.within.iter().filter(|_| left.is_finite()).collect();
        all.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut best: Vec<&CandidateOf<K>> = Vec::with_capacity(AHEAD);
        for one in all {
            if best.len() < AHEAD && best.iter().all(|other| is_apart::<K>(one, other)) {
                best.push(one);
            }
        }
        let mut sum = 0.0;
        let reached = |one: &&CandidateOf<K>| {
            sum += one.score;
            sum >= left
        };
        let fewest = best.iter().position(reached).map(|last| last + 1);
        Self { best, fewest, left }
    }

    /// Whether no more touches are expected with this one among them.
    fn keeps(&self, one: &CandidateOf<K>) -> bool {
        self.fewest.is_none_or(|fewest| {
            let others = self.best.iter().filter(|other| is_apart::<K>(one, other)).take(fewest - 1);
            one.score + others.map(|other| other.score).sum::<f64>() >= self.left * (1.0 - TIE)
        })
    }
}

fn is_apart<K: Touching>(one: &CandidateOf<K>, other: &CandidateOf<K>) -> bool {
    one.along.angle_to(other.along) > APART
}
