//! The closed loop with the estimator in it.

use super::super::dynamics::{Dynamics, lasts};
use super::super::explore::{RollEnd, RollError, RollTask, inside};
use super::super::palms::PalmsError;
use super::super::planner::{RollPlanError, RollPlanner, RollProposal, View};
use super::super::planners::PalmSweep;
use super::super::predict::Prediction;
use super::super::track::Track;
use super::super::workspace::radians;
use super::hands::{Hands, HandsError};
use super::look::Look;
use crate::certificate::Certificate;
use crate::confidence::{Confidence, ConfidenceError, Spending};
use crate::knowledge::Knowledge;
use crate::planar::PlanarKnowledge;
use crate::planner::Reason;
use object_dynamics::planar::PlanarMass;
use observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane};
use shape_bounds::planar::Direction;
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

/// How it ended.
#[derive(Clone, Debug, PartialEq)]
pub enum SensedOutcome {
    /// The goal is proven.
    Reached(Certificate<Direction>),
    /// It is not.
    Short {
        /// Why, where the planner or the budget ended it; none where the palms cannot go on.
        end: Option<RollEnd>,
        /// Why the palms cannot go on.
        stopped: Option<HandsError>,
        /// The best that was proven; none if nothing ever was.
        certificate: Option<Certificate<Direction>>,
    },
}

impl SensedOutcome {
    /// What is proven.
    #[must_use]
    pub fn certificate(&self) -> Option<&Certificate<Direction>> {
        match self {
            Self::Reached(certificate) => Some(certificate),
            Self::Short { certificate, .. } => certificate.as_ref(),
        }
    }
}

/// Why it cannot be made.
#[derive(Clone, Debug, Error, PartialEq)]
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

struct Loop<'a> {
    task: &'a SensedTask,
    confidence: Confidence,
    look: Option<Look>,
    best: Option<Certificate<Direction>>,
    doubt: Option<String>,
    deviations: Option<[f64; 2]>,
    radians: f64,
    looks: usize,
}

impl Loop<'_> {
    /// Estimates the motion from all that was sensed, and bounds the body by it.
    fn look(&mut self, hands: &dyn Hands) -> Result<(), HandsError> {
        let log = hands.log()?;
        self.looks += 1;
        (self.look, self.deviations) = (None, None);
        let estimate = match estimate_plane(&log, &self.task.sensors) {
            Ok(estimate) if estimate.reliability.is_reliable() => estimate,
            Ok(estimate) => {
                self.doubt = Some(format!("{:?}", estimate.reliability));
                return Ok(());
            }
            Err(error) => {
                self.doubt = Some(error.to_string());
                return Ok(());
            }
        };
        self.deviations = estimate.deviations.last().map(|d| [d.p_WCm.length(), d.phi0]);
        let share = match self.confidence.share(self.looks) {
            Ok(share) => share,
            Err(spent) => {
                self.doubt = Some(spent.to_string());
                return Ok(());
            }
        };
        let levels = (1.0 - share, self.confidence.level());
        let contact = self.task.sensors.noise.contact;
        let place = (hands.palms(), self.dynamics(&estimate));
        match Look::new(&log, &estimate, contact, levels, self.task.roll.spacing, place) {
            Ok(look) => {
                let spending = Some(self.confidence.spending());
                let now = Certificate::of(&look.proven, self.task.roll.goal, spending);
                if self.best.as_ref().is_none_or(|best| now.proven < best.proven) {
                    self.best = Some(now);
                }
                (self.look, self.doubt) = (Some(look), None);
            }
            Err(error) => self.doubt = Some(error.to_string()),
        }
        Ok(())
    }

    /// How the body moves, by its estimate.
    fn dynamics(&self, estimate: &PlaneEstimate) -> Option<Dynamics> {
        let known = self.task.sensors.body;
        let mass = known.or_else(|| PlanarMass::new(estimate.mass.0, estimate.inertia.0).ok())?;
        let omega = estimate.states.last()?.omega0;
        Some(Dynamics { mass, gravity: self.task.sensors.gravity, omega })
    }

    fn reached(&self) -> Option<Certificate<Direction>> {
        self.best.clone().filter(|best| best.proven <= self.task.roll.goal.value())
    }

    fn step(
        &self,
        motion: usize,
        proposal: Option<&RollProposal>,
        hands: &dyn Hands,
        seconds: f64,
    ) -> SensedStep {
        SensedStep {
            motion,
            why: proposal.map(|p| (p.reason, p.expected)),
            palms: hands.palms(),
            radians: self.radians,
            seconds,
            doubt: self.doubt.clone(),
            progress: self.look.as_ref().map_or(f64::INFINITY, |l| l.proven.progress(&self.task.roll.goal)),
            deviations: self.deviations,
        }
    }

    fn next(
        &self,
        planner: &mut dyn RollPlanner,
        sweep: &mut PalmSweep,
        palms: [f64; 2],
        motion: usize,
    ) -> Result<RollProposal, RollPlanError> {
        let (nothing, RollTask { goal, workspace, risk, spacing, .. }) =
            (PlanarKnowledge::exact(), &self.task.roll);
        let still = Track::about_the_centre(palms, 0.0, None);
        let (known, track) = self.look.as_ref().map_or((&nothing, &still), |l| (&l.planned_on, &l.track));
        let (risk, spacing) = (*risk, *spacing);
        let view = View { known, track, workspace, goal, risk, spacing, motion };
        // Without an estimate there is nothing to plan on: the palms move, so that there is something to estimate from.
        if self.look.is_none() { sweep.next(&view) } else { planner.next(&view) }
    }
}

