//! Contacts that stick and slip too slowly for events are followed by time stepping.
//!
//! Where over-constrained sticking comes loose, slips are so slow that their directions settle at once (at the rate
//! `mu f / (m slip)`) and modes change without end. Steps in time of velocities are implicit in the slip and need no order of
//! events. They end where slips are so fast that friction cannot change them much within a step, or where all rests.

use super::error::ContactSimulationError as Error;
use super::field::Evaluated;
use super::result::{ContactEvent, ContactEventKind as Kind};
use super::run::{MOST_STEPS, Run};
use super::step::{Stepped, Stepper};
use crate::ContactMode;
use crate::contacts::{MOST_PALMS, Modes, NO_DIRECTIONS};
use crate::integrate::IntegrationError;
use contact_kinematics::{SupportFunction, is_stopped};
use glam::{DQuat, DVec3};

/// Sticking contacts creep by this share of the tolerance: what makes their forces one.
const CREEP: f64 = 0.01;
/// The smallest local error that time stepping is asked for. Sticking contacts creep by 1e-12 of the natural speed then; with a hundredth of
/// that, over-constrained ones whose forces creep alone makes one took forces that were off by a tenth, and 3.6 times as long.
const FINEST: f64 = 1e-10;
/// What is left of the longest step that the tolerance allows, and the factors by which steps change at most.
const MARGIN: f64 = 0.8;
const SHRINK: f64 = 0.1;
const GROW: f64 = 4.0;
/// A step that comes so near to a sample or a joint ends there.
const LANDS: f64 = 0.999;

