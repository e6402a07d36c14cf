use super::estimate::{ITERATIONS, Scene, entries};
use super::problem::{Guess, Row, TouchProblem, UNKNOWNS, uniform};
use super::series::TouchSeries;
use super::shape::FreeEllipsoid;
use super::*;
use crate::faults::Constant;
use crate::least_squares::FitStatus;
use crate::rigid::{inertia_of_numbers, numbers_of_inertia};
use crate::three_palms::motion_state::MotionState;
use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, Palm, PalmFrame, Sphere, SupportFunction, Translated,
};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{
    InitialMotion, MassProperties, PalmReading, Sample, SampleTimes, SensorLog, SensorNoise, Simulation,
    ThreePalmScene,
};

const AXES: DVec3 = DVec3::new(1.0, 2.0, 2.5);
const OFFSET: DVec3 = DVec3::new(0.1, -0.05, 0.12);

fn palms() -> [Palm; 3] {
    let palm = |azimuth, slope, amplitude, frequency, phase| {
        Palm::new(azimuth, MotionLaw::Sinusoid { mean: slope, amplitude, frequency, phase }).unwrap()
    };
    [palm(0.1, 0.9, 0.08, 1.7, 0.3), palm(2.0, 1.05, 0.1, 2.1, 1.0), palm(4.3, 1.0, 0.06, 1.3, 2.0)]
}

