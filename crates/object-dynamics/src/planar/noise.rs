//! Seeded sensor noise on planar logs.

use super::contact_log::ContactLog;
use super::log::PlanarLog;
use glam::DVec2;
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

/// Standard deviations of white Gaussian sensor noise of palms of any number and shape.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactNoise {
    /// Of each coordinate of the contact points, m.
    pub contact: f64,
    /// Of each component of the contact forces, N, whether there is contact or not.
    pub force: f64,
    /// The same as a share of the force's size, added in square.
    pub force_share: f64,
}

impl ContactNoise {
    /// The log with noise added; the same seed gives the same noise.
    #[must_use]
    pub fn add_to(&self, log: &ContactLog, seed: u64) -> ContactLog {
        let mut source = Pcg64Mcg::seed_from_u64(seed);
        let mut draw = |scale: f64| {
            let mut unit = || -> f64 { StandardNormal.sample(&mut source) };
            scale * DVec2::new(unit(), unit())
        };
        let mut noisy = log.clone();
        for palm in noisy.samples_mut().iter_mut().flat_map(|sample| &mut sample.palms) {
            palm.p_WC = palm.p_WC.map(|p| p + draw(self.contact));
            palm.force += draw(self.force.hypot(self.force_share * palm.force.length()));
        }
        noisy
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::{ContactLogSample, PalmSample};

    #[test]
    fn noise_has_the_spread_that_is_asked_for_and_repeats_by_seed() {
        let on = PalmSample { p_WC: Some(DVec2::ONE), force: DVec2::new(3.0, 4.0), ..PalmSample::default() };
        let samples: Vec<_> = (0..4000)
            .map(|k| ContactLogSample { t: f64::from(k), palms: vec![on, PalmSample::default()] })
            .collect();
        let log = ContactLog::new(samples, None).unwrap();
        let noise = ContactNoise { contact: 1e-3, force: 0.03, force_share: 0.008 };
        let noisy = noise.add_to(&log, 5);
        assert_eq!(noisy, noise.add_to(&log, 5));
        assert_ne!(noisy, noise.add_to(&log, 6));
        let spread = |read: &dyn Fn(&ContactLogSample) -> DVec2| {
            let sum: f64 = noisy.samples().iter().map(|s| read(s).length_squared()).sum();
            (sum / 8000.0).sqrt()
        };
        // A mean over 8,000 squares is known to 1.6 %, its root to 0.8 %: five of these.
        let close =
            |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 0.04, "{found} {expected}");
        close(spread(&|s| s.palms[0].p_WC.unwrap() - DVec2::ONE), 1e-3);
        close(spread(&|s| s.palms[0].force - on.force), 0.05);
        close(spread(&|s| s.palms[1].force), 0.03);
        assert!(noisy.samples().iter().all(|s| s.palms[1].p_WC.is_none()));
    }
}
