//! The simulation as a whole: from event to event, and by time stepping where those crowd.

use super::error::ContactSimulationError as Error;
use super::events::Crossing;
use super::field::{Evaluated, Stretch};
use super::packed::{RIGID, Tallies, Units, YIELDING};
use super::result::ContactSimulation;
use super::start::{ContactStart, check_overlap};
use crate::contacts::{ContactScene, MOST_PALMS, ModeError, SceneState};
use crate::integrate::{Statistics, Tolerance};
use crate::three_palms::check_times;
use crate::{ContactMode, SampleTimes};
use contact_kinematics::SupportFunction;
use glam::DVec3;

impl<S: SupportFunction> ContactScene<S> {
    /// Simulates from `start` through every change of modes to the last sample.
    ///
    /// Smooth motion by DOP853 in maximal coordinates with the forces of the present modes, pulled back onto the contacts
    /// after each step; changes of modes are located on its dense output, and the modes after each are the consistent ones.
    /// Where over-constrained sticking comes loose, or events and steps crowd, it goes on by time stepping for a while.
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

/// Steps within one natural time after which a motion is taken to be too fast to be followed: smooth motion takes some tens,
/// logs with a pose of each palm at every millisecond some hundreds.
pub(super) const MOST_STEPS: usize = 10_000;

pub(super) struct Run<'a, S, const N: usize> {
    pub(super) scene: &'a ContactScene<S>,
    pub(super) units: Units,
    pub(super) tolerance: Tolerance,
    pub(super) sample_rate: f64,
    pub(super) count: usize,
    pub(super) joints: Vec<f64>,
    pub(super) stretch: Stretch,
    pub(super) t: f64,
    pub(super) y: [f64; N],
    pub(super) blow_work: f64,
    /// Work (in steps) since a time, s: more than time stepping takes is too much.
    pub(super) work: (f64, usize),
    /// Steps since the start, refused ones among them.
    steps: f64,
    pub(super) result: ContactSimulation,
}

/// How far a stretch went.
pub(super) enum Reached {
    Limit,
    Event(Crossing),
    /// Events and steps have become denser than time stepping is.
    Crowded,
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
        check_overlap(&surfaces, units.length)?;
        let gaps: Vec<f64> = touch.contacts.iter().map(|contact| contact.gap).collect();
        let closed = start.closed(&gaps, units.length)?;
        let mut joints: Vec<f64> = scene.palms().iter().flat_map(|palm| palm.drive.joints()).collect();
        joints.sort_by(f64::total_cmp);
        let modes = closed.map(|closed| if closed { ContactMode::Slide } else { ContactMode::Off });
        let stretch =
            Stretch { modes, towards: [DVec3::ZERO; MOST_PALMS], starting: [false; MOST_PALMS], guesses };
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
            work: (0.0, 0),
            steps: 0.0,
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
                    if self.change(&crossing)? {
                        self.crawl(last)?;
                    }
                }
                Reached::Crowded => {
                    limit = last;
                    self.crawl(last)?;
                }
            }
        }
        Ok(self.result)
    }

    pub(super) fn evaluated(&self, t: f64, y: &[f64; N]) -> Result<Evaluated, Error> {
        let state = self.units.unpack(t, y);
        self.stretch.evaluate(self.scene, &self.units, state).map_err(|source| Error::Contact { t, source })
    }

    /// Counts a step that begins at `t`, at its share of what is allowed, and refuses to go on where so many have led nowhere.
    pub(super) fn pace(&mut self, t: f64, y: &[f64; N], share: f64) -> Result<(), Error> {
        self.steps += share;
        if self.steps <= MOST_STEPS as f64 * (1.0 + t * self.units.rate) {
            return Ok(());
        }
        Err(self.too_slow(&self.units.unpack(t, y).0))
    }

    /// That the run stands still at this state, with what moves there.
    pub(super) fn too_slow(&self, state: &SceneState) -> Error {
        let palm = |i: usize| self.scene.palm_state(i, state.t, &state.palms[i]).v_WP.length();
        let palms = (0..self.scene.palms().len()).map(palm);
        Error::TooSlow {
            t: state.t,
            steps: self.steps as usize,
            spin: state.body.w_WO.length(),
            speed: state.body.v_WCm.length(),
            palms: palms.fold(0.0, f64::max),
        }
    }

    pub(super) fn sample(&mut self, t: f64, y: &[f64; N]) -> Result<(), Error> {
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