fn run<S: SupportFunction>(body: S, inertia: DMat3, duration: f64, rate: f64) -> (Simulation, SensorLog) {
    let mass = MassProperties::new(1.7, inertia * 1.7).unwrap();
    let scene = ThreePalmScene::new(body, mass, palms(), 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let simulation =
        scene.simulate(start, SampleTimes { duration, rate }, Tolerance::uniform(1e-12)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap().split_truth().0;
    let mut samples = log.samples().to_vec();
    for palm in samples.iter_mut().flat_map(|s| &mut s.palms) {
        (palm.force, palm.torque) = (None, None);
    }
    (simulation, SensorLog::new(samples, None).unwrap())
}

/// A body whose inertia is not that of its shape.
fn general(duration: f64, rate: f64) -> (Simulation, SensorLog, Guess) {
    let inertia = DMat3::from_cols_array(&[2.1, 0.08, -0.05, 0.08, 1.5, 0.06, -0.05, 0.06, 1.1]);
    let body = Translated { body: Ellipsoid::new(AXES).unwrap(), offset: OFFSET };
    let (simulation, log) = run(body, inertia, duration, rate);
    let mut shape = FreeEllipsoid::numbers(AXES, DQuat::IDENTITY);
    shape[6..].copy_from_slice(&OFFSET.to_array());
    let truth = Guess { w: simulation.instants[0].w_WO, shape, inertia: numbers_of_inertia(inertia) };
    (simulation, log, truth)
}

const KNOWN: KnownTouch = KnownTouch { gravity: DVec3::new(0.0, 0.0, -9.81), contact_noise: None };

/// Of palms that shake faster than steps tell their rates are missed, up to all of them; of palms that swing slowly next to nothing is, whatever the phase of
/// the samples and though rates are logged.
#[test]
fn rates_of_palms_that_shake_are_missed() {
    let (amplitude, h) = (1e-3, 0.01);
    // Beyond pi samples of a fast motion look like those of a slow one, as 6.1 rad like 0.18.
    for (angle, least, most) in
        [(0.05, 0.0, 1e-6), (0.3, 1e-6, 0.01), (2.5, 0.3, 3.0), (3.1, 0.3, 3.0), (6.1, 0.3, 3.0)]
    {
        let frequency = angle / h;
        let palm = |azimuth: f64, phase| {
            Palm::new(azimuth, MotionLaw::Sinusoid { mean: 1.0, amplitude, frequency, phase }).unwrap()
        };
        let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
        let reading = |t: f64, i: usize| {
            let at = palms[i].at(t);
            let normal = Direction::new(at.frame.n).unwrap();
            PalmReading { normal, contact: Some([0.1, 0.2]), force: None, torque: None, rate: Some(at.rate) }
        };
        let sample = |k: u32| {
            let t = f64::from(k) * h;
            Sample { t, palms: [0, 1, 2].map(|i| reading(t, i)) }
        };
        let log = SensorLog::new((0..200).map(sample).collect(), None).unwrap();
        let missed = TouchSeries::new(&log).unwrap().nodes(2).missed_rates;
        // Root of the mean square of three rates.
        let all = amplitude * frequency * 1.5f64.sqrt();
        assert!((least..most).contains(&(missed / all)), "{angle}: {missed} of {all}");
    }
}

/// Steps of a search may lead anywhere; what is no number there must not reach the contacts.
#[test]
fn spins_beyond_all_numbers_are_no_motion() {
    let (_, log, truth) = general(0.5, 200.0);
    let series = TouchSeries::new(&log).unwrap();
    let nodes = series.nodes(5);
    let problem = TouchProblem::new(&nodes, KNOWN.gravity, 2.0, f64::INFINITY);
    for speed in [1e80, 1e160, 1e250, 1e300, f64::NAN] {
        let guess = Guess { w: DVec3::splat(speed), ..truth };
        assert!(problem.residuals(&guess).is_none(), "{speed}");
    }
}

#[test]
fn the_true_motion_leaves_nothing_to_fourth_order() {
    let (_, log, truth) = general(2.0, 1000.0);
    let series = TouchSeries::new(&log).unwrap();
    let rms = |stride: usize| {
        let nodes = series.nodes(stride);
        let problem = TouchProblem::new(&nodes, KNOWN.gravity, 2.0, f64::INFINITY);
        let r = problem.residuals(&truth).unwrap();
        (r.iter().map(|r| r * r).sum::<f64>() / r.len() as f64).sqrt()
    };
    let (fine, coarse) = (rms(10), rms(40));
    assert!((coarse / fine).log2() / 2.0 > 3.5 && fine < 1e-6, "{fine:e} {coarse:e}");
}

#[test]
fn motion_shape_and_inertia_come_from_contacts_alone() {
    let (simulation, log, truth) = general(3.0, 500.0);
    let estimate = estimate_without_forces(&log, &KNOWN).unwrap();
    // What the steps of the integration leave at 2 x 24 nodes in a natural time, over 3 s.
    assert!((estimate.shape.semi_axes - AXES).length() < 1e-8, "{:?}", estimate.shape);
    assert!((estimate.shape.centre - OFFSET).length() < 1e-8, "{:?}", estimate.shape);
    let inertia = estimate.inertia_per_mass - inertia_of_numbers(&truth.inertia);
    assert!(inertia.to_cols_array().iter().all(|v| v.abs() < 1e-8), "{inertia}");
    let last = estimate.motion.last().unwrap();
    let now = simulation.instants.iter().min_by(|a, b| (a.t - last.t).abs().total_cmp(&(b.t - last.t).abs()));
    assert!((last.p_WCm - now.unwrap().touch.p_WCm).length() < 1e-7);
    assert!((last.w_WO - now.unwrap().w_WO).length() < 1e-7);
    assert_eq!(estimate.evidence.rank, UNKNOWNS);
    // Axes of the body are those of the world at the first node, by definition.
    assert!(estimate.deviations.len() == estimate.motion.len() && estimate.deviations[0][3] == DVec3::ZERO);
    // The curves cross; what is left at the crossings is of second order in the angle, 0.03^2 x 2.5 m at most.
    let closure = estimate.evidence.closure.unwrap();
    assert!(closure.pairs > 20 && closure.distance_rms < 2e-3, "{closure:?}");
}

/// The unknowns as the covariance has them.
fn found(estimate: &NoForceEstimate) -> Row {
    let TouchShape { centre, orientation, semi_axes } = estimate.shape;
    let mut shape = FreeEllipsoid::numbers(semi_axes, orientation);
    shape[6..].copy_from_slice(&centre.to_array());
    let inertia = numbers_of_inertia(estimate.inertia_per_mass);
    entries(&Guess { w: estimate.motion[0].w_WO, shape, inertia })
}

/// Squared errors over their covariance have mean 18 and, over 30 runs, a deviation of sqrt(2 18 / 30) = 1.1: four of
/// those. The noise is 0.1 % of the size. So has each of the 12 numbers of the motion at the last node a squared error of its deviation
/// in the mean; that they are independent of each other is not claimed.
#[test]
fn covariance_is_true_under_noise() {
    let (simulation, clean, truth) = general(3.0, 500.0);
    let noise = 2.5e-3;
    let (mut sum, runs) = (0.0, crate::few_or_all(10, 30));
    let mut of_motion = [[0.0; 3]; 4];
    for seed in 0..runs {
        let level = SensorNoise { contact: noise, force: 0.0, torque: 0.0 };
        let series = TouchSeries::new(&clean.with_noise(&level, seed).unwrap()).unwrap();
        let scene =
            Scene { series: &series, gravity: KNOWN.gravity, length: 2.0, noise, iterations: ITERATIONS };
        let estimate = scene.estimate(&series.nodes(8), truth).unwrap();
        let error = found(&estimate) - entries(&truth);
        sum += error.dot(&estimate.covariance.cholesky().unwrap().solve(&error));
        for (sums, (error, deviation)) in of_motion.iter_mut().zip(errors_at_the_end(&estimate, &simulation))
        {
            (0..3).for_each(|axis| sums[axis] += (error[axis] / deviation[axis]).powi(2));
        }
        let rms = estimate.evidence.residual_rms / estimate.evidence.noise_explains;
        assert!((0.9..1.1).contains(&rms), "{rms}");
        let closure = estimate.evidence.closure.unwrap();
        // Pairs share samples, so their sum scatters more than the count suggests.
        assert!((0.7..1.4).contains(&(closure.distance_rms / closure.noise_explains)), "{closure:?}");
    }
    let mean = sum / runs as f64;
    // Chi-squared of 18 numbers, four deviations of its mean.
    let band = 4.0 * (36.0 / runs as f64).sqrt();
    assert!((mean - 18.0).abs() < band, "{mean}");
    // Of one number the mean of squares has a deviation of sqrt(2 / runs): below four of them above 1 each, and none far too small.
    let (count, all) = (runs as f64, of_motion.as_flattened());
    let high = 1.0 + 4.0 * (2.0 / count).sqrt();
    assert!(all.iter().all(|sum| (0.1..high).contains(&(sum / count))), "{of_motion:?}");
    let mean = all.iter().sum::<f64>() / (12.0 * count);
    assert!((0.5..1.8).contains(&mean), "{mean}");
}

/// Errors of centre of mass, velocity, angular velocity and turn at the last node, with their deviations.
fn errors_at_the_end(estimate: &NoForceEstimate, truth: &Simulation) -> [(DVec3, DVec3); 4] {
    let (last, deviations) = (estimate.motion.last().unwrap(), estimate.deviations.last().unwrap());
    let now = truth.instants.iter().find(|now| (now.t - last.t).abs() < 1e-9).unwrap();
    let d = last.R_WO * now.R_WO.conjugate();
    let errors = [
        last.p_WCm - now.touch.p_WCm,
        last.v_WCm - now.rates.v_WCm,
        last.w_WO - now.w_WO,
        2.0 * d.w.signum() * d.xyz(),
    ];
    std::array::from_fn(|i| (errors[i], deviations[i]))
}

/// What is left of an exact log is no noise, and is what the estimate is off by: deviations that count noise alone were too small by a
/// factor of ten thousand and more.
#[test]
fn deviations_count_what_is_left_of_an_exact_log() {
    let (_, log, truth) = general(3.0, 500.0);
    let series = TouchSeries::new(&log).unwrap();
    let noise = 1e-13;
    let scene = Scene { series: &series, gravity: KNOWN.gravity, length: 2.0, noise, iterations: ITERATIONS };
    let estimate = scene.estimate(&series.nodes(8), truth).unwrap();
    assert!(estimate.evidence.residual_rms > 10.0 * estimate.evidence.noise_explains);
    let error = found(&estimate) - entries(&truth);
    for (i, error) in error.iter().enumerate() {
        let deviation = estimate.covariance[(i, i)].sqrt();
        assert!(error.abs() < 20.0 * deviation, "{i}: {error} against {deviation}");
    }
}

/// Two linearisations from the truth leave no more than noise, and are no minimum: the answer would be as good as the
/// guess.
#[test]
fn a_fit_that_has_not_settled_is_refused() {
    let (_, clean, truth) = general(2.0, 250.0);
    let noise = 2.5e-3;
    let level = SensorNoise { contact: noise, force: 0.0, torque: 0.0 };
    let series = TouchSeries::new(&clean.with_noise(&level, 1).unwrap()).unwrap();
    let after = |iterations: usize| {
        let scene = Scene { series: &series, gravity: KNOWN.gravity, length: 2.0, noise, iterations };
        scene.estimate(&series.nodes(8), truth)
    };
    let refused = after(2);
    assert!(matches!(refused, Err(NoForceError::NotSettled { iterations: 2, .. })), "{refused:?}");
    assert_eq!(after(ITERATIONS).unwrap().evidence.status, FitStatus::Converged);
}

#[test]
fn what_contacts_do_not_determine_is_refused_in_words() {
    let ball = run(Sphere::new(2.0).unwrap(), uniform(DVec3::splat(2.0), DQuat::IDENTITY), 1.5, 100.0).1;
    match estimate_without_forces(&ball, &KNOWN) {
        Err(NoForceError::NotDetermined { words, deviation }) => {
            assert!(!words.is_empty() && deviation > 0.25, "{words} {deviation}");
        }
        other => panic!("{other:?}"),
    }
    let (_, log, _) = general(0.6, 200.0);
    assert!(matches!(estimate_without_forces(&log, &KNOWN), Err(NoForceError::TooShort { .. })));
    let floating = KnownTouch { gravity: DVec3::ZERO, ..KNOWN };
    assert!(matches!(estimate_without_forces(&log, &floating), Err(NoForceError::Gravity { .. })));
    let odd = KnownTouch { contact_noise: Some(-1.0), ..KNOWN };
    assert_eq!(estimate_without_forces(&log, &odd).unwrap_err(), NoForceError::Noise { value: -1.0 });
}

/// Without noise of its own a tilt of a fiftieth of a degree moves the motion by far more than noise explains: it is named, and counts in the deviations.
#[test]
fn a_tilted_palm_is_named_and_counts() {
    const TILT: f64 = 3e-4;
    let (simulation, log, _) = general(3.0, 100.0);
    let noise = SensorNoise { contact: 2e-4, ..SensorNoise::default() };
    let mut samples = log.with_noise(&noise, 3).unwrap().samples().to_vec();
    for sample in &mut samples {
        let palm = &mut sample.palms[1];
        let frame = PalmFrame::from_normal(palm.normal).unwrap();
        palm.normal = Direction::new(DQuat::from_axis_angle(frame.t1, TILT) * frame.n).unwrap();
    }
    let known = KnownTouch { contact_noise: Some(2e-4), ..KNOWN };
    let found = estimate_without_forces(&SensorLog::new(samples, None).unwrap(), &known).unwrap();
    let first =
        found.evidence.suspects.iter().max_by(|a, b| a.score().abs().total_cmp(&b.score().abs())).unwrap();
    assert_eq!(first.fault, Constant::PalmTilt { palm: 2, axis: 0 }, "{first}");
    // The palm stands turned back from where it is said to be.
    assert!((first.value + TILT).abs() < 5.0 * first.deviation && first.score() < -4.75, "{first}");
    let off = |(motion, deviations): (&MotionState, &[DVec3; 4])| {
        let now = simulation.instants.iter().find(|now| (now.t - motion.t).abs() < 1e-9).unwrap();
        let errors = [motion.p_WCm - now.touch.p_WCm, motion.w_WO - now.w_WO];
        errors
            .into_iter()
            .zip([deviations[0], deviations[2]])
            .map(|(e, d)| (e / d).abs().max_element())
            .fold(0.0, f64::max)
    };
    let worst = found.motion.iter().zip(&found.deviations).map(off).fold(0.0, f64::max);
    assert!(worst < 3.0, "{worst} deviations");
}
