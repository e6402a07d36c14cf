//! The smooth motion between events: rates of the state with the modes held.

use super::packed::{Tallies, Units};
use super::project::Guesses;
use crate::ContactMode;
use crate::contacts::{
    ContactProblem, ContactScene, Contacts, Directions, MOST_PALMS, Modes, PalmContactError, Reaction,
    SceneState,
};
use contact_kinematics::SupportFunction;
use glam::{DQuat, DVec2, DVec3};

/// Slip below this share of the natural speed has no direction of its own.
pub(super) const STILL: f64 = 1e-9;

/// A stretch of motion with the same modes.
#[derive(Clone, Copy)]
pub(super) struct Stretch {
    pub(super) modes: Modes,
    /// Slip directions of sliding contacts when the present step began, world axes.
    ///
    /// Along them the field goes on smoothly where a slip passes through zero: the friction keeps its side until the event
    /// is located.
    pub(super) towards: [DVec3; MOST_PALMS],
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
        for (i, contact) in problem.contacts().iter().enumerate() {
            if self.modes[i] == ContactMode::Slide {
                let slip = contact.in_tangent(touch.rates[i].slip);
                let towards = contact.in_tangent(self.towards[i]);
                let speed = slip.length();
                directions[i] = if speed > STILL * units.speed {
                    // Not `signum`, which takes minus zero for negative.
                    slip / if slip.dot(towards) < 0.0 { -speed } else { speed }
                } else {
                    towards.try_normalize().unwrap_or(DVec2::X)
                };
            }
        }
        let reaction = problem.solve(&self.modes, &directions).ok();
        Ok(Evaluated { state, tallies, touch, problem, directions, reaction })
    }

    /// The stretch as the next step sees it: slip directions and contacts as they are now.
    pub(super) fn renewed(&self, now: &Evaluated, units: &Units) -> Self {
        let mut next = *self;
        for (i, contact) in now.problem.contacts().iter().enumerate() {
            next.guesses[i] = Some(now.touch.contacts[i].n_O);
            let slip = contact.in_tangent(now.touch.rates[i].slip);
            if slip.length() > STILL * units.speed {
                next.towards[i] = contact.from_tangent(slip).normalize();
            }
        }
        next
    }
}

impl Evaluated {
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
