//! Seeded sensor noise on planar logs.

use super::contact_log::ContactLog;
use super::log::PlanarLog;
use crate::ChannelNoise;
use contact_kinematics::planar::{PalmSurface, SurfacePose};
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

/// Standard deviations of white Gaussian sensor noise of palms of any number and shape. A palm that nothing touches reads
/// what is true.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ContactNoise {
    /// Of a contact point along its palm, m. On a curved one the noise turns the normal.
    pub contact: f64,
    /// Of each axis of a force, N.
    pub force: ChannelNoise,
    /// Of each axis of the impulse over one interval, N s.
    pub impulse: ChannelNoise,
}

impl ContactNoise {
    /// The log with noise added; the same seed gives the same noise.
    #[must_use]
    pub fn add_to(&self, log: &ContactLog, seed: u64) -> ContactLog {
        let mut source = Pcg64Mcg::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut source) };
        let mut noisy = log.clone();
        // Noise of an impulse adds up.
        let mut sums = vec![DVec2::ZERO; log.surfaces().len()];
        let mut before: Vec<Option<DVec2>> = vec![None; log.surfaces().len()];
        for sample in noisy.samples_mut() {
            for (i, palm) in sample.palms.iter_mut().enumerate() {
                // Every palm draws five numbers, touched or not: a lost contact does not shift the noise of the others.
                let along = draw();
                let [force, impulse] = [0; 2].map(|_| DVec2::new(draw(), draw()));
                let exact = palm.impulse;
                if let Some(p_WC) = palm.p_WC {
                    palm.p_WC = Some(moved_along(log.surfaces()[i], palm.pose, p_WC, self.contact * along));
                    palm.force += force * self.force.deviation(palm.force.length());
                    let change = exact.zip(before[i]).map_or(0.0, |(now, last)| (now - last).length());
                    sums[i] += impulse * self.impulse.deviation(change);
                }
                palm.impulse = exact.map(|exact| exact + sums[i]);
                before[i] = exact;
            }
        }
        noisy
    }
}

/// A point of a palm's surface, moved along it by `by`, m.
fn moved_along(surface: PalmSurface, pose: SurfacePose, p_WC: DVec2, by: f64) -> DVec2 {
    match surface {
        PalmSurface::Line => p_WC + by * DVec2::from_angle(pose.angle),
        PalmSurface::Arc { radius } | PalmSurface::Cup { radius } => {
            pose.p_WP + DVec2::from_angle(by / radius).rotate(p_WC - pose.p_WP)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planar::{ContactLogSample, PalmSample};

    const RADIUS: f64 = 0.02;

    /// A line, a fingertip and a palm that nothing touches; the impulses grow by 0.05 N s from sample to sample.
    fn log() -> ContactLog {
        let sample = |k: u32| {
            let impulse = Some(DVec2::new(0.03, 0.04) * f64::from(k));
            let on = PalmSample { force: DVec2::new(3.0, 4.0), impulse, ..PalmSample::default() };
            let line = PalmSample { p_WC: Some(DVec2::X), ..on };
            let tip = PalmSample { p_WC: Some(DVec2::Y * RADIUS), ..on };
            let free = PalmSample::default();
            ContactLogSample { t: f64::from(k), palms: vec![line, tip, free] }
        };
        let surfaces = vec![PalmSurface::Line, PalmSurface::Arc { radius: RADIUS }, PalmSurface::Line];
        ContactLog::new(surfaces, (0..8000).map(sample).collect(), None).unwrap()
    }

    #[test]
    fn noise_has_the_spread_that_is_asked_for_and_repeats_by_seed() {
        let log = log();
        let noise = ContactNoise {
            contact: 1e-3,
            force: ChannelNoise { fixed: 0.03, share: 0.008 },
            impulse: ChannelNoise { fixed: 3e-4, share: 8e-3 },
        };
        let noisy = noise.add_to(&log, 5);
        assert_eq!(noisy, noise.add_to(&log, 5));
        assert_ne!(noisy, noise.add_to(&log, 6));
        let pairs = || noisy.samples().iter().zip(log.samples());
        // A mean over 8,000 squares is known to 1.6 %, its root to 0.8 %: five of these.
        let close = |squares: f64, count: f64, expected: f64| {
            let found = (squares / count).sqrt();
            assert!((found / expected - 1.0).abs() < 0.04, "{found} {expected}");
        };
        for i in 0..2 {
            let shift = |(a, b): (&ContactLogSample, &ContactLogSample)| {
                (a.palms[i].p_WC.unwrap() - b.palms[i].p_WC.unwrap()).length_squared()
            };
            close(pairs().map(shift).sum(), 8e3, 1e-3);
            let force = |(a, b): (&ContactLogSample, &ContactLogSample)| {
                (a.palms[i].force - b.palms[i].force).length_squared()
            };
            close(pairs().map(force).sum(), 16e3, 0.05);
            let sums: Vec<DVec2> =
                pairs().map(|(a, b)| a.palms[i].impulse.unwrap() - b.palms[i].impulse.unwrap()).collect();
            close(sums.windows(2).map(|w| (w[1] - w[0]).length_squared()).sum(), 16e3, 5e-4);
        }
        // On the line y = 0 and on the fingertip about the origin.
        assert!(noisy.samples().iter().all(|s| s.palms[0].p_WC.unwrap().y == 0.0));
        assert!(noisy.samples().iter().all(|s| (s.palms[1].p_WC.unwrap().length() - RADIUS).abs() < 1e-15));
        assert!(noisy.samples().iter().all(|s| s.palms[2] == PalmSample::default()));
    }
}
