//! Seeded sensor noise on a planar log.

use super::log::PlanarLog;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;

/// Standard deviations of white Gaussian sensor noise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarNoise {
    /// Of the contact positions `s_i`, m.
    pub contact: f64,
    /// Of the contact forces, N.
    pub force: f64,
    /// Of the motor torques, N m.
    pub torque: f64,
}

impl PlanarNoise {
    /// The log with noise added; the same seed gives the same noise.
    #[must_use]
    pub fn add_to(&self, log: &PlanarLog, seed: u64) -> PlanarLog {
        let mut source = Pcg64Mcg::seed_from_u64(seed);
        let mut draw = |scale: f64| -> f64 {
            let unit: f64 = StandardNormal.sample(&mut source);
            scale * unit
        };
        let mut noisy = log.clone();
        for sample in noisy.samples_mut() {
            sample.contacts = sample.contacts.map(|s| s.map(|s| s + draw(self.contact)));
            sample.forces = sample.forces.map(|f| f.map(|f| f + draw(self.force)));
            sample.torques = sample.torques.map(|tau| tau.map(|tau| tau + draw(self.torque)));
        }
        noisy
    }
}
