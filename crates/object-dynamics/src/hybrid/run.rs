use super::blow::blow;
use super::error::ContactSimulationError as Error;
use super::events::{Crossing, first_crossing};
use super::field::{Evaluated, STILL, Stretch};
use super::guards::{Guards, suspicious};
use super::packed::{RIGID, Tallies, Units, YIELDING};
use super::project::projected;
use super::result::{ContactEvent, ContactEventKind, ContactSimulation};
use super::start::{ContactStart, check_overlap};
use crate::contacts::{ContactScene, Left, MOST_PALMS, ModeError, Modes, SceneState, Touch};
use crate::integrate::{Dop853, IntegrationError, Statistics, Tolerance};
use crate::three_palms::check_times;
use crate::{ContactMode, SampleTimes};
use contact_kinematics::SupportFunction;
use glam::DVec3;
use std::cell::Cell;

/// A slip that ends must have fallen below this share of the natural speed: else its direction has only turned by a right
/// angle within a step, and the step is taken again, shorter.
const SLIP_ENDED: f64 = 1e-4;
/// More changes of modes than this without time to tell them apart are a pile-up.
const MOST_AT_ONCE: usize = 1000;
/// What counts as no time, in natural times.
const AT_ONCE: f64 = 1e-4;
/// Slips and rates of gaps at the start below this share of the natural speed are none: a state given to six digits.
const STATED: f64 = 1e-5;
/// A contact whose gap opens slower than this share of the natural speed has not left.
const LEAVES: f64 = 1e-5;
/// An approach slower than this share of the natural speed is no blow.
const GRAZING: f64 = 1e-9;

impl<S: SupportFunction> ContactScene<S> {
    /// Simulates from `start` through every change of modes to the last sample.
    ///
    /// Smooth motion by DOP853 in maximal coordinates with the forces of the present modes, pulled back onto the contacts
    /// after each step; changes of modes are located on its dense output, and the modes after each are the consistent ones.
    /// `tolerance` is the local error allowed in natural units (size of the body, `sqrt(g l)`).
    ///
    /// # Errors
    /// [`ContactSimulationError`](Error); where rigid bodies with friction have no motion, or several, the state is named.
    pub fn simulate(
        &self,
        start: &ContactStart,
        times: SampleTimes,
        tolerance: f64,
    ) -> Result<ContactSimulation, Error> {
        if self.palms().iter().all(|palm| palm.drive.is_prescribed()) {
            Run::<S, RIGID>::new(self, start, times, tolerance)?.finished()
        } else {
            Run::<S, YIELDING>::new(self, start, times, tolerance)?.finished()
        }
    }

    /// Half of the body's mean width over three axes, m: the unit of length.
    pub(super) fn size(&self) -> f64 {
        use contact_kinematics::Direction;
        let axes = [Direction::X, Direction::Y, Direction::Z];
        axes.into_iter().map(|u| self.body().value(u) + self.body().value(-u)).sum::<f64>() / 6.0
    }
}

struct Run<'a, S, const N: usize> {
    scene: &'a ContactScene<S>,
    units: Units,
    tolerance: Tolerance,
    sample_rate: f64,
    count: usize,
    joints: Vec<f64>,
    stretch: Stretch,
    t: f64,
    y: [f64; N],
    blow_work: f64,
    /// When guards fell to zero, whether the modes changed or not.
    crossings: Vec<f64>,
    result: ContactSimulation,
}

/// How far a stretch went.
enum Reached {
    Limit,
    Event(Crossing),
    /// A step must be taken again up to this time.
    Again(f64),
}

impl<'a, S: SupportFunction, const N: usize> Run<'a, S, N> {
    fn new(
        scene: &'a ContactScene<S>,
        start: &ContactStart,
        times: SampleTimes,
        tolerance: f64,
    ) -> Result<Self, Error> {
        let count = check_times(times)?;
        let state = start.state(scene)?;
        let units = Units::new(scene.size(), scene.mass().mass(), -scene.gravity().z);
        let guesses = [None; MOST_PALMS];
        let touch =
            scene.contacts_at(&state, &guesses).map_err(|source| Error::Contact { t: 0.0, source })?;
        let surfaces: Vec<_> = scene.palms().iter().map(|p| p.surface).zip(touch.palms.clone()).collect();
        check_overlap(&surfaces)?;
        let gaps: Vec<f64> = touch.contacts.iter().map(|contact| contact.gap).collect();
        let closed = start.closed(&gaps, units.length)?;
        let mut joints: Vec<f64> = scene.palms().iter().flat_map(|palm| palm.drive.joints()).collect();
        joints.sort_by(f64::total_cmp);
        let modes = closed.map(|closed| if closed { ContactMode::Slide } else { ContactMode::Off });
        let stretch = Stretch {
            modes,
            towards: [DVec3::ZERO; MOST_PALMS],
            starting: [false; MOST_PALMS],
            at_edge: [false; MOST_PALMS],
            guesses,
        };
        let result = ContactSimulation {
            instants: Vec::with_capacity(count),
            events: Vec::new(),
            statistics: Statistics::default(),
        };
        let mut run = Self {
            scene,
            units,
            tolerance: Tolerance::uniform(tolerance),
            sample_rate: times.rate,
            count,
            joints,
            stretch,
            t: 0.0,
            y: [0.0; N],
            blow_work: 0.0,
            crossings: Vec::new(),
            result,
        };
        run.settle(state, &Tallies::default(), &closed, None)?;
        run.sample(0.0, &run.y.clone())?;
        Ok(run)
    }

