//! Motion and an ellipsoid from contacts alone.

use super::super::judged::Ran;
use super::super::{DEVIATIONS, Failure, G, Method, Way};
use super::scene::{Motion, Spec};
use super::worse;
use glam::DVec3;
use recon::object_dynamics::SensorLog;
use recon::observer::three_palms::no_force::{KnownTouch, estimate_without_forces};

/// What semi-axes from exact readings may be off by, in sizes.
const EXACT: f64 = 1e-5;

pub(in super::super) const METHOD: Method = Method {
    name: "without forces",
    about: "motion and ellipsoid from contacts alone; right: semi-axes and the first angular velocity within five stated deviations",
    ways: {
        use Way::*;
        &[
            Parallel,
            Flat,
            Steep,
            Sphere,
            Revolution,
            Pole,
            Relative,
            Slow,
            Window,
            Noise,
            Unstated,
            Correlation,
            Taxels,
            Outliers,
            Gap,
            Dropped,
            Rate,
            Palm,
            Shaking,
            Size,
        ]
    },
    seeds: 1,
    every: 2,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let of = Spec::of(way, strength);
    // Contacts alone need fewer times than contacts and forces, and cost more.
    let lasts = if way == Way::Window { of.lasts } else { 6.0 };
    let motion = Motion::drawn(Spec { lasts, ..of }, seed)?;
    let (log, [contact, _]) = motion.log()?;
    let mut samples = log.samples().to_vec();
    samples.iter_mut().flat_map(|sample| &mut sample.palms).for_each(|palm| palm.force = None);
    let log = SensorLog::new(samples, None)?;
    let known =
        KnownTouch { gravity: DVec3::new(0.0, 0.0, -G), contact_noise: (contact > 0.0).then_some(contact) };
    let found = match estimate_without_forces(&log, &known) {
        Ok(found) => found,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let mut axes = motion.scene.axes.to_array();
    axes.sort_by(f64::total_cmp);
    // The matrix's diagonal is of squared semi-axes: dD = 2 a da, about the smallest.
    let deviation = (3..6).map(|i| found.covariance[(i, i)]).sum::<f64>().sqrt() / (2.0 * axes[0]);
    let least = if contact > 0.0 { 0.0 } else { EXACT * of.size };
    let mut off = (found.shape.semi_axes - DVec3::from_array(axes)).length() / deviation.max(least);
    let spin = found.motion.first().map_or(DVec3::NAN, |first| first.w_WO);
    for axis in 0..3 {
        let deviation = found.covariance[(axis, axis)].sqrt().max(least / of.size / of.natural());
        off = worse(off, (spin[axis] - motion.scene.start.w_WO[axis]).abs() / deviation);
    }
    Ok(Ran::Found { off: off / DEVIATIONS, doubt: None })
}
