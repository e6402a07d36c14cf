use super::pieces::Pieces;
use super::*;
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::track::{Track, TrackError};
use contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use glam::{DQuat, DVec3};
use nalgebra::SVector;
use object_dynamics::integrate::Tolerance;
use object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, Simulation, ThreePalmScene,
};

const NOISE: NoiseLevel = NoiseLevel { contact: 2.5e-3, force: 0.065 };

/// An ellipsoid on palms that swing, which keeps its contacts.
fn run(duration: f64, rate: f64) -> (ThreePalmScene<Ellipsoid>, Simulation, SensorLog) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palm = |azimuth, phase| {
        let motion = MotionLaw::Sinusoid { mean: 1.0, amplitude: 0.08, frequency: 1.7, phase };
        Palm::new(azimuth, motion).unwrap()
    };
    let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let times = SampleTimes { duration, rate };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-12)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap();
    (scene, simulation, log)
}

fn stream(scene: &ThreePalmScene<Ellipsoid>, noise: NoiseLevel, rate: f64, known: bool) -> MotionStream {
    let options = StreamOptions {
        mass: known.then_some(*scene.mass()),
        gravity: scene.gravity(),
        palm_inertias: None,
        noise,
        sample_rate: rate,
    };
    MotionStream::new(options).unwrap()
}

fn noisy(log: &SensorLog, seed: u64) -> Vec<Sample> {
    let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force, torque: 0.0 };
    log.with_noise(&noise, seed).unwrap().samples().to_vec()
}

/// The estimates of a stream, each with the index of its sample.
fn taken(stream: &mut MotionStream, samples: &[Sample]) -> Vec<StreamEstimate> {
    samples.iter().filter_map(|sample| stream.push(sample).unwrap()).collect()
}

/// Distance of a block of the state from the truth, in the deviation that the covariance gives to its length.
fn in_deviations(estimate: &StreamEstimate, block: usize, distance: f64) -> f64 {
    let variance: f64 = (3 * block..3 * block + 3).map(|i| estimate.covariance[(i, i)]).sum();
    distance / variance.sqrt()
}

#[test]
fn a_known_body_is_found_and_followed_from_no_guess() {
    let (scene, simulation, log) = run(4.0, 1000.0);
    let estimates = taken(&mut stream(&scene, NOISE, 1000.0, true), &noisy(&log, 1));
    // From the first sample on there is an estimate, which says that it knows nothing.
    assert_eq!(estimates[0].stage, StreamStage::Gathering);
    assert!(estimates[0].covariance.diagonal().iter().all(|v| *v >= 1.0));
    let first = estimates.iter().position(|e| e.stage == StreamStage::Tracking).unwrap();
    assert!(estimates[first].motion.t < 3.0, "{}", estimates[first].motion.t);
    for (estimate, truth) in estimates.iter().zip(&simulation.instants).skip(first).step_by(100) {
        assert_eq!(estimate.stage, StreamStage::Tracking);
        assert!((estimate.motion.t - truth.t).abs() < 1e-12);
        let p = in_deviations(estimate, 0, estimate.motion.p_WCm.distance(truth.touch.p_WCm));
        let v = in_deviations(estimate, 1, estimate.motion.v_WCm.distance(truth.rates.v_WCm));
        assert!(p < 5.0 && v < 5.0, "t = {}: {p} {v}", truth.t);
        // A hundred channels have a deviation of 0.14.
        assert!((0.4..1.8).contains(&estimate.innovation), "{}", estimate.innovation);
    }
}

/// Normalised errors of position and velocity over whole logs: one in the mean, from the first motion on.
#[test]
fn the_covariance_is_honest_from_the_first_motion_on() {
    let (scene, simulation, log) = run(7.0, 1000.0);
    for known in [true, false] {
        let (mut sum, mut count, mut largest) = (0.0, 0usize, 0.0f64);
        for seed in 10..13 {
            let estimates = taken(&mut stream(&scene, NOISE, 1000.0, known), &noisy(&log, seed));
            for (estimate, truth) in estimates.iter().zip(&simulation.instants).step_by(10) {
                assert_ne!(estimate.stage, StreamStage::Contradicted);
                if estimate.stage != StreamStage::Tracking {
                    continue;
                }
                let p = estimate.motion.p_WCm - truth.touch.p_WCm;
                let v = estimate.motion.v_WCm - truth.rates.v_WCm;
                let error = SVector::<f64, 6>::from_fn(|i, _| [p, v][i / 3][i % 3]);
                let six = estimate.covariance.fixed_view::<6, 6>(0, 0).into_owned();
                let square = error.dot(&six.cholesky().unwrap().solve(&error)) / 6.0;
                (sum, count, largest) = (sum + square, count + 1, largest.max(square));
            }
        }
        // Errors last for about half a second: some 20 independent samples of 6 numbers, a deviation of 0.13.
        let mean = sum / count as f64;
        assert!((0.6..1.4).contains(&mean), "known {known}: {mean}");
        // Chi-squared of 6 beyond 42 has a chance of 2e-7.
        assert!(largest < 7.0, "known {known}: {largest}");
        assert!(count > 400, "{count}");
    }
}

