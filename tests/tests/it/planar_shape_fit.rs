//! Shape and motion from contacts and palm angles alone.

use crate::planar_common::{scene, times};
use recon::contact_kinematics::planar::{PairContact, RadiusFunction};
use recon::object_dynamics::planar::*;
use recon::observer::Status;
use recon::observer::planar::*;
use recon_tests::few_or_all;

struct Outcome {
    radius_rms: f64,
    gyration: f64,
    fit: ShapeFit,
}

fn run(name: &str, rate: f64, duration: f64, deviation: f64, order: usize, seed: u64) -> Outcome {
    let (object, motion, start) = scene(name);
    let run = simulate_prescribed(&object, &motion, start, &times(rate, duration), 1e-13).unwrap();
    let noise = PlanarNoise { contact: deviation, ..PlanarNoise::default() };
    let noisy = noise.add_to(&run.log().unwrap(), seed);
    let options = ShapeFitOptions { order, contact_deviation: deviation, gravity: object.gravity };
    // No forces and no torques in the log.
    let samples =
        noisy.samples().iter().map(|s| PlanarSample { forces: None, torques: None, ..*s }).collect();
    let fit = fit_shape(&PlanarLog::new(samples, None).unwrap(), &options).unwrap();
    let mut sum = 0.0;
    for (s, radii) in run.samples.iter().zip(&fit.radii) {
        let palms = motion.at(s.sample.t).unwrap().pair;
        let truth = PairContact::new(&object.shape, &palms, s.truth.phi0);
        sum += (radii[0] - truth.jets[0].r).powi(2) + (radii[1] - truth.jets[1].r).powi(2);
    }
    let radius_rms = (sum / (2 * run.samples.len()) as f64).sqrt();
    let gyration = fit.gyration_squared.0 / object.mass.gyration_squared() - 1.0;
    println!(
        "{name} {duration} s at {rate} Hz, noise {} mm, order {order}: r {:.4} mm rms, gyration {:+.2e}, residual {:.3}, {:?}, {} iterations",
        1e3 * deviation,
        1e3 * radius_rms,
        gyration,
        fit.residual,
        fit.status,
        fit.iterations
    );
    Outcome { radius_rms, gyration, fit }
}

/// One turn of the 50 mm object at 0.1 mm noise, with more harmonics than the shape has.
#[test]
fn one_turn_without_forces() {
    for seed in [1, 2, 3] {
        let outcome = run("S2_rotating_pair", 250.0, 1.05, 1e-4, 5, seed);
        let turn = outcome.fit.motion.last().unwrap()[0].abs();
        assert!(turn > 5.5, "{turn} rad");
        assert_eq!(outcome.fit.status, Status::Converged);
        assert!(outcome.radius_rms < 0.02e-3, "{}", outcome.radius_rms);
        assert!(outcome.gyration.abs() < 0.01, "{}", outcome.gyration);
        assert!((outcome.fit.residual - 1.0).abs() < 0.15, "{}", outcome.fit.residual);
        assert!(outcome.fit.body().is_ok());
        // The stated deviation of the radius of gyration is true.
        let (value, deviation) = outcome.fit.gyration_squared;
        assert!((outcome.gyration * value).abs() < 4.0 * deviation, "{value} {deviation}");
        // Around the outline, apart from the gauge that phi0(0) is zero.
        let (object, _, start) = scene("S2_rotating_pair");
        let body = outcome.fit.body().unwrap();
        let worst = (0..360)
            .map(|i| f64::from(i).to_radians())
            .map(|t| (body.jet(t + start.phi0).r - object.shape.jet(t).r).abs())
            .fold(0.0, f64::max);
        assert!(worst < 0.1e-3, "{worst}");
    }
}

/// Less noise, less error: the estimator is limited by noise, not by its model.
#[test]
fn error_falls_with_the_noise() {
    let coarse = run("S2_rotating_pair", 250.0, 1.05, 1e-4, 4, 7);
    let fine = run("S2_rotating_pair", 250.0, 1.05, 1e-6, 4, 7);
    assert!(fine.radius_rms < 0.03 * coarse.radius_rms, "{} {}", fine.radius_rms, coarse.radius_rms);
}

