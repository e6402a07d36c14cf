//! The closed loop with the estimator in it.

use super::super::dynamics::{Dynamics, lasts};
use super::super::explore::{RollError, RollTask, inside};
use super::super::outcome::RollEnd;
use super::super::palms::PalmsError;
use super::super::planner::{RollPlanError, RollPlanner, RollProposal, View};
use super::super::planners::PalmSweep;
use super::super::predict::Prediction;
use super::super::track::Track;
use super::super::workspace::radians;
use super::friction::of_sliding;
use super::hands::{Hands, HandsError};
use super::look::Look;
use crate::certificate::Certificate;
use crate::confidence::{Confidence, ConfidenceError, Spending};
use crate::knowledge::Knowledge;
use crate::planar::PlanarKnowledge;
use crate::planner::Reason;
use glam::DVec2;
use object_dynamics::planar::{ContactLog, PlanarMass};
use observer::contacts::Beginning;
use observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane, estimate_plane_from};
use observer::reliability::Reliability;
use shape_bounds::exact_hull::planar::Direction;
use thiserror::Error;

/// What is to be reached, with what sensors, at which confidence.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedTask {
    /// Goal and limits. Its spacing is that of the contacts that are planned on; its spending is not read.
    pub roll: RollTask,
    /// Noise of the sensors, gravity, friction and what is known of the body.
    pub sensors: PlaneOptions,
    /// Confidence of the certificate, for all looks that may be taken together: one after each motion.
    pub level: f64,
}

/// What was done and known after a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct SensedStep {
    /// Number of the motion, from 1; 0 for the rest at the start.
    pub motion: usize,
    /// Why it was made, and what it was expected to bring.
    pub why: Option<(Reason, Option<Prediction>)>,
    /// Absolute angles of the palms after it, rad.
    pub palms: [f64; 2],
    /// Radians of palm motion up to it.
    pub radians: f64,
    /// Seconds up to it.
    pub seconds: f64,
    /// Why the estimate is not relied on, in words; none where it is.
    pub doubt: Option<String>,
    /// The goal's quantity as it is proven now; infinite or 1 where nothing is.
    pub progress: f64,
    /// Deviations of place (m) and turn (rad) of the body at the end; none without an estimate that is relied on.
    pub deviations: Option<[f64; 2]>,
}

/// Why a goal was not reached.
#[derive(Clone, Debug, PartialEq)]
pub enum SensedEnd {
    /// The budget, the planner, or a lost body.
    Rolling(RollEnd),
    /// The palms cannot go on.
    Stopped(HandsError),
    /// One estimate after the other was not relied on.
    Doubted {
        /// Why the last one was not.
        doubt: String,
    },
}

/// How it ended.
pub struct SensedOutcome {
    /// The goal is proven, or why not.
    pub short: Option<SensedEnd>,
    /// What was known when an estimate was last relied on; none if it never was.
    pub look: Option<Look>,
    /// What that proves.
    pub certificate: Option<Certificate<Direction>>,
}

