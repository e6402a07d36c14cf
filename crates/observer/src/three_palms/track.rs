//! A sensor log as the estimator sees it: contacts in the world, and running integrals of the contact wrench.

use super::quadrature::{RunningIntegral, derivative};
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

/// Integrals from the start of the track, at one time. With the mass known, momentum is affine in the unknowns:
/// `v = v0 + velocity`, `p_WCm = cm0 + v0 t + position`, `L = L0 + moment - cm0 x impulse - v0 x first_moment`.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Integrals {
    pub(super) impulse: DVec3,
    pub(super) first_moment: DVec3,
    pub(super) moment: DVec3,
    pub(super) velocity: DVec3,
    pub(super) position: DVec3,
    /// `-d moment / d(1 / mass)`: integral of the travel by the impulses of a unit mass, times the force.
    pub(super) curl: DVec3,
    /// Rates of impulse, first moment, moment and curl: for interpolation between samples.
    rates: [DVec3; 4],
}

impl Integrals {}

/// The part of a log in contact with all palms, prepared for the momentum form.
#[derive(Clone, Debug)]
pub struct Track {
    pub(super) t: Vec<f64>,
    pub(super) nodes: Vec<Node>,
    pub(super) integrals: Vec<Integrals>,
    /// Impulse, first moment, moment and curl half-way between each node and the next.
    pub(super) middle: Vec<[DVec3; 4]>,
    pub(super) mass: f64,
    pub(super) gravity: DVec3,
    start: f64,
}

impl Track {
    /// The samples of `log` from its start up to the first loss of contact, for a body of known `mass` (kg) under
    /// `gravity` (m/s^2, world).
    ///
    /// Forces are taken as logged, else from torques by the paper's (29) with the palms' moments of inertia (kg m^2).
    ///
    /// # Errors
    /// [`TrackError`].
    pub fn new(
        log: &SensorLog,
        mass: f64,
        gravity: DVec3,
        palm_inertias: Option<[f64; 3]>,
    ) -> Result<Self, TrackError> {
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
        Ok(Self::assemble(t, nodes, mass, gravity, start))
    }

    /// Of nodes at times since `start`.
    pub(super) fn assemble(t: Vec<f64>, nodes: Vec<Node>, mass: f64, gravity: DVec3, start: f64) -> Self {
        let force: Vec<DVec3> = nodes.iter().map(|n| sum(|i| n.forces[i] * n.palms[i].frame.n)).collect();
        let torque: Vec<DVec3> =
            nodes.iter().map(|n| sum(|i| n.p_WC[i].cross(n.forces[i] * n.palms[i].frame.n))).collect();
        let timed: Vec<DVec3> = force.iter().zip(&t).map(|(f, t)| *f * *t).collect();
        let running = RunningIntegral::new(&t);
        let integral = |rates: &[DVec3]| running.of(rates, DVec3::ZERO);
        let impulse = integral(&force);
        let travel = integral(&impulse);
        let first_moment = integral(&timed);
        let position: Vec<DVec3> =
            travel.iter().zip(&t).map(|(x, t)| 0.5 * gravity * *t * *t + *x / mass).collect();
        let moment_rate: Vec<DVec3> = (0..t.len()).map(|k| torque[k] - position[k].cross(force[k])).collect();
        let moment = integral(&moment_rate);
        let curl_rate: Vec<DVec3> = (0..t.len()).map(|k| travel[k].cross(force[k])).collect();
        let curl = integral(&curl_rate);
        let integrals: Vec<Integrals> = (0..t.len())
            .map(|k| Integrals {
                impulse: impulse[k],
                first_moment: first_moment[k],
                moment: moment[k],
                velocity: gravity * t[k] + impulse[k] / mass,
                position: position[k],
                curl: curl[k],
                rates: [force[k], timed[k], moment_rate[k], curl_rate[k]],
            })
            .collect();
        let middle = (1..t.len()).map(|k| interpolate(&t, &integrals, 0.5 * (t[k - 1] + t[k]), k)).collect();
        Self { t, nodes, integrals, middle, mass, gravity, start }
    }