/// An ellipse has harmonics without end: as many are taken as noise does not hide.
#[test]
fn an_ellipse_finds_its_order() {
    use glam::DVec2;
    use recon::contact_kinematics::planar::Ellipse;
    let shape = Ellipse::new(0.055, 0.035, DVec2::new(0.003, 0.002)).unwrap();
    let mass = PlanarMass::from_gyration(0.2, 0.0009).unwrap();
    let object = PlanarObject { shape, mass, gravity: 9.81 };
    let motion = ConstantRates { angles: [0.75, 1.6], rates: [0.2, 0.0] };
    let start = PlanarStart { phi0: 0.3, omega0: 7.0 };
    for &(seed, order) in few_or_all(&[(2, 5), (3, 2)][..], &[(1, 5), (2, 5), (3, 2)]) {
        let run = simulate_prescribed(&object, &motion, start, &times(250.0, 1.5), 1e-13).unwrap();
        let noise = PlanarNoise { contact: 1e-4, ..PlanarNoise::default() };
        let log = noise.add_to(&run.log().unwrap(), seed);
        let options = ShapeFitOptions { order, contact_deviation: 1e-4, gravity: 9.81 };
        let fit = fit_shape(&log, &options).unwrap();
        let (value, deviation) = fit.gyration_squared;
        let (off, found) = ((value - 0.0009) / deviation, fit.cosines.len() - 1);
        println!(
            "ellipse, {} samples, seed {seed}, from order {order}: {found}, residual {:.3}, excess {:.1}, gyration {off:.1} deviations, {:?}",
            run.samples.len(),
            fit.residual,
            fit.excess,
            fit.status
        );
        assert!(fit.status == Status::Converged && fit.excess <= ShapeFit::UNEXPLAINED, "{}", fit.excess);
        assert!(found > order && off.abs() < 4.0, "{found} {off}");
    }
}

/// Noise that is stated too small is not explained by any shape.
#[test]
fn what_noise_does_not_explain_is_not_relied_on() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(100.0, 1.0), 1e-13).unwrap();
    let log = PlanarNoise { contact: 1.5e-4, ..PlanarNoise::default() }.add_to(&run.log().unwrap(), 1);
    let options = ShapeFitOptions { order: 4, contact_deviation: 1e-4, gravity: object.gravity };
    assert_eq!(fit_shape(&log, &options).unwrap().status, Status::Inconsistent);
}

/// A centred disc shows neither its turn nor its radius of gyration: the prior stays, and the report says so.
#[test]
fn a_disc_is_reported() {
    use glam::DVec2;
    use recon::contact_kinematics::planar::Circle;
    let shape = Circle::new(0.04, DVec2::ZERO).unwrap();
    let mass = PlanarMass::from_gyration(0.2, 0.0008).unwrap();
    let object = PlanarObject { shape, mass, gravity: 9.81 };
    let motion = ConstantRates { angles: [0.7, 1.5], rates: [0.2, 0.0] };
    let start = PlanarStart { phi0: 0.0, omega0: 3.0 };
    let run = simulate_prescribed(&object, &motion, start, &times(200.0, 0.5), 1e-13).unwrap();
    let noise = PlanarNoise { contact: 1e-4, ..PlanarNoise::default() };
    let log = noise.add_to(&run.log().unwrap(), 3);
    let options = ShapeFitOptions { order: 3, contact_deviation: 1e-4, gravity: 9.81 };
    let fit = fit_shape(&log, &options).unwrap();
    println!("disc: {:?}, {} -> {}", fit.status, fit.smallest_information, fit.direction);
    assert_eq!(fit.status, Status::NotObservable);
    let (omega0, deviation) = fit.omega0;
    assert!((omega0 - 3.0).abs() < 3.0 * deviation, "covariance covers the truth: {omega0} {deviation}");
}
