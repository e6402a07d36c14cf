//! A scene that unit tests share.

use contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{InitialMotion, MassProperties, SampleTimes, SensorLog, ThreePalmScene};

/// One second of an ellipsoid of 1.3 kg on three palms that swing, at 1 kHz, with truth and without noise; gravity.
pub(super) fn on_swinging_palms() -> (SensorLog, MassProperties, DVec3) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palm = |azimuth, phase| {
        let motion = MotionLaw::Sinusoid { mean: 1.0, amplitude: 0.08, frequency: 1.7, phase };
        Palm::new(azimuth, motion).unwrap()
    };
    let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let times = SampleTimes { duration: 1.0, rate: 1000.0 };
    let log = scene.simulate(start, times, Tolerance::uniform(1e-12)).unwrap().sensor_log(&scene).unwrap();
    (log, mass, scene.gravity())
}
