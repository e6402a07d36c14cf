//! Noisy logs that more than one motion explains, and logs too short for the noise: what is found, and what is said.

use crate::noisy::{estimated, worst_of_all};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::{InitialMotion, MassProperties, SensorNoise, ThreePalmScene};
use recon_tests::{exact_log, f5, few_or_all, g2};

/// Over 2 s of `F5` with 1 % and 1 % other motions explain the log about as well: the right one is taken.
#[test]
fn the_right_motion_is_taken_of_several() {
    let (scene, start) = f5();
    let (simulation, log) = exact_log(&scene, start, 2.0, 1000.0);
    let noise = SensorNoise { contact: 0.025, force: 0.065, torque: 0.0 };
    let found = estimated(&scene, &log.with_noise(&noise, 5002).unwrap(), noise, true);
    let worst = worst_of_all(&found, &simulation.instants);
    assert!(worst < 5.0, "{worst}");
}

/// Two palms 40 degrees apart: another motion, far off, explains the log as well. It is not the one taken, or nothing is relied on.
#[test]
fn odds_without_small_corrections_do_not_win() {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let palm = |azimuth: f64| Palm::fixed(azimuth.to_radians(), 60f64.to_radians()).unwrap();
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let palms = [palm(0.0), palm(160.0), palm(200.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) };
    let (simulation, log) = exact_log(&scene, start, 2.0, 1000.0);
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    for seed in few_or_all(3..4, 3..6) {
        let found = estimated(&scene, &log.with_noise(&noise, seed).unwrap(), noise, true);
        let worst = worst_of_all(&found, &simulation.instants);
        assert!(worst < 5.0 || !found.reliability.is_reliable(), "seed {seed}: {worst}");
    }
}

/// A second of `G2` with nothing known says little of the moments of inertia. What it says nothing of stays within what can
/// be, and what it does determine is found beside it.
#[test]
fn what_a_short_log_leaves_open_stays_within_what_can_be() {
    let (scene, start) = g2();
    let (simulation, log) = exact_log(&scene, start, 0.7, 100.0);
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    for seed in 0..few_or_all(2, 4) {
        let found = estimated(&scene, &log.with_noise(&noise, seed).unwrap(), noise, false);
        let worst = worst_of_all(&found, &simulation.instants);
        assert!(worst < 5.0 || !found.reliability.is_reliable(), "seed {seed}: {worst}");
        let mass = found.mass / scene.mass().mass();
        assert!((0.5..2.0).contains(&mass), "seed {seed}: {mass}");
        let moments = MassProperties::new(found.mass, found.inertia).unwrap().principal().moments
            / scene.mass().principal().moments;
        // Three deviations of what is taken for known beforehand, 0.7 of the logarithm of a second moment's root.
        let most = (3.0 * 2.0 * 0.7f64).exp();
        assert!(moments.min_element() > 1.0 / most && moments.max_element() < most, "seed {seed}: {moments}");
        assert!(found.inertia_deviations.iter().all(|of| of.is_finite() && *of > 0.0));
    }
}
