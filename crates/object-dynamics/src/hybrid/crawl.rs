//! Contacts that stick and slip too slowly for events: time stepping of velocities.
//!
//! Where sticking contacts are over-constrained and a palm begins to move, slips are so slow that their directions settle at once
//! and modes change without end. A step of length `h` asks for the velocity at its end instead, `v + h (free acceleration)` and
//! impulses that obey Coulomb's law with the slips at the end (Moreau 1988; Stewart and Trinkle 1996). It is implicit in the slip,
//! so that a slow slip is not stiff, and needs no order of events. Of order 1 in `h`; two half steps against one tell the error.

use super::error::ContactSimulationError as Error;
use super::field::Evaluated;
use super::packed::{Tallies, Units};
use super::project::{Guesses, Part, apply, projected};
use super::result::{ContactEvent, ContactEventKind as Kind};
use super::run::Run;
use crate::ContactMode;
use crate::contacts::{
    Choice, ContactProblem, ContactScene, Contacts, Impulses, MOST_PALMS, ModeError, Modes, SceneState,
};
use contact_kinematics::SupportFunction;
use glam::{DQuat, DVec3};

/// A contact takes part in a step if its gap could close within it at so many times its speed.
const REACH: f64 = 2.0;
/// Sticking contacts creep by this share of the tolerance: what makes their forces one.
const CREEP: f64 = 0.01;
/// A step grows and shrinks by at most these factors; the first leaves a margin to what the tolerance allows.
const MARGIN: f64 = 0.8;
const SHRINK: f64 = 0.1;
const GROW: f64 = 4.0;

/// Where time stepping stands.
#[derive(Clone, Copy)]
pub(super) struct Crawled {
    pub(super) state: SceneState,
    pub(super) tallies: Tallies,
    pub(super) blow_work: f64,
    pub(super) modes: Modes,
    /// Mean forces over the last step, in the axes of each contact, N: the start of the next search.
    forces: Impulses,
    /// The same in world axes, and the normals that they belong to.
    pushes: [DVec3; MOST_PALMS],
    normals: [DVec3; MOST_PALMS],
    guesses: Guesses,
}

/// The step over a time.
struct Step<'a, S> {
    scene: &'a ContactScene<S>,
    units: Units,
    /// Slip of sticking contacts that is allowed, as a share of the natural speed.
    creep: f64,
}

