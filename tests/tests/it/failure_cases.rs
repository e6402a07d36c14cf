//! Where the three-palm estimator stops working: it says so, or what it says holds.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm, PalmError, Sphere, SupportFunction};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, Simulation, ThreePalmScene,
};
use recon::observer::{
    EstimateError, KnownBody, MotionEstimate, Quantity, Reason, Reliability, TrackError, UnknownBody,
    estimate_body, estimate_motion,
};
use recon_tests::{exact_log, f5, fig5};

fn estimate<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
) -> Result<MotionEstimate, EstimateError> {
    let known = KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise: None };
    estimate_motion(log, &known)
}

fn centre_error(estimate: &MotionEstimate, simulation: &Simulation) -> f64 {
    let pairs = estimate.motion.iter().zip(&simulation.instants);
    pairs.map(|(m, now)| m.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max)
}

fn unobservable(estimate: &MotionEstimate) -> Option<Quantity> {
    let Reliability::Unreliable(reasons) = &estimate.reliability else { return None };
    reasons.iter().find_map(|reason| match reason {
        Reason::Unobservable { direction } => Some(direction.quantity),
        _ => None,
    })
}

fn palms() -> [Palm; 3] {
    [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap())
}

const SPIN: InitialMotion = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.1, 0.3, 0.3) };

#[test]
fn a_ball_has_no_orientation_and_that_is_said() {
    let mass = MassProperties::uniform_ellipsoid(1.0, DVec3::ONE).unwrap();
    let scene = ThreePalmScene::new(Sphere::new(1.0).unwrap(), mass, palms(), 9.81).unwrap();
    let (_, log) = exact_log(&scene, SPIN, 3.0, 500.0);
    let estimate = estimate(&scene, &log).unwrap();
    assert!(unobservable(&estimate).is_some(), "{:?}", estimate.reliability);
    assert!(estimate.evidence.rank < 12, "{}", estimate.evidence.rank);
}

#[test]
fn a_body_of_revolution_hides_the_turn_about_its_axis() {
    let axes = DVec3::new(1.0, 1.0, 1.8);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms(), 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::from_rotation_x(0.4), ..SPIN };
    let (simulation, log) = exact_log(&scene, start, 3.0, 500.0);
    let estimate = estimate(&scene, &log).unwrap();
    assert_eq!(unobservable(&estimate), Some(Quantity::Orientation), "{:?}", estimate.reliability);
    assert_eq!(estimate.evidence.rank, 11);
    // The hidden direction is the body's own axis, and the rest is right.
    let axis = simulation.instants[0].R_WO * DVec3::Z;
    assert!(estimate.evidence.weakest.axis.dot(axis).abs() > 0.999, "{}", estimate.evidence.weakest);
    assert!(centre_error(&estimate, &simulation) < 1e-6);
}

#[test]
fn a_body_at_rest_says_nothing_of_its_orientation() {
    let (scene, _) = f5();
    // F5's palms hold the ellipsoid in balance where its contact normals meet the axis of gravity; it is not at rest at
    // the identity, so take the motion of the first hundredth of a second instead: next to none.
    let (simulation, log) = exact_log(&scene, InitialMotion { w_WO: DVec3::ZERO, ..SPIN }, 0.05, 500.0);
    let estimate = estimate(&scene, &log).unwrap();
    let wrong = centre_error(&estimate, &simulation) > 1e-3;
    assert!(!(wrong && estimate.reliability.is_reliable()), "{:?}", estimate.evidence);
}

#[test]
fn windows_below_the_natural_time_are_right_or_reported() {
    let (scene, start) = f5();
    for duration in [0.02, 0.05, 0.1, 0.2, 0.4] {
        let (simulation, log) = exact_log(&scene, start, duration, 500.0);
        let estimate = estimate(&scene, &log).unwrap();
        let error = centre_error(&estimate, &simulation);
        assert!(
            error < 1e-3 || !estimate.reliability.is_reliable(),
            "{duration} s: {error:e} without a warning"
        );
    }
}

#[test]
fn the_part_in_contact_is_used_and_named() {
    let (scene, start) = fig5(1.0);
    let (simulation, log) = exact_log(&scene, start, 2.0, 500.0);
    // A log that goes on after contact is lost, as a real one does.
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
    let estimate = estimate(&scene, &with_loss).unwrap();
    assert_eq!(estimate.motion.len(), log.samples().len());
    assert!(centre_error(&estimate, &simulation) < 1e-6);
}

#[test]
fn logs_that_cannot_be_used_are_named() {
    let (scene, start) = f5();
    let (_, log) = exact_log(&scene, start, 0.1, 500.0);
    let change = |f: &dyn Fn(usize, &mut recon::object_dynamics::PalmReading)| {
        let mut samples = log.samples().to_vec();
        for sample in &mut samples {
            for (i, palm) in sample.palms.iter_mut().enumerate() {
                f(i, palm);
            }
        }
        estimate(&scene, &SensorLog::new(samples, None).unwrap()).err()
    };
    assert!(matches!(
        change(&|i, palm| if i == 1 {
            palm.force = None
        }),
        Some(EstimateError::Track(TrackError::NoForce { palm: 2, .. }))
    ));
    assert!(matches!(
        change(&|i, palm| if i == 2 {
            palm.contact = None
        }),
        Some(EstimateError::Track(TrackError::TooFewSamples { found: 0 }))
    ));
    assert!(matches!(
        change(&|i, palm| if i == 0 {
            palm.normal = recon::contact_kinematics::Direction::Z
        }),
        Some(EstimateError::Track(TrackError::Palm {
            palm: 1,
            source: PalmError::VerticalNormal { .. },
            ..
        }))
    ));
}

#[test]
fn parallel_palms_are_right_or_reported() {
    // Two palms whose azimuths come together: the estimator never inverts the matrix of normals, the simulation does.
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    for degrees in [60.0, 30.0, 15.0] {
        let azimuths = [0.0, 180.0 - degrees / 2.0, 180.0 + degrees / 2.0f64];
        let palms = azimuths.map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
        let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) };
        let times = SampleTimes { duration: 3.0, rate: 500.0 };
        let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { continue };
        let Ok(log) = simulation.sensor_log(&scene) else { continue };
        let estimate = estimate(&scene, &log.split_truth().0).unwrap();
        let error = centre_error(&estimate, &simulation);
        assert!(error < 1e-6 || !estimate.reliability.is_reliable(), "{degrees} degrees: {error:e}");
    }
}

#[test]
fn bodies_that_hide_their_inertia_are_reported() {
    // Nothing is known of them: a ball, and a body of revolution whose axis is the vertical's neighbour.
    for (axes, R_WO) in
        [(DVec3::ONE, DQuat::IDENTITY), (DVec3::new(1.0, 1.0, 1.8), DQuat::from_rotation_x(0.4))]
    {
        let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms(), 9.81).unwrap();
        let (_, log) = exact_log(&scene, InitialMotion { R_WO, ..SPIN }, 1.5, 200.0);
        let unknown = UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise: None };
        let Ok(estimate) = estimate_body(&log, &unknown) else { continue };
        assert!(!estimate.motion.reliability.is_reliable(), "{axes}: {:?}", estimate.body);
        assert!(estimate.motion.evidence.rank < 16, "{axes}: {}", estimate.motion.evidence.rank);
    }
}
