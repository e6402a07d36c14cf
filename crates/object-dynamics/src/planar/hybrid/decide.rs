//! What the contacts do next: blows where gaps close, then modes anew.

use super::error::{ContactSimulationError, FieldError, PalmContactError};
use super::events::{ContactEventKind as Kind, End};
use super::phase::Phase;
use super::state::{BodyState, PALM_WORK, TIME, Vector, add_impulse};
use super::tracker::{Touch, Tracker};
use crate::planar::contacts::{ContactProblem, ModeError, PlanarMode};
use contact_kinematics::planar::RadiusFunction;
use glam::DVec2;

/// Share of the body's size up to which a gap counts as closed when modes are chosen.
const CLOSED: f64 = 1e-10;
/// Share of the natural speed up to which a gap rate counts as zero when modes are chosen. A body falls through a gap that is
/// rounding, 1e-14 of its size, at 1.4e-7 of that speed: a body that rattles between two palms never comes to rest below that.
const SETTLED: f64 = 1e-6;
/// Share of the natural speed up to which a slip counts as zero.
const STILL: f64 = 1e-9;

/// What an event leads to.
pub(super) struct Decision<'a, S> {
    pub(super) phase: Phase<'a, S>,
    pub(super) y: Vector,
    /// Work of the impulses of a blow against the slips and gap rates, J; none without a blow.
    pub(super) blow: Option<f64>,
    /// Energy, J, that goes with the gap rates that count as zero.
    pub(super) settled: f64,
}

/// What is known when modes are to be chosen.
pub(super) struct Question<'q> {
    /// Modes of all palms so far.
    pub(super) present: &'q [PlanarMode],
    /// Why they end; none at the start.
    pub(super) end: Option<End>,
    /// Sets that have ended at this instant.
    pub(super) ended: &'q [Vec<PlanarMode>],
}

