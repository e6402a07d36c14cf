//! A step in time of velocities: implicit in the slip.
//!
//! The velocity at the end of a step of length `h` is `v + h (free acceleration)` and what impulses add that obey Coulomb's law
//! with the slips at the end (Moreau 1988; Stewart and Trinkle 1996). Every closed contact takes part, and those that may close.

use super::error::ContactSimulationError as Error;
use super::packed::{Tallies, Units};
use super::project::{Guesses, Part, apply, projected};
use crate::ContactMode;
use crate::contacts::{
    Choice, ContactProblem, ContactScene, Contacts, Forces, MOST_PALMS, ModeError, Modes, SceneState, Search,
    Touch,
};
use contact_kinematics::SupportFunction;
use glam::{DQuat, DVec3};

/// An open contact takes part in a step if its gap could close within it at so many times its speed.
const REACH: f64 = 2.0;
/// Starts of the search for impulses where none follow from those of the last step.
const STARTS: u32 = 1000;

/// Where time stepping stands.
#[derive(Clone, Copy)]
pub(super) struct Stepped {
    pub(super) state: SceneState,
    pub(super) tallies: Tallies,
    pub(super) blow_work: f64,
    pub(super) modes: Modes,
    /// Mean forces over the last step, world, N, and the palm's normals that they belong to.
    pub(super) forces: [DVec3; MOST_PALMS],
    pub(super) normals: [DVec3; MOST_PALMS],
    pub(super) guesses: Guesses,
    /// The forces along the axes of their contacts: where the next search begins.
    along: Forces,
}

impl Stepped {
    pub(super) fn new(
        state: SceneState,
        tallies: Tallies,
        blow_work: f64,
        modes: Modes,
        guesses: Guesses,
    ) -> Self {
        let (forces, normals) = ([DVec3::ZERO; MOST_PALMS], [DVec3::Z; MOST_PALMS]);
        let along = [[0.0; 3]; MOST_PALMS];
        Self { state, tallies, blow_work, modes, forces, normals, guesses, along }
    }
}

/// What takes steps.
pub(super) struct Stepper<'a, S> {
    pub(super) scene: &'a ContactScene<S>,
    pub(super) units: Units,
    /// Slip of sticking contacts that is allowed, m/s.
    pub(super) creep: f64,
}

