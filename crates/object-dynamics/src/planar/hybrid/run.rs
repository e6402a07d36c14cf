//! The loop: a phase, its event, the modes after it.

use super::decide::Question;
use super::error::ContactSimulationError;
use super::events::Cause;
use super::phase::Phase;
use super::start::ContactStart;
use super::state::{BodyState, FRICTION_WORK, PALM_WORK, TIME, Vector};
use super::tracker::Tracker;
use crate::integrate::{Dop853, Tolerance};
use crate::planar::contacts::{ContactScene, PlanarMode};
use contact_kinematics::planar::{RadiusFunction, SurfaceState};
use glam::DVec2;

/// Absolute tolerance against the relative one: lengths, speeds and energies of a scene are not far below 1e-2.
const ABSOLUTE_SHARE: f64 = 1e-2;
/// Share of its size by which the body, or a palm at its place, may move in one step, so that no contact is passed by.
const STEP_SHARE: f64 = 0.25;
/// Changes of modes within one natural time after which they are taken to have no end. A body that rattles to rest in a wedge
/// takes some tens.
const MOST_CHANGES: usize = 5_000;

/// One palm at one instant of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactReading {
    /// Where it stands and how it moves.
    pub palm: SurfaceState,
    /// What its contact does.
    pub mode: PlanarMode,
    /// Gap, m.
    pub gap: f64,
    /// Contact point, world, m; none where the contact is off.
    pub p_WC: Option<DVec2>,
    /// Force on the body, world, N.
    pub force: DVec2,
    /// Slip of the body along the palm's tangent, m/s; zero where the contact is off.
    pub slip: f64,
}

/// One instant of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRunSample {
    /// Time in s.
    pub t: f64,
    /// State of the body.
    pub state: BodyState,
    /// The palms, in the order of the scene.
    pub contacts: Vec<ContactReading>,
    /// Kinetic and potential energy of the body, J.
    pub energy: f64,
    /// Work of the palms' motion since the start, J: of the forces, and of the impulses of blows.
    pub palm_work: f64,
    /// Work of friction since the start, J; not positive.
    pub friction_work: f64,
    /// Energy lost in blows since the start, J; not positive.
    pub blow_work: f64,
}

/// A change of modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEvent {
    /// Time in s.
    pub t: f64,
    /// Why.
    pub cause: Cause,
    /// Modes from then on, of all palms.
    pub modes: Vec<PlanarMode>,
    /// Energy that a blow took, J; none where there was none.
    pub blow_work: Option<f64>,
}

/// A simulated run.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactRun {
    /// Samples at the times asked for.
    pub samples: Vec<ContactRunSample>,
    /// Changes of modes, the first one at the start.
    pub events: Vec<ContactEvent>,
    /// Steps of the integrator.
    pub steps: usize,
}

impl ContactRun {
    /// Largest departure of energy from start energy plus work, as a fraction of the largest energy seen.
    #[must_use]
    pub fn energy_drift(&self) -> f64 {
        let Some(first) = self.samples.first() else { return 0.0 };
        let balance = |s: &ContactRunSample| s.energy - s.palm_work - s.friction_work - s.blow_work;
        let worst = self.samples.iter().map(|s| (balance(s) - balance(first)).abs()).fold(0.0, f64::max);
        worst / self.samples.iter().map(|s| s.energy.abs()).fold(f64::MIN_POSITIVE, f64::max)
    }
}

impl<S: RadiusFunction> ContactScene<S> {
    /// Simulates from `start` at the first of `times` (s) on, sampled at them, to the relative `tolerance` per step.
    ///
    /// Between events the modes stay and the equations are smooth; an event ends a step. After each step gaps and gap rates of
    /// touching contacts, and slips of sticking ones, are taken back to zero. Blows are inelastic.
    ///
    /// # Errors
    /// [`ContactSimulationError`].
    pub fn simulate(
        &self,
        start: &ContactStart,
        times: &[f64],
        tolerance: f64,
    ) -> Result<ContactRun, ContactSimulationError> {
        check_times(times)?;
        let tracker = Tracker::new(self);
        tracker.check_start(times[0], start)?;
        let mut y = [0.0; 9];
        start.state.write(&mut y);
        y[TIME] = times[0];
        let mut present = vec![PlanarMode::Off; self.palms().len()];
        for &palm in &start.contacts {
            // Whether it slides or sticks is asked for at once.
            present[palm] = PlanarMode::Slide { sense: 0.0 };
        }
        let mut joints: Vec<f64> = self.palms().iter().flat_map(|palm| palm.motion.joints()).collect();
        joints.sort_by(f64::total_cmp);
        let tolerance = Tolerance { relative: tolerance, absolute: ABSOLUTE_SHARE * tolerance };
        let run = ContactRun { samples: Vec::with_capacity(times.len()), events: Vec::new(), steps: 0 };
        let mut recorder = Recorder { tracker: &tracker, times, joints, tolerance, run, blow_work: 0.0 };
        recorder.record(y, &present)?;
        Ok(recorder.run)
    }
}

struct Recorder<'a, S> {
    tracker: &'a Tracker<'a, S>,
    times: &'a [f64],
    joints: Vec<f64>,
    tolerance: Tolerance,
    run: ContactRun,
    blow_work: f64,
}