/// Turns `hands` as `planner` says until `task.roll.goal` is proven, or cannot be; `observe` sees each motion and what is known after it.
///
/// After each motion the body's motion is estimated anew from all that was sensed. Where that estimate is not relied on nothing is proven by it, and
/// the palms go on. The confidence is shared among all looks: a motion's bounds hold with one less a share of what may go wrong.
///
/// # Errors
/// [`SensedError`] for tasks that are none.
pub fn explore_sensed(
    planner: &mut dyn RollPlanner,
    hands: &mut dyn Hands,
    task: &SensedTask,
    mut observe: impl FnMut(&SensedStep, Option<&Look>),
) -> Result<SensedOutcome, SensedError> {
    let RollTask { workspace, motions, radians: most, .. } = task.roll;
    task.roll.check()?;
    inside(&task.roll, hands.palms())?;
    let confidence = Confidence::new(task.level, Spending::Budget(motions + 1))?;
    let mut state = Loop {
        task,
        confidence,
        look: None,
        best: None,
        doubt: None,
        deviations: None,
        radians: 0.0,
        looks: 0,
    };
    let (mut sweep, mut seconds) = (PalmSweep::new(), 2.0 * workspace.settle);
    hands.turn(hands.palms(), workspace.settle, workspace.settle).map_err(SensedError::Start)?;
    state.look(hands).map_err(SensedError::Start)?;
    observe(&state.step(0, None, hands, seconds), state.look.as_ref());
    let mut motion = 0;
    loop {
        if let Some(certificate) = state.reached() {
            return Ok(SensedOutcome::Reached(certificate));
        }
        let short = |state: &Loop<'_>, end, stopped| {
            Ok(SensedOutcome::Short { end, stopped, certificate: state.best.clone() })
        };
        if motion >= motions || state.radians >= most {
            return short(&state, Some(RollEnd::Budget), None);
        }
        let proposal = match state.next(planner, &mut sweep, hands.palms(), motion) {
            Ok(proposal) => proposal,
            Err(RollPlanError::Unreachable { directions }) => {
                return short(&state, Some(RollEnd::Unreachable { directions }), None);
            }
            // Drawn from contacts that noise put past each other: the next estimate has others.
            Err(RollPlanError::NoBody { .. }) => {
                state.look = None;
                continue;
            }
        };
        motion += 1;
        for leg in &proposal.legs {
            inside(&task.roll, *leg)?;
            let from = hands.palms();
            let lasts = lasts(&workspace, from, *leg);
            match hands.turn(*leg, lasts, workspace.settle) {
                Ok(()) => {}
                Err(HandsError::Off { palm, s, length }) => {
                    let lost = RollEnd::Lost(PalmsError::Off { palm, s, length });
                    return short(&state, Some(lost), None);
                }
                Err(error) => return short(&state, None, Some(error)),
            }
            state.radians += radians(from, *leg);
            seconds += lasts + workspace.settle;
        }
        if let Err(error) = state.look(hands) {
            return short(&state, None, Some(error));
        }
        observe(&state.step(motion, Some(&proposal), hands, seconds), state.look.as_ref());
    }
}
