//! A log without forces: palms at nodes and half-way between, and means of the contacts over blocks about nodes.

use super::NoForceError;
use crate::predicted::predicted;
use crate::roughness::Rough;
use crate::three_palms::track::{FEWEST_SAMPLES, TrackError, palm_states};
use contact_kinematics::{PalmState, PalmTriple};
use glam::{DMat3, DVec3};
use object_dynamics::{PalmReading, SensorLog};

/// Sensor coordinates of the three contacts.
pub(super) type Contacts = [[f64; 2]; 3];

/// Palms at one time.
pub(super) type Palms = ([PalmState; 3], PalmTriple);

/// The part of a log in contact with all palms.
pub(super) struct TouchSeries {
    /// Times of the samples since the first, s.
    pub(super) t: Vec<f64>,
    pub(super) start: f64,
    pub(super) palms: Vec<Palms>,
    pub(super) contacts: Vec<Contacts>,
}

/// Every so many samples of a series.
#[derive(Clone)]
pub(super) struct Nodes {
    pub(super) t: Vec<f64>,
    /// At nodes and half-way between, in turns.
    pub(super) palms: Vec<Palms>,
    /// Means over a block about each inner node.
    pub(super) means: Vec<Contacts>,
    /// Mean of `u^2 / 2` over a block, in squared spacings of the nodes.
    pub(super) curved: f64,
    /// Variance of a mean in variances of a sample.
    pub(super) variance: f64,
    /// What is missed of the rates of palms between those that are used, rad/s.
    pub(super) missed_rates: f64,
}

impl TouchSeries {
    pub(super) fn new(log: &SensorLog) -> Result<Self, NoForceError> {
        // A contact is lost when it is not felt; forces are not looked at.
        let end = log.samples().iter().position(|s| s.palms.iter().any(|p| p.contact.is_none()));
        let samples = &log.samples()[..end.unwrap_or(log.samples().len())];
        if samples.len() < FEWEST_SAMPLES {
            return Err(NoForceError::Log(TrackError::TooFewSamples { found: samples.len() }));
        }
        let start = samples[0].t;
        let t: Vec<f64> = samples.iter().map(|s| s.t - start).collect();
        let mut states = Vec::with_capacity(3);
        for i in 0..3 {
            let readings: Vec<&PalmReading> = samples.iter().map(|s| &s.palms[i]).collect();
            states.push(palm_states(i, start, &t, &readings).map_err(NoForceError::Log)?);
        }
        let mut palms = Vec::with_capacity(samples.len());
        for (k, time) in t.iter().enumerate() {
            let three = [states[0][k], states[1][k], states[2][k]];
            let triple = PalmTriple::new(three.map(|p| p.frame.n))
                .map_err(|source| NoForceError::Palms { t: start + time, source })?;
            palms.push((three, triple));
        }
        let contacts =
            samples.iter().map(|s| std::array::from_fn(|i| s.palms[i].contact.unwrap_or_default())).collect();
        Ok(Self { t, start, palms, contacts })
    }

    pub(super) fn duration(&self) -> f64 {
        self.t.last().copied().unwrap_or_default()
    }

    /// Standard deviation of the contacts' noise by their roughness, m.
    pub(super) fn noise(&self) -> f64 {
        roughness(&self.t, |i, k| self.contacts[k][i])
    }

    /// Where the normals at the contacts of the first sample pass each other most closely, and the mean distance of the
    /// palms from there: centre and radius, were the body a ball.
    pub(super) fn ball(&self) -> (DVec3, f64) {
        let (palms, s) = (&self.palms[0].0, &self.contacts[0]);
        let mut matrix = DMat3::ZERO;
        let mut rhs = DVec3::ZERO;
        for i in 0..3 {
            let frame = &palms[i].frame;
            let n = frame.n;
            let across = DMat3::IDENTITY - DMat3::from_cols(n * n.x, n * n.y, n * n.z);
            matrix += across;
            rhs += across * frame.contact_from_sensor(s[i]);
        }
        // Regular: the palms' normals are not parallel, or there were no triple.
        let centre = matrix.inverse() * rhs;
        (centre, (0..3).map(|i| palms[i].frame.n.dot(centre)).sum::<f64>() / 3.0)
    }

    /// What rates are off by, rad/s, as the angles between samples tell: of palms that shake so fast that samples of them look slow.
    fn against_angles(&self) -> f64 {
        let one = |k: usize| {
            let h = self.t[k + 1] - self.t[k];
            let off = |i: usize| {
                let [a, b] = [&self.palms[k].0[i], &self.palms[k + 1].0[i]];
                let turned = a.frame.t1.dot(a.frame.n.cross(b.frame.n)).clamp(-1.0, 1.0).asin();
                let stated = 0.5 * (a.rate + b.rate) + h / 12.0 * (a.acceleration - b.acceleration);
                turned / h - stated
            };
            (0..3).map(|i| off(i).powi(2)).sum::<f64>()
        };
        let intervals = self.t.len() - 1;
        ((0..intervals).map(one).sum::<f64>() / intervals as f64).sqrt()
    }

    /// Nodes at every `stride`-th sample (an even number).
    pub(super) fn nodes(&self, stride: usize) -> Nodes {
        let half = stride / 2;
        let count = (self.t.len() - 1) / stride;
        let weight = |j: usize| if j == 0 || j == stride { 0.5 / stride as f64 } else { 1.0 / stride as f64 };
        let mean = |node: usize| -> Contacts {
            let begin = node * stride - half;
            std::array::from_fn(|i| {
                std::array::from_fn(|axis| {
                    (0..=stride).map(|j| weight(j) * self.contacts[begin + j][i][axis]).sum()
                })
            })
        };
        let curved = (0..=stride).map(|j| 0.5 * weight(j) * (j as f64 / stride as f64 - 0.5).powi(2)).sum();
        let used: Vec<f64> = self.t.iter().copied().step_by(half).collect();
        let missed = predicted(&used, |k| self.palms[k * half].0.map(|palm| palm.rate));
        Nodes {
            missed_rates: missed.map_or(0.0, |of| of.off * of.falls.sqrt()).hypot(self.against_angles()),
            t: (0..=count).map(|k| self.t[k * stride]).collect(),
            palms: (0..=2 * count).map(|k| self.palms[k * half]).collect(),
            means: (1..count).map(mean).collect(),
            curved,
            variance: (0..=stride).map(|j| weight(j).powi(2)).sum(),
        }
    }
}

/// Standard deviation of the white noise that is common to the contact coordinates of three palms, by palm and sample.
fn roughness(times: &[f64], contact: impl Fn(usize, usize) -> [f64; 2]) -> f64 {
    let mut rough = Rough::default();
    for i in 0..3 {
        let point = |k: usize| Some(DVec3::new(contact(i, k)[0], contact(i, k)[1], 0.0));
        rough.add(times, point, |_| [DVec3::X, DVec3::Y].into());
    }
    rough.deviation()
}
