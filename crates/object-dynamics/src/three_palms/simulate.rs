use super::{Instant, ThreePalmScene};
use crate::integrate::{DenseOutput, Dop853, IntegrationError, Statistics, Tolerance, find_root};
use crate::{LogError, PalmReading, Sample, SensorLog, TrueState};
use contact_kinematics::{Direction, PalmError, SupportFunction};
use glam::{DQuat, DVec3};
use std::cell::Cell;
use thiserror::Error;

/// Below this share of the total contact force a step is searched for a loss of contact inside of it.
const SUSPICIOUS_SHARE: f64 = 0.05;
/// Points at which such a step is searched: a dip shorter than this share of a step can pass unnoticed.
const SEARCH_POINTS: u32 = 16;
/// Most samples a simulation may be asked for: each takes 1.5 kB.
const MOST_SAMPLES: usize = 1_000_000;

/// Orientation and angular velocity at `t = 0`; the palms determine the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InitialMotion {
    /// Orientation, body to world; normalised on use.
    pub R_WO: DQuat,
    /// Angular velocity, rad/s, world axes.
    pub w_WO: DVec3,
}

/// Equidistant sample times `0, 1 / rate, ...` up to `duration`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleTimes {
    /// In s.
    pub duration: f64,
    /// In 1/s.
    pub rate: f64,
}

impl SampleTimes {
    /// All of them, s.
    ///
    /// # Errors
    /// [`SimulationError::SampleTimes`] unless duration and rate are positive and the samples are not too many.
    pub fn all(self) -> Result<Vec<f64>, SimulationError> {
        Ok((0..check_times(self)?).map(|k| k as f64 / self.rate).collect())
    }
}

/// How a simulation ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// All samples were reached with three contacts.
    Completed,
    /// A palm lost contact: the three-contact equations hold no longer.
    ContactLost {
        /// Palm number from 0.
        palm: usize,
        /// When its force reached zero, in s.
        t: f64,
    },
}

/// A simulated motion.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// One for each sample time up to the end.
    pub instants: Vec<Instant>,
    /// How it ended.
    pub end: End,
    /// Work of the integrator.
    pub statistics: Statistics,
}

