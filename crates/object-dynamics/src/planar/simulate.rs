//! Simulation between palms that move as prescribed, and the driver that both simulations share.

use super::error::{PlanarLogError, PlanarSimulationError};
use super::log::{PlanarLog, PlanarSample, PlanarTruth};
use super::motion::PairMotion;
use super::reaction::PlanarObject;
use crate::integrate::{Dop853, Tolerance, find_root};
use contact_kinematics::planar::{PalmPairError, RadiusFunction};

/// Points inside of each integration step at which the sign of the contact forces is looked at. A force that dips below
/// zero and back between two of them is missed; a step resolves the motion to its tolerance, so such a dip is short.
const EVENT_CHECKS: u32 = 8;
/// Absolute tolerance against the relative one: angles, rates (rad/s) and work (J) of a scene are not far below 1e-2.
const ABSOLUTE_SHARE: f64 = 1e-2;

/// Orientation (rad) and angular velocity (rad/s) at the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarStart {
    /// Orientation in rad.
    pub phi0: f64,
    /// Angular velocity in rad/s.
    pub omega0: f64,
}

/// One instant of a simulated run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarRunSample {
    /// What the palms sense, noise-free: contacts, forces and torques.
    pub sample: PlanarSample,
    /// State of the object.
    pub truth: PlanarTruth,
    /// Angular acceleration of the object, rad/s^2.
    pub alpha0: f64,
    /// Absolute palm rates, rad/s.
    pub palm_rates: [f64; 2],
    /// Kinetic and potential energy of the object (and of driven palms), J.
    pub energy: f64,
    /// Work done by the palms (or the motors of driven palms) since the first sample, J.
    pub work: f64,
}

/// Where and when a contact broke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LostContact {
    /// Time in s.
    pub t: f64,
    /// Palm index, from 0.
    pub palm: usize,
}

/// A simulated run: its samples up to the end or up to the first loss of contact.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarRun {
    /// Samples at the times asked for, while both contacts hold.
    pub samples: Vec<PlanarRunSample>,
    /// The first loss of contact, where there is one before the last time asked for.
    pub lost: Option<LostContact>,
}

impl PlanarRun {
    /// The run as a log with truth.
    ///
    /// # Errors
    /// [`SeriesError::TooShort`](crate::SeriesError) when contact broke before the second sample.
    pub fn log(&self) -> Result<PlanarLog, PlanarLogError> {
        let truth = self.samples.iter().map(|s| s.truth).collect();
        PlanarLog::new(self.samples.iter().map(|s| s.sample).collect(), Some(truth))
    }

    /// Largest departure of energy from start energy plus work, as a fraction of the largest energy seen.
    #[must_use]
    pub fn energy_drift(&self) -> f64 {
        let Some(first) = self.samples.first() else { return 0.0 };
        let worst = self.samples.iter().map(|s| (s.energy - first.energy - s.work).abs()).fold(0.0, f64::max);
        worst / self.samples.iter().map(|s| s.energy.abs()).fold(f64::MIN_POSITIVE, f64::max)
    }
}

/// Simulates `object` between palms in prescribed `motion`, sampled at `times` (s), to the relative `tolerance` per step.
///
/// State: orientation, angular velocity and the palms' work (`f_1 s_1 W_1 - f_2 s_2 W_2` integrated). Motor torques in the
/// samples are those of massless palms, `tau_1 = f_1 s_1`, `tau_2 = -f_2 s_2`; heavy ones add `I_i A_i`.
///
/// # Errors
/// [`PlanarSimulationError`]: unusable times, or palms that close their wedge. Loss of contact is no error; it ends the run.
pub fn simulate_prescribed(
    object: &PlanarObject<impl RadiusFunction>,
    motion: &impl PairMotion,
    start: PlanarStart,
    times: &[f64],
    tolerance: f64,
) -> Result<PlanarRun, PlanarSimulationError> {
    let field = |t: f64, y: &[f64; 3]| {
        let palms = motion.at(t)?;
        let reaction = object.reaction(&palms, y[0], y[1]);
        let [w1, w2] = palms.motion.rates;
        let ([f1, f2], [s1, s2]) = (reaction.forces, reaction.contact.s);
        Ok([y[1], reaction.alpha0, f1 * s1 * w1 - f2 * s2 * w2])
    };
    let observe = |t: f64, y: &[f64; 3]| {
        let palms = motion.at(t)?;
        let reaction = object.reaction(&palms, y[0], y[1]);
        let ([f1, f2], [s1, s2]) = (reaction.forces, reaction.contact.s);
        let [p1, p2] = palms.pair.angles();
        Ok(PlanarRunSample {
            sample: PlanarSample {
                t,
                angles: [p1, p2 - p1],
                contacts: [Some(s1), Some(s2)],
                forces: Some([f1, f2]),
                torques: Some([f1 * s1, -f2 * s2]),
            },
            truth: PlanarTruth {
                p_WCm: reaction.contact.p_WCm,
                phi0: y[0],
                v_WCm: reaction.v_WCm,
                omega0: y[1],
            },
            alpha0: reaction.alpha0,
            palm_rates: palms.motion.rates,
            energy: object.energy(reaction.contact.p_WCm, reaction.v_WCm, y[1]),
            work: y[2],
        })
    };
    drive(field, observe, [start.phi0, start.omega0, 0.0], times, tolerance)
}

