//! What is asked of the thread when, and the estimate at each sample.

use super::estimate::{StreamError, StreamEstimate, StreamOptions, StreamStage};
use super::front::Front;
use super::log::LEFT_OUT;
use super::misread::Newest;
use super::modes::{Modes, StreamModes};
use super::sample::{Contacts, Felt, PalmSensed, Raw, StreamPalm};
use super::solution::Solution;
use super::thread::Worker;
use super::window::{Asked, LONGEST, Outcome, Window};
use crate::contacts::options::ContactEstimateError;
use glam::DVec3;
use object_dynamics::{MOST_PALMS, SensedAxes, StuckWatch};
use std::collections::VecDeque;

/// Natural times after which a window that follows a motion is taken, and the next one is asked for.
const FOLLOWED: f64 = 0.5;
/// The same after a gap, until a window confirms the one before that is the first to bridge it.
const AFTER_GAP: f64 = 0.25;
/// Natural times after which a search is taken.
const SEARCHED: f64 = 1.0;
/// Samples of the first task, which tells the natural time; after as many more it is taken.
const FIRST: usize = 20;
/// Samples that a task is given at least.
const FEWEST: usize = 4;
/// Windows in a row that may come to no end while a motion is followed: forces alone carry it over two natural times.
const UNSETTLED: usize = 4;
/// Natural times from one search that found nothing to the next.
const PATIENCE: f64 = 1.0;

/// The motion of a body on palms, sample by sample; mass and inertia are estimated along where they are not known.
///
/// A palm that is not touched gives no condition; where none is, the body flies.
pub struct MotionStream {
    palms: Vec<StreamPalm>,
    /// What tells of each palm whether its readings are stuck.
    watches: [StuckWatch; MOST_PALMS],
    options: StreamOptions,
    worker: Worker,
    /// Samples that the thread has not been given.
    fresh: Vec<Raw>,
    /// Memory for them while the thread has the other.
    spare: Vec<Raw>,
    newest: Newest,
    /// Forces since the end of the latest window, oldest first.
    felt: VecDeque<Felt>,
    front: Option<Front>,
    /// Whether the window before it was the latest on the other side of a gap.
    bridged: bool,
    /// Beside it, of each palm, the motion in which that need not stick, where there is one.
    freed: Vec<Option<Front>>,
    /// What tells modes, once there was a motion.
    modes: Option<Box<Modes>>,
    /// Number of the sample at which the task that was begun is taken.
    due: Option<usize>,
    /// Number of the sample at which the next one begins.
    next: usize,
    asked: Asked,
    /// Natural time, s, once it is known.
    natural: Option<f64>,
    stage: StreamStage,
    rounds: usize,
    count: usize,
    /// How many of the latest windows came to no end.
    unsettled: usize,
    left_out: usize,
    latest: f64,
}

impl MotionStream {
    /// A stream that has seen no sample yet.
    ///
    /// # Errors
    /// [`StreamError`] names the option that cannot be used; [`StreamError::Thread`] where the system gives no thread.
    pub fn new(palms: Vec<StreamPalm>, options: StreamOptions) -> Result<Self, StreamError> {
        options.check()?;
        if !(1..=MOST_PALMS).contains(&palms.len()) {
            return Err(StreamError::Palms { found: palms.len(), expected: MOST_PALMS, t: 0.0 });
        }
        if palms.len() == 1 && options.contacts.size.is_none() {
            return Err(ContactEstimateError::NoSize.into());
        }
        let worker = Worker::new(Window::new(palms.clone(), options.contacts, options.sample_rate))?;
        Ok(Self {
            freed: palms.iter().map(|_| None).collect(),
            modes: None,
            palms,
            watches: [StuckWatch::default(); MOST_PALMS],
            options,
            worker,
            fresh: Vec::with_capacity(2 * FIRST),
            spare: Vec::with_capacity(2 * FIRST),
            natural: None,
            newest: Newest::default(),
            felt: VecDeque::with_capacity(4 * FIRST),
            front: None,
            bridged: false,
            due: None,
            next: FIRST,
            asked: Asked::Search,
            stage: StreamStage::Gathering,
            rounds: 0,
            count: 0,
            unsettled: 0,
            left_out: 0,
            latest: f64::NEG_INFINITY,
        })
    }

