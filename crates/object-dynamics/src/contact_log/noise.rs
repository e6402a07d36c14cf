use super::record::{ContactPoints, ForceChannel, PalmRecord};
use super::{ContactLog, ContactLogError, LoggedPalm};
use glam::DVec3;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;

/// Standard deviations of white noise on a log of contacts.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactNoise {
    /// Of a contact point in each tangent direction of its palm, m.
    pub contact: f64,
    /// Of each axis of a force, N.
    pub force: ChannelNoise,
    /// Of each axis of the impulse over one interval, N s.
    pub impulse: ChannelNoise,
    /// Of a motor's torque, N m.
    pub torque: f64,
}

/// Noise of each axis of a vector: a fixed part, and one that grows with the vector.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ChannelNoise {
    /// Standard deviation of the fixed part, in the unit of the channel.
    pub fixed: f64,
    /// That of the growing part, as a share of the vector's length.
    pub share: f64,
}

impl ChannelNoise {
    /// Standard deviation of each axis of a vector of this length.
    pub(crate) fn deviation(&self, length: f64) -> f64 {
        self.fixed.hypot(self.share * length)
    }
}

impl ContactLog {
    /// The log with noise on its readings; the same seed gives the same noise on every machine. Truth, and where the palms are,
    /// stays as it is. Contacts stay on their palms: on a curved one the noise turns the normal.
    ///
    /// # Errors
    /// [`ContactLogError`] when a standard deviation is so large (or not a number) that the readings are no log any more.
    pub fn with_noise(&self, noise: &ContactNoise, seed: u64) -> Result<Self, ContactLogError> {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut records = self.records();
        let mut sums = vec![DVec3::ZERO; records.len()];
        for k in 0..self.times.len() {
            for (i, record) in records.iter_mut().enumerate() {
                // Every palm draws nine numbers, present or not: a lost contact does not shift the noise of the others.
                let mut draw = || StandardNormal.sample(&mut random);
                let draws = Draws {
                    contact: [draw(), draw()],
                    force: [draw(), draw(), draw()].into(),
                    impulse: [draw(), draw(), draw()].into(),
                    torque: draw(),
                };
                let palm = &self.palms[i];
                sums[i] += draws.impulse * impulse_deviation(palm, noise, k);
                draws.put_on(record, palm, noise, k);
                add(&mut record.impulse, k, sums[i]);
            }
        }
        Self::new(self.times.clone(), records, self.truth.clone())
    }
}

/// Of the interval that ends at sample `k`: zero where the object did not touch the palm.
fn impulse_deviation(palm: &LoggedPalm, noise: &ContactNoise, k: usize) -> f64 {
    match (palm.touch(k), palm.impulse(k)) {
        (Some(_), Some(impulse)) => noise.impulse.deviation(impulse.vector.length()),
        _ => 0.0,
    }
}

/// Standard normal numbers for one palm at one sample.
struct Draws {
    contact: [f64; 2],
    force: DVec3,
    impulse: DVec3,
    torque: f64,
}

impl Draws {
    fn put_on(&self, record: &mut PalmRecord, palm: &LoggedPalm, noise: &ContactNoise, k: usize) {
        // A motor is read whether or not its palm is touched.
        if let Some(torque) = record.torque.as_mut().and_then(|torque| torque[k].as_mut()) {
            *torque += noise.torque * self.torque;
        }
        let Some(touch) = palm.touch(k) else { return };
        if let ContactPoints::World(points) = &mut record.contacts {
            let (a, b) = touch.n.tangent_basis();
            points[k] = Some(touch.p_WC + noise.contact * (self.contact[0] * a + self.contact[1] * b));
        }
        if let Some(force) = palm.force(k) {
            add(&mut record.force, k, self.force * noise.force.deviation(force.vector.length()));
        }
    }
}

/// Adds a vector to a channel, or its first component to one that has one axis.
fn add(channel: &mut ForceChannel, k: usize, by: DVec3) {
    match channel {
        ForceChannel::Missing => {}
        ForceChannel::Normal(values) => values[k] += by.x,
        ForceChannel::Three(vectors) => vectors[k] += by,
    }
}