/// Integrates `field` and samples it at `times` through dense output, until a contact force falls to zero.
pub(super) fn drive<const N: usize>(
    field: impl FnMut(f64, &[f64; N]) -> Result<[f64; N], PalmPairError>,
    observe: impl Fn(f64, &[f64; N]) -> Result<PlanarRunSample, PalmPairError>,
    start: [f64; N],
    times: &[f64],
    tolerance: f64,
) -> Result<PlanarRun, PlanarSimulationError> {
    check_times(times)?;
    let (first, last) = (times[0], times[times.len() - 1]);
    let observe = |t, y: &[f64; N]| {
        observe(t, y).map_err(|source| crate::integrate::IntegrationError::Field { t, source })
    };
    let tolerance = Tolerance { relative: tolerance, absolute: ABSOLUTE_SHARE * tolerance };
    let mut solver = Dop853::new(field, first, start, tolerance)?;
    let mut run = PlanarRun { samples: Vec::with_capacity(times.len()), lost: None };
    let initial = observe(first, &start)?;
    if let Some(palm) = broken(&initial) {
        run.lost = Some(LostContact { t: first, palm });
        return Ok(run);
    }
    run.samples.push(initial);
    while solver.time() < last {
        solver.step(last, |_| ())?;
        let end = solver.time();
        let Some(dense) = solver.dense()? else { break };
        run.lost = first_break(&dense, end, &observe)?;
        let until = run.lost.map_or(end, |lost| lost.t);
        while let Some(&t) = times.get(run.samples.len()).filter(|&&t| t <= until) {
            let state = if t == end { *solver.state() } else { dense.at(t) };
            run.samples.push(observe(t, &state)?);
        }
        if run.lost.is_some() {
            break;
        }
    }
    Ok(run)
}

fn broken(sample: &PlanarRunSample) -> Option<usize> {
    // Written so that a NaN counts as broken.
    sample.sample.forces.and_then(|f| f.iter().position(|&f| f.is_nan() || f <= 0.0))
}

/// First instant of the step at which a contact force is zero.
fn first_break<const N: usize, E>(
    dense: &crate::integrate::DenseOutput<N>,
    end: f64,
    observe: &impl Fn(f64, &[f64; N]) -> Result<PlanarRunSample, E>,
) -> Result<Option<LostContact>, E> {
    let start = dense.start();
    let mut before = start;
    for check in 1..=EVENT_CHECKS {
        let t = if check == EVENT_CHECKS {
            end
        } else {
            start + (end - start) * f64::from(check) / f64::from(EVENT_CHECKS)
        };
        if let Some(palm) = broken(&observe(t, &dense.at(t))?) {
            let force = |palm: usize, t: f64| {
                let sample = observe(t, &dense.at(t)).ok().and_then(|s| s.sample.forces);
                sample.map_or(f64::NAN, |f| f[palm])
            };
            // Both may fall within one interval: the earlier one counts. No sign change means that it broke at `t`.
            let roots = [0, 1].map(|p| find_root(|t| force(p, t), before, t, f64::EPSILON * t.abs()).ok());
            let earliest = match roots {
                [Some(a), Some(b)] if b < a => LostContact { t: b, palm: 1 },
                [Some(a), _] => LostContact { t: a, palm: 0 },
                [None, Some(b)] => LostContact { t: b, palm: 1 },
                [None, None] => LostContact { t, palm },
            };
            return Ok(Some(earliest));
        }
        before = t;
    }
    Ok(None)
}

fn check_times(times: &[f64]) -> Result<(), PlanarSimulationError> {
    if times.is_empty() {
        return Err(PlanarSimulationError::NoTimes);
    }
    for (index, &time) in times.iter().enumerate() {
        if !time.is_finite() || index > 0 && time <= times[index - 1] {
            return Err(PlanarSimulationError::Times { index, time });
        }
    }
    Ok(())
}