    /// The same track, thinned or not, for a body of another mass, kg.
    pub(super) fn of_mass(&self, mass: f64) -> Self {
        let excess = 1.0 / mass - 1.0 / self.mass;
        let mut all = self.clone();
        all.mass = mass;
        for (k, x) in all.integrals.iter_mut().enumerate() {
            let fall = 0.5 * self.gravity * self.t[k] * self.t[k];
            let scale = self.mass / mass;
            x.velocity += excess * x.impulse;
            x.position = fall + (x.position - fall) * scale;
            x.moment -= excess * x.curl;
            x.rates[2] -= excess * x.rates[3];
        }
        for x in &mut all.middle {
            x[2] -= excess * x[3];
        }
        all
    }

    /// Every `stride`-th sample, with the integrals of all of them and contacts smoothed over the samples left out.
    pub(super) fn thinned(&self, stride: usize) -> Self {
        let stride = stride.max(1);
        let picked: Vec<usize> = (0..self.t.len()).step_by(stride).collect();
        let nodes = picked.iter().map(|&k| self.smoothed(k, stride / 2)).collect();
        let t: Vec<f64> = picked.iter().map(|&k| self.t[k]).collect();
        let integrals = picked.iter().map(|&k| self.integrals[k]).collect();
        let middle = picked
            .windows(2)
            .map(|w| {
                let at = 0.5 * (self.t[w[0]] + self.t[w[1]]);
                let next = self.t.partition_point(|&t| t < at).clamp(1, self.t.len() - 1);
                interpolate(&self.t, &self.integrals, at, next)
            })
            .collect();
        Self { t, nodes, integrals, middle, mass: self.mass, gravity: self.gravity, start: self.start }
    }

    /// The same samples with time running backwards: frictionless motion obeys the same laws with all velocities
    /// reversed.
    pub(super) fn reversed(&self) -> Self {
        let end = self.duration();
        let t = self.t.iter().rev().map(|t| end - t).collect();
        let mut nodes: Vec<Node> = self.nodes.iter().rev().copied().collect();
        for node in &mut nodes {
            for i in 0..3 {
                node.palms[i].rate = -node.palms[i].rate;
                node.lift[i] = -node.lift[i];
            }
        }
        Self::assemble(t, nodes, self.mass, self.gravity, 0.0)
    }

    /// Node `k` with its contacts from a parabola fitted to the `reach` samples on either side (none near the ends).
    fn smoothed(&self, k: usize, reach: usize) -> Node {
        let mut node = self.nodes[k];
        let reach = reach.min(k).min(self.t.len() - 1 - k);
        if reach < 2 {
            return node;
        }
        node.p_WC = [DVec3::ZERO; 3];
        for (j, near) in self.nodes[k - reach..=k + reach].iter().enumerate() {
            let weight = smoothing_weight(reach, j as f64 - reach as f64);
            for i in 0..3 {
                node.p_WC[i] += weight * near.p_WC[i];
            }
        }
        node
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

/// Savitzky-Golay weight of degree 2 over `2 reach + 1` samples, at `offset` from the middle.
fn smoothing_weight(reach: usize, offset: f64) -> f64 {
    let m = reach as f64;
    let norm = (2.0 * m - 1.0) * (2.0 * m + 1.0) * (2.0 * m + 3.0);
    3.0 * (3.0 * m * m + 3.0 * m - 1.0 - 5.0 * offset * offset) / norm
}

/// Variance of a smoothed contact in variances of one sample: the weight of the middle one.
pub(super) fn smoothing_variance(reach: usize) -> f64 {
    if reach < 2 { 1.0 } else { smoothing_weight(reach, 0.0) }
}

fn sum(term: impl Fn(usize) -> DVec3) -> DVec3 {
    term(0) + term(1) + term(2)
}

/// Cubic Hermite interpolation of impulse, first moment, moment and curl between samples `next - 1` and `next`.
fn interpolate(t: &[f64], integrals: &[Integrals], at: f64, next: usize) -> [DVec3; 4] {
    let (a, b) = (&integrals[next - 1], &integrals[next]);
    let h = t[next] - t[next - 1];
    let s = (at - t[next - 1]) / h;
    let values = |x: &Integrals| [x.impulse, x.first_moment, x.moment, x.curl];
    let (va, vb) = (values(a), values(b));
    let (s2, s3) = (s * s, s * s * s);
    std::array::from_fn(|i| {
        va[i] * (2.0 * s3 - 3.0 * s2 + 1.0)
            + a.rates[i] * (h * (s3 - 2.0 * s2 + s))
            + vb[i] * (3.0 * s2 - 2.0 * s3)
            + b.rates[i] * (h * (s3 - s2))
    })
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
