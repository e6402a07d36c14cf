//! The loop: a phase, its event, the modes after it.

use super::decide::Question;
use super::error::{ContactSimulationError, FieldError};
use super::events::End;
use super::phase::Phase;
use super::result::{ContactEvent, ContactSimulation};
use super::start::ContactStart;
use super::state::{BodyState, LENGTH, TIME, Vector};
use super::tracker::Tracker;
use crate::integrate::{Dop853, IntegrationError, Statistics, Tolerance};
use crate::planar::contacts::{ContactScene, ModeError, PlanarMode, letters};
use contact_kinematics::planar::RadiusFunction;

/// Absolute tolerance against the relative one: lengths, speeds and energies of a scene are not far below 1e-2.
const ABSOLUTE_SHARE: f64 = 1e-2;
/// Share of its size by which the body, or a palm at its place, may move in one step, so that no contact is passed by.
const STEP_SHARE: f64 = 0.25;
/// Angle by which body and a palm together may turn and swing in one step while a gap may close, rad: between eight looks at it the gap is then a
/// polynomial of low degree.
const TURN: f64 = 0.5;
/// Changes of modes within one natural time after which they are taken to have no end. A body that rattles to rest in
/// a wedge takes some tens, with much friction some hundreds.
const MOST_CHANGES: usize = 5_000;
/// Steps within one natural time after which the integrator is taken to stand still: smooth motion takes some tens.
const MOST_STEPS: usize = 10_000;
/// A principal minor below this, where the integrator cannot go on, is why: forces are a hundred times what they were.
const CRITICAL: f64 = 1e-2;

impl<S: RadiusFunction> ContactScene<S> {
    /// Simulates from `start` at the first of `times` (s) through every change of modes, sampled at `times`.
    ///
    /// Smooth motion by DOP853 with the forces of the present modes, to the relative `tolerance` per step, pulled
    /// back onto the contacts after each; changes of modes are located on its dense output, and the modes after each
    /// are the consistent ones. Blows are inelastic.
    ///
    /// # Errors
    /// [`ContactSimulationError`]; where rigid bodies with friction have no motion, or several, the state is named.
    pub fn simulate(
        &self,
        start: &ContactStart,
        times: &[f64],
        tolerance: f64,
    ) -> Result<ContactSimulation, ContactSimulationError> {
        check_times(times)?;
        let tracker = Tracker::new(self);
        tracker.check_overlap(times[0])?;
        tracker.check_start(times[0], start)?;
        let mut y = [0.0; LENGTH];
        start.body.write(&mut y);
        y[TIME] = times[0];
        let mut present = vec![PlanarMode::Off; self.palms().len()];
        for &palm in &start.contacts {
            // Whether it slides or sticks is asked for at once.
            present[palm] = PlanarMode::Slide { sense: 0.0 };
        }
        let mut joints: Vec<f64> = self.palms().iter().flat_map(|palm| palm.motion.joints()).collect();
        joints.sort_by(f64::total_cmp);
        let tolerance = Tolerance { relative: tolerance, absolute: ABSOLUTE_SHARE * tolerance };
        let instants = Vec::with_capacity(times.len());
        let result = ContactSimulation { instants, events: Vec::new(), statistics: Statistics::default() };
        let mut run = Run { tracker: &tracker, times, joints, tolerance, result, blow_work: 0.0 };
        run.finish(y, present)?;
        Ok(run.result)
    }

    /// Kinetic and potential energy of the body, J; zero height is the world origin.
    #[must_use]
    pub fn energy(&self, body: &BodyState) -> f64 {
        self.object().energy(body.p_WCm, body.v_WCm, body.omega0)
    }
}

struct Run<'a, S> {
    tracker: &'a Tracker<'a, S>,
    times: &'a [f64],
    joints: Vec<f64>,
    tolerance: Tolerance,
    result: ContactSimulation,
    blow_work: f64,
}