    /// Samples that the latest windows could not be read with, and were left out of.
    #[must_use]
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// Number of palms whose contact modes are told, once there is a motion: all, or none where it is not asked for or no palm has friction.
    #[must_use]
    pub fn palms_with_modes(&self) -> usize {
        let contacts = &self.options.contacts;
        let rubs = self.palms.iter().any(|palm| !contacts.frictionless(palm.friction));
        if contacts.mode_odds && rubs { self.palms.len() } else { 0 }
    }

    /// Takes what the palms sense at the time `t` (s) and returns the motion there.
    ///
    /// # Errors
    /// [`StreamError::Time`], [`StreamError::Palms`], [`StreamError::Reading`], [`StreamError::NoForce`] or [`StreamError::Stuck`] for a sample that cannot be
    /// used (it is left out); [`StreamError::Thread`] where the thread that estimates is gone.
    pub fn push(&mut self, t: f64, sensed: &[PalmSensed]) -> Result<StreamEstimate, StreamError> {
        let raw = self.checked(t, sensed)?;
        self.refuse_stuck(t, sensed)?;
        let since = t - self.latest;
        self.latest = t;
        self.count += 1;
        let (mut contacts, mut felt) = raw.felt(&self.palms, &self.options.contacts);
        self.newest.judge(&mut contacts, &mut felt, self.options.contacts.noise.contact, |taken| {
            if let Some(felt) = self.felt.iter_mut().find(|felt| felt.number == taken.number) {
                felt.wrench.moment += taken.moment;
            }
            let fronts = self.front.iter_mut().chain(self.freed.iter_mut().flatten());
            fronts.for_each(|front| front.give_back(taken.moment * since));
        });
        self.fresh.push(raw);
        self.felt.push_back(felt);
        self.front.iter_mut().chain(self.freed.iter_mut().flatten()).for_each(|front| front.advance(&felt));
        if self.due.is_some_and(|due| raw.number >= due) {
            let (outcome, memory) = self.worker.take()?;
            self.due = None;
            self.take(outcome, memory, raw.number);
        }
        if self.due.is_none() && raw.number >= self.next {
            self.begin(raw.number)?;
        }
        let motion = self.front.as_ref().map(Front::motion);
        let stage = if self.is_gapped() && self.stage == StreamStage::Tracking {
            self.searching()
        } else {
            self.stage
        };
        let modes = self.told(t, &contacts);
        Ok(StreamEstimate { t, motion, stage, touching: felt.touching, modes })
    }

    /// Modes at the newest sample, by slips of motions that do not rest on the modes they tell.
    fn told(&mut self, t: f64, contacts: &Contacts) -> Option<StreamModes> {
        let (front, freed) = (&self.front, &self.freed);
        let motion = |palm: usize| freed.get(palm).and_then(Option::as_ref).or(front.as_ref());
        self.modes.as_mut().map(|modes| modes.take(t, contacts, motion))
    }

    fn checked(&self, t: f64, sensed: &[PalmSensed]) -> Result<Raw, StreamError> {
        let previous = self.latest;
        if !(t > previous && t.is_finite()) {
            return Err(StreamError::Time { t, previous });
        }
        let (found, expected) = (sensed.len(), self.palms.len());
        if found != expected {
            return Err(StreamError::Palms { found, expected, t });
        }
        let mut palms = [None; MOST_PALMS];
        for (i, (palm, kept)) in sensed.iter().zip(&mut palms).enumerate() {
            palm.check(i + 1, t)?;
            let normal = matches!(palm.force, super::ForceReading::Normal(_));
            if normal && !self.options.contacts.frictionless(self.palms[i].friction) {
                return Err(ContactEstimateError::NoForce { palm: i + 1 }.into());
            }
            *kept = Some(*palm);
        }
        Ok(Raw { number: self.count, t, palms })
    }

    fn refuse_stuck(&mut self, t: f64, sensed: &[PalmSensed]) -> Result<(), StreamError> {
        let mut stuck = None;
        // Each is to see every sample.
        for (i, (watch, palm)) in self.watches.iter_mut().zip(sensed).enumerate() {
            let force = match palm.force {
                super::ForceReading::Normal(f) => (DVec3::X * f, SensedAxes::Normal),
                super::ForceReading::Three(f) => (f, SensedAxes::Three),
            };
            let found = watch.take(&palm.pose, palm.contact, force);
            stuck = stuck.or(found.map(|(what, run)| StreamError::Stuck { what, palm: i + 1, t, run }));
        }
        stuck.map_or(Ok(()), Err)
    }