    fn finished(mut self) -> Result<ContactSimulation, Error> {
        let last = (self.count - 1) as f64 / self.sample_rate;
        let mut limit = last;
        while self.t < last {
            match self.stretch_until(limit)? {
                Reached::Limit => limit = last,
                Reached::Again(sooner) => limit = sooner,
                Reached::Event(crossing) => {
                    limit = last;
                    self.change(&crossing)?;
                }
            }
        }
        Ok(self.result)
    }

    /// Integrates with the present modes up to `limit` or the first event.
    fn stretch_until(&mut self, limit: f64) -> Result<Reached, Error> {
        let (scene, units) = (self.scene, self.units);
        let now = Cell::new(self.stretch);
        let (doubt, at_start) = (Cell::new(false), Cell::new(Guards::default()));
        let failed = Cell::new(None);
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
            Ok(evaluated.rates(scene, &units))
        };
        let mut solver = Dop853::new(field, self.t, self.y, self.tolerance).map_err(Error::Integration)?;
        let reached = loop {
            let (t, y) = (solver.time(), *solver.state());
            if t >= limit {
                (self.t, self.y) = (t, y);
                break Reached::Limit;
            }
            let evaluated = self.evaluated(t, &y)?;
            self.check_wedging(&evaluated)?;
            self.stretch = self.stretch.renewed(&evaluated, &units);
            now.set(self.stretch);
            at_start.set(self.stretch.guards(&evaluated, &units));
            doubt.set(false);
            failed.set(None);
            // A table of poses has a joint at every row: thousands of them.
            let next = self.joints.partition_point(|joint| *joint <= t);
            let next_joint = self.joints.get(next).copied().unwrap_or(limit);
            let project = |t: f64, y: &mut [f64; N]| self.project(t, y);
            if let Err(error) = solver.step_onto(limit.min(next_joint), project) {
                return Err(match (&error, failed.get()) {
                    (IntegrationError::NotFinite { t }, Some(source)) => Error::Contact { t: *t, source },
                    _ => self.stuck(&evaluated, error),
                });
            }
            let at_edge = std::mem::take(&mut self.stretch.at_edge);
            let (end, next_sample) = (solver.time(), self.result.instants.len() as f64 / self.sample_rate);
            if !doubt.get() && next_sample > end {
                continue;
            }
            let Some(dense) = solver.dense().map_err(Error::Integration)? else { continue };
            let passed = Stretch { at_edge, ..self.stretch };
            let crossing = match doubt.get() {
                true => first_crossing(&passed, scene, &units, &dense, &at_start.get())
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

    fn evaluated(&self, t: f64, y: &[f64; N]) -> Result<Evaluated, Error> {
        let state = self.units.unpack(t, y);
        self.stretch.evaluate(self.scene, &self.units, state).map_err(|source| Error::Contact { t, source })
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

    fn check_wedging(&self, now: &Evaluated) -> Result<(), Error> {
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
        Error::Integration(error)
    }

    /// New modes after an event.
    fn change(&mut self, crossing: &Crossing) -> Result<(), Error> {
        let mut closed = self.stretch.modes.map(|mode| mode != ContactMode::Off);
        closed[crossing.palm] = true;
        let left = match crossing.kind {
            ContactEventKind::Touches | ContactEventKind::SlipEnds => None,
            ContactEventKind::Lifts | ContactEventKind::ConeLeft => {
                let squeezed =
                    self.evaluated(self.t, &self.y)?.reaction.is_some_and(|reaction| !reaction.unique);
                let mode = self.stretch.modes[crossing.palm];
                Some(if squeezed { Left::Set } else { Left::Mode(crossing.palm, mode) })
            }
        };
        let (state, tallies) = self.units.unpack(self.t, &self.y);
        // Until now the old modes have held: what departs from them is the integrator's error, the rest of a slip as well.
        let mut modes: Modes = self.stretch.modes;
        if crossing.kind == ContactEventKind::SlipEnds {
            modes[crossing.palm] = ContactMode::Stick;
        }
        let state = projected(
            self.scene,
            state,
            &modes,
            &[None; MOST_PALMS],
            &self.stretch.guesses,
            self.units.length,
        )
        .map_err(|source| Error::Contact { t: self.t, source })?;
        if crossing.kind == ContactEventKind::SlipEnds {
            self.stretch.modes = modes;
        }
        let before = self.stretch.modes;
        self.settle(state, &tallies, &closed, left)?;
        self.stretch.at_edge = [false; MOST_PALMS];
        self.crossings.push(self.t);
        self.check_pile_up()?;
        if self.stretch.modes == before && left.is_some() {
            self.stretch.at_edge[crossing.palm] = true;
            return Ok(());
        }
        let modes = self.stretch.modes[..self.scene.palms().len()].to_vec();
        let event = ContactEvent { t: self.t, palm: crossing.palm, kind: crossing.kind, modes };
        self.result.events.push(event);
        Ok(())
    }

    fn check_pile_up(&self) -> Result<(), Error> {
        let Some(first) = self.crossings.len().checked_sub(MOST_AT_ONCE) else { return Ok(()) };
        let span = self.t - self.crossings[first];
        if span > AT_ONCE / self.units.rate {
            return Ok(());
        }
        Err(Error::TooManyEvents { count: MOST_AT_ONCE, span, t: self.t })
    }

    /// Finds the modes of a state whose `closed` contacts touch, after a blow where one approaches.
    fn settle(
        &mut self,
        state: SceneState,
        tallies: &Tallies,
        closed: &[bool; MOST_PALMS],
        left: Option<Left>,
    ) -> Result<(), Error> {
        let (scene, units) = (self.scene, self.units);
        let t = state.t;
        let contact = |source| Error::Contact { t, source };
        let gaps_closed = closed.map(|closed| if closed { ContactMode::Slide } else { ContactMode::Off });
        let (mut state, mut tallies) = (state, *tallies);
        let mut touch = scene.contacts_at(&state, &self.stretch.guesses).map_err(contact)?;
        // At the start the state is as exact as who gave it.
        let at_start = self.result.instants.is_empty();
        let [grazing, still] =
            [GRAZING, STILL].map(|rate| units.speed * if at_start { STATED } else { rate });
        let approaches = |i: usize| closed[i] && touch.rates[i].gap_rate < -grazing;
        let struck = (0..scene.palms().len()).any(approaches);
        if struck {
            let before = scene.energy(&state.body);
            let (after, impulses) = blow(scene, &state, &touch, closed)
                .map_err(|source| Error::Modes { state: Box::new(state), source })?;
            state = after;
            self.blow_work += scene.energy(&state.body) - before;
            for (sum, impulse) in tallies.impulses.iter_mut().zip(impulses.forces) {
                *sum += impulse;
            }
            touch = scene.contacts_at(&state, &self.stretch.guesses).map_err(contact)?;
        }
        let problem = scene.problem(&state.body, &touch);
        let mut touches = [Touch::Apart; MOST_PALMS];
        for (i, at) in problem.contacts().iter().enumerate() {
            let rates = &touch.rates[i];
            if closed[i] && rates.gap_rate <= LEAVES * units.speed {
                let slip = at.in_tangent(rates.slip);
                let speed = slip.length();
                // Palms that have begun to pull sticking contacts apart leave some slip in all of them.
                let sticks = !struck && self.stretch.modes[i] == ContactMode::Stick;
                touches[i] =
                    if sticks || speed <= still { Touch::Rests } else { Touch::Slides(slip / speed) };
            }
        }
        let present = if at_start { gaps_closed } else { self.stretch.modes };
        let choice = problem
            .choose(&touches, &present, left)
            .map_err(|source| Error::Modes { state: Box::new(state), source })?;
        self.stretch.modes = choice.modes;
        for (i, at) in problem.contacts().iter().enumerate() {
            self.stretch.towards[i] = at.along_tangent(choice.directions[i]);
            self.stretch.starting[i] = touches[i] == Touch::Rests;
            self.stretch.guesses[i] = Some(touch.contacts[i].n_O);
        }
        let state =
            projected(scene, state, &choice.modes, &[None; MOST_PALMS], &self.stretch.guesses, units.length)
                .map_err(contact)?;
        (self.t, self.y) = (t, units.pack(&state, &tallies));
        Ok(())
    }

    fn sample(&mut self, t: f64, y: &[f64; N]) -> Result<(), Error> {
        let now = self.evaluated(t, y)?;
        let state = now.state;
        let modes = &self.stretch.modes[..self.scene.palms().len()];
        let instant = now
            .into_instant(modes, self.blow_work)
            .ok_or_else(|| Error::Modes { state: Box::new(state), source: ModeError::Inconsistent })?;
        self.result.instants.push(instant);
        Ok(())
    }
}
