//! `recon simulate` on scenes in the plane: the log, what is said of it, and what is refused.

use crate::common::{Run, Scratch, Table};
use recon::contact_kinematics::planar::PalmSurface;
use recon_io::read_planar_contact_log;
use serde_json::Value;

/// A disc on a slope with friction, which slides at first and then rolls; a fingertip above takes no part.
const SLOPE: &str = r#"
plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 2.5e-4
[[palm]]
kind = "line"
friction = 0.2
pose = { position = [0.0, 0.0], angle = 0.3 }
[[palm]]
kind = "arc"
radius = 0.01
friction = 0.5
pose = { position = [0.0, 1.0] }
[simulation]
duration = 0.5
sample_rate = 200.0
position = [0.0, 0.06]
velocity = [0.4, 0.0]
touches = [1]
shape = { kind = "circle", radius = 0.05 }
"#;

fn simulate(scratch: &Scratch, scene: &str) -> Run {
    scratch.write("scene.toml", scene);
    scratch.run(&["simulate", "scene.toml", "-o", "log.csv", "--json"])
}

#[test]
fn a_page_shows_it_if_one_is_asked_for() {
    let scratch = Scratch::new("planar-page");
    scratch.write("slope.toml", SLOPE);
    let run = scratch.run(&["simulate", "slope.toml", "-o", "log.csv", "--report", "page.html", "--json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(said["report"].as_str(), Some("page.html"));
    let page = scratch.read("page.html");
    assert!(page.contains("<title>slope") && page.contains("class=\"palm p2\""));
    // Neither the scene nor the log is written over, and scenes without [[palm]] tables have no such page.
    for file in ["slope.toml", "log.csv"] {
        let run = scratch.run(&["simulate", "slope.toml", "-o", "log.csv", "--report", file]);
        assert!(run.code != Some(0) && run.stderr.contains(file), "{}", run.stderr);
    }
    scratch.write("three.toml", include_str!("../../scenes/fig5.toml"));
    let run = scratch.run(&["simulate", "three.toml", "-o", "other.csv", "--report", "other.html"]);
    assert!(run.code == Some(3) && run.stderr.contains("recon reconstruct"), "{}", run.stderr);
    assert!(!scratch.path().join("other.csv").exists());
}

#[test]
fn a_disc_on_a_slope_slides_and_then_rolls() {
    let scratch = Scratch::new("planar-slope");
    let run = simulate(&scratch, SLOPE);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    // One palm tells no size.
    let refused = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"]);
    assert!(refused.code == Some(3) && refused.stderr.contains("as object.size"), "{}", refused.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((said["samples"].as_u64(), said["duration_s"].as_f64()), (Some(101), Some(0.5)));
    assert_eq!(said["mode_changes"]["slip_ends"].as_u64(), Some(1), "{said}");
    // The slope is 0.3 rad: the disc of radius 0.05 at a height of 0.06 is moved onto it.
    let laid = said["laid_by_m"].as_f64().unwrap();
    assert!((laid - (0.06 * 0.3_f64.cos() - 0.05)).abs() < 1e-12, "{laid}");
    // It comes up the slope at 0.4 cos 0.3 without a spin; gravity and friction slow it, and friction spins it, until it rolls.
    let (sin, cos) = 0.3_f64.sin_cos();
    let (speed, radius, inertia_share) = (0.4 * cos, 0.05, 0.2 * 0.05_f64.powi(2) / 2.5e-4);
    let [a, alpha] = [-9.81 * (sin + 0.2 * cos), -0.2 * 9.81 * cos * inertia_share / radius];
    let slides = speed / -(a + alpha * radius);
    let said_slides = said["palms"][0]["slides_s"].as_f64().unwrap();
    assert!((said_slides - slides).abs() < 1e-9, "{said_slides} {slides}");
    assert_eq!(said["palms"][1]["off_s"].as_f64(), Some(0.5));
    let surfaces = [PalmSurface::Line, PalmSurface::Arc { radius: 0.01 }];
    let log = read_planar_contact_log(scratch.path().join("log.csv"), &surfaces).unwrap();
    // Rolling: the force is that of a disc of this inertia, and no more than friction holds.
    let (normal, along) = (0.2 * 9.81 * cos, 0.2 * 9.81 * sin / (1.0 + inertia_share));
    let force = log.samples()[100].palms[0].force;
    assert!((force.length() - normal.hypot(along)).abs() < 1e-9, "{force}");
    assert!(log.samples().iter().all(|sample| sample.palms[1].p_WC.is_none()));
    assert_eq!(log.truth().unwrap().len(), 101);
    let text = scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]).stdout;
    for part in ["101 samples over 0.5 s", "slip ends 1", "laid on its palms by a move of 7.3e-3 m"] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
}

#[test]
fn its_sensors_have_the_noise_of_the_scene() {
    let scratch = Scratch::new("planar-noise");
    let scene = SLOPE.replace("sample_rate = 200.0", "sample_rate = 2000.0");
    let read = |sensors: &str| {
        let run = simulate(
            &scratch,
            &scene.replace("[simulation]", &format!("[sensors]\n{sensors}\n[simulation]")),
        );
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        Table::parse(&scratch.read("log.csv"))
    };
    let (exact, noisy) = (read(""), read("contact_std = 1e-3\nforce_std = 0.05"));
    for (column, deviation) in [("fx_1", 0.05), ("fy_1", 0.05)] {
        let place = exact.column(column);
        let value = |row: &Vec<String>| row[place].parse::<f64>().unwrap();
        let pairs = || exact.rows.iter().zip(&noisy.rows);
        let sum: f64 = pairs().map(|(a, b)| (value(a) - value(b)).powi(2)).sum();
        // Of 1001 samples: known to 2.2 %.
        let found = (sum / exact.rows.len() as f64).sqrt();
        assert!((found / deviation - 1.0).abs() < 0.09, "{column}: {found}");
    }
    assert_ne!(exact.rows[7][exact.column("px_1")], noisy.rows[7][noisy.column("px_1")]);
}

#[test]
fn what_cannot_be_is_told_and_leaves_no_log() {
    let scratch = Scratch::new("planar-refused");
    let refused = |scene: String, words: &[&str]| {
        let run = simulate(&scratch, &scene);
        scratch.check_refused_scene(&run, words);
    };
    refused(SLOPE.replace("touches = [1]", "touches = [3]"), &["scene.toml", "`simulation.touches[0]` is 3"]);
    refused(
        SLOPE.replace("touches = [1]", "touches = []").replace("0.06]", "0.03]"),
        &["penetrate", "palm 1"],
    );
    refused(
        SLOPE.replace("inertia = 2.5e-4\n", ""),
        &["scene.toml", "`object.inertia`", "radius_of_gyration"],
    );
    refused(SLOPE.replace("radius = 0.05", "radius = -0.05"), &["scene.toml", "`simulation.shape`", "-0.05"]);
    refused(SLOPE.replace("[0.0, 1.0]", "[0.0, 0.0]"), &["no room for the object", "palm 2"]);
    // A command that knows space alone.
    scratch.write("scene.toml", SLOPE);
    let run = scratch.run(&["follow", "scene.toml", "--scene", "scene.toml", "-o", "out.csv"]);
    assert_eq!(run.code, Some(3), "{}", run.stdout);
    assert!(run.stderr.contains("scene in the plane"), "{}", run.stderr);
}
