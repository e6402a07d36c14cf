//! What happens at an event: blows, and the modes that follow.

use super::blow::blow;
use super::error::ContactSimulationError as Error;
use super::events::Crossing;
use super::field::STILL;
use super::packed::Tallies;
use super::project::projected;
use super::result::{ContactEvent, ContactEventKind};
use super::run::Run;
use crate::ContactMode;
use crate::contacts::{EXACT, Left, MOST_PALMS, ModeError, Modes, SceneState, Touch};
use contact_kinematics::SupportFunction;

/// Work of an event, in steps.
const EVENT: usize = 5;
/// Slips and rates of gaps at the start below this share of the natural speed are none: a state given to six digits.
const STATED: f64 = 1e-5;
/// A contact whose gap opens slower than this share of the natural speed has not left.
const LEAVES: f64 = 1e-5;
/// An approach slower than this share of the natural speed is no blow.
const GRAZING: f64 = 1e-9;

impl<S: SupportFunction, const N: usize> Run<'_, S, N> {
    /// New modes after an event; whether time stepping must find them instead.
    pub(super) fn change(&mut self, crossing: &Crossing) -> Result<bool, Error> {
        let mut closed = self.stretch.modes.map(|mode| mode != ContactMode::Off);
        closed[crossing.palm] = true;
        let left = match crossing.kind {
            ContactEventKind::Touches | ContactEventKind::SlipEnds => None,
            ContactEventKind::Lifts | ContactEventKind::ConeLeft => {
                let squeezed =
                    self.evaluated(self.t, &self.y)?.reaction.is_some_and(|reaction| !reaction.unique);
                if squeezed {
                    return Ok(true);
                }
                Some(Left { contact: crossing.palm, mode: self.stretch.modes[crossing.palm] })
            }
        };
        let (state, tallies) = self.units.unpack(self.t, &self.y);
        // Until now the old modes have held: what departs from them is the integrator's error, the rest of a slip as well.
        let mut modes: Modes = self.stretch.modes;
        if crossing.kind == ContactEventKind::SlipEnds {
            modes[crossing.palm] = ContactMode::Stick;
        }
        let state = projected(
            self.scene,
            state,
            &modes,
            &[None; MOST_PALMS],
            &self.stretch.guesses,
            self.units.length,
        )
        .map_err(|source| Error::Contact { t: self.t, source })?;
        if crossing.kind == ContactEventKind::SlipEnds {
            self.stretch.modes = modes;
        }
        let before = self.stretch.modes;
        let (kept, blow_work) = (self.stretch, self.blow_work);
        if let Err(error) = self.settle(state, &tallies, &closed, left) {
            if !matches!(error, Error::Modes { source: ModeError::Inconsistent, .. }) {
                return Err(error);
            }
            (self.stretch, self.blow_work) = (kept, blow_work);
            (self.t, self.y) = (state.t, self.units.pack(&state, &tallies));
            return Ok(true);
        }
        // Modes that neither hold nor change: forces are at an edge that only a step of some length tells.
        if self.stretch.modes == before && left.is_some() {
            return Ok(true);
        }
        let modes = self.stretch.modes[..self.scene.palms().len()].to_vec();
        let event = ContactEvent { t: self.t, palm: crossing.palm, kind: crossing.kind, modes };
        self.result.events.push(event);
        Ok(self.crowded(self.t, EVENT))
    }

    /// Finds the modes of a state whose `closed` contacts touch, after a blow where one approaches. Whether sticking contacts agree
    /// exactly.
    pub(super) fn settle(
        &mut self,
        state: SceneState,
        tallies: &Tallies,
        closed: &[bool; MOST_PALMS],
        left: Option<Left>,
    ) -> Result<bool, Error> {
        let (scene, units) = (self.scene, self.units);
        let t = state.t;
        let contact = |source| Error::Contact { t, source };
        let gaps_closed = closed.map(|closed| if closed { ContactMode::Slide } else { ContactMode::Off });
        let (mut state, mut tallies) = (state, *tallies);
        let mut touch = scene.contacts_at(&state, &self.stretch.guesses).map_err(contact)?;
        // At the start the state is as exact as who gave it.
        let at_start = self.result.instants.is_empty();
        let [grazing, still] =
            [GRAZING, STILL].map(|rate| units.speed * if at_start { STATED } else { rate });
        let approaches = |i: usize| closed[i] && touch.rates[i].gap_rate < -grazing;
        let struck = (0..scene.palms().len()).any(approaches);
        if struck {
            let before = scene.energy(&state.body);
            let (after, impulses) = blow(scene, &state, &touch, closed)
                .map_err(|source| Error::Modes { state: Box::new(state), source })?;
            state = after;
            self.blow_work += scene.energy(&state.body) - before;
            for (sum, impulse) in tallies.impulses.iter_mut().zip(impulses.forces) {
                *sum += impulse;
            }
            touch = scene.contacts_at(&state, &self.stretch.guesses).map_err(contact)?;
        }
        let problem = scene.problem(&state.body, &touch);
        let mut touches = [Touch::Apart; MOST_PALMS];
        for (i, at) in problem.contacts().iter().enumerate() {
            let rates = &touch.rates[i];
            if closed[i] && rates.gap_rate <= LEAVES * units.speed {
                let slip = at.in_tangent(rates.slip);
                let speed = slip.length();
                // Palms that have begun to pull sticking contacts apart leave some slip in all of them.
                let sticks = !struck && self.stretch.modes[i] == ContactMode::Stick;
                touches[i] =
                    if sticks || speed <= still { Touch::Rests } else { Touch::Slides(slip / speed) };
            }
        }
        let present = if at_start { gaps_closed } else { self.stretch.modes };
        let choice = problem
            .choose(&touches, &present, left)
            .map_err(|source| Error::Modes { state: Box::new(state), source })?;
        self.stretch.modes = choice.modes;
        for (i, at) in problem.contacts().iter().enumerate() {
            self.stretch.towards[i] = at.along_tangent(choice.directions[i]);
            self.stretch.starting[i] = touches[i] == Touch::Rests;
            self.stretch.guesses[i] = Some(touch.contacts[i].n_O);
        }
        let state =
            projected(scene, state, &choice.modes, &[None; MOST_PALMS], &self.stretch.guesses, units.length)
                .map_err(contact)?;
        (self.t, self.y) = (t, units.pack(&state, &tallies));
        Ok(choice.reaction.unmet <= EXACT)
    }
}
