//! Where the estimators stop working on palms that swing and for bodies of which nothing is known: it is said, in words,
//! and not guessed.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm, SupportFunction};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, PalmReading, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon::observer::{
    BodyEstimate, EstimateError, KnownBody, MotionEstimate, NoiseLevel, Reliability, TrackError, UnknownBody,
    estimate_body, estimate_motion,
};
use recon_tests::{exact_log, g2};

const NOISE: SensorNoise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
const STATED: NoiseLevel = NoiseLevel { contact: NOISE.contact, force: NOISE.force };

fn of_known<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: Option<NoiseLevel>,
) -> Result<MotionEstimate, EstimateError> {
    let known = KnownBody { mass: *scene.mass(), gravity: scene.gravity(), palm_inertias: None, noise };
    estimate_motion(log, &known)
}

fn of_unknown<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    log: &SensorLog,
    noise: Option<NoiseLevel>,
) -> Result<BodyEstimate, EstimateError> {
    estimate_body(log, &UnknownBody { gravity: scene.gravity(), palm_inertias: None, noise })
}

/// What is said against an estimate, in words; empty where it is relied on.
fn words(reliability: &Reliability) -> String {
    match reliability {
        Reliability::Reliable => String::new(),
        Reliability::Unreliable(reasons) => {
            reasons.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ")
        }
    }
}

/// What is said of the log by both estimators.
fn both<S: SupportFunction>(scene: &ThreePalmScene<S>, log: &SensorLog) -> [String; 2] {
    let said = [
        of_known(scene, log, Some(STATED)).map(|e| words(&e.reliability)),
        of_unknown(scene, log, Some(STATED)).map(|e| words(&e.motion.reliability)),
    ];
    said.map(|said| said.unwrap_or_else(|error| error.to_string()))
}

/// Of a log that is too short: said outright, or no motion is found at all.
fn says_too_little(said: &str) -> bool {
    said.contains("too short") || said.contains("no motion fits")
}

fn changed(log: &SensorLog, change: impl Fn(usize, usize, &mut PalmReading)) -> SensorLog {
    let mut samples = log.samples().to_vec();
    for (k, sample) in samples.iter_mut().enumerate() {
        sample.palms.iter_mut().enumerate().for_each(|(i, palm)| change(k, i, palm));
    }
    SensorLog::new(samples, None).unwrap()
}

#[test]
fn a_log_that_is_too_short_for_its_noise_is_reported() {
    let (scene, start) = g2();
    let (_, clean) = exact_log(&scene, start, 0.5, 200.0);
    for seed in 0..2 {
        for said in both(&scene, &clean.with_noise(&NOISE, seed).unwrap()) {
            assert!(says_too_little(&said), "seed {seed}: {said:?}");
        }
    }
}

#[test]
fn a_wrong_force_gain_is_reported() {
    let (scene, start) = g2();
    let (_, clean) = exact_log(&scene, start, 2.0, 100.0);
    let noisy = clean.with_noise(&NOISE, 1).unwrap();
    let wrong = changed(&noisy, |_, i, palm| {
        if i == 1 {
            palm.force = palm.force.map(|force| 1.1 * force);
        }
    });
    for said in both(&scene, &wrong) {
        assert!(said.contains("had to be corrected by") || said.contains("no motion fits"), "{said:?}");
    }
    // With the right gain both are relied on: it is the gain that is reported.
    assert_eq!(both(&scene, &noisy), [String::new(), String::new()]);
}

#[test]
fn a_palm_without_forces_is_named() {
    let (scene, start) = g2();
    let (_, log) = exact_log(&scene, start, 0.5, 250.0);
    for palm in 0..3 {
        let without = changed(&log, |_, i, reading| {
            if i == palm {
                reading.force = None;
            }
        });
        let is_named = |error: &EstimateError| matches!(error, EstimateError::Track(TrackError::NoForce { palm: named, .. }) if *named == palm + 1);
        assert!(of_known(&scene, &without, None).err().as_ref().is_some_and(is_named), "palm {palm}");
        assert!(of_unknown(&scene, &without, None).err().as_ref().is_some_and(is_named), "palm {palm}");
    }
}

#[test]
fn a_log_is_used_up_to_the_loss_of_contact() {
    let (scene, start) = g2();
    let (simulation, log) = exact_log(&scene, start, 3.0, 250.0);
    let lost = 500;
    let with_loss = changed(&log, |k, i, palm| {
        if i == 2 && k >= lost {
            palm.contact = None;
            palm.force = Some(0.0);
        }
    });
    assert_eq!(with_loss.first_contact_loss(), Some((lost, 2)));
    let known = of_known(&scene, &with_loss, None).unwrap();
    let unknown = of_unknown(&scene, &with_loss, None).unwrap().motion;
    for estimate in [known, unknown] {
        assert_eq!(estimate.motion.len(), lost);
        assert!(estimate.reliability.is_reliable(), "{}", words(&estimate.reliability));
        let last = simulation.instants[lost - 1].touch.p_WCm;
        assert!(estimate.motion[lost - 1].p_WCm.distance(last) < 1e-5);
    }
    // What is left before an early loss is too little for noisy data, and that is said.
    let noisy = log.with_noise(&NOISE, 4).unwrap();
    let early = changed(&noisy, |k, i, palm| {
        if i == 0 && k >= 125 {
            palm.contact = None;
            palm.force = Some(0.0);
        }
    });
    for said in both(&scene, &early) {
        assert!(says_too_little(&said), "{said:?}");
    }
}

#[test]
fn a_body_at_rest_is_reported() {
    // In balance on palms that stand still: symmetric about the vertical, so that it stays.
    let axes = DVec3::new(1.8, 1.8, 1.0);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palms = [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let rest = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::ZERO };
    let (_, clean) = exact_log(&scene, rest, 1.5, 50.0);
    for said in both(&scene, &clean.with_noise(&NOISE, 2).unwrap()) {
        println!("{said}");
        assert!(!said.is_empty());
    }
}

#[test]
fn palms_that_are_nearly_parallel_are_right_or_reported() {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let degrees = 15.0;
    let azimuths = [0.0, 180.0 - degrees / 2.0, 180.0 + degrees / 2.0f64];
    let palms = azimuths.map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) };
    let times = SampleTimes { duration: 2.0, rate: 100.0 };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-13)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap().split_truth().0.with_noise(&NOISE, 3).unwrap();
    let truth = simulation.instants[0].touch.p_WCm;
    let known = of_known(&scene, &log, Some(STATED));
    let unknown = of_unknown(&scene, &log, Some(STATED)).map(|e| e.motion);
    for estimate in [known, unknown] {
        // No estimate at all is a report too.
        let Ok(estimate) = estimate else { continue };
        let error = estimate.start.p_WCm - truth;
        let worst = (0..3).fold(0.0, |m: f64, k| m.max(error[k].abs() / estimate.covariance[(k, k)].sqrt()));
        println!("{degrees}: {worst:.2} deviations; {}", words(&estimate.reliability));
        let sure = estimate.reliability.is_reliable();
        assert!(worst < 5.0 || !sure, "{degrees} degrees: {worst:.1}, {:?}", estimate.evidence);
    }
}
