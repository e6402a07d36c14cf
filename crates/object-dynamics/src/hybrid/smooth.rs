//! Smooth motion with the same modes, up to the first event.

use super::error::ContactSimulationError as Error;
use super::events::{Crossing, first_crossing};
use super::field::Evaluated;
use super::gaps::{Gaps, any_dips};
use super::guards::{Guards, suspicious};
use super::project::projected;
use super::result::ContactEventKind;
use super::run::{Reached, Run};
use crate::ContactMode;
use crate::integrate::{Dop853, IntegrationError};
use contact_kinematics::SupportFunction;
use std::cell::Cell;

/// A slip that ends must have fallen below this share of the natural speed: else its direction has only turned by a right
/// angle within a step, and the step is taken again, shorter.
const SLIP_ENDED: f64 = 1e-4;

/// Local errors of the state below this are rounding: some 50 units of it, as the error estimate has.
const ROUNDING: f64 = 1e-14;

/// Steps and events within one step of time stepping that take more work than that.
const CROWDED: usize = 50;

impl<S: SupportFunction, const N: usize> Run<'_, S, N> {
    /// Integrates with the present modes up to `limit` or the first event.
    pub(super) fn stretch_until(&mut self, limit: f64) -> Result<Reached, Error> {
        let (scene, units) = (self.scene, self.units);
        let now = Cell::new(self.stretch);
        let (doubt, at_start) = (Cell::new(false), Cell::new(Guards::default()));
        let (failed, latest) = (Cell::new(None), Cell::new(Gaps::default()));
        let field = |t: f64, y: &[f64; N]| {
            if !y.iter().all(|v| v.is_finite()) {
                return Ok([f64::NAN; N]);
            }
            let stretch = now.get();
            let evaluated = match stretch.evaluate(scene, &units, units.unpack(t, y)) {
                Ok(evaluated) => evaluated,
                // A step that is tried may reach into a palm, and is then taken again, shorter.
                Err(error) => {
                    failed.set(Some(error));
                    return Ok([f64::NAN; N]);
                }
            };
            if suspicious(&stretch.guards(&evaluated, &units), &at_start.get()) {
                doubt.set(true);
            }
            latest.set(stretch.gaps(&evaluated));
            Ok(evaluated.rates(scene, &units))
        };
        let mut solver = Dop853::new(field, self.t, self.y, self.tolerance).map_err(Error::Integration)?;
        let reached = loop {
            let (t, y) = (solver.time(), *solver.state());
            if t >= limit {
                (self.t, self.y) = (t, y);
                break Reached::Limit;
            }
            self.pace(t, &y, 1.0)?;
            if self.crowded(t, 1) {
                (self.t, self.y) = (t, y);
                break Reached::Crowded;
            }
            let evaluated = self.evaluated(t, &y)?;
            self.check_wedging(&evaluated)?;
            self.stretch = self.stretch.renewed(&evaluated, &units);
            now.set(self.stretch);
            at_start.set(self.stretch.guards(&evaluated, &units));
            doubt.set(false);
            failed.set(None);
            solver.set_shares(units.velocities(self.share_of_velocities(&evaluated)));
            // A table of poses has a joint at every row: thousands of them.
            let next = self.joints.partition_point(|joint| *joint <= t);
            let next_joint = self.joints.get(next).copied().unwrap_or(limit);
            let (gaps, longest) =
                (self.stretch.gaps(&evaluated), self.stretch.longest_step(scene, &evaluated, &units));
            let project = |t: f64, y: &mut [f64; N]| self.project(t, y);
            if let Err(error) = solver.step_onto(limit.min(next_joint).min(t + longest), project) {
                return Err(match (&error, failed.get()) {
                    (IntegrationError::NotFinite { t }, Some(source)) => Error::Contact { t: *t, source },
                    _ => self.stuck(&evaluated, error),
                });
            }
            let (end, next_sample) = (solver.time(), self.result.instants.len() as f64 / self.sample_rate);
            // The field was seen last at the end of the step.
            if any_dips(&gaps, &latest.get(), end - t) {
                doubt.set(true);
            }
            if !doubt.get() && next_sample > end {
                continue;
            }
            let Some(dense) = solver.dense().map_err(Error::Integration)? else { continue };
            let crossing = match doubt.get() {
                true => first_crossing(&self.stretch, scene, &units, &dense, (at_start.get(), gaps))
                    .map_err(|source| Error::Contact { t, source })?,
                false => None,
            };
            let until = crossing.map_or(end, |c| c.t);
            if let Some(c) = &crossing
                && c.kind == ContactEventKind::SlipEnds
                && !self.slip_has_ended(c, &dense.at(c.t))?
                && c.t - t > 1e-12 * end.abs()
            {
                (self.t, self.y) = (t, y);
                break Reached::Again(t + 0.25 * (c.t - t));
            }
            while self.result.instants.len() < self.count {
                let sample = self.result.instants.len() as f64 / self.sample_rate;
                if sample > until {
                    break;
                }
                let state = if sample == end { *solver.state() } else { dense.at(sample) };
                self.sample(sample, &state)?;
            }
            if let Some(crossing) = crossing {
                (self.t, self.y) =
                    (crossing.t, if crossing.t == end { *solver.state() } else { dense.at(crossing.t) });
                break Reached::Event(crossing);
            }
        };
        let done = solver.statistics();
        let sum = &mut self.result.statistics;
        sum.evaluations += done.evaluations;
        sum.accepted += done.accepted;
        sum.rejected += done.rejected;
        Ok(reached)
    }

    /// The share of the tolerance that velocities are held to in the next step: it is one of the directions of slow slips as well,
    /// in rad, since friction turns with them.
    ///
    /// Without that a slip of 1e-6 natural speeds turns by 0.01 at a tolerance of 1e-8: forces of contacts that stick beside it
    /// leave their cones and come back, and events follow that are none.
    fn share_of_velocities(&self, now: &Evaluated) -> f64 {
        let contacts = now.problem.contacts().iter().enumerate();
        let slowest = contacts.fold(1.0, |slowest, (i, contact)| {
            let slip = now.touch.rates[i].slip;
            let slides = self.stretch.modes[i] == ContactMode::Slide && contact.friction > 0.0;
            if slides && !self.stretch.begins(i, &now.problem, slip, &self.units) {
                f64::min(slowest, contact.in_tangent(slip).length() / self.units.speed)
            } else {
                slowest
            }
        });
        slowest.max(ROUNDING / self.tolerance.absolute).min(1.0)
    }

    /// Pulls a packed state back onto the contacts; where that fails it stays, and the next evaluation tells why.
    fn project(&self, t: f64, y: &mut [f64; N]) {
        let (state, tallies) = self.units.unpack(t, y);
        let (stretch, size) = (&self.stretch, self.units.length);
        let Ok(along) = stretch.beginning(self.scene, &self.units, (state, tallies)) else { return };
        if let Ok(state) = projected(self.scene, state, &stretch.modes, &along, &stretch.guesses, size) {
            *y = self.units.pack(&state, &tallies);
        }
    }

    fn slip_has_ended(&self, crossing: &Crossing, y: &[f64; N]) -> Result<bool, Error> {
        let now = self.evaluated(crossing.t, y)?;
        let slip = now.touch.contacts[crossing.palm].in_tangent(now.touch.rates[crossing.palm].slip);
        Ok(slip.length() < SLIP_ENDED * self.units.speed)
    }

    pub(super) fn check_wedging(&self, now: &Evaluated) -> Result<(), Error> {
        let minor = now.problem.smallest_sliding_minor(&self.stretch.modes, &now.directions);
        if minor > 0.0 {
            return Ok(());
        }
        let source = now.problem.not_p(&self.stretch.modes, minor);
        Err(Error::Modes { state: Box::new(now.state), source })
    }

    /// An integrator that cannot go on near a critical friction is told as that.
    fn stuck(&self, now: &Evaluated, error: IntegrationError<crate::contacts::PalmContactError>) -> Error {
        let minor = now.problem.smallest_sliding_minor(&self.stretch.modes, &now.directions);
        if minor < 1e-2 {
            let source = now.problem.not_p(&self.stretch.modes, minor);
            return Error::Modes { state: Box::new(now.state), source };
        }
        match error {
            IntegrationError::StepTooSmall { .. } => self.too_slow(&now.state),
            other => Error::Integration(other),
        }
    }

    /// Whether events and steps have become so many in so little time that time stepping needs fewer.
    pub(super) fn crowded(&mut self, t: f64, work: usize) -> bool {
        if t - self.work.0 > self.crawl_step() {
            self.work = (t, 0);
        }
        self.work.1 += work;
        self.work.1 > CROWDED
    }
}