impl<S: RadiusFunction> Recorder<'_, S> {
    fn record(&mut self, y: Vector, present: &[PlanarMode]) -> Result<(), ContactSimulationError> {
        let (mut y, mut present, mut cause) = (y, present.to_vec(), Cause::Start);
        let mut ended: Vec<Vec<PlanarMode>> = Vec::new();
        loop {
            self.check_progress(y[TIME])?;
            let question = Question { present: &present, cause, ended: &ended };
            let decision = self.tracker.decide(y, &question)?;
            self.blow_work += decision.blow.unwrap_or(0.0) + decision.settled;
            let (phase, t) = (decision.phase, y[TIME]);
            let modes = phase.modes.clone();
            self.run.events.push(ContactEvent { t, cause, modes, blow_work: decision.blow });
            let Some((end, why)) = self.follow(&phase, decision.y)? else { return Ok(()) };
            // Sets that end at the instant at which they begin are not tried again there.
            if end[TIME] > t || decision.blow.is_some() {
                ended.clear();
            }
            ended.push(phase.modes.clone());
            (y, present, cause) = (end, phase.modes, why);
        }
    }

    /// Integrates one phase and samples it. Its end and why, unless it lasts to the last sample.
    fn follow(
        &mut self,
        phase: &Phase<'_, S>,
        y: Vector,
    ) -> Result<Option<(Vector, Cause)>, ContactSimulationError> {
        let last = self.times[self.times.len() - 1];
        let mut solver = Dop853::new(|t, y: &Vector| phase.rate(t, y), y[TIME], y, self.tolerance)?;
        if self.run.samples.is_empty() {
            self.sample(phase, y)?;
        }
        while solver.time() < last {
            let limit = self.step_limit(phase, solver.time(), solver.state());
            solver.step(limit, |y| {
                // What cannot be projected fails in the next rate.
                let _ = phase.project(y);
            })?;
            self.run.steps += 1;
            let end = solver.time();
            let Some(dense) = solver.dense()? else { break };
            let event = phase.first_event(&dense, end).map_err(|source| contact_error(end, source))?;
            let until = event.map_or(end, |(t, _)| t);
            while let Some(&t) = self.times.get(self.run.samples.len()).filter(|&&t| t <= until) {
                let mut y = if t == end { *solver.state() } else { dense.at(t) };
                y[TIME] = t;
                phase.project(&mut y).map_err(|source| contact_error(t, source))?;
                self.sample(phase, y)?;
            }
            if let Some((t, cause)) = event {
                let mut y = dense.at(t);
                y[TIME] = t;
                return Ok(Some((y, cause)));
            }
        }
        Ok(None)
    }

    /// How far the next step may go: to a joint of the palms' motions, the last sample, or, where a gap may close, a share of
    /// the body's size.
    fn step_limit(&self, phase: &Phase<'_, S>, t: f64, y: &Vector) -> f64 {
        let last = self.times[self.times.len() - 1];
        let next = self.joints.partition_point(|&joint| joint <= t);
        let joint = self.joints.get(next).copied().unwrap_or(last);
        if !phase.modes.contains(&PlanarMode::Off) {
            // Nothing can be passed by.
            return joint.min(last);
        }
        let state = BodyState::of(y);
        let palms = self.tracker.scene.palms().iter().map(|palm| palm.motion.at(t));
        let fastest = palms.map(|palm| palm.material_velocity(state.p_WCm).length()).fold(0.0, f64::max);
        let speed = phase.tracker.speed(&state) + fastest;
        (t + STEP_SHARE * self.tracker.size / speed).min(joint).min(last)
    }

    fn sample(&mut self, phase: &Phase<'_, S>, y: Vector) -> Result<(), ContactSimulationError> {
        let (t, state) = (y[TIME], BodyState::of(&y));
        let at = |source| contact_error(t, source);
        let reading = phase.reading(t, &state).map_err(at)?;
        let mut contacts = Vec::with_capacity(phase.modes.len());
        for (palm, &mode) in phase.modes.iter().enumerate() {
            let surface = self.tracker.scene.palms()[palm].motion.at(t);
            let touching = reading.touches.iter().zip(reading.forces()).find(|((c, _), _)| c.palm == palm);
            contacts.push(match touching {
                Some(((touch, rates), force)) => ContactReading {
                    palm: surface,
                    mode,
                    gap: touch.contact.gap,
                    p_WC: Some(touch.contact.p_WC),
                    force,
                    slip: touch.contact.t.dot(rates.slip),
                },
                None => {
                    let [gap, _] = self.tracker.gap(palm, t, &state).map_err(at)?;
                    ContactReading { palm: surface, mode, gap, p_WC: None, force: DVec2::ZERO, slip: 0.0 }
                }
            });
        }
        let energy = self.tracker.scene.object().energy(state.p_WCm, state.v_WCm, state.omega0);
        let (palm_work, friction_work) = (y[PALM_WORK], y[FRICTION_WORK]);
        let blow_work = self.blow_work;
        let sample = ContactRunSample { t, state, contacts, energy, palm_work, friction_work, blow_work };
        self.run.samples.push(sample);
        Ok(())
    }

    fn check_progress(&self, t: f64) -> Result<(), ContactSimulationError> {
        let natural = self.tracker.natural_time();
        let recent = self.run.events.iter().rev().take_while(|event| t - event.t < natural);
        let changes = recent.take(MOST_CHANGES).count();
        if changes == MOST_CHANGES { Err(ContactSimulationError::Stalled { t, changes }) } else { Ok(()) }
    }
}

fn contact_error(t: f64, source: super::FieldError) -> ContactSimulationError {
    ContactSimulationError::Contact { t, source }
}

fn check_times(times: &[f64]) -> Result<(), ContactSimulationError> {
    if times.is_empty() {
        return Err(ContactSimulationError::Times { index: 0, time: f64::NAN });
    }
    let bad = (0..times.len()).find(|&i| !times[i].is_finite() || i > 0 && times[i] <= times[i - 1]);
    bad.map_or(Ok(()), |index| Err(ContactSimulationError::Times { index, time: times[index] }))
}