impl<S: RadiusFunction> Run<'_, S> {
    fn finish(&mut self, y: Vector, present: Vec<PlanarMode>) -> Result<(), ContactSimulationError> {
        let (mut y, mut present, mut end) = (y, present, None);
        let mut ended: Vec<Vec<PlanarMode>> = Vec::new();
        loop {
            let decision = self.tracker.decide(y, &Question { present: &present, end, ended: &ended })?;
            self.blow_work += decision.blow.unwrap_or(0.0) + decision.settled;
            let (phase, t) = (decision.phase, y[TIME]);
            if let Some(End::Event(kind, palm)) = end {
                let modes = phase.modes.iter().map(|mode| mode.mode()).collect();
                let event = ContactEvent { t, palm, kind, modes, blow_work: decision.blow };
                self.result.events.push(event);
                self.check_pile_up(t)?;
            }
            let Some((last, why)) = self.follow(&phase, decision.y)? else { return Ok(()) };
            // Sets that end at the instant at which they begin are not tried again there.
            if last[TIME] > t || decision.blow.is_some() {
                ended.clear();
            }
            ended.push(phase.modes.clone());
            (y, present, end) = (last, phase.modes, Some(why));
        }
    }

    /// Integrates one phase and samples it. Its last state and why it ends, unless it holds up to the last sample.
    fn follow(
        &mut self,
        phase: &Phase<'_, S>,
        y: Vector,
    ) -> Result<Option<(Vector, End)>, ContactSimulationError> {
        if self.result.instants.is_empty() {
            self.sample(phase, y)?;
        }
        let last = self.times[self.times.len() - 1];
        // A trial step may overshoot to where there is no contact any more: not a number, and the step is taken shorter.
        let field = |t: f64, y: &Vector| Ok(phase.rate(t, y).unwrap_or([f64::NAN; LENGTH]));
        let mut solver = Dop853::new(field, y[TIME], y, self.tolerance)?;
        let mut reached = None;
        while solver.time() < last && reached.is_none() {
            let limit = self.step_limit(phase, solver.time(), solver.state());
            // What cannot be projected fails in the next rate.
            let stepped = solver.step(limit, |y| drop(phase.project(y)));
            stepped.map_err(|error| stuck(phase, solver.state(), error))?;
            let end = solver.time();
            self.check_pace(solver.statistics().accepted, end - y[TIME]).map_err(|step| {
                stuck(phase, solver.state(), IntegrationError::StepTooSmall { t: end, step })
            })?;
            let Some(dense) = solver.dense()? else { break };
            let event = phase.first_event(&dense, end).map_err(|source| contact_error(end, source))?;
            let until = event.map_or(end, |(t, _)| t);
            let at = |t: f64| {
                let mut y = if t == end { *solver.state() } else { dense.at(t) };
                y[TIME] = t;
                y
            };
            while let Some(&t) = self.times.get(self.result.instants.len()).filter(|&&t| t <= until) {
                let mut y = at(t);
                phase.project(&mut y).map_err(|source| contact_error(t, source))?;
                self.sample(phase, y)?;
            }
            reached = event.map(|(t, why)| (at(t), why));
        }
        let (sum, done) = (&mut self.result.statistics, solver.statistics());
        sum.evaluations += done.evaluations;
        sum.accepted += done.accepted;
        sum.rejected += done.rejected;
        match reached {
            Some((y, End::Wedged)) => Err(wedged(phase, &y)),
            reached => Ok(reached),
        }
    }

    /// How far the next step may go: to a joint of the palms' motions, the last sample, or, where a gap may close, a
    /// share of the body's size and of a turn.
    fn step_limit(&self, phase: &Phase<'_, S>, t: f64, y: &Vector) -> f64 {
        let last = self.times[self.times.len() - 1];
        let next = self.joints.partition_point(|&joint| joint <= t);
        let joint = self.joints.get(next).copied().unwrap_or(last);
        if !phase.modes.contains(&PlanarMode::Off) {
            return joint.min(last);
        }
        let body = BodyState::of(y);
        let palms = self.tracker.scene.palms().iter().map(|palm| palm.motion.at(t));
        let fastest = palms.map(|palm| palm.material_velocity(body.p_WCm).length()).fold(0.0, f64::max);
        let speed = phase.tracker.speed(&body) + fastest;
        // A palm that is about to turn back is slow.
        let palms = self.tracker.scene.palms().iter().map(|palm| palm.motion.quickness(t));
        let quickest = palms.fold(0.0, f64::max) + body.omega0.abs();
        let turned = if quickest > 0.0 { TURN / quickest } else { f64::INFINITY };
        (t + (STEP_SHARE * self.tracker.size / speed).min(turned)).min(joint).min(last)
    }

    fn sample(&mut self, phase: &Phase<'_, S>, y: Vector) -> Result<(), ContactSimulationError> {
        let instant = phase.instant(&y, self.blow_work).map_err(|source| contact_error(y[TIME], source))?;
        self.result.instants.push(instant);
        Ok(())
    }

    /// Refuses steps so small that the motion does not go on; names their mean.
    fn check_pace(&self, steps: usize, elapsed: f64) -> Result<(), f64> {
        let allowed = MOST_STEPS as f64 * (1.0 + elapsed / self.tracker.natural_time());
        if (steps as f64) < allowed { Ok(()) } else { Err(elapsed / steps as f64) }
    }

    fn check_pile_up(&self, t: f64) -> Result<(), ContactSimulationError> {
        let events = &self.result.events;
        let Some(first) = events.len().checked_sub(MOST_CHANGES) else { return Ok(()) };
        let span = t - events[first].t;
        if span > self.tracker.natural_time() {
            return Ok(());
        }
        Err(ContactSimulationError::TooManyEvents { count: MOST_CHANGES, span, t })
    }
}

