//! The closed loop: plan, move the upper palm, feel, learn, stop with a proof.

use super::hold::{Hold, Stop, Wall, steps};
use super::palms::{FeltBetween, ParallelPalms, ParallelPalmsError};
use super::planner::{ParallelPlanError, ParallelPlanner, ParallelProposal, ParallelView};
use super::predict::{Prediction, unfelt};
use super::workspace::{ParallelWorkspace, ParallelWorkspaceError};
use crate::certificate::{Certificate, Outcome, Shortfall};
use crate::confidence::Spending;
use crate::goal::{Goal, GoalError};
use crate::heading::Heading;
use crate::knowledge::{Knowledge, KnowledgeError};
use crate::planner::Reason;
use crate::space::SpaceKnowledge;
use contact_kinematics::Direction;
use glam::DVec2;
use thiserror::Error;

/// What is to be reached, and with what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelTask {
    /// What is to be known.
    pub goal: Goal<Direction>,
    /// Limits of the palms.
    pub workspace: ParallelWorkspace,
    /// Strokes at most.
    pub strokes: usize,
    /// Way of the upper palm at most, m.
    pub way: f64,
    /// Normals of contacts that are taken lie about so far apart, in rad: what is felt between is of little use, and under noise each contact that is
    /// taken costs some of the confidence.
    pub spacing: f64,
    /// How the confidence is spent, for the certificate; none for exact contacts.
    pub spending: Option<Spending>,
}

impl ParallelTask {
    /// A goal to be reached from exact contacts.
    #[must_use]
    pub fn new(goal: Goal<Direction>, workspace: ParallelWorkspace) -> Self {
        Self { goal, workspace, strokes: 200, way: 100.0 * workspace.size, spacing: 0.2, spending: None }
    }

    fn check(&self) -> Result<(), ParallelError> {
        self.goal.check()?;
        self.workspace.check()?;
        for (what, value) in [("the way of the palm", self.way), ("the spacing of normals", self.spacing)] {
            // An infinite way is none of the limits.
            if value.is_nan() || value <= 0.0 {
                return Err(ParallelError::Setting { what, value });
            }
        }
        Ok(())
    }
}

/// One reading as it was learned from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParallelStep {
    /// Number of the stroke, from 1; 0 for what is felt at the start.
    pub stroke: usize,
    /// Why the stroke is made, and what it is expected to bring; none of what is felt at the start.
    pub why: Option<(Reason, Option<Prediction>)>,
    /// As felt.
    pub reading: FeltBetween,
    /// Way of the upper palm up to it, m.
    pub way: f64,
    /// The goal's quantity after it.
    pub progress: f64,
    /// What friction that stopped the stroke there tells of the body.
    pub wall: Option<Wall>,
}

