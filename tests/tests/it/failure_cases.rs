//! Where the three-palm estimator stops working: it says so, or what it says holds.

use crate::noisy::{exactly, largest_errors, words, worst_of_all};
use glam::{DQuat, DVec3};
use rand_distr::{Distribution, Uniform};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;
use recon::contact_kinematics::{Ellipsoid, Palm, Sphere};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, Simulation, ThreePalmScene,
};
use recon::observer::contacts::{ContactEstimate, ContactEstimateError};
use recon_tests::{exact_log, f5, few_or_all, fig5};

/// Right to within a share of the size or within deviations, or refused.
fn is_honest(found: &ContactEstimate, simulation: &Simulation) -> bool {
    let (centre, _) = largest_errors(found, &simulation.instants);
    centre < 1e-6 || !found.reliability.is_reliable() || worst_of_all(found, &simulation.instants) < 5.0
}

fn palms() -> [Palm; 3] {
    [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap())
}

const SPIN: InitialMotion = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.1, 0.3, 0.3) };

#[test]
fn a_ball_has_no_orientation_and_that_is_said() {
    let mass = MassProperties::uniform_ellipsoid(1.0, DVec3::ONE).unwrap();
    let scene = ThreePalmScene::new(Sphere::new(1.0).unwrap(), mass, palms(), 9.81).unwrap();
    let (simulation, log) = exact_log(&scene, SPIN, few_or_all(0.4, 3.0), 500.0);
    let found = exactly(&scene, &log, true).unwrap();
    let open = found.axes_deviations.unwrap();
    assert!(open.min_element() > 0.5, "{open}");
    assert!(is_honest(&found, &simulation), "{:?}", found.evidence);
}

#[test]
fn a_body_of_revolution_hides_the_turn_about_its_axis() {
    let axes = DVec3::new(1.0, 1.0, 1.8);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms(), 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::from_rotation_x(0.4), ..SPIN };
    let (simulation, log) = exact_log(&scene, start, 3.0, 500.0);
    let found = exactly(&scene, &log, true).unwrap();
    // Another turn about its axis explains the log as well, so that the axes are said to be open; its own axis and the rest are right.
    let (axis, open) = (simulation.instants[0].R_WO * DVec3::Z, found.axes_deviations.unwrap());
    assert!(open.max_element() > 1.0, "{open}");
    assert!((found.states[0].R_WO * DVec3::Z).dot(axis).abs() > 1.0 - 1e-6);
    assert!(largest_errors(&found, &simulation.instants).0 < 1e-6, "{}", words(&found.reliability));
}

#[test]
fn a_body_at_rest_says_nothing_of_its_orientation() {
    let (scene, _) = f5();
    // F5's palms hold the ellipsoid in balance where its contact normals meet the axis of gravity; it is not at rest at
    // the identity, so take the motion of the first hundredth of a second instead: next to none.
    let (simulation, log) = exact_log(&scene, InitialMotion { w_WO: DVec3::ZERO, ..SPIN }, 0.05, 500.0);
    let found = exactly(&scene, &log, true).unwrap();
    assert!(is_honest(&found, &simulation), "{:?}", found.evidence);
}

#[test]
fn windows_below_the_natural_time_are_right_or_reported() {
    let (scene, start) = f5();
    for &duration in few_or_all(&[0.05, 0.2][..], &[0.02, 0.05, 0.1, 0.2, 0.4]) {
        let (simulation, log) = exact_log(&scene, start, duration, 500.0);
        for known in [true, false] {
            let found = exactly(&scene, &log, known).unwrap();
            let (centre, _) = largest_errors(&found, &simulation.instants);
            assert!(is_honest(&found, &simulation), "{duration} s: {centre:e} without a warning");
        }
    }
}

#[test]
fn a_log_that_goes_on_with_a_palm_lost_is_right_or_reported() {
    let (scene, start) = fig5(1.0);
    let (simulation, log) = exact_log(&scene, start, 2.0, 500.0);
    // Sensors that repeat their last reading, but for a palm that says that it lost contact.
    let mut samples = log.samples().to_vec();
    let last = *samples.last().unwrap();
    for k in 1..50 {
        let mut sample = last;
        sample.t += f64::from(k) * 2e-3;
        sample.palms[1].contact = None;
        sample.palms[1].force = Some(0.0);
        samples.push(sample);
    }
    let with_loss = SensorLog::new(samples, None).unwrap();
    assert_eq!(with_loss.first_contact_loss(), Some((log.samples().len(), 1)));
    // There may be no motion to tell.
    let silent = |found: ContactEstimate| !is_honest(&found, &simulation);
    assert!(!exactly(&scene, &with_loss, true).is_ok_and(silent));
}

