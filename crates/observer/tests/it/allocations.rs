//! A stream that follows a motion makes and frees nothing.

#![cfg(feature = "palms")]
#![allow(clippy::unwrap_used, reason = "a helper of tests may panic, as a test may")]

use contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{InitialMotion, MassProperties, Sample, SampleTimes, SensorNoise, ThreePalmScene};
use observer::{MotionStream, NoiseLevel, StreamOptions, StreamStage};

const NOISE: NoiseLevel = NoiseLevel { contact: 2.5e-3, force: 0.065 };

fn samples() -> (MassProperties, Vec<Sample>) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palm = |azimuth, phase| {
        let motion = MotionLaw::Sinusoid { mean: 1.0, amplitude: 0.08, frequency: 1.7, phase };
        Palm::new(azimuth, motion).unwrap()
    };
    let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let times = SampleTimes { duration: 4.5, rate: 1000.0 };
    let run = scene.simulate(start, times, Tolerance::uniform(1e-10)).unwrap();
    let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force, torque: 0.0 };
    (mass, run.sensor_log(&scene).unwrap().with_noise(&noise, 1).unwrap().samples().to_vec())
}

#[test]
fn no_sample_allocates_once_a_motion_is_followed() {
    let (mass, samples) = samples();
    for mass in [Some(mass), None] {
        let gravity = DVec3::new(0.0, 0.0, -9.81);
        let options = StreamOptions { mass, gravity, palm_inertias: None, noise: NOISE, sample_rate: 1000.0 };
        let mut stream = MotionStream::new(options).unwrap();
        let (mut followed, mut allocated, mut searching) = (0, 0, 0);
        for sample in &samples {
            let mut tracking = false;
            let counted = allocation_counter::measure(|| {
                let estimate = stream.push(sample).unwrap();
                tracking = estimate.is_some_and(|e| e.stage == StreamStage::Tracking);
            });
            // The sample with which the motion is first told puts the search away.
            *(if followed > 0 { &mut allocated } else { &mut searching }) += counted.count_total;
            followed += usize::from(tracking);
        }
        // The search does allocate: what counts is at work.
        assert!(followed > 500 && searching > 0, "{followed} {searching}");
        assert_eq!(allocated, 0);
    }
}
