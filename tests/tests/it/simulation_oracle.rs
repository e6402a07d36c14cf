//! Simulation against reference numbers of another formulation at 140 bits, and against the laws of mechanics.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{End, InitialMotion, SampleTimes, Simulation, ThreePalmScene};
use recon_tests::{f5, fig5, g2, orientation_difference, relative_energy_drift, tilted};
use serde_json::Value;

/// Close to rounding: local errors of 1e-14 grow by the flow's own factor (up to 240 over `F5`).
const TIGHT: Tolerance = Tolerance { relative: 1e-14, absolute: 1e-14 };

fn oracle() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/oracle-three-palms-flat.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn vector(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn run<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    duration: f64,
    rate: f64,
) -> Simulation {
    scene.simulate(start, SampleTimes { duration, rate }, TIGHT).unwrap()
}

/// Largest departure from the oracle's samples, over every quantity that it lists.
fn departure<S: SupportFunction>(name: &str, scene: &ThreePalmScene<S>, start: InitialMotion) -> f64 {
    let oracle = &oracle()[name];
    let samples = oracle["samples"].as_array().unwrap();
    let duration = number(&oracle["setup"]["T"]);
    let mut worst = 0.0_f64;
    let mut compared = 0;
    for sample in samples {
        let t = number(&sample["t"]);
        // Each sample on its own grid, so that it is hit exactly.
        let simulation = run(scene, start, t.max(1e-3), 1.0 / t.max(1e-3));
        assert_eq!(simulation.end, End::Completed);
        assert!(t <= duration);
        let now = if t == 0.0 { &simulation.instants[0] } else { simulation.instants.last().unwrap() };
        assert!((now.t - t).abs() < 1e-15);
        let q = &sample["q"];
        let orientation = DQuat::from_xyzw(number(&q[1]), number(&q[2]), number(&q[3]), number(&q[0]));
        worst = worst
            .max(orientation_difference(now.R_WO, orientation))
            .max((now.w_WO - vector(&sample["omega"])).length())
            .max((now.touch.p_WCm - vector(&sample["cm"])).length())
            .max((now.rates.v_WCm - vector(&sample["v"])).length())
            .max((now.energy(scene) - number(&sample["energy"])).abs() / number(&sample["energy"]));
        for i in 0..3 {
            let s = now.sensor(i);
            worst = worst
                .max((now.touch.contacts[i].jet.value - number(&sample["r"][i])).abs())
                .max((now.accelerations.forces[i] - number(&sample["f"][i])).abs() / number(&sample["f"][i]))
                .max((s[0] - number(&sample["s"][i][0])).abs())
                .max((s[1] - number(&sample["s"][i][1])).abs());
        }
        compared += 1;
    }
    assert!(compared >= 5, "{compared}");
    worst
}

#[test]
fn immobile_palms_match_the_oracle() {
    let (scene, start) = f5();
    let worst = departure("F5", &scene, start);
    assert!(worst < 1e-11, "{worst:e}");
}

#[test]
fn moving_palms_match_the_oracle() {
    let (scene, start) = g2();
    let worst = departure("G2", &scene, start);
    assert!(worst < 1e-11, "{worst:e}");
}

#[test]
fn energy_is_kept_on_immobile_palms() {
    for (scene, start) in [f5(), fig5(9.81)] {
        let simulation = run(&scene, start, 4.2, 100.0);
        assert_eq!(simulation.instants.len(), 421);
        let drift = relative_energy_drift(&scene, &simulation.instants);
        assert!(drift < 1e-12, "{drift:e}");
    }
}

#[test]
fn energy_changes_by_the_work_of_the_palms() {
    let (scene, start) = g2();
    let rate = 1000.0;
    let simulation = run(&scene, start, 4.0, rate);
    let power: Vec<f64> = simulation.instants.iter().map(|now| now.palm_power()).collect();
    // Simpson's rule: error of order rate^-4 = 1e-12 times fourth derivatives.
    let work: f64 = power.windows(3).step_by(2).map(|w| (w[0] + 4.0 * w[1] + w[2]) / (3.0 * rate)).sum();
    let gained = simulation.instants.last().unwrap().energy(&scene) - simulation.instants[0].energy(&scene);
    assert!((gained - work).abs() < 1e-10 * gained.abs().max(50.0), "{gained} {work}");
    assert!(gained.abs() > 1e-2, "the palms do work in this scene: {gained}");
}

#[test]
fn gentle_scene_loses_palm_2_at_the_known_time() {
    let (scene, start) = fig5(1.0);
    let simulation = run(&scene, start, 2.0, 1000.0);
    let End::ContactLost { palm, t } = simulation.end else { panic!("{:?}", simulation.end) };
    assert_eq!(palm, 1, "palm 2, counted from 0");
    assert!((t - 1.25888).abs() < 1e-5, "{t}");
    assert_eq!(simulation.instants.len(), 1259, "samples up to the loss and none after it");
    assert!(simulation.instants.iter().all(|now| now.accelerations.forces.iter().all(|&f| f > 0.0)));
}

#[test]
fn loss_of_contact_is_located_alike_at_every_tolerance() {
    let (scene, start) = fig5(1.0);
    for exponent in [4, 6, 8, 10, 12] {
        let tolerance = Tolerance::uniform(10f64.powi(-exponent));
        let times = SampleTimes { duration: 2.0, rate: 100.0 };
        let simulation = scene.simulate(start, times, tolerance).unwrap();
        let End::ContactLost { palm: 1, t } = simulation.end else {
            panic!("1e-{exponent}: {:?}", simulation.end)
        };
        // The flow amplifies a local error by about 10 over this run.
        assert!((t - 1.25888).abs() < 1e-5 + 100.0 * tolerance.relative, "1e-{exponent}: {t}");
    }
}

#[test]
fn golden_logs_are_met() {
    for (file, (scene, start), duration) in
        [("golden_A_fig5.csv", fig5(9.81), 4.2), ("golden_D_tilted.csv", tilted(), 3.0)]
    {
        let path = format!("{}/data/{file}", env!("CARGO_MANIFEST_DIR"));
        let text = std::fs::read_to_string(path).unwrap();
        let mut lines = text.lines();
        let header: Vec<&str> = lines.next().unwrap().split(',').collect();
        let simulation = run(&scene, start, duration, 5.0);
        let mut rows = 0;
        for (line, now) in lines.zip(&simulation.instants) {
            let row: Vec<f64> = line.split(',').map(|v| v.parse().unwrap()).collect();
            let value = |name: &str| row[header.iter().position(|h| *h == name).unwrap()];
            assert!((value("t") - now.t).abs() < 1e-12);
            for i in 0..3 {
                let s = now.sensor(i);
                let palm = i + 1;
                assert!((value(&format!("s1_{palm}")) - s[0]).abs() < 1e-11, "{file} {palm} {}", now.t);
                assert!((value(&format!("s2_{palm}")) - s[1]).abs() < 1e-11);
                assert!((value(&format!("f_{palm}")) - now.accelerations.forces[i]).abs() < 1e-10);
            }
            let w = DVec3::new(value("wx"), value("wy"), value("wz"));
            assert!((w - now.w_WO).length() < 1e-11, "{:e}", (w - now.w_WO).length());
            rows += 1;
        }
        assert!(rows >= 15, "{rows}");
    }
}
