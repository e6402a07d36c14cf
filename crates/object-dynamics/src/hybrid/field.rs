//! The smooth motion between events: rates of the state with the modes held.

use super::packed::{Tallies, Units};
use super::project::{Along, Guesses};
use super::result::ContactInstant;
use crate::ContactMode;
use crate::contacts::{
    ContactProblem, ContactScene, Contacts, Directions, MOST_PALMS, Modes, PalmContactError, Reaction,
    SceneState,
};
use contact_kinematics::SupportFunction;
use glam::{DQuat, DVec2, DVec3};

/// Slip below this share of the natural speed is none.
pub(super) const STILL: f64 = 1e-9;
/// A contact that has begun to slide takes the direction in which it is driven until its slip reaches this share of the natural
/// speed. It is drawn there at the rate `mu f / (m slip)`, too fast to be integrated; what lags behind is of the order of the
/// slip, in rad.
const STARTING: f64 = 1e-6;

/// A stretch of motion with the same modes.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub(super) modes: Modes,
    /// Slip directions of sliding contacts when the present step began, world axes.
    ///
    /// Along them the field goes on smoothly where a slip passes through zero: the friction keeps its side until the event
    /// is located.
    pub(super) towards: [DVec3; MOST_PALMS],
    /// Sliding contacts that have just begun to.
    pub(super) starting: [bool; MOST_PALMS],
    pub(super) guesses: Guesses,
}

/// What is known of the motion at one time and state.
pub(super) struct Evaluated {
    pub(super) state: SceneState,
    pub(super) tallies: Tallies,
    pub(super) touch: Contacts,
    pub(super) problem: ContactProblem,
    pub(super) directions: Directions,
    /// None where the modes have no forces: at a critical friction, say.
    pub(super) reaction: Option<Reaction>,
}

impl Stretch {
    pub(super) fn evaluate<S: SupportFunction>(
        &self,
        scene: &ContactScene<S>,
        units: &Units,
        (state, tallies): (SceneState, Tallies),
    ) -> Result<Evaluated, PalmContactError> {
        let touch = scene.contacts_at(&state, &self.guesses)?;
        let problem = scene.problem(&state.body, &touch);
        let mut directions = [DVec2::X; MOST_PALMS];
        let mut starting = Vec::new();
        for (i, contact) in problem.contacts().iter().enumerate() {
            if self.modes[i] != ContactMode::Slide {
                continue;
            }
            let slip = contact.in_tangent(touch.rates[i].slip);
            let towards = contact.in_tangent(self.towards[i]);
            let speed = slip.length();
            let begins = self.begins(i, &problem, touch.rates[i].slip, units);
            directions[i] = if begins || speed <= STILL * units.speed {
                towards.try_normalize().unwrap_or(DVec2::X)
            } else {
                // Not `signum`, which takes minus zero for negative.
                slip / if slip.dot(towards) < 0.0 { -speed } else { speed }
            };
            if begins {
                starting.push(i);
            }
        }
        let begun = match starting.is_empty() {
            true => None,
            false => problem.directions_near(&self.modes, &directions, &starting),
        };
        let reaction = match begun {
            Some((found, reaction)) => {
                directions = found;
                Some(reaction)
            }
            None => problem.solve(&self.modes, &directions).ok(),
        };
        let force = problem.force_scale(|i| self.modes[i] != ContactMode::Off);
        let reaction =
            reaction.map(|reaction| problem.within_cones(&self.modes, reaction, force).unwrap_or(reaction));
        Ok(Evaluated { state, tallies, touch, problem, directions, reaction })
    }

    /// Whether contact `i` has so little slip since it began to slide that its direction is that of the drive.
    pub(super) fn begins(&self, i: usize, problem: &ContactProblem, slip: DVec3, units: &Units) -> bool {
        let contact = &problem.contacts()[i];
        let slow = contact.in_tangent(slip).length() < STARTING * units.speed;
        self.starting[i] && contact.friction > 0.0 && slow
    }

    /// Directions of the contacts that have just begun to slide: the friction keeps their slip in them.
    pub(super) fn beginning<S: SupportFunction>(
        &self,
        scene: &ContactScene<S>,
        units: &Units,
        state: (SceneState, Tallies),
    ) -> Result<Along, PalmContactError> {
        let mut along: Along = [None; MOST_PALMS];
        if !self.starting.contains(&true) {
            return Ok(along);
        }
        let now = self.evaluate(scene, units, state)?;
        for (i, contact) in now.problem.contacts().iter().enumerate() {
            let begins = self.modes[i] == ContactMode::Slide
                && self.begins(i, &now.problem, now.touch.rates[i].slip, units);
            along[i] = begins.then(|| contact.along_tangent(now.directions[i]));
        }
        Ok(along)
    }

    /// The stretch as the next step sees it: slip directions and contacts as they are now.
    pub(super) fn renewed(&self, now: &Evaluated, units: &Units) -> Self {
        let mut next = *self;
        for (i, contact) in now.problem.contacts().iter().enumerate() {
            next.guesses[i] = Some(now.touch.contacts[i].n_O);
            let speed = contact.in_tangent(now.touch.rates[i].slip).length();
            next.starting[i] = self.starting[i] && speed < STARTING * units.speed;
            if self.modes[i] == ContactMode::Slide {
                next.towards[i] = contact.along_tangent(now.directions[i]);
            }
        }
        next
    }
}

impl Evaluated {
    /// The instant for people to read; none where the modes have no forces. `blow_work`: what blows have taken so far, J.
    pub(super) fn into_instant(self, modes: &[ContactMode], blow_work: f64) -> Option<ContactInstant> {
        let (reaction, count) = (self.reaction?, modes.len());
        Some(ContactInstant {
            state: self.state,
            modes: modes.to_vec(),
            palms: self.touch.palms,
            contacts: self.touch.contacts,
            rates: self.touch.rates,
            forces: reaction.forces[..count].to_vec(),
            impulses: self.tallies.impulses[..count].to_vec(),
            a_WCm: reaction.a,
            alpha_WO: reaction.alpha,
            friction_work: self.tallies.friction_work,
            palm_work: self.tallies.palm_work,
            blow_work,
        })
    }

    /// Rates of the packed state; NaN where the modes have no forces, so that the integrator takes a shorter step.
    pub(super) fn rates<S: SupportFunction, const N: usize>(
        &self,
        scene: &ContactScene<S>,
        units: &Units,
    ) -> [f64; N] {
        let Some(reaction) = &self.reaction else { return [f64::NAN; N] };
        let body = &self.state.body;
        let w = body.w_WO;
        let mut rate = self.state;
        rate.body.p_WCm = body.v_WCm;
        // Not a unit quaternion: the rate of one.
        rate.body.R_WO = DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * body.R_WO * 0.5;
        rate.body.v_WCm = reaction.a;
        rate.body.w_WO = reaction.alpha;
        let mut tallies = Tallies { impulses: reaction.forces, ..Tallies::default() };
        for (i, contact) in self.problem.contacts().iter().enumerate() {
            let force = reaction.forces[i];
            tallies.friction_work += force.dot(self.touch.rates[i].slip);
            tallies.palm_work += force.dot(self.touch.rates[i].surface_velocity);
            rate.palms[i].position = self.state.palms[i].velocity;
            rate.palms[i].velocity = scene.free_palm_acceleration(i, &self.touch.palms[i], self.state.t)
                - contact.yields.coordinates(force);
        }
        units.pack(&rate, &tallies)
    }
}