/// An integrator that cannot go on where accelerations cannot be told, or near critical friction, is told as that.
fn stuck<S: RadiusFunction>(
    phase: &Phase<'_, S>,
    y: &Vector,
    error: IntegrationError<FieldError>,
) -> ContactSimulationError {
    match wedged(phase, y) {
        told @ ContactSimulationError::Contact { .. } => told,
        told @ ContactSimulationError::Modes { source: ModeError::NotP { minor, .. }, .. }
            if minor < CRITICAL =>
        {
            told
        }
        _ => match error {
            IntegrationError::StepTooSmall { t, step } => {
                let body = BodyState::of(y);
                let (spin, speed) = (body.omega0.abs(), body.v_WCm.length());
                ContactSimulationError::TooSlow { t, step, spin, speed }
            }
            other => other.into(),
        },
    }
}

/// Friction has become critical for the sliding contacts.
fn wedged<S: RadiusFunction>(phase: &Phase<'_, S>, y: &Vector) -> ContactSimulationError {
    let (t, body) = (y[TIME], BodyState::of(y));
    match phase.reading(t, &body) {
        Ok(reading) => {
            let minor = reading.smallest_minor();
            let source = ModeError::NotP { modes: letters(&reading.modes), minor };
            ContactSimulationError::Modes { t, body, source }
        }
        Err(source) => contact_error(t, source),
    }
}

fn contact_error(t: f64, source: FieldError) -> ContactSimulationError {
    ContactSimulationError::Contact { t, source }
}

fn check_times(times: &[f64]) -> Result<(), ContactSimulationError> {
    if times.is_empty() {
        return Err(ContactSimulationError::Times { index: 0, time: f64::NAN });
    }
    let bad = (0..times.len()).find(|&i| !times[i].is_finite() || i > 0 && times[i] <= times[i - 1]);
    bad.map_or(Ok(()), |index| Err(ContactSimulationError::Times { index, time: times[index] }))
}