#[test]
fn a_palm_without_force_is_named() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 0.1, 500.0);
    for palm in 0..3 {
        let mut samples = log.samples().to_vec();
        samples.iter_mut().for_each(|sample| sample.palms[palm].force = None);
        let refused = exactly(&scene, &SensorLog::new(samples, None).unwrap(), true).unwrap_err();
        assert_eq!(refused, ContactEstimateError::NoForce { palm: palm + 1 });
    }
}

#[test]
fn parallel_palms_are_right_or_reported() {
    // Two palms whose azimuths come together: the estimator never inverts the matrix of normals, the simulation does.
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    for &degrees in few_or_all(&[30.0][..], &[60.0, 30.0, 15.0]) {
        let azimuths = [0.0, 180.0 - degrees / 2.0, 180.0 + degrees / 2.0f64];
        let palms = azimuths.map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
        let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) };
        let times = SampleTimes { duration: few_or_all(0.8, 3.0), rate: 100.0 };
        let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { continue };
        let Ok(log) = simulation.sensor_log(&scene) else { continue };
        let found = exactly(&scene, &log.split_truth().0, true).unwrap();
        assert!(is_honest(&found, &simulation), "{degrees} degrees: {:?}", found.evidence);
    }
}

#[test]
fn bodies_that_hide_their_inertia_are_reported() {
    // Nothing is known of them: a body of revolution whose axis is the vertical's neighbour, and a ball.
    let bodies = [(DVec3::new(1.0, 1.0, 1.8), DQuat::from_rotation_x(0.4)), (DVec3::ONE, DQuat::IDENTITY)];
    for &(axes, R_WO) in few_or_all(&bodies[..1], &bodies) {
        let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms(), 9.81).unwrap();
        let (simulation, log) =
            exact_log(&scene, InitialMotion { R_WO, ..SPIN }, few_or_all(0.3, 1.5), 100.0);
        let Ok(found) = exactly(&scene, &log, false) else { continue };
        assert!(is_honest(&found, &simulation), "{axes}: {:?}", found.evidence);
        let (inertia, turned) = (found.inertia, mass.inertia());
        let R = glam::DMat3::from_quat(simulation.instants[0].R_WO);
        let error = (inertia - R * turned * R.transpose())
            .to_cols_array()
            .iter()
            .fold(0.0, |m: f64, e| m.max(e.abs()));
        let stated = (0..6).map(|i| found.inertia_covariance[i][i].max(0.0).sqrt()).fold(0.0, f64::max);
        assert!(
            !found.reliability.is_reliable() || error < 5.0 * stated,
            "{axes}: off by {error:e}, stated {stated:e}"
        );
    }
}

/// A body of uniform density, half of them of revolution, on three palms, from any orientation.
fn any_scene(mut draw: impl FnMut() -> f64) -> (ThreePalmScene<Ellipsoid>, InitialMotion) {
    let longer = [1.0 + 1.5 * draw(), 1.0 + 1.5 * draw()];
    let axes = DVec3::new(1.0, if draw() < 0.5 { 1.0 } else { longer[0] }, longer[1]);
    let first = 360.0 * draw();
    let palms = [0.0, 120.0, 240.0].map(|further: f64| {
        let (azimuth, slope): (f64, f64) =
            (first + further + 15.0 * (2.0 * draw() - 1.0), 45.0 + 30.0 * draw());
        Palm::fixed(azimuth.to_radians(), slope.to_radians()).unwrap()
    });
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let mut either = || 2.0 * draw() - 1.0;
    let R_WO = DQuat::from_xyzw(either(), either(), either(), either()).normalize();
    let w_WO = DVec3::new(either(), either(), either());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    (scene, InitialMotion { R_WO, w_WO })
}

/// Where samples are few, what steps from one to the next miss is more than what is left of the conditions: it was 10 to 30 of the stated deviations.
#[test]
fn exact_logs_of_few_samples_are_as_right_as_is_said() {
    let mut random = Pcg64Mcg::seed_from_u64(11);
    let uniform = Uniform::new(0.0, 1.0).unwrap();
    let mut draw = || uniform.sample(&mut random);
    let (mut tried, mut relied_on) = (0, 0);
    let all = few_or_all(3, 14);
    while tried < all {
        let (scene, start) = any_scene(&mut draw);
        let times = SampleTimes { duration: 1.5 + 1.5 * draw(), rate: 60.0 + 60.0 * draw() };
        let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { continue };
        let Ok(log) = simulation.sensor_log(&scene) else { continue };
        tried += 1;
        let found = exactly(&scene, &log.split_truth().0, false).unwrap();
        assert!(is_honest(&found, &simulation), "{times:?}: {:?}", found.evidence);
        relied_on += usize::from(found.reliability.is_reliable());
    }
    assert!(relied_on * 14 >= 11 * all, "{relied_on} of {all}");
}