#[test]
fn mass_and_inertia_are_found_along_with_the_motion() {
    let (scene, simulation, log) = run(4.5, 1000.0);
    let estimates = taken(&mut stream(&scene, NOISE, 1000.0, false), &noisy(&log, 1));
    let last = estimates.last().unwrap();
    assert_eq!(last.stage, StreamStage::Tracking);
    let body = last.body.unwrap();
    assert!((body.mass - scene.mass().mass()).abs() < 5.0 * body.mass_deviation, "{body:?}");
    assert!(body.mass_deviation < 1e-3 * body.mass, "{body:?}");
    let found = MassProperties::new(body.mass, body.inertia).unwrap().principal().moments;
    let error = (found / scene.mass().principal().moments - DVec3::ONE).abs().max_element();
    assert!(error < 0.02, "{found}");
    let truth = &simulation.instants[estimates.len() - 1];
    assert!(in_deviations(last, 0, last.motion.p_WCm.distance(truth.touch.p_WCm)) < 5.0);
}

#[test]
fn a_wrong_force_gain_is_flagged() {
    let (scene, _, log) = run(5.0, 1000.0);
    let mut samples = noisy(&log, 2);
    for sample in samples.iter_mut().filter(|s| s.t > 3.5) {
        sample.palms[1].force = sample.palms[1].force.map(|f| 1.1 * f);
    }
    let estimates = taken(&mut stream(&scene, NOISE, 1000.0, true), &samples);
    let at = |t: f64| estimates.iter().find(|e| e.motion.t >= t).unwrap();
    assert_eq!(at(3.45).stage, StreamStage::Tracking);
    // A tenth of 4 N on 1.3 kg makes 0.3 m/s in a second, where the condition is known to some 1e-3 m/s.
    assert_eq!(at(4.3).stage, StreamStage::Contradicted);
    // With the gain wrong from the start, no motion is ever told without a word against it.
    for sample in &mut samples {
        sample.palms[1].force = sample.palms[1].force.map(|f| if sample.t > 3.5 { f } else { 1.1 * f });
    }
    let estimates = taken(&mut stream(&scene, NOISE, 1000.0, true), &samples);
    let believed = estimates.iter().filter(|e| e.stage == StreamStage::Tracking).count();
    assert_eq!(believed, 0);
}

/// Palms are withdrawn: the body flies freely, and so does the estimate.
#[test]
fn loss_of_contact_is_told_and_the_flight_is_followed() {
    let (scene, simulation, log) = run(4.0, 1000.0);
    let mut samples = noisy(&log, 3);
    let (start, flight) = (3000, 400);
    samples.truncate(start + flight);
    for sample in &mut samples[start..] {
        for palm in &mut sample.palms {
            (palm.contact, palm.force) = (None, Some(0.0));
        }
    }
    let estimates = taken(&mut stream(&scene, NOISE, 1000.0, true), &samples);
    assert!(estimates[..start].iter().all(|e| e.lost == [false; 3]));
    assert!(estimates[start..].iter().all(|e| e.lost == [true; 3]));
    // In the last sample with contact, half of its force acts on.
    let (before, now) = (&simulation.instants[start - 1], estimates.last().unwrap());
    let t = now.motion.t - before.t;
    let p = before.touch.p_WCm + t * before.rates.v_WCm + 0.5 * t * t * scene.gravity();
    let v = before.rates.v_WCm + t * scene.gravity();
    assert!(in_deviations(now, 0, now.motion.p_WCm.distance(p)) < 5.0, "{} {p}", now.motion.p_WCm);
    // Half a sample of the force is 5e-3 m/s.
    assert!(now.motion.v_WCm.distance(v) < 2e-2, "{} {v}", now.motion.v_WCm);
    let L = |R: DQuat, w: DVec3| R * (scene.mass().inertia() * (R.inverse() * w));
    let (had, has) = (L(before.R_WO, before.w_WO), L(now.motion.R_WO, now.motion.w_WO));
    assert!(had.distance(has) < 0.05 * had.length(), "{had} {has}");
    // What is not felt is not known better: the position drifts with the velocity's uncertainty.
    let size = |e: &StreamEstimate| (0..3).map(|i| e.covariance[(i, i)]).sum::<f64>().sqrt();
    assert!(size(now) > size(&estimates[start - 1]), "{} {}", size(now), size(&estimates[start - 1]));
}

