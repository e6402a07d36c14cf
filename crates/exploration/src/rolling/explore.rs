//! The closed loop: plan, turn the palms, feel, learn, stop with a proof.

use super::outcome::{RollEnd, RollOutcome};
use super::palms::{Palms, PalmsError, Reading, SENSED};
use super::planner::{RollPlanError, RollPlanner, RollProposal, View};
use super::predict::Prediction;
use super::track::Track;
use super::workspace::{Workspace, WorkspaceError, along, radians};
use crate::certificate::Certificate;
use crate::confidence::Spending;
use crate::goal::{Goal, GoalError};
use crate::heading::Heading;
use crate::knowledge::{Knowledge, KnowledgeError};
use crate::planar::PlanarKnowledge;
use crate::planner::Reason;
use shape_bounds::exact_hull::planar::Direction;
use thiserror::Error;

/// What is to be reached, and with what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollTask {
    /// What is to be known.
    pub goal: Goal<Direction>,
    /// Limits of the palms.
    pub workspace: Workspace,
    /// Motions at most.
    pub motions: usize,
    /// Radians of palm motion at most, both palms together.
    pub radians: f64,
    /// Normals of contacts that are taken lie about so far apart, in rad: what is felt between is of little use, and under noise each contact that is
    /// taken costs some of the confidence.
    pub spacing: f64,
    /// Largest share of the bodies drawn that a motion may lose, in [0, 1].
    pub risk: f64,
    /// How the confidence is spent, for the certificate; none for exact contacts.
    pub spending: Option<Spending>,
}

impl RollTask {
    /// A goal to be reached from exact contacts.
    #[must_use]
    pub fn new(goal: Goal<Direction>, workspace: Workspace) -> Self {
        Self { goal, workspace, motions: 100, radians: 100.0, spacing: 0.1, risk: 0.1, spending: None }
    }

    pub(super) fn check(&self) -> Result<(), RollError> {
        self.goal.check()?;
        self.workspace.check()?;
        let numbers = [("radians of palm motion", self.radians), ("spacing of normals", self.spacing)];
        for (what, value) in numbers {
            // An infinite way is none of the limits.
            if value.is_nan() || value <= 0.0 {
                return Err(RollError::Setting { what, value, range: "above 0" });
            }
        }
        if !(0.0..=1.0).contains(&self.risk) {
            return Err(RollError::Setting { what: "risk", value: self.risk, range: "from 0 to 1" });
        }
        Ok(())
    }
}

/// One reading as it was learned from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollStep {
    /// Number of the motion, from 1; 0 for what is felt at the start.
    pub motion: usize,
    /// Why the motion is made, and what it is expected to bring; none of what is felt at the start.
    pub why: Option<(Reason, Option<Prediction>)>,
    /// As felt.
    pub reading: Reading,
    /// Radians of palm motion up to it.
    pub radians: f64,
    /// Seconds up to it, with the times after falls.
    pub seconds: f64,
    /// The goal's quantity after it.
    pub progress: f64,
}

/// Why an exploration cannot be made, or broke off.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RollError {
    /// The goal is none.
    #[error(transparent)]
    Goal(#[from] GoalError),
    /// The limits of the palms are none.
    #[error(transparent)]
    Workspace(#[from] WorkspaceError),
    /// A setting that is none.
    #[error("{what} is {value}; it must be {range}")]
    Setting {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// The palms are, or are to be, where they must not.
    #[error("palms at {} and {} rad are outside of the workspace; widen it, or bring them in first", palms[0], palms[1])]
    Outside {
        /// Absolute angles, rad.
        palms: [f64; 2],
    },
    /// Nothing is felt at the start.
    #[error("nothing is felt at the start: {0}")]
    Start(#[source] PalmsError),
    /// A contact contradicts those before.
    #[error(transparent)]
    Knowledge(#[from] KnowledgeError),
    /// Nothing can be predicted.
    #[error(transparent)]
    Plan(RollPlanError),
    /// No number of contacts reaches the goal: noise keeps the bounds further apart.
    #[error(
        "the goal {goal} is below what the noise leaves, at least {floor:.4} however often palms turn; ask for more, or measure better"
    )]
    BelowNoise {
        /// As asked for.
        goal: f64,
        /// What the noise leaves at least.
        floor: f64,
    },
}

/// What is kept from reading to reading.
struct Loop<'a> {
    known: &'a mut PlanarKnowledge,
    task: &'a RollTask,
    track: Track,
    taken: Vec<Direction>,
    last: [Direction; 2],
    radians: f64,
    seconds: f64,
}

impl Loop<'_> {
    /// Takes those contacts of a reading whose palm was, by the reading before, where nothing is known yet. The choice does not look at
    /// what is taken: under noise its chance of misleading is the one that was stated.
    fn learn(&mut self, reading: &Reading) -> Result<(), KnowledgeError> {
        for i in 0..2 {
            let apart = |n: &Direction| n.angle_to(self.last[i]) >= self.task.spacing;
            if self.taken.iter().all(apart) {
                self.known.insert(reading.contacts[i])?;
                self.taken.push(reading.contacts[i].normal);
            }
            self.last[i] = reading.contacts[i].normal;
        }
        self.track.follow(reading);
        Ok(())
    }

    fn spent(&self) -> bool {
        match self.task.spending {
            Some(Spending::Budget(budget)) => self.known.touches() + 2 > budget,
            _ => false,
        }
    }

    fn step(&self, motion: usize, proposal: Option<&RollProposal>, reading: Reading) -> RollStep {
        let progress = self.known.progress(&self.task.goal);
        let why = proposal.map(|proposal| (proposal.reason, proposal.expected));
        RollStep { motion, why, reading, radians: self.radians, seconds: self.seconds, progress }
    }
}

