//! A sensor log of three palms: contacts in the world, and forces.

use crate::quadrature::derivative;
use contact_kinematics::{PalmError, PalmFrame, PalmState};
use glam::DVec3;
use object_dynamics::{PalmReading, Sample, SensorLog};
use thiserror::Error;

/// Fewest samples that an estimate is made from.
pub(super) const FEWEST_SAMPLES: usize = 8;
/// Shortest lever of a palm's torque that a force is taken from, as a share of the contact's distance.
const SHORTEST_LEVER: f64 = 1e-3;
/// Rotational acceleration of a palm, rad/s^2, below which its own inertia does not enter its torque to speak of.
const STILL: f64 = 1e-3;

/// Why a log cannot be turned into a track.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TrackError {
    /// Too few samples before contact is lost.
    #[error(
        "only {found} sample(s) with contact on all three palms at the start of the log; at least {FEWEST_SAMPLES} are needed"
    )]
    TooFewSamples {
        /// How many there are.
        found: usize,
    },
    /// A palm's frame is undefined.
    #[error("palm {palm} at t = {t} s: {source}")]
    Palm {
        /// Palm number from 1.
        palm: usize,
        /// Time in s.
        t: f64,
        /// Why.
        source: PalmError,
    },
    /// Neither a force nor a usable torque.
    #[error(
        "palm {palm} has no contact force at t = {t} s: the log needs f_{palm}, or tau_{palm} with the palm's moment of inertia and a contact away from its axis (a log of contacts: fn_{palm}, or the impulse of every palm in three axes, Jx_{palm}, Jy_{palm}, Jz_{palm}); an ellipsoid is found from contacts alone (`estimate_without_forces`, `recon reconstruct --without-forces`)"
    )]
    NoForce {
        /// Palm number from 1.
        palm: usize,
        /// Time in s.
        t: f64,
    },
}

/// One sample: contacts and palms.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub(super) palms: [PalmState; 3],
    pub(super) p_WC: [DVec3; 3],
    pub(super) forces: [f64; 3],
    /// `p_i = -s_i2 rate_i`: minus the speed of the palm's surface along its normal at the contact.
    pub(super) lift: [f64; 3],
}

impl Node {
    /// Of a sample in contact with all palms, which stand and turn as given.
    pub(super) fn new(
        sample: &Sample,
        palms: [PalmState; 3],
        palm_inertias: Option<[f64; 3]>,
    ) -> Result<Self, TrackError> {
        let s = sample.palms.map(|p| p.contact.unwrap_or_default());
        let p_WC = std::array::from_fn(|i| palms[i].frame.contact_from_sensor(s[i]));
        let lift = std::array::from_fn(|i| -s[i][1] * palms[i].rate);
        let mut forces = [0.0; 3];
        for i in 0..3 {
            forces[i] = force(&sample.palms[i], s[i], &palms[i], palm_inertias.map(|inertias| inertias[i]))
                .ok_or(TrackError::NoForce { palm: i + 1, t: sample.t })?;
        }
        Ok(Self { palms, p_WC, forces, lift })
    }
}

/// The part of a log in contact with all palms.
#[derive(Clone, Debug)]
pub struct Track {
    pub(super) t: Vec<f64>,
    pub(super) nodes: Vec<Node>,
    pub(super) gravity: DVec3,
    start: f64,
}

impl Track {
    /// The samples of `log` from its start up to the first loss of contact, under `gravity` (m/s^2, world).
    ///
    /// Forces are taken as logged, else from torques by the paper's (29) with the palms' moments of inertia (kg m^2).
    ///
    /// # Errors
    /// [`TrackError`].
    pub fn new(log: &SensorLog, gravity: DVec3, palm_inertias: Option<[f64; 3]>) -> Result<Self, TrackError> {
        let end = log.first_contact_loss().map_or(log.samples().len(), |(sample, _)| sample);
        if end < FEWEST_SAMPLES {
            return Err(TrackError::TooFewSamples { found: end });
        }
        let samples = &log.samples()[..end];
        let start = samples[0].t;
        let t: Vec<f64> = samples.iter().map(|s| s.t - start).collect();
        let mut palms = Vec::with_capacity(3);
        for i in 0..3 {
            let readings: Vec<&PalmReading> = samples.iter().map(|s| &s.palms[i]).collect();
            palms.push(palm_states(i, start, &t, &readings)?);
        }
        let mut nodes = Vec::with_capacity(end);
        for (k, sample) in samples.iter().enumerate() {
            nodes.push(Node::new(sample, [palms[0][k], palms[1][k], palms[2][k]], palm_inertias)?);
        }
        Ok(Self { t, nodes, gravity, start })
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.t.len()
    }

    /// Whether there is no sample; never, for a track that was made from a log.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.t.is_empty()
    }

    /// Times of the samples as in the log, in s.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        self.t.iter().map(|t| t + self.start)
    }

    /// Time from the first sample to the last, in s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.t.last().copied().unwrap_or(0.0)
    }
}

/// Frames, rates and accelerations of palm `i`, at times `t` since `start`.
pub(super) fn palm_states(
    i: usize,
    start: f64,
    t: &[f64],
    readings: &[&PalmReading],
) -> Result<Vec<PalmState>, TrackError> {
    let normals: Vec<DVec3> = readings.iter().map(|r| r.normal.get()).collect();
    // A palm that stands still, as most do, has one frame.
    let still = normals.windows(2).all(|pair| pair[0] == pair[1]);
    if let (true, Some((first, &t0))) =
        (still && readings.iter().all(|r| r.rate.is_none()), readings.iter().zip(t).next())
    {
        let frame = PalmFrame::from_normal(first.normal).map_err(|source| TrackError::Palm {
            palm: i + 1,
            t: start + t0,
            source,
        })?;
        return Ok(vec![PalmState { frame, rate: 0.0, acceleration: 0.0 }; t.len()]);
    }
    let mut frames = Vec::with_capacity(t.len());
    for (reading, t) in readings.iter().zip(t) {
        let frame = PalmFrame::from_normal(reading.normal);
        frames.push(frame.map_err(|source| TrackError::Palm { palm: i + 1, t: start + t, source })?);
    }
    let turning = derivative(t, &normals, DVec3::ZERO);
    // n' = rate t1 x n = -rate t2.
    let rates: Vec<f64> =
        (0..t.len()).map(|k| readings[k].rate.unwrap_or_else(|| -frames[k].t2.dot(turning[k]))).collect();
    let accelerations = derivative(t, &rates, 0.0);
    Ok((0..t.len())
        .map(|k| PalmState { frame: frames[k], rate: rates[k], acceleration: accelerations[k] })
        .collect())
}

/// Contact force of one palm: as logged, else `(tau - I alpha) / s2` (paper, (29)).
fn force(reading: &PalmReading, s: [f64; 2], palm: &PalmState, inertia: Option<f64>) -> Option<f64> {
    if reading.force.is_some() {
        return reading.force;
    }
    let lever = s[1];
    let usable = lever.abs() > SHORTEST_LEVER * s[0].hypot(lever);
    let torque = reading.torque.filter(|_| usable)?;
    let inertial = match inertia {
        Some(inertia) => inertia * palm.acceleration,
        None if palm.acceleration.abs() < STILL => 0.0,
        None => return None,
    };
    Some((torque - inertial) / lever)
}