impl<S: RadiusFunction> Tracker<'_, S> {
    /// Modes from the vector `y` on, which is pulled onto the contacts first.
    pub(super) fn decide(
        &self,
        mut y: Vector,
        question: &Question<'_>,
    ) -> Result<Decision<'_, S>, ContactSimulationError> {
        let t = y[TIME];
        let at = |source| ContactSimulationError::Contact { t, source };
        let mut modes = question.present.to_vec();
        if let Some(End::Event(Kind::Touches, Some(palm))) = question.end {
            // Its gap is taken out, its gap rate is not: that is the blow's.
            let mut closed = modes.clone();
            closed[palm] = PlanarMode::Slide { sense: 0.0 };
            let velocity = [y[3], y[4], y[5]];
            self.phase(&closed).project(&mut y).map_err(at)?;
            y[3..6].copy_from_slice(&velocity);
            modes[palm] = PlanarMode::Stick;
        }
        self.phase(question.present).project(&mut y).map_err(at)?;
        let mut state = BodyState::of(&y);
        let told = |state: BodyState| {
            move |source: ModeError| ContactSimulationError::Modes { t, body: state, source }
        };
        let mut touches = self.closed(t, &state, &modes).map_err(|source| at(source.into()))?;
        let still = SETTLED * self.speed(&state);
        let closes = |touch: &Touch| touch.contact.n.dot(touch.slip(&state)) < -still;
        let mut blow = None;
        if touches.iter().any(closes) {
            blow = Some(self.blow(&touches, &mut y, &mut modes).map_err(told(state))?);
            state = BodyState::of(&y);
        }
        touches.retain(|touch| touch.contact.n.dot(touch.slip(&state)) <= still);
        // After a blow nothing is told against the sets before it.
        let ended = if blow.is_some() { &[] } else { question.ended };
        let question = Question { present: &modes, end: question.end, ended };
        let modes = self.choose(&touches, &state, &question).map_err(at)?.map_err(told(state))?;
        let phase = self.phase(&modes);
        // What goes with rates that count as zero is an impulse, too.
        let before = self.kinetic(&y);
        let impulses = phase.project(&mut y).map_err(at)?;
        let mut settled = self.kinetic(&y) - before;
        for (touch, impulse) in impulses {
            settled -= add_blow(&mut y, &touch, impulse);
        }
        Ok(Decision { phase, y, blow, settled })
    }

    fn phase(&self, modes: &[PlanarMode]) -> Phase<'_, S> {
        Phase { tracker: self, modes: modes.to_vec() }
    }

    fn kinetic(&self, y: &Vector) -> f64 {
        let BodyState { v_WCm, omega0, .. } = BodyState::of(y);
        self.scene.object().energy(DVec2::ZERO, v_WCm, omega0)
    }

    /// Contacts that touch: by their modes, or by their gaps.
    fn closed(
        &self,
        t: f64,
        state: &BodyState,
        modes: &[PlanarMode],
    ) -> Result<Vec<Touch>, PalmContactError> {
        let mut touches = Vec::new();
        for (palm, mode) in modes.iter().enumerate() {
            let near = *mode != PlanarMode::Off || self.gap(palm, t, state)?[0] <= CLOSED * self.size;
            if near {
                touches.push(self.touch(palm, t, state)?);
            }
        }
        Ok(touches)
    }

    /// Inelastic blow: impulses in the friction cones after which no gap closes, and the modes that they are of. Returns their
    /// work (J) on gap rates and slips; what they do at the palms' velocities is work of the palms.
    fn blow(&self, touches: &[Touch], y: &mut Vector, modes: &mut [PlanarMode]) -> Result<f64, ModeError> {
        let contacts: Vec<_> = touches
            .iter()
            .map(|touch| {
                let u = touch.surface.material_velocity(touch.contact.p_WC);
                let biases = [-touch.contact.n.dot(u), -touch.contact.t.dot(u)];
                touch.touching(biases, self.friction(touch.palm), 0.0)
            })
            .collect();
        let present: Vec<_> = touches.iter().map(|touch| modes[touch.palm]).collect();
        let before = BodyState::of(y);
        let problem = ContactProblem::new(self.mass(), (before.v_WCm, before.omega0), &contacts);
        let choice = problem.choose(&present, &[])?;
        let (v_WCm, omega0) = (choice.response.a_WCm, choice.response.alpha0);
        let after = BodyState { v_WCm, omega0, ..before };
        after.write(y);
        let mut work = 0.0;
        for ((touch, mode), [normal, along]) in touches.iter().zip(&choice.modes).zip(&choice.response.forces)
        {
            let impulse = touch.contact.n * *normal + touch.contact.t * *along;
            add_blow(y, touch, impulse);
            work += 0.5 * impulse.dot(touch.slip(&before) + touch.slip(&after));
            modes[touch.palm] = *mode;
        }
        Ok(work)
    }

    /// Modes of all palms from the contacts that touch and do not part.
    fn choose(
        &self,
        touches: &[Touch],
        state: &BodyState,
        question: &Question<'_>,
    ) -> Result<Result<Vec<PlanarMode>, ModeError>, FieldError> {
        let still = STILL * self.speed(state);
        let mut contacts = Vec::new();
        for touch in touches {
            let (rates, mu) = (touch.rates(state)?, self.friction(touch.palm));
            let along = touch.contact.t.dot(rates.slip);
            let stopped = question.end == Some(End::Event(Kind::SlipEnds, Some(touch.palm)))
                || along.abs() <= still
                || mu == 0.0;
            let sense = if stopped { 0.0 } else { along.signum() };
            contacts.push(touch.touching([rates.gap_bias, touch.contact.t.dot(rates.slip_bias)], mu, sense));
        }
        let of_touches = |all: &[PlanarMode]| touches.iter().map(|touch| all[touch.palm]).collect::<Vec<_>>();
        let ended: Vec<_> = question.ended.iter().map(|set| of_touches(set)).collect();
        let problem = ContactProblem::new(self.mass(), self.free_fall(), &contacts);
        Ok(problem.choose(&of_touches(question.present), &ended).map(|choice| {
            let mut modes = vec![PlanarMode::Off; question.present.len()];
            for (touch, mode) in touches.iter().zip(choice.modes) {
                modes[touch.palm] = mode;
            }
            modes
        }))
    }
}

/// Adds an impulse and what it works at the palm's velocity, J, which is returned.
fn add_blow(y: &mut Vector, touch: &Touch, impulse: DVec2) -> f64 {
    let work = impulse.dot(touch.surface.material_velocity(touch.contact.p_WC));
    add_impulse(y, touch.palm, impulse);
    y[PALM_WORK] += work;
    work
}