/// Turns `palms` as `planner` says until `task.goal` is proven, or cannot be. `observe` sees each reading.
///
/// The planner sees what is known alone, and the proof is by the bounds alone: a bad planner costs motion, never truth.
///
/// # Errors
/// [`RollError`] for tasks that are none and contacts that contradict each other; what was learned until then is in `known`.
pub fn explore_rolling(
    known: &mut PlanarKnowledge,
    planner: &mut dyn RollPlanner,
    palms: &mut dyn Palms,
    task: &RollTask,
    mut observe: impl FnMut(&RollStep, &PlanarKnowledge),
) -> Result<RollOutcome, RollError> {
    task.check()?;
    check_floor(known, task)?;
    let first = palms.feel().map_err(RollError::Start)?;
    inside(task, first.palms)?;
    let last = first.contacts.map(|c| c.normal);
    let mut state =
        Loop { known, task, track: Track::new(&first), taken: Vec::new(), last, radians: 0.0, seconds: 0.0 };
    state.learn(&first)?;
    observe(&state.step(0, None, first), state.known);
    let mut motion = 0;
    loop {
        if state.known.proves(&task.goal) {
            return Ok(RollOutcome::Reached(Certificate::of(state.known, task.goal, task.spending)));
        }
        let short = |state: &Loop<'_>, end| {
            let certificate = Certificate::of(state.known, task.goal, task.spending);
            Ok(RollOutcome::Short { end, certificate })
        };
        if motion >= task.motions || state.radians >= task.radians || state.spent() {
            return short(&state, RollEnd::Budget);
        }
        let view = View {
            known: state.known,
            track: &state.track,
            workspace: &task.workspace,
            goal: &task.goal,
            risk: task.risk,
            spacing: task.spacing,
            motion,
        };
        let proposal = match planner.next(&view) {
            Ok(proposal) => proposal,
            Err(RollPlanError::NotFound { directions }) => {
                return short(&state, RollEnd::NotFound { directions });
            }
            Err(error) => return Err(RollError::Plan(error)),
        };
        motion += 1;
        if let Some(lost) = carry_out(&mut state, &proposal, palms, motion, &mut observe)? {
            return short(&state, RollEnd::Lost(lost));
        }
    }
}

/// One motion, until its end or the proof; why the body is lost, if it is.
fn carry_out(
    state: &mut Loop<'_>,
    proposal: &RollProposal,
    palms: &mut dyn Palms,
    motion: usize,
    observe: &mut impl FnMut(&RollStep, &PlanarKnowledge),
) -> Result<Option<PalmsError>, RollError> {
    let task = state.task;
    for leg in &proposal.legs {
        inside(task, *leg)?;
        for to in along(state.track.palms, *leg, SENSED) {
            let from = state.track.palms;
            let reading = match palms.turn(to) {
                Ok(reading) => reading,
                Err(lost) => return Ok(Some(lost)),
            };
            state.radians += radians(from, to);
            state.seconds += task.workspace.seconds(from, to);
            state.seconds += if reading.fell { task.workspace.settle } else { 0.0 };
            state.learn(&reading)?;
            observe(&state.step(motion, Some(proposal), reading), state.known);
            if state.known.proves(&task.goal) || state.radians >= task.radians || state.spent() {
                return Ok(None);
            }
        }
    }
    Ok(None)
}

pub(super) fn inside(task: &RollTask, palms: [f64; 2]) -> Result<(), RollError> {
    if task.workspace.allows(palms) { Ok(()) } else { Err(RollError::Outside { palms }) }
}

fn check_floor(known: &PlanarKnowledge, task: &RollTask) -> Result<(), RollError> {
    let floor = known.noise_floor(&task.goal, task.workspace.size);
    let goal = task.goal.value();
    if goal < floor { Err(RollError::BelowNoise { goal, floor }) } else { Ok(()) }
}