/// Why a simulation cannot start or go on.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SimulationError {
    /// A number that must be positive is not, or there would be too many samples.
    #[error("{what} is {value}; it must be positive and finite, and samples at most {MOST_SAMPLES}")]
    SampleTimes {
        /// Which number.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// The initial orientation or angular velocity is not usable.
    #[error("initial {what} is not usable: it must be finite, and the quaternion not zero")]
    InitialMotion {
        /// Which.
        what: &'static str,
    },
    /// A palm would have to pull to hold the body at the start.
    #[error("palm {palm} would have to pull with {force:.3e} N at t = 0; start slower or turn the palms")]
    NotInContact {
        /// Palm number from 1.
        palm: usize,
        /// Its force in N.
        force: f64,
    },
    /// The equations of motion could not be integrated.
    #[error("integration: {0}")]
    Integration(#[source] IntegrationError<PalmError>),
    /// The samples do not make a log.
    #[error("sensor log: {0}")]
    Log(#[source] LogError),
}

impl<S: SupportFunction> ThreePalmScene<S> {
    /// Simulates from `start`, until the last sample or until a palm loses contact.
    ///
    /// Orientation and angular velocity by DOP853 with the quaternion kept unit; samples from its dense output, a
    /// polynomial of order 7 (keep the tolerance a decade or two below what the samples need).
    ///
    /// # Errors
    /// [`SimulationError`].
    pub fn simulate(
        &self,
        start: InitialMotion,
        times: SampleTimes,
        tolerance: Tolerance,
    ) -> Result<Simulation, SimulationError> {
        let count = check_times(times)?;
        let first = self.first_instant(start)?;
        let smallest_share = Cell::new(f64::INFINITY);
        let field = |t: f64, y: &[f64; 7]| -> Result<[f64; 7], PalmError> {
            let (rate, share) = self.rate(t, y)?;
            smallest_share.set(smallest_share.get().min(share));
            Ok(rate)
        };
        let mut solver = Dop853::new(field, 0.0, pack(first.R_WO, first.w_WO), tolerance)
            .map_err(SimulationError::Integration)?;
        let mut instants = Vec::with_capacity(count);
        instants.push(first);
        let last = (count - 1) as f64 / times.rate;
        let mut end = End::Completed;
        while solver.time() < last && end == End::Completed {
            smallest_share.set(f64::INFINITY);
            solver.step(last, normalise_state).map_err(SimulationError::Integration)?;
            let suspicious = smallest_share.get() < SUSPICIOUS_SHARE;
            let next = instants.len() as f64 / times.rate;
            if !suspicious && next > solver.time() {
                continue;
            }
            let Some(dense) = solver.dense().map_err(SimulationError::Integration)? else { continue };
            if suspicious && let Some((palm, t)) = self.contact_loss(&dense)? {
                end = End::ContactLost { palm, t };
            }
            let limit = if let End::ContactLost { t, .. } = end { t } else { solver.time() };
            while instants.len() < count {
                let t = instants.len() as f64 / times.rate;
                if t > limit {
                    break;
                }
                instants.push(self.instant_of(t, &dense.at(t))?);
            }
        }
        Ok(Simulation { instants, end, statistics: solver.statistics() })
    }

    fn first_instant(&self, start: InitialMotion) -> Result<Instant, SimulationError> {
        if !(start.R_WO.is_finite() && start.R_WO.length() > 1e-6) {
            return Err(SimulationError::InitialMotion { what: "orientation" });
        }
        if !start.w_WO.is_finite() {
            return Err(SimulationError::InitialMotion { what: "angular velocity" });
        }
        let first = self.instant_of(0.0, &pack(start.R_WO.normalize(), start.w_WO))?;
        let (palm, force) = first.weakest_contact();
        // A NaN force is not above zero either.
        if force > 0.0 { Ok(first) } else { Err(SimulationError::NotInContact { palm: palm + 1, force }) }
    }

    /// Rate of the packed state, and the smallest share of a contact force in their sum.
    fn rate(&self, t: f64, y: &[f64; 7]) -> Result<([f64; 7], f64), PalmError> {
        let (R_WO, w) = unpack(y);
        let Instant { accelerations, .. } = self.instant(t, R_WO.normalize(), w)?;
        let q_dot = DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * R_WO * 0.5;
        let total: f64 = accelerations.forces.iter().map(|f| f.abs()).sum();
        let weakest = accelerations.forces.iter().copied().fold(f64::INFINITY, f64::min);
        let share = if total > 0.0 { weakest / total } else { 0.0 };
        Ok((pack(q_dot, accelerations.alpha_WO), share))
    }

    fn instant_of(&self, t: f64, y: &[f64; 7]) -> Result<Instant, SimulationError> {
        let (R_WO, w) = unpack(y);
        self.instant(t, R_WO.normalize(), w)
            .map_err(|source| SimulationError::Integration(IntegrationError::Field { t, source }))
    }

    /// First time inside of a step at which a contact force falls through zero.
    fn contact_loss(&self, dense: &DenseOutput<7>) -> Result<Option<(usize, f64)>, SimulationError> {
        let (start, end) = (dense.start(), dense.end());
        let mut before = start;
        for k in 1..=SEARCH_POINTS {
            let t = start + (end - start) * f64::from(k) / f64::from(SEARCH_POINTS);
            let (palm, force) = self.instant_of(t, &dense.at(t))?.weakest_contact();
            if force <= 0.0 {
                let force_at = |t: f64| {
                    self.instant_of(t, &dense.at(t)).map_or(f64::NAN, |now| now.accelerations.forces[palm])
                };
                // Without a sign change the force was zero at the last point already.
                let t = find_root(force_at, before, t, 1e-13 * end.abs().max(1.0)).unwrap_or(before);
                return Ok(Some((palm, t)));
            }
            before = t;
        }
        Ok(None)
    }
}

impl Simulation {
    /// The motion as a log of ideal sensors, truth included; torques where the scene knows the palms' inertias.
    ///
    /// # Errors
    /// [`SimulationError::Log`] when the motion ended before its second sample.
    pub fn sensor_log<S: SupportFunction>(
        &self,
        scene: &ThreePalmScene<S>,
    ) -> Result<SensorLog, SimulationError> {
        let reading = |now: &Instant, i: usize| PalmReading {
            normal: Direction::new_unchecked(now.palms[i].frame.n),
            contact: Some(now.sensor(i)),
            force: Some(now.accelerations.forces[i]),
            torque: scene.palm_inertias().map(|inertias| now.torque(i, inertias[i])),
            rate: Some(now.palms[i].rate),
        };
        let samples = self
            .instants
            .iter()
            .map(|now| Sample { t: now.t, palms: std::array::from_fn(|i| reading(now, i)) })
            .collect();
        let truth = self.instants.iter().map(|now| TrueState {
            p_WCm: now.touch.p_WCm,
            R_WO: now.R_WO,
            v_WCm: now.rates.v_WCm,
            w_WO: now.w_WO,
        });
        SensorLog::new(samples, Some(truth.collect())).map_err(SimulationError::Log)
    }
}

pub(crate) fn check_times(times: SampleTimes) -> Result<usize, SimulationError> {
    for (what, value) in [("duration", times.duration), ("sample rate", times.rate)] {
        if !(value > 0.0 && value.is_finite()) {
            return Err(SimulationError::SampleTimes { what, value });
        }
    }
    // A hair of slack, so that 4.2 s at 1 kHz has its last sample.
    let samples = (times.duration * times.rate * (1.0 + 1e-12) + 1e-9).floor() + 1.0;
    if samples > MOST_SAMPLES as f64 {
        return Err(SimulationError::SampleTimes { what: "number of samples", value: samples });
    }
    Ok(samples as usize)
}

fn pack(q: DQuat, w: DVec3) -> [f64; 7] {
    [q.w, q.x, q.y, q.z, w.x, w.y, w.z]
}

fn unpack(y: &[f64; 7]) -> (DQuat, DVec3) {
    (DQuat::from_xyzw(y[1], y[2], y[3], y[0]), DVec3::new(y[4], y[5], y[6]))
}

fn normalise_state(y: &mut [f64; 7]) {
    let (q, w) = unpack(y);
    *y = pack(q.normalize(), w);
}
