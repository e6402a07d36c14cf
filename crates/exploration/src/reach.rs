//! The closed loop: plan, touch, learn, stop with a proof.

use crate::certificate::{Certificate, Outcome, Shortfall};
use crate::confidence::Spending;
use crate::finger::{Finger, TouchError};
use crate::goal::{Goal, GoalError};
use crate::heading::Heading;
use crate::knowledge::{Knowledge, KnowledgeError};
use crate::limits::Limits;
use crate::planner::{PlanError, Planner, Proposal, Situation};
use thiserror::Error;

/// What is to be reached, and with what.
#[derive(Clone, Debug, PartialEq)]
pub struct Task<H> {
    /// What is to be known.
    pub goal: Goal<H>,
    /// Touches at most, those known at the start included. Where contacts are noisy, the budget of the confidence, if it has
    /// one, is a limit as well.
    pub most: usize,
    /// Directions that can be reached.
    pub limits: Limits<H>,
    /// How the confidence is spent, for the certificate; none for exact contacts.
    pub spending: Option<Spending>,
    /// Largest mean width that the body may have, in m, if known beforehand: whether the goal is within reach of the noise is
    /// then said before the first touch, else as soon as the upper bound is closed.
    pub width: Option<f64>,
}

impl<H> Task<H> {
    /// A goal to be reached with at most `most` exact touches, from all sides.
    #[must_use]
    pub fn new(goal: Goal<H>, most: usize) -> Self
    where
        H: Heading,
    {
        Self { goal, most, limits: Limits::default(), spending: None, width: None }
    }
}

/// One touch as it was made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<K: Knowledge> {
    /// Number of the touch, from 1, with those known at the start.
    pub touch: usize,
    /// As proposed.
    pub proposal: Proposal<K>,
    /// As felt.
    pub contact: K::Contact,
    /// The goal's quantity after it.
    pub progress: f64,
    /// Volume (area) of the lower bound after it.
    pub lower: f64,
    /// Volume (area) of the upper bound after it.
    pub upper: f64,
    /// Way from the touch before, in rad: zero for the first.
    pub turned: f64,
}

/// Why an exploration cannot be made, or broke off.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ExploreError {
    /// The goal is none.
    #[error(transparent)]
    Goal(#[from] GoalError),
    /// No number of touches reaches the goal: noise keeps the bounds further apart.
    #[error(
        "the goal {goal} is below what the noise leaves, at least {floor:.4} however many touches are made; ask for more than \
         that, measure better, or average repeated touches before they are stated as one"
    )]
    BelowNoise {
        /// As asked for.
        goal: f64,
        /// What the noise leaves at least.
        floor: f64,
    },
    /// The finger felt nothing.
    #[error("touch {touch}: {reason}")]
    Touch {
        /// Number of the touch, from 1.
        touch: usize,
        /// Why.
        #[source]
        reason: TouchError,
    },
    /// A contact contradicts those before, or says nothing.
    #[error(transparent)]
    Knowledge(#[from] KnowledgeError),
}

/// Touches with `finger` where `planner` says until `task.goal` is proven, or cannot be. `known` may hold contacts already;
/// `observe` sees each step.
///
/// The planner sees `known` alone, and the proof is by the bounds alone: a bad planner costs touches, never truth.
///
/// # Errors
/// [`ExploreError`] for goals that are none or below the noise, and for contacts that there are none of or that contradict
/// each other; what was learned until then is in `known`.
pub fn explore<K: Knowledge>(
    known: &mut K,
    planner: &mut dyn Planner<K>,
    finger: &mut dyn Finger<K>,
    task: &Task<K::Heading>,
    mut observe: impl FnMut(&Step<K>, &K),
) -> Result<Outcome<K::Heading>, ExploreError> {
    task.goal.check()?;
    if let Some(width) = task.width {
        check_floor(known, &task.goal, width)?;
    }
    let mut here = None;
    loop {
        let certificate = |known: &K| Certificate::of(known, task.goal, task.spending);
        if known.proves(&task.goal) {
            return Ok(Outcome::Reached(certificate(known)));
        }
        if known.confidence().is_some() {
            check_floor(known, &task.goal, known.mean_width())?;
        }
        let short = |shortfall| Ok(Outcome::Short { shortfall, certificate: certificate(known) });
        if known.touches() >= budget(task) {
            return short(Shortfall::Budget);
        }
        let situation = Situation { known: &*known, here, goal: &task.goal, limits: &task.limits };
        let proposal = match planner.next(&situation) {
            Ok(proposal) => proposal,
            Err(PlanError::NothingToGain) => return short(Shortfall::NothingToGain),
            Err(PlanError::Unreachable { directions }) => {
                return short(Shortfall::Unreachable { directions });
            }
        };
        let touch = known.touches() + 1;
        let contact = finger.touch(&proposal).map_err(|reason| ExploreError::Touch { touch, reason })?;
        known.insert(contact)?;
        let turned = here.map_or(0.0, |h| proposal.along.angle_to(h));
        here = Some(proposal.along);
        let (progress, measures) = (known.progress(&task.goal), known.measures());
        let (lower, upper) = (measures.lower, measures.upper);
        observe(&Step { touch, proposal, contact, progress, lower, upper, turned }, known);
    }
}

fn budget<H>(task: &Task<H>) -> usize {
    match task.spending {
        Some(Spending::Budget(budget)) => budget.min(task.most),
        _ => task.most,
    }
}

fn check_floor<K: Knowledge>(known: &K, goal: &Goal<K::Heading>, width: f64) -> Result<(), ExploreError> {
    let floor = if width.is_finite() { known.noise_floor(goal, width) } else { 0.0 };
    if goal.value() < floor { Err(ExploreError::BelowNoise { goal: goal.value(), floor }) } else { Ok(()) }
}
