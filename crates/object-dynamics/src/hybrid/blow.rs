//! A blow: impulses in the friction cones that leave no approaching contact.

use super::project::{Part, apply};
use crate::ContactMode;
use crate::contacts::{ContactScene, Contacts, MOST_PALMS, ModeError, Modes, Reaction, SceneState, Touch};
use contact_kinematics::SupportFunction;

/// The state after an inelastic blow on the `closed` contacts, and its impulses.
///
/// The final velocity obeys the same laws as an acceleration does: a contact sticks with its impulse in the cone, slides with
/// the impulse against its final slip, or leaves without one. Every closed contact takes part, those that did not approach
/// as well.
pub(super) fn blow<S: SupportFunction>(
    scene: &ContactScene<S>,
    state: &SceneState,
    touch: &Contacts,
    closed: &[bool; MOST_PALMS],
) -> Result<(SceneState, Reaction), ModeError> {
    let problem = scene.problem(&state.body, touch).of_motion(|i| touch.rates[i].slip);
    let mut touches = [Touch::Apart; MOST_PALMS];
    let mut present: Modes = [ContactMode::Off; MOST_PALMS];
    for i in 0..touch.contacts.len() {
        if closed[i] {
            touches[i] = Touch::Rests;
            present[i] = ContactMode::Slide;
        }
    }
    let choice = problem.choose(&touches, &present, None)?;
    let mut after = *state;
    apply(&mut after, &problem, &choice.reaction, Part::Velocity);
    Ok((after, choice.reaction))
}