    fn begin(&mut self, number: usize) -> Result<(), StreamError> {
        // A window ends with its newest sample, but for those that it is not read with.
        while self.felt.front().is_some_and(|felt| felt.number + LEFT_OUT < number) {
            self.felt.pop_front();
        }
        let fresh = std::mem::replace(&mut self.fresh, std::mem::take(&mut self.spare));
        self.worker.begin(fresh, self.asked)?;
        let wait = match self.asked {
            Asked::Follow if self.bridged || self.is_gapped() => self.samples(AFTER_GAP),
            Asked::Follow => self.samples(FOLLOWED),
            Asked::Search => self.samples(SEARCHED),
        };
        self.due = Some(number + wait);
        Ok(())
    }

    /// So many natural times in samples.
    fn samples(&self, times: f64) -> usize {
        let natural = self.natural.map_or(0.0, |natural| times * natural * self.options.sample_rate);
        if self.natural.is_none() { FIRST } else { (natural as usize).max(FEWEST) }
    }

    fn take(&mut self, outcome: Outcome, memory: Vec<Raw>, number: usize) {
        self.spare = memory;
        self.natural = outcome.natural;
        self.left_out += outcome.left_out;
        self.next = number;
        let found = outcome.solution.filter(|solution| solution.explained);
        // An iteration that came to no end is no contradiction: the motion of the window before goes on with the forces.
        let unsettled = found.as_ref().is_some_and(|solution| !solution.settled);
        if unsettled && self.asked == Asked::Follow && self.unsettled < UNSETTLED {
            self.unsettled += 1;
            return;
        }
        self.unsettled = 0;
        let found = found.filter(|solution| solution.settled);
        let gravity = self.gravity();
        self.modes = self.modes.take().or(outcome.modes);
        if let Some(newest) = found.and_then(|solution| front(&self.felt, solution, gravity)) {
            // What the window before has foretold is confirmed.
            self.bridged = self.is_gapped();
            let confirmed =
                !self.bridged && self.front.as_ref().is_some_and(|before| before.foretold(&newest));
            let relied_on = newest.solution().relied_on && confirmed;
            self.rounds += usize::from(!relied_on);
            self.stage = if relied_on { StreamStage::Tracking } else { self.searching() };
            self.front = Some(newest);
            let mut freed = outcome.freed;
            for (palm, kept) in self.freed.iter_mut().enumerate() {
                let own = freed.iter().position(|(freed, _)| *freed == palm);
                *kept = own.and_then(|own| front(&self.felt, freed.swap_remove(own).1, gravity));
            }
            self.asked = Asked::Follow;
            return;
        }
        self.rounds += usize::from(outcome.lacks.is_none());
        // What is followed no more for long is forgotten.
        let longest = self.natural.map_or(0.0, |natural| LONGEST * natural);
        if self.front.as_ref().is_some_and(|front| self.latest - front.solution().t > longest) {
            self.front = None;
            self.freed.iter_mut().for_each(|front| *front = None);
        }
        self.stage = match (&self.front, outcome.lacks.is_none()) {
            (Some(_), _) => StreamStage::Contradicted,
            (None, true) => self.searching(),
            (None, false) => StreamStage::Gathering,
        };
        if self.asked == Asked::Search {
            self.next = number + self.samples(outcome.lacks.unwrap_or(PATIENCE));
        }
        self.asked = Asked::Search;
    }

    /// Whether samples were missing for so long that only later contacts can tell how the motion went on.
    fn is_gapped(&self) -> bool {
        self.front.as_ref().is_some_and(|front| front.gapped)
    }

    fn searching(&self) -> StreamStage {
        StreamStage::Searching { rounds: self.rounds }
    }

    fn gravity(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, -self.options.contacts.gravity)
    }
}

/// At the newest sample, from the end of a window.
fn front(felt: &VecDeque<Felt>, solution: Solution, gravity: DVec3) -> Option<Front> {
    let from = felt.iter().position(|felt| felt.number == solution.number)?;
    let mut felt = felt.iter().skip(from);
    let mut front = Front::new(solution, *felt.next()?, gravity);
    felt.for_each(|felt| front.advance(felt));
    Some(front)
}
