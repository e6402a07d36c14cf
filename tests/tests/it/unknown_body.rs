//! Motion, mass and inertia together, of a body of which nothing is known.

use crate::noisy::{estimated, exactly, largest_errors, words};
use glam::DVec3;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{InitialMotion, MassProperties, SensorNoise, ThreePalmScene};
use recon_tests::{exact_log, f5, g2};

fn moments<S: SupportFunction>(scene: &ThreePalmScene<S>) -> DVec3 {
    scene.mass().principal().moments
}

fn check_exact<S: SupportFunction>(scene: &ThreePalmScene<S>, start: InitialMotion, duration: f64) {
    let (simulation, log) = exact_log(scene, start, duration, 1000.0);
    let found = exactly(scene, &log, false).unwrap();
    let mass = found.mass / scene.mass().mass() - 1.0;
    let body = MassProperties::new(found.mass, found.inertia).unwrap();
    let inertia = (body.principal().moments - moments(scene)).abs().max_element();
    let (centre, _) = largest_errors(&found, &simulation.instants);
    assert!(found.reliability.is_reliable(), "{}", words(&found.reliability));
    assert!(mass.abs() < 1e-7 && inertia < 1e-6 && centre < 1e-7, "{mass:e} {inertia:e} {centre:e}");
    assert!(found.inertia_deviations.iter().all(|of| *of < 1e-4), "{:?}", found.inertia_deviations);
}

#[test]
fn exact_logs_give_mass_and_inertia() {
    let (scene, start) = f5();
    check_exact(&scene, start, 4.2);
    let (scene, start) = g2();
    check_exact(&scene, start, 4.0);
}

#[test]
fn deviations_of_mass_and_inertia_are_true() {
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    let (scene, start) = g2();
    let (simulation, clean) = exact_log(&scene, start, 4.0, 100.0);
    let axes = simulation.instants[0].R_WO * scene.mass().principal().axes;
    let runs = 3;
    let (mut sum, mut count) = (0.0, 0);
    for seed in 0..runs {
        let found = estimated(&scene, &clean.with_noise(&noise, seed).unwrap(), noise, false);
        assert!(found.reliability.is_reliable(), "seed {seed}: {:?}", found.reliability);
        let mass = (found.mass - scene.mass().mass()) / (found.mass * found.mass_deviation);
        let mut squares = vec![mass * mass];
        for (axis, moment) in DVec3::AXES.into_iter().zip(moments(&scene).to_array()) {
            let axis = axes * axis;
            let error = axis.dot(found.inertia * axis) - moment;
            squares.push((error / found.moment_deviation(axis)).powi(2));
        }
        count += squares.len();
        sum += squares.iter().sum::<f64>();
        assert!(squares.iter().all(|s| *s < 25.0), "{squares:?}");
    }
    // Four numbers a run: 12 squares, deviation sqrt(2 / 12) = 0.41.
    let mean = sum / count as f64;
    assert!((0.1..1.82).contains(&mean), "{mean}");
}