impl<S: SupportFunction> Step<'_, S> {
    fn taken(&self, from: &Crawled, h: f64) -> Result<Crawled, Error> {
        let (scene, t) = (self.scene, from.state.t);
        let contact = |source| Error::Contact { t, source };
        let touch = scene.contacts_at(&from.state, &from.guesses).map_err(contact)?;
        let problem = scene.problem(&from.state.body, &touch);
        let (velocities, touching) = over_time(&problem, &touch, &from.modes, h);
        let guess = from.forces.map(|f| f.map(|x| x * h));
        let (choice, impulses) = velocities.coulomb(&touching, &guess, self.creep / (h * self.units.rate)).ok_or_else(|| {
            Error::Modes { state: Box::new(from.state), source: ModeError::Inconsistent }
        })?;
        let mut next = self.moved(from, &touch, &velocities, &choice, h);
        for (i, now) in touch.contacts.iter().enumerate() {
            next.guesses[i] = Some(now.n_O);
            next.normals[i] = now.n;
        }
        next.pushes = choice.reaction.forces.map(|f| f / h);
        next.forces = impulses.map(|f| f.map(|x| x / h));
        next.modes = choice.modes;
        next.state = projected(
            scene,
            next.state,
            &choice.modes,
            &[None; MOST_PALMS],
            &next.guesses,
            self.units.length,
        )
        .map_err(contact)?;
        let after = scene.contacts_at(&next.state, &next.guesses).map_err(contact)?;
        self.tally(from, &mut next, &touch, &after, h);
        Ok(next)
    }

    /// Velocities by the impulses, positions by the mean velocity.
    fn moved(
        &self,
        from: &Crawled,
        touch: &Contacts,
        velocities: &ContactProblem,
        choice: &Choice,
        h: f64,
    ) -> Crawled {
        let mut next = *from;
        let before = from.state;
        apply(&mut next.state, velocities, &choice.reaction, Part::Velocity);
        for i in 0..self.scene.palms().len() {
            next.state.palms[i].velocity +=
                h * self.scene.free_palm_acceleration(i, &touch.palms[i], before.t);
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

    /// Works: the impulse along the mean of the velocities before and after.
    fn tally(&self, from: &Crawled, next: &mut Crawled, before: &Contacts, after: &Contacts, h: f64) {
        for i in 0..self.scene.palms().len() {
            let impulse = h * next.pushes[i];
            next.tallies.impulses[i] += impulse;
            let n = before.contacts[i].n;
            let slip = 0.5 * (before.rates[i].slip + after.rates[i].slip);
            let surface = 0.5 * (before.rates[i].surface_velocity + after.rates[i].surface_velocity);
            next.tallies.friction_work += impulse.reject_from_normalized(n).dot(slip);
            next.blow_work += impulse.dot(n) * n.dot(slip);
            next.tallies.palm_work += impulse.dot(surface);
        }
        let _ = from;
    }
}

/// The problem of velocities at the end of a step, and which contacts take part.
fn over_time(
    problem: &ContactProblem,
    touch: &Contacts,
    closed: &Modes,
    h: f64,
) -> (ContactProblem, [bool; MOST_PALMS]) {
    let mut touching = [false; MOST_PALMS];
    let mut motion = [DVec3::ZERO; MOST_PALMS];
    for (i, contact) in problem.contacts().iter().enumerate() {
        let (gap, slip) = (touch.contacts[i].gap.max(0.0), touch.rates[i].slip);
        let free = slip + h * (contact.free + contact.normal_bias * contact.n);
        let open = closed[i] == ContactMode::Off;
        touching[i] = !open || gap <= REACH * h * (slip.length() + h * contact.free.length());
        motion[i] = if open { free + gap / h * contact.n } else { free };
    }
    (problem.clone().after(h, |i| motion[i]), touching)
}

impl<S: SupportFunction, const N: usize> Run<'_, S, N> {
    /// Goes on by time stepping until slips are fast enough for events, all rests, or the last sample is reached.
    pub(super) fn crawl(&mut self, last: f64) -> Result<(), Error> {
        let (state, tallies) = self.units.unpack(self.t, &self.y);
        let step = Step { scene: self.scene, units: self.units, creep: CREEP * self.tolerance.absolute };
        let mut now = Crawled {
            state,
            tallies,
            blow_work: self.blow_work,
            modes: self.stretch.modes,
            forces: [[0.0; 3]; MOST_PALMS],
            pushes: [DVec3::ZERO; MOST_PALMS],
            normals: [DVec3::Z; MOST_PALMS],
            guesses: self.stretch.guesses,
        };
        let mut h = self.crawl_step();
        let floor = self.tolerance.absolute / self.units.rate;
        let debug = std::env::var_os("CRAWL").is_some();
        if debug { eprintln!("crawl from {} modes {:?}", self.t, &now.modes[..self.scene.palms().len()]); }
        let mut steps = 0usize;
        while self.t < last {
            let until = self.next_stop(self.t, last);
            let lands = h >= 0.999 * (until - self.t);
            let taken = if lands { until - self.t } else { h };
            let whole = step.taken(&now, taken)?;
            let half = step.taken(&now, 0.5 * taken)?;
            let mut next = step.taken(&half, 0.5 * taken)?;
            let error = self.apart(&whole, &next) / self.tolerance.absolute;
            let factor = (MARGIN / error.sqrt()).clamp(SHRINK, GROW);
            if debug && std::env::var("CRAWL").unwrap().len() > 1 {
                eprintln!("  t {:.9} h {:.2e} err {:.2e} {:?} slips {:?}", self.t, taken, error, &next.modes[..self.scene.palms().len()].iter().map(|m| m.letter()).collect::<String>(),
                  self.slips(&next));
            }
            if error > 1.0 && taken > floor {
                h = (taken * factor).max(floor);
                self.result.statistics.rejected += 1;
                continue;
            }
            self.extrapolate(&whole, &half, &mut next)?;
            if lands { next.state.t = until; }
            steps += 1;
            self.result.statistics.accepted += 1;
            let before = now.modes;
            now = next;
            (self.t, self.y, self.blow_work) =
                (now.state.t, self.units.pack(&now.state, &now.tallies), now.blow_work);
            self.note_changes(&before, &now.modes);
            if !lands || factor < 1.0 { h = (taken * factor).max(floor); }
            while self.result.instants.len() < self.count && self.result.instants.len() as f64 / self.sample_rate <= self.t {
                self.crawled_sample(&now)?;
            }
            if self.may_leave(&now, taken)? {
                break;
            }
        }
        if debug { eprintln!("crawl to {} steps {steps} modes {:?}", self.t, &self.stretch.modes[..self.scene.palms().len()]); }
        Ok(())
    }

    /// Takes out the error of first order, where the modes are the same all along.
    fn extrapolate(&self, whole: &Crawled, half: &Crawled, next: &mut Crawled) -> Result<(), Error> {
        if whole.modes != next.modes || half.modes != next.modes {
            return Ok(());
        }
        let t = next.state.t;
        let one: [f64; N] = self.units.pack(&whole.state, &whole.tallies);
        let two: [f64; N] = self.units.pack(&next.state, &next.tallies);
        let y: [f64; N] = std::array::from_fn(|k| 2.0 * two[k] - one[k]);
        let (state, tallies) = self.units.unpack(t, &y);
        let state = projected(self.scene, state, &next.modes, &[None; MOST_PALMS], &next.guesses, self.units.length)
            .map_err(|source| Error::Contact { t, source })?;
        next.blow_work += next.blow_work - whole.blow_work;
        (next.state, next.tallies) = (state, tallies);
        Ok(())
    }

    fn slips(&self, at: &Crawled) -> Vec<f64> {
        let touch = self.scene.contacts_at(&at.state, &at.guesses).unwrap();
        touch.rates.iter().map(|r| (r.slip.length()/self.units.speed * 1e12).round() * 1e-12).collect()
    }

    /// The step whose error at the natural acceleration is the tolerance, s.
    pub(super) fn crawl_step(&self) -> f64 {
        (2.0 * self.tolerance.absolute).sqrt() / self.units.rate
    }

    fn next_stop(&self, t: f64, last: f64) -> f64 {
        let sample = self.result.instants.len() as f64 / self.sample_rate;
        let next = self.joints.partition_point(|joint| *joint <= t);
        let joint = self.joints.get(next).copied().unwrap_or(last);
        last.min(sample).min(joint)
    }

    fn apart(&self, one: &Crawled, other: &Crawled) -> f64 {
        let a: [f64; N] = self.units.pack(&one.state, &Tallies::default());
        let b: [f64; N] = self.units.pack(&other.state, &Tallies::default());
        a.iter().zip(&b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    }

    fn note_changes(&mut self, before: &Modes, after: &Modes) {
        for i in 0..self.scene.palms().len() {
            let kind = match (before[i], after[i]) {
                (a, b) if a == b => continue,
                (ContactMode::Off, _) => Kind::Touches,
                (_, ContactMode::Off) => Kind::Lifts,
                (_, ContactMode::Slide) => Kind::ConeLeft,
                (_, ContactMode::Stick) => Kind::SlipEnds,
            };
            let modes = after[..self.scene.palms().len()].to_vec();
            self.result.events.push(ContactEvent { t: self.t, palm: i, kind, modes });
        }
        self.stretch.modes = *after;
    }

    fn crawled_sample(&mut self, now: &Crawled) -> Result<(), Error> {
        let contact = |source| Error::Contact { t: now.state.t, source };
        let touch = self.scene.contacts_at(&now.state, &now.guesses).map_err(contact)?;
        let problem = self.scene.problem(&now.state.body, &touch);
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        for (i, at) in problem.contacts().iter().enumerate() {
            forces[i] = DQuat::from_rotation_arc(now.normals[i], at.n) * now.pushes[i];
        }
        let reaction = Some(problem.reaction(forces));
        let directions = crate::contacts::NO_DIRECTIONS;
        let evaluated =
            Evaluated { state: now.state, tallies: now.tallies, touch, problem, directions, reaction };
        let modes = &now.modes[..self.scene.palms().len()];
        let instant = evaluated.into_instant(modes, now.blow_work);
        self.result.instants.extend(instant);
        Ok(())
    }

    /// Whether event-driven simulation can go on from here: it then has its modes.
    fn may_leave(&mut self, now: &Crawled, h: f64) -> Result<bool, Error> {
        let contact = |source| Error::Contact { t: now.state.t, source };
        let touch = self.scene.contacts_at(&now.state, &now.guesses).map_err(contact)?;
        let problem = self.scene.problem(&now.state.body, &touch);
        for (i, at) in problem.contacts().iter().enumerate() {
            if now.modes[i] == ContactMode::Slide {
                let friction = at.in_tangent(now.pushes[i]).length();
                let slip = at.in_tangent(touch.rates[i].slip).length();
                if slip <= h * friction * problem.own_response(i) {
                    return Ok(false);
                }
            }
        }
        let closed = now.modes.map(|mode| mode != ContactMode::Off);
        let kept = self.stretch;
        self.stretch.guesses = now.guesses;
        match self.settle(now.state, &now.tallies, &closed, None) {
            Ok(exact) if exact && self.stretch.modes == now.modes => Ok(true),
            _ => {
                self.stretch = kept;
                (self.t, self.y, self.blow_work) =
                    (now.state.t, self.units.pack(&now.state, &now.tallies), now.blow_work);
                Ok(false)
            }
        }
    }
}