impl<S: SupportFunction, const N: usize> Run<'_, S, N> {
    /// Goes on by time stepping until events can take over, or to the time `last`.
    ///
    /// Two halves of each step against the whole one tell its error, which is kept within the tolerance; a step as long as the
    /// tolerance in natural units is taken whatever it says: over a jump of the velocity it errs by no more than that.
    pub(super) fn crawl(&mut self, last: f64) -> Result<(), Error> {
        let tolerance = self.crawl_tolerance();
        let stepper =
            Stepper { scene: self.scene, units: self.units, creep: CREEP * tolerance * self.units.speed };
        let (state, tallies) = self.units.unpack(self.t, &self.y);
        let mut now = Stepped::new(state, tallies, self.blow_work, self.stretch.modes, self.stretch.guesses);
        let (mut h, shortest) = (self.crawl_step(), tolerance / self.units.rate);
        // Of order 1 it takes many steps: four times those that are as long as the tolerance allows.
        let share = (0.25 * MOST_STEPS as f64 * self.crawl_step() * self.units.rate).min(1.0);
        while self.t < last {
            if is_stopped() {
                return Err(Error::Integration(IntegrationError::Stopped { t: self.t }));
            }
            self.pace(self.t, &self.y.clone(), share)?;
            let until = self.next_stop(last, shortest);
            let left = until - self.t;
            let lands = h >= LANDS * left;
            // Not a step of next to nothing at the end: forces are impulses over the step.
            let taken = if lands { left } else { h.min(0.5 * left) };
            let (mut next, apart) = stepper.halved::<N>(&now, taken)?;
            let factor = (MARGIN * (tolerance / apart).sqrt()).clamp(SHRINK, GROW);
            if apart > tolerance && taken > shortest {
                h = (taken * factor).max(shortest);
                self.result.statistics.rejected += 1;
                continue;
            }
            if lands {
                next.state.t = until;
            }
            // A step that a sample has cut short says nothing against longer ones.
            if taken == h || factor < 1.0 {
                h = (taken * factor).max(shortest);
            }
            let before = std::mem::replace(&mut now, next).modes;
            self.crawled(&before, &now)?;
            if self.is_over(&now, taken)? {
                break;
            }
        }
        Ok(())
    }

    /// The step whose error at the natural acceleration is the tolerance, s.
    pub(super) fn crawl_step(&self) -> f64 {
        (2.0 * self.crawl_tolerance()).sqrt() / self.units.rate
    }

    /// The local error that steps are held to: the tolerance, or what rounding leaves of it.
    fn crawl_tolerance(&self) -> f64 {
        self.tolerance.absolute.max(FINEST)
    }

    /// The next sample, joint of a palm's motion or end; a joint less than the `shortest` step before one of them is passed.
    fn next_stop(&self, last: f64, shortest: f64) -> f64 {
        let sample = last.min(self.result.instants.len() as f64 / self.sample_rate);
        let next = self.joints.partition_point(|joint| *joint <= self.t + shortest);
        self.joints.get(next).copied().filter(|joint| joint + shortest < sample).unwrap_or(sample)
    }

    /// Takes over what a step has led to: state, changes of modes and samples.
    fn crawled(&mut self, before: &Modes, now: &Stepped) -> Result<(), Error> {
        self.result.statistics.accepted += 1;
        self.stand(now);
        for i in 0..self.scene.palms().len() {
            let kind = match (before[i], now.modes[i]) {
                (a, b) if a == b => continue,
                (ContactMode::Off, _) => Kind::Touches,
                (_, ContactMode::Off) => Kind::Lifts,
                (_, ContactMode::Slide) => Kind::ConeLeft,
                (_, ContactMode::Stick) => Kind::SlipEnds,
            };
            let modes = now.modes[..self.scene.palms().len()].to_vec();
            self.result.events.push(ContactEvent { t: self.t, palm: i, kind, modes });
        }
        let due = self.result.instants.len() as f64 / self.sample_rate;
        if self.result.instants.len() < self.count && due <= self.t {
            self.crawled_sample(now)?;
        }
        Ok(())
    }

    fn stand(&mut self, now: &Stepped) {
        (self.t, self.y) = (now.state.t, self.units.pack(&now.state, &now.tallies));
        self.blow_work = now.blow_work;
        (self.stretch.modes, self.stretch.guesses) = (now.modes, now.guesses);
    }

    /// The instant at the end of a step: its forces are the means over the step, turned along with the palms' normals.
    fn crawled_sample(&mut self, now: &Stepped) -> Result<(), Error> {
        let contact = |source| Error::Contact { t: now.state.t, source };
        let touch = self.scene.contacts_at(&now.state, &now.guesses).map_err(contact)?;
        let problem = self.scene.problem(&now.state.body, &touch);
        let mut forces = [DVec3::ZERO; MOST_PALMS];
        for (i, at) in problem.contacts().iter().enumerate() {
            forces[i] = DQuat::from_rotation_arc(now.normals[i], at.n) * now.forces[i];
        }
        let reaction = Some(problem.reaction(forces));
        let (state, tallies, directions) = (now.state, now.tallies, NO_DIRECTIONS);
        let evaluated = Evaluated { state, tallies, touch, problem, directions, reaction };
        let modes = &now.modes[..self.scene.palms().len()];
        self.result.instants.extend(evaluated.into_instant(modes, now.blow_work));
        Ok(())
    }

    /// Whether events can take over after a step of length `h`; the run then stands ready for that.
    ///
    /// Each slip must be faster than what friction changes within a step, and the modes must hold for the accelerations as well.
    fn is_over(&mut self, now: &Stepped, h: f64) -> Result<bool, Error> {
        let contact = |source| Error::Contact { t: now.state.t, source };
        let touch = self.scene.contacts_at(&now.state, &now.guesses).map_err(contact)?;
        let problem = self.scene.problem(&now.state.body, &touch);
        for (i, at) in problem.contacts().iter().enumerate() {
            let friction = at.in_tangent(now.forces[i]).length();
            let slip = at.in_tangent(touch.rates[i].slip).length();
            if now.modes[i] == ContactMode::Slide && slip <= h * friction * problem.own_response(i) {
                return Ok(false);
            }
        }
        let closed = now.modes.map(|mode| mode != ContactMode::Off);
        let settled = self.settle(now.state, &now.tallies, &closed, None);
        if matches!(settled, Ok(exact) if exact && self.stretch.modes == now.modes) {
            return Ok(true);
        }
        self.stand(now);
        Ok(false)
    }
}
