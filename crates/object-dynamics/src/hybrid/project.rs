//! Pulls a state back onto its contacts: gaps closed, no rate of a gap, no slip where a contact sticks.

use crate::contacts::{
    ContactProblem, ContactScene, MOST_PALMS, Modes, NO_DIRECTIONS, PalmContactError, Reaction, SceneState,
};
use crate::{BodyState, ContactMode};
use contact_kinematics::{Direction, SupportFunction};
use glam::{DQuat, DVec3};

/// Rounds of the position's projection: it converges quadratically from the integrator's error.
const ROUNDS: u32 = 3;

/// Normals of the body at the contacts, body axes, where they are known.
pub(super) type Guesses = [Option<Direction>; MOST_PALMS];

/// Slip directions of contacts that have just begun to slide, world axes.
pub(super) type Along = [Option<DVec3>; MOST_PALMS];

/// The state with every contact of `modes` held, by the smallest change as the masses weigh it.
///
/// A contact with a direction in `along` slips in that direction alone.
pub(super) fn projected<S: SupportFunction>(
    scene: &ContactScene<S>,
    mut state: SceneState,
    modes: &Modes,
    along: &Along,
    guesses: &Guesses,
    size: f64,
) -> Result<SceneState, PalmContactError> {
    let held = |mode: &ContactMode| *mode != ContactMode::Off;
    if !modes.iter().any(held) {
        return Ok(state);
    }
    let closed = modes.map(|mode| if held(&mode) { ContactMode::Slide } else { mode });
    for _ in 0..ROUNDS {
        let touch = scene.contacts_at(&state, guesses)?;
        let open = (0..scene.palms().len()).filter(|&i| held(&modes[i]));
        let worst = open.map(|i| touch.contacts[i].gap.abs()).fold(0.0, f64::max);
        if worst <= 4.0 * f64::EPSILON * size {
            break;
        }
        let gap = |i: usize| touch.contacts[i].gap * touch.contacts[i].n;
        let problem = scene.problem(&state.body, &touch).of_motion(gap).smooth();
        let Ok(change) = problem.solve(&closed, &NO_DIRECTIONS) else { break };
        apply(&mut state, &problem, &change, Part::Position);
    }
    let touch = scene.contacts_at(&state, guesses)?;
    let mut rows = *modes;
    let slip = |i: usize| {
        let slip = touch.rates[i].slip;
        along[i].map_or(slip, |tau| slip - slip.dot(tau) * tau)
    };
    for i in 0..rows.len() {
        if along[i].is_some() {
            rows[i] = ContactMode::Stick;
        }
    }
    let problem = scene.problem(&state.body, &touch).of_motion(slip).smooth();
    if let Ok(change) = problem.solve(&rows, &NO_DIRECTIONS) {
        apply(&mut state, &problem, &change, Part::Velocity);
    }
    Ok(state)
}

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Part {
    Position,
    Velocity,
}

/// Changes position or velocity of body and palms by what forces of a problem do.
pub(super) fn apply(state: &mut SceneState, problem: &ContactProblem, change: &Reaction, part: Part) {
    let BodyState { p_WCm, R_WO, v_WCm, w_WO } = &mut state.body;
    match part {
        Part::Position => {
            *p_WCm += change.a;
            *R_WO = (DQuat::from_scaled_axis(change.alpha) * *R_WO).normalize();
        }
        Part::Velocity => {
            *v_WCm += change.a;
            *w_WO += change.alpha;
        }
    }
    for (i, contact) in problem.contacts().iter().enumerate() {
        let coordinates = &mut state.palms[i];
        let coordinate = match part {
            Part::Position => &mut coordinates.position,
            Part::Velocity => &mut coordinates.velocity,
        };
        *coordinate -= contact.yields.coordinates(change.forces[i]);
    }
}
