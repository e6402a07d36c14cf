//! Seeded Gaussian noise on the readings of a log.

use crate::{LogError, Sample, SensorLog};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::SeedableRng;

/// Standard deviations of white sensor noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorNoise {
    /// Of each contact coordinate, m.
    pub contact: f64,
    /// Of each contact force, N.
    pub force: f64,
    /// Of each motor torque, N m.
    pub torque: f64,
}

impl SensorLog {
    /// The log with noise on its readings; the same seed gives the same noise on every machine. Truth stays as it is.
    ///
    /// # Errors
    /// [`LogError`] when a standard deviation is so large (or not a number) that the readings are no log any more.
    pub fn with_noise(&self, noise: &SensorNoise, seed: u64) -> Result<Self, LogError> {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut draw = move |deviation: f64| {
            let unit: f64 = StandardNormal.sample(&mut random);
            deviation * unit
        };
        let mut samples: Vec<Sample> = self.samples().to_vec();
        for palm in samples.iter_mut().flat_map(|sample| &mut sample.palms) {
            // Every palm draws four numbers, present or not: a lost contact does not shift the noise of the others.
            let [s1, s2, force, torque] =
                [draw(noise.contact), draw(noise.contact), draw(noise.force), draw(noise.torque)];
            palm.contact = palm.contact.map(|s| [s[0] + s1, s[1] + s2]);
            palm.force = palm.force.map(|f| f + force);
            palm.torque = palm.torque.map(|t| t + torque);
        }
        Self::new(samples, self.truth().map(<[_]>::to_vec))
    }
}