/// Why an exploration cannot be made, or broke off.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ParallelError {
    /// The goal is none.
    #[error(transparent)]
    Goal(#[from] GoalError),
    /// The limits of the palms are none.
    #[error(transparent)]
    Workspace(#[from] ParallelWorkspaceError),
    /// A setting that is none.
    #[error("{what} is {value}; it must be above 0")]
    Setting {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// Nothing is felt.
    #[error(transparent)]
    Palms(#[from] ParallelPalmsError),
    /// A contact contradicts those before.
    #[error(transparent)]
    Knowledge(#[from] KnowledgeError),
    /// No number of contacts reaches the goal: noise keeps the bounds further apart.
    #[error(
        "the goal {goal} is below what the noise leaves, at least {floor:.4} however far the body is rolled; ask for more, or measure better"
    )]
    BelowNoise {
        /// As asked for.
        goal: f64,
        /// What the noise leaves at least.
        floor: f64,
    },
}

/// Contacts are read whenever the body has turned by so many rad.
const SENSED: f64 = 0.05;

/// What is kept from reading to reading.
struct Loop<'a> {
    known: &'a mut SpaceKnowledge,
    task: &'a ParallelTask,
    hold: Hold,
    /// Normals of the reading before.
    last: [Direction; 2],
    way: f64,
    idle: usize,
    walls: Vec<Wall>,
}

impl Loop<'_> {
    /// Takes those contacts of a reading that were, by the reading before, where nothing is known yet. The choice does not look at
    /// what is taken: under noise its chance of misleading is the one that was stated.
    fn learn(&mut self, reading: &FeltBetween) -> Result<(), KnowledgeError> {
        for (i, (contact, last)) in reading.contacts.iter().zip(&mut self.last).enumerate() {
            if unfelt(self.known, *last, self.task.spacing) || self.known.touches() < 2 {
                match &reading.noise {
                    Some(noise) => self.known.insert_with(*contact, noise[i])?,
                    None => self.known.insert(*contact)?,
                }
            }
            *last = contact.normal;
        }
        self.hold = reading.hold;
        self.way += reading.way;
        Ok(())
    }

    fn spent(&self) -> bool {
        match self.task.spending {
            Some(Spending::Budget(budget)) => self.known.touches() + 2 > budget,
            _ => false,
        }
    }

    fn step(&self, stroke: usize, proposal: Option<&ParallelProposal>, reading: FeltBetween) -> ParallelStep {
        let progress = self.known.progress(&self.task.goal);
        let why = proposal.map(|proposal| (proposal.reason, proposal.expected));
        let stopped = proposal.filter(|_| reading.stop == Some(Stop::Shear));
        let wall = stopped.map(|proposal| Wall {
            at: reading.hold.normals()[0],
            along: reading.hold.onwards(DVec2::from_angle(proposal.stroke.heading)),
        });
        ParallelStep { stroke, why, reading, way: self.way, progress, wall }
    }

    /// One stroke, until its end, a stop or the proof.
    fn carry_out(
        &mut self,
        proposal: &ParallelProposal,
        palms: &mut dyn ParallelPalms,
        stroke: usize,
        observe: &mut impl FnMut(&ParallelStep, &SpaceKnowledge),
    ) -> Result<(), ParallelError> {
        let (parts, turn) = steps(proposal.stroke.turn, SENSED);
        let before = self.known.touches();
        for _ in 0..parts {
            let reading = palms.roll(proposal.stroke.heading, turn)?;
            self.learn(&reading)?;
            let step = self.step(stroke, Some(proposal), reading);
            self.walls.extend(step.wall);
            observe(&step, self.known);
            let done = self.known.proves(&self.task.goal) || self.way >= self.task.way || self.spent();
            if done || reading.stop.is_some() {
                break;
            }
        }
        self.idle = if self.known.touches() > before { 0 } else { self.idle + 1 };
        Ok(())
    }
}

/// Moves the upper palm as `planner` says until `task.goal` is proven, or cannot be. `observe` sees each reading.
///
/// The planner sees what is known alone, and the proof is by the bounds alone: a bad planner costs motion, never truth.
///
/// # Errors
/// [`ParallelError`] for tasks that are none and contacts that contradict each other; what was learned until then is in `known`.
pub fn explore_parallel(
    known: &mut SpaceKnowledge,
    planner: &mut dyn ParallelPlanner,
    palms: &mut dyn ParallelPalms,
    task: &ParallelTask,
    mut observe: impl FnMut(&ParallelStep, &SpaceKnowledge),
) -> Result<Outcome<Direction>, ParallelError> {
    task.check()?;
    let (goal, floor) = (task.goal.value(), known.noise_floor(&task.goal, task.workspace.size));
    if goal < floor {
        return Err(ParallelError::BelowNoise { goal, floor });
    }
    let first = palms.feel()?;
    let (hold, last) = (first.hold, first.contacts.map(|c| c.normal));
    let mut state = Loop { known, task, hold, last, way: 0.0, idle: 0, walls: Vec::new() };
    state.learn(&first)?;
    observe(&state.step(0, None, first), state.known);
    let mut stroke = 0;
    loop {
        let certificate = |known: &SpaceKnowledge| Certificate::of(known, task.goal, task.spending);
        if state.known.proves(&task.goal) {
            return Ok(Outcome::Reached(certificate(state.known)));
        }
        let short = |known, shortfall| Ok(Outcome::Short { shortfall, certificate: certificate(known) });
        if stroke >= task.strokes || state.way >= task.way || state.spent() {
            return short(state.known, Shortfall::Budget);
        }
        let view = ParallelView {
            known: state.known,
            hold: &state.hold,
            workspace: &task.workspace,
            goal: &task.goal,
            walls: &state.walls,
            spacing: task.spacing,
            stroke,
            idle: state.idle,
        };
        let proposal = match planner.next(&view) {
            Ok(proposal) => proposal,
            Err(ParallelPlanError::NotFound { directions }) => {
                let directions = directions.into_iter().map(Heading::coordinates).collect();
                return short(state.known, Shortfall::NotFound { directions });
            }
        };
        stroke += 1;
        state.carry_out(&proposal, palms, stroke, &mut observe)?;
    }
}