#[test]
fn bad_options_and_samples_are_named() {
    let (scene, _, log) = run(0.2, 1000.0);
    let mut options = StreamOptions {
        mass: None,
        gravity: scene.gravity(),
        palm_inertias: None,
        noise: NOISE,
        sample_rate: f64::NAN,
    };
    assert!(matches!(MotionStream::new(options), Err(StreamError::Option { what: "sample rate", .. })));
    options.sample_rate = 1000.0;
    options.noise.force = 0.0;
    assert!(matches!(MotionStream::new(options), Err(StreamError::Option { what: "noise of forces", .. })));
    let mut stream = stream(&scene, NOISE, 1000.0, true);
    let mut samples = log.samples().to_vec();
    samples[3].palms[0].force = None;
    let failed: Vec<_> = samples.iter().filter_map(|s| stream.push(s).err()).collect();
    assert_eq!(failed.len(), 1);
    assert!(matches!(failed[0], StreamError::Sample(TrackError::NoForce { palm: 1, .. })), "{failed:?}");
}

/// Blocks are short then, and each sample does the work of many.
#[test]
fn few_samples_a_second_are_followed_too() {
    for rate in [50.0, 100.0] {
        let (scene, simulation, log) = run(6.0, rate);
        let estimates = taken(&mut stream(&scene, NOISE, rate, true), &noisy(&log, 4));
        assert_eq!(estimates.last().unwrap().stage, StreamStage::Tracking, "{rate}");
        for (estimate, truth) in estimates.iter().zip(&simulation.instants) {
            if estimate.stage == StreamStage::Tracking {
                let p = in_deviations(estimate, 0, estimate.motion.p_WCm.distance(truth.touch.p_WCm));
                let v = in_deviations(estimate, 1, estimate.motion.v_WCm.distance(truth.rates.v_WCm));
                assert!(p < 5.0 && v < 5.0, "{rate} Hz, t = {}: {p} {v}", truth.t);
            }
        }
    }
}

#[test]
fn samples_that_are_no_numbers_or_stand_still_are_left_out() {
    let (scene, _, log) = run(4.0, 1000.0);
    let samples = noisy(&log, 1);
    let clean = taken(&mut stream(&scene, NOISE, 1000.0, true), &samples);
    let mut stream = stream(&scene, NOISE, 1000.0, true);
    let mut with_rubbish = Vec::new();
    for (k, sample) in samples.iter().enumerate() {
        with_rubbish.extend(stream.push(sample).unwrap());
        let mut wrong = *sample;
        wrong.t += 0.5e-3;
        match k % 4 {
            0 => wrong.t = sample.t,
            1 => wrong.t = f64::NAN,
            2 => wrong.palms[1].contact = Some([0.1, f64::NAN]),
            _ => wrong.palms[2].force = Some(f64::INFINITY),
        }
        let error = stream.push(&wrong).unwrap_err();
        let time = matches!(error, StreamError::Time { .. });
        let reading = matches!(error, StreamError::Reading { palm: 2 | 3, .. });
        assert!(if k % 4 < 2 { time } else { reading }, "{error}");
    }
    // As if they had never been.
    assert_eq!(with_rubbish.len(), clean.len());
    let (with, without) = (with_rubbish.last().unwrap(), clean.last().unwrap());
    assert_eq!(
        (with.motion, with.covariance, with.stage),
        (without.motion, without.covariance, without.stage)
    );
}

#[test]
fn pieces_make_the_track_that_the_whole_log_makes() {
    let (scene, _, log) = run(1.0, 1000.0);
    let mass = scene.mass().mass();
    let whole = Track::new(&log, mass, scene.gravity(), None).unwrap().thinned(21);
    let mut pieces = Pieces::new(21, None, mass, scene.gravity());
    let mut track: Option<Track> = None;
    for sample in log.samples() {
        pieces.push(sample).unwrap();
        if pieces.piece().is_none() {
            continue;
        }
        let piece = pieces.track().integrated();
        let track = track.get_or_insert_with(|| {
            let mut track = Track::growing(mass, scene.gravity(), 0.0, 60);
            track.extend(&piece, 0, 10);
            track
        });
        track.extend(&piece, 21, 10);
    }
    let track = track.unwrap();
    assert!(track.len() >= 45);
    for k in 0..track.len() {
        let (a, b) = (&track.integrals[k], &whole.integrals[k]);
        for (a, b) in [
            (a.impulse, b.impulse),
            (a.first_moment, b.first_moment),
            (a.moment, b.moment),
            (a.curl, b.curl),
            (a.velocity, b.velocity),
            (a.position, b.position),
        ] {
            // The quadrature at the ends of pieces leans to one side: order 7 in the spacing still.
            assert!(a.distance(b) < 1e-9 * (1.0 + b.length()), "{k}: {a} {b}");
        }
        if k > 0 {
            let (a, b) = (track.middle[k - 1], whole.middle[k - 1]);
            assert!((0..4).all(|i| a[i].distance(b[i]) < 1e-9 * (1.0 + b[i].length())), "{k}");
        }
    }
}
