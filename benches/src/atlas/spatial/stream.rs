//! The motion sample by sample.

use super::super::judged::Ran;
use super::super::{DEVIATIONS, Failure, G, Method, Way};
use super::estimate::FLOOR;
use super::scene::{Motion, Spec, state};
use super::{in_deviations, worse};
use glam::DVec3;
use recon::observer::contacts::stream::{
    MotionStream, PlaneReadings, StreamEstimate, StreamOptions, StreamStage,
};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions};

pub(in super::super) const METHOD: Method = Method {
    name: "streaming",
    about: "sample by sample, body unknown (known where its mass or inertia is wrong); right: every stated motion within five deviations",
    ways: {
        use Way::*;
        &[
            Parallel,
            Flat,
            Steep,
            Sphere,
            Revolution,
            Relative,
            Force,
            Slow,
            Window,
            Noise,
            Unstated,
            Bias,
            Gain,
            Delay,
            Correlation,
            Taxels,
            Outliers,
            Gap,
            Dropped,
            Rate,
            Mass,
            Inertia,
            Palm,
            Shaking,
            Long,
            Size,
        ]
    },
    seeds: 1,
    every: 2,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let of = Spec::of(way, strength);
    // A motion is stated after some seven natural times: other ways than that of the window have some after it.
    let lasts = if way == Way::Window { of.lasts } else { of.lasts.max(13.0) };
    let of = Spec { lasts, ..of };
    let motion = Motion::drawn(of, seed)?;
    let (log, [contact, force_fixed]) = motion.log()?;
    let floor = FLOOR * (G * of.size).sqrt();
    let noise = ContactNoiseLevel {
        contact: contact.max(1e-8 * of.size),
        force_fixed: force_fixed.max(1e-8 * motion.scene.scale().weight),
        force_share: 0.0,
        impulse: None,
        floor,
    };
    let body = matches!(way, Way::Mass | Way::Inertia).then(|| motion.told());
    let contacts = ContactOptions { body, suspects: true, ..ContactOptions::new(noise, G) };
    let options = StreamOptions { contacts, sample_rate: motion.scene.times().rate };
    let mut stream = match MotionStream::new(PlaneReadings::palms(), options) {
        Ok(stream) => stream,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let mut readings = PlaneReadings::new(None);
    let (mut off, mut stated, mut before) = (0.0, 0_usize, 0.0);
    for sample in log.samples() {
        match readings.push(sample).map(|sensed| sensed.map(|(t, sensed)| stream.push(t, &sensed))) {
            Ok(None) => {}
            Ok(Some(Ok(estimate))) => {
                if let Some(error) = error(&estimate, &motion, before) {
                    off = worse(off, error / DEVIATIONS);
                    stated += 1;
                }
            }
            Ok(Some(Err(error))) => return Ok(Ran::refused(&error)),
            Err(error) => return Ok(Ran::refused(&error)),
        }
        before = sample.t;
    }
    Ok(Ran::Found { off, doubt: (stated == 0).then(|| "no motion is stated".to_owned()) })
}

/// Of a stated motion, which is of the sample at the time `t`.
fn error(estimate: &StreamEstimate, motion: &Motion, t: f64) -> Option<f64> {
    if estimate.stage != StreamStage::Tracking {
        return None;
    }
    let (found, truth) = (estimate.motion?, state(motion.at(t)?));
    let deviation = |i: usize| {
        DVec3::from_array([0, 1, 2].map(|axis| found.covariance[(3 * i + axis, 3 * i + axis)].sqrt()))
    };
    Some(in_deviations(&found.state, &truth, &[0, 1, 2].map(deviation)))
}
