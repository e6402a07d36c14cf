//! A stream that follows a motion makes and frees nothing.

#![cfg(feature = "palms")]
#![allow(clippy::unwrap_used, reason = "a helper of tests may panic, as a test may")]

use contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use glam::{DQuat, DVec3};
use nalgebra::{Matrix2, Matrix2x6, Matrix6, Vector2};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{InitialMotion, MassProperties, Sample, SampleTimes, SensorNoise, ThreePalmScene};
use observer::contact_modes::{
    ContactFriction, ContactModes, ContactModesOptions, ContactReading, ContactSeen, ContactSlip, TwistError,
};
use observer::contacts::stream::{ForceReading, MotionStream, PlaneReadings, StreamOptions, StreamStage};
use observer::contacts::{ContactNoiseLevel, ContactOptions};

const NOISE: ContactNoiseLevel =
    ContactNoiseLevel { contact: 2.5e-3, force_fixed: 0.065, force_share: 0.0, impulse: None, floor: 1e-4 };

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
    let times = SampleTimes { duration: 6.0, rate: 1000.0 };
    let run = scene.simulate(start, times, Tolerance::uniform(1e-10)).unwrap();
    let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force_fixed, torque: 0.0 };
    (mass, run.sensor_log(&scene).unwrap().with_noise(&noise, 1).unwrap().samples().to_vec())
}

#[test]
fn no_sample_allocates_once_a_motion_is_followed() {
    let (mass, samples) = samples();
    // Of an unknown body that is told to rub modes are told as well.
    for (body, mode_odds) in [(Some(mass), false), (None, true)] {
        let contacts = ContactOptions { body, mode_odds, ..ContactOptions::new(NOISE, 9.81) };
        let options = StreamOptions { contacts, sample_rate: 1000.0 };
        let mut palms = PlaneReadings::palms();
        palms.iter_mut().filter(|_| mode_odds).for_each(|palm| palm.friction = Some(0.1));
        let mut stream = MotionStream::new(palms, options).unwrap();
        let mut readings = PlaneReadings::new(None);
        // Memory for samples grows until a window of motion has been taken twice.
        let (mut followed, mut allocated, mut searching) = (0, 0, 0);
        for sample in &samples {
            let mut tracking = false;
            let counted = allocation_counter::measure(|| {
                if let Some((t, mut sensed)) = readings.push(sample).unwrap() {
                    for palm in sensed.iter_mut().filter(|_| mode_odds) {
                        let ForceReading::Normal(f) = palm.force else { continue };
                        palm.force = ForceReading::Three(f * (palm.pose.R_WP * DVec3::Z));
                    }
                    let estimate = stream.push(t, &sensed).unwrap();
                    tracking = estimate.stage == StreamStage::Tracking;
                    assert!(!tracking || estimate.modes.is_some() == mode_odds);
                }
            });
            *(if followed > 500 { &mut allocated } else { &mut searching }) += counted.count_total;
            followed += usize::from(tracking);
        }
        // The search does allocate: what counts is at work.
        assert!(followed > 1000 && searching > 0, "{followed} {searching}");
        assert_eq!(allocated, 0);
    }
}

#[test]
fn contact_modes_allocate_at_set_up_alone() {
    let slip = ContactSlip { velocity: Vector2::new(-0.05, 0.0), covariance: Matrix2::identity() * 4e-6 };
    let (normal_force, friction, force_deviation) = (2.0, Vector2::new(0.6, 0.0), 0.04);
    let reading =
        ContactReading { normal_force, friction, force_deviation, slip: Some(slip), touches: false };
    let seen = [ContactSeen::Read(reading), ContactSeen::Off, ContactSeen::Touches];
    let alike = ContactFriction::Alike { material: 0 };
    let frictions = [alike, ContactFriction::Known(0.3), alike];
    let mut modes = ContactModes::new(&frictions, ContactModesOptions::new(0.6, 0.01, 1.0)).unwrap();
    let (slopes, covariance) = ([Matrix2x6::identity(); 3], Matrix6::identity() * 1e-6);
    let counted = allocation_counter::measure(|| {
        for dt in [1e-3, 2e-3, 1e-3] {
            modes.push(dt, &seen).unwrap();
            modes
                .push_with_twist(dt, &seen, &TwistError { slopes: &slopes, covariance: &covariance })
                .unwrap();
        }
    });
    assert_eq!(counted.count_total, 0);
    assert!(allocation_counter::measure(|| drop(modes.clone())).count_total > 0, "the counter counts");
}