impl<S: SupportFunction> Stepper<'_, S> {
    /// One step of length `h`.
    pub(super) fn step(&self, from: &Stepped, h: f64) -> Result<Stepped, Error> {
        let (scene, t) = (self.scene, from.state.t);
        let contact = |source| Error::Contact { t, source };
        let before = scene.contacts_at(&from.state, &from.guesses).map_err(contact)?;
        let problem = scene.problem(&from.state.body, &before);
        let (velocities, touches) = over_time(&problem, &before, &from.modes, h);
        let guess = from.along.map(|force| force.map(|part| part * h));
        let contacts = velocities.contacts().iter().zip(touches);
        let free =
            contacts.filter(|(_, touch)| *touch != Touch::Apart).map(|(contact, _)| contact.free.length());
        let creep = (self.creep / free.fold(f64::MIN_POSITIVE, f64::max)).min(1.0);
        let found = velocities.coulomb(&touches, &guess, Search { creep, starts: STARTS });
        let (choice, impulses) = found
            .ok_or_else(|| Error::Modes { state: Box::new(from.state), source: ModeError::Inconsistent })?;
        let mut next = self.moved(from, &before, &velocities, &choice, h);
        for (i, now) in before.contacts.iter().enumerate() {
            (next.guesses[i], next.normals[i]) = (Some(now.n_O), now.n);
        }
        next.modes = choice.modes;
        next.forces = choice.reaction.forces.map(|impulse| impulse / h);
        next.along = impulses.map(|impulse| impulse.map(|part| part / h));
        next.state = self.held(next.state, &next).map_err(contact)?;
        let after = scene.contacts_at(&next.state, &next.guesses).map_err(contact)?;
        self.tally(&mut next, &before, &after, h);
        Ok(next)
    }

    /// A step and two halves of it: the state after the halves, and after the whole one for comparison.
    ///
    /// Where the modes are the same all along the error of first order is taken out.
    pub(super) fn halved<const M: usize>(&self, from: &Stepped, h: f64) -> Result<(Stepped, f64), Error> {
        let whole = self.step(from, h)?;
        let half = self.step(from, 0.5 * h)?;
        let mut next = self.step(&half, 0.5 * h)?;
        let packed = |at: &Stepped, tallies: &Tallies| self.units.pack::<M>(&at.state, tallies);
        let none = Tallies::default();
        let pairs = packed(&whole, &none).into_iter().zip(packed(&next, &none));
        let apart = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        if whole.modes == next.modes && half.modes == next.modes {
            let (one, two) = (packed(&whole, &whole.tallies), packed(&next, &next.tallies));
            let better: [f64; M] = std::array::from_fn(|k| 2.0 * two[k] - one[k]);
            let (state, tallies) = self.units.unpack(next.state.t, &better);
            let contact = |source| Error::Contact { t: state.t, source };
            next.state = self.held(state, &next).map_err(contact)?;
            next.tallies = tallies;
            next.blow_work += next.blow_work - whole.blow_work;
        }
        Ok((next, apart))
    }

    fn held(&self, state: SceneState, at: &Stepped) -> Result<SceneState, crate::contacts::PalmContactError> {
        let none = [None; MOST_PALMS];
        projected(self.scene, state, &at.modes, &none, &at.guesses, self.units.length)
    }

    /// Velocities by the impulses, positions by the mean velocity.
    fn moved(
        &self,
        from: &Stepped,
        touch: &Contacts,
        velocities: &ContactProblem,
        choice: &Choice,
        h: f64,
    ) -> Stepped {
        let mut next = *from;
        let before = from.state;
        apply(&mut next.state, velocities, &choice.reaction, Part::Velocity);
        for (i, palm) in touch.palms.iter().enumerate() {
            next.state.palms[i].velocity += h * self.scene.free_palm_acceleration(i, palm, before.t);
        }
        let (old, new) = (before.body, &mut next.state.body);
        new.p_WCm += 0.5 * h * (old.v_WCm + new.v_WCm);
        let turn = DQuat::from_scaled_axis(0.5 * h * (old.w_WO + new.w_WO));
        new.R_WO = (turn * old.R_WO).normalize();
        for (old, new) in before.palms.iter().zip(&mut next.state.palms) {
            new.position += 0.5 * h * (old.velocity + new.velocity);
        }
        next.state.t = before.t + h;
        next
    }

    /// Works: impulses along the mean of the velocities before and after. What they do along a normal is that of a blow.
    fn tally(&self, next: &mut Stepped, before: &Contacts, after: &Contacts, h: f64) {
        for i in 0..self.scene.palms().len() {
            let (impulse, n) = (h * next.forces[i], before.contacts[i].n);
            let [a, b] = [before, after].map(|touch| &touch.rates[i]);
            let (slip, surface) = (0.5 * (a.slip + b.slip), 0.5 * (a.surface_velocity + b.surface_velocity));
            next.tallies.impulses[i] += impulse;
            next.tallies.palm_work += impulse.dot(surface);
            next.tallies.friction_work += impulse.reject_from_normalized(n).dot(slip);
            next.blow_work += impulse.dot(n) * n.dot(slip);
        }
    }
}

/// The problem of the velocities at the end of a step, and which contacts take part.
fn over_time(
    problem: &ContactProblem,
    touch: &Contacts,
    modes: &Modes,
    h: f64,
) -> (ContactProblem, [Touch; MOST_PALMS]) {
    let mut touches = [Touch::Apart; MOST_PALMS];
    let mut motion = [DVec3::ZERO; MOST_PALMS];
    for (i, contact) in problem.contacts().iter().enumerate() {
        let slip = touch.rates[i].slip;
        motion[i] = slip + h * (contact.free + contact.normal_bias * contact.n);
        let gap = touch.contacts[i].gap.max(0.0);
        let open = modes[i] == ContactMode::Off;
        if open {
            // What is left of the gap may close within the step.
            motion[i] += gap / h * contact.n;
        }
        if !open || gap <= REACH * h * (slip.length() + h * contact.free.length()) {
            touches[i] = Touch::Rests;
        }
    }
    (problem.clone().after(h, |i| motion[i]), touches)
}