/// Why it cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SensedError {
    /// Goal, limits or settings that are none; a planner that cannot plan.
    #[error(transparent)]
    Task(#[from] RollError),
    /// A confidence that is none.
    #[error(transparent)]
    Confidence(#[from] ConfidenceError),
    /// Nothing is sensed at the start.
    #[error("nothing is sensed at the start: {0}")]
    Start(#[source] HandsError),
}

/// Estimates in a row that are not relied on before it is ended: what made them so stays in the log.
const DOUBTS: usize = 4;

struct Loop<'a> {
    task: &'a SensedTask,
    confidence: Confidence,
    look: Option<Look>,
    /// What the last estimate that was relied on tells of the log as it goes on.
    beginning: Option<Beginning>,
    /// Estimates since then that were not relied on, and why the last one was not.
    doubts: usize,
    doubt: Option<String>,
    deviations: Option<[f64; 2]>,
    radians: f64,
    seconds: f64,
    looks: usize,
}

impl Loop<'_> {
    /// Estimates the motion from all that was sensed, and bounds the body by it.
    fn look(&mut self, hands: &dyn Hands) -> Result<(), HandsError> {
        let log = hands.log()?;
        self.looks += 1;
        match self.seen(&log, hands.palms()) {
            Ok(look) => {
                self.look = Some(look);
                (self.doubts, self.doubt) = (0, None);
            }
            Err(doubt) => {
                self.doubts += 1;
                (self.doubt, self.deviations) = (Some(doubt), None);
            }
        }
        Ok(())
    }

    /// What a log tells, or why it is not relied on.
    fn seen(&mut self, log: &ContactLog, palms: [f64; 2]) -> Result<Look, String> {
        let sensors = &self.task.sensors;
        let estimate = match &self.beginning {
            Some(beginning) => estimate_plane_from(beginning, log, sensors),
            None => estimate_plane(log, sensors),
        };
        let estimate = estimate.map_err(|error| error.to_string())?;
        if let Reliability::Unreliable(reasons) = &estimate.reliability {
            return Err(reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "));
        }
        // What some samples contradict is wrong of the body, maybe, and then of all samples.
        let (all, relied) = (estimate.relied_on.len(), estimate.relied_on.iter().filter(|r| **r).count());
        if relied < all {
            return Err(format!("noise does not explain what is left at {} of {all} samples", all - relied));
        }
        self.beginning = estimate.beginning();
        self.deviations = estimate.deviations.last().map(|d| [d.p_WCm.length(), d.phi0]);
        let share = self.confidence.share(self.looks).map_err(|error| error.to_string())?;
        let levels = (1.0 - share, self.confidence.level());
        let (contact, spacing) = (self.task.sensors.noise.contact, self.task.roll.spacing);
        let place = (palms, self.dynamics(log, &estimate));
        Look::new(log, &estimate, contact, levels, spacing, place).map_err(|error| error.to_string())
    }

    /// How the body moves, by its estimate.
    fn dynamics(&self, log: &ContactLog, estimate: &PlaneEstimate) -> Option<Dynamics> {
        let PlaneOptions { body, gravity, ref friction, .. } = self.task.sensors;
        let mass = body.or_else(|| PlanarMass::new(estimate.mass.0, estimate.inertia.0).ok())?;
        let omega = estimate.states.last()?.omega0;
        let known: Option<Vec<f64>> = friction.iter().copied().collect();
        let friction = known.and_then(|known| known.into_iter().reduce(f64::max));
        let friction = friction.unwrap_or_else(|| of_sliding(log, estimate));
        Some(Dynamics { mass, gravity, omega, friction })
    }

    fn certificate(&self) -> Option<Certificate<Direction>> {
        let of = |look: &Look| {
            Certificate::of(&look.proven, self.task.roll.goal, Some(self.confidence.spending()))
        };
        self.look.as_ref().map(of)
    }

    fn ended(self, short: Option<SensedEnd>) -> SensedOutcome {
        SensedOutcome { short, certificate: self.certificate(), look: self.look }
    }

    fn step(&self, motion: usize, proposal: Option<&RollProposal>, hands: &dyn Hands) -> SensedStep {
        let proven = self.look.as_ref().filter(|_| self.doubts == 0);
        SensedStep {
            motion,
            why: proposal.map(|p| (p.reason, p.expected)),
            palms: hands.palms(),
            radians: self.radians,
            seconds: self.seconds,
            doubt: self.doubt.clone(),
            progress: proven.map_or(f64::INFINITY, |l| l.proven.progress(&self.task.roll.goal)),
            deviations: self.deviations,
        }
    }

    /// The next motion. Without an estimate there is nothing to plan on: the palms sweep, so that there is something to estimate from.
    fn next(
        &self,
        planner: &mut dyn RollPlanner,
        sweep: &mut PalmSweep,
        palms: [f64; 2],
        motion: usize,
    ) -> Result<RollProposal, RollPlanError> {
        let RollTask { goal, workspace, risk, spacing, .. } = &self.task.roll;
        let (risk, spacing) = (*risk, *spacing);
        if let Some(Look { planned_on: known, track, .. }) = self.look.as_ref().filter(|_| self.doubts == 0) {
            let next = planner.next(&View { known, track, workspace, goal, risk, spacing, motion });
            // No body: noise put contacts past each other, and the next estimate has others.
            if !matches!(next, Err(RollPlanError::NoBody { .. })) {
                return next;
            }
        }
        let (known, track) = (&PlanarKnowledge::exact(), &Track::about(palms, 0.0, DVec2::ZERO, None));
        sweep.next(&View { known, track, workspace, goal, risk, spacing, motion })
    }

    /// Carries a motion out; why it cannot be.
    fn carry_out(
        &mut self,
        proposal: &RollProposal,
        hands: &mut dyn Hands,
    ) -> Result<Option<SensedEnd>, SensedError> {
        let workspace = &self.task.roll.workspace;
        for leg in &proposal.legs {
            inside(&self.task.roll, *leg)?;
            let (from, lasts) = (hands.palms(), lasts(workspace, hands.palms(), *leg));
            match hands.turn(*leg, lasts, workspace.settle) {
                Ok(()) => {}
                Err(HandsError::Off { palm, s, length }) => {
                    let lost = PalmsError::Off { palm, s, length };
                    return Ok(Some(SensedEnd::Rolling(RollEnd::Lost(lost))));
                }
                Err(error) => return Ok(Some(SensedEnd::Stopped(error))),
            }
            self.radians += radians(from, *leg);
            self.seconds += lasts + workspace.settle;
        }
        Ok(self.look(hands).err().map(SensedEnd::Stopped))
    }

    /// Why no other motion is made, if none is; none within where the goal is proven.
    fn done(&self, motion: usize) -> Option<Option<SensedEnd>> {
        let RollTask { motions, radians, ref goal, .. } = self.task.roll;
        if self.look.as_ref().is_some_and(|look| look.proven.proves(goal)) {
            Some(None)
        } else if motion >= motions || self.radians >= radians {
            Some(Some(SensedEnd::Rolling(RollEnd::Budget)))
        } else if self.doubts >= DOUBTS {
            Some(Some(SensedEnd::Doubted { doubt: self.doubt.clone().unwrap_or_default() }))
        } else {
            None
        }
    }
}

/// Turns `hands` as `planner` says until `task.roll.goal` is proven, or cannot be; `observe` sees each motion and what is known after it.
///
/// After each motion the body's motion is estimated anew from all that was sensed. Where that estimate is not relied on nothing new is proven, and
/// the palms go on. The confidence is shared among all looks: the bounds of each hold but for a share of what may go wrong.
///
/// # Errors
/// [`SensedError`] for tasks that are none.
pub fn explore_sensed(
    planner: &mut dyn RollPlanner,
    hands: &mut dyn Hands,
    task: &SensedTask,
    mut observe: impl FnMut(&SensedStep, Option<&Look>),
) -> Result<SensedOutcome, SensedError> {
    task.roll.check()?;
    inside(&task.roll, hands.palms())?;
    let confidence = Confidence::new(task.level, Spending::Budget(task.roll.motions + 1))?;
    let settle = task.roll.workspace.settle;
    let mut state = Loop {
        task,
        confidence,
        look: None,
        beginning: None,
        doubts: 0,
        doubt: None,
        deviations: None,
        radians: 0.0,
        seconds: 2.0 * settle,
        looks: 0,
    };
    hands.turn(hands.palms(), settle, settle).map_err(SensedError::Start)?;
    state.look(hands).map_err(SensedError::Start)?;
    observe(&state.step(0, None, hands), state.look.as_ref());
    let (mut sweep, mut motion) = (PalmSweep::new(), 0);
    loop {
        if let Some(end) = state.done(motion) {
            return Ok(state.ended(end));
        }
        let proposal = match state.next(planner, &mut sweep, hands.palms(), motion) {
            Ok(proposal) => proposal,
            Err(RollPlanError::NotFound { directions }) => {
                return Ok(state.ended(Some(SensedEnd::Rolling(RollEnd::NotFound { directions }))));
            }
            Err(error) => return Err(RollError::Plan(error).into()),
        };
        motion += 1;
        if let Some(end) = state.carry_out(&proposal, hands)? {
            return Ok(state.ended(Some(end)));
        }
        observe(
            &state.step(motion, Some(&proposal), hands),
            state.look.as_ref().filter(|_| state.doubts == 0),
        );
    }
}
