//! `recon simulate` on scenes of any palms: the log, what is said of it, and what is refused.

use crate::common::{Run, Scratch, Table, scene};
use recon_tests::few_or_all;
use serde_json::Value;

const PICK_UP: &str = include_str!("../../scenes/pick-up.toml");

/// An ellipsoid at rest on a table with friction.
const RESTING: &str = r#"
gravity = 9.81
[object]
mass = 0.1
principal_moments = [3.05e-5, 3.7e-5, 4.25e-5]
[[palm]]
kind = "flat"
friction = 0.5
pose = { position = [0.0, 0.0, 0.0] }
[simulation]
duration = 0.1
sample_rate = 100.0
position = [0.0, 0.0, 0.025]
shape = { kind = "ellipsoid", semi_axes = [0.035, 0.03, 0.025] }
"#;

fn simulate(scratch: &Scratch, scene: &str) -> Run {
    scratch.write("scene.toml", scene);
    scratch.run(&["simulate", "scene.toml", "-o", "log.csv", "--tolerance", "1e-9", "--json"])
}

#[test]
fn a_scene_of_any_palms_gives_a_log_and_its_modes() {
    let scratch = Scratch::new("simulate-any");
    let scene = PICK_UP.replace("sample_rate = 1000.0", "sample_rate = 100.0");
    let run = simulate(&scratch, &scene);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!((said["samples"].as_u64(), said["duration_s"].as_f64()), (Some(101), Some(1.0)));
    // Each fingertip comes to touch, and the table is left.
    assert!(said["mode_changes"]["touches"].as_u64().unwrap() >= 3, "{said}");
    assert_eq!(said["mode_changes"]["lifts"].as_u64(), Some(1));
    let log = Table::parse(&scratch.read("log.csv"));
    let (rows, mode) = (log.rows.len(), |row: usize, palm| log.rows[row][log.column(palm)].clone());
    assert_eq!(rows, 101);
    assert_eq!([mode(0, "mode_1"), mode(100, "mode_1"), mode(100, "mode_2")], ["2.0", "0.0", "2.0"]);
    for (i, palm) in said["palms"].as_array().unwrap().iter().enumerate() {
        let times = ["off_s", "slides_s", "sticks_s"].map(|key| palm[key].as_f64().unwrap());
        assert!((times.iter().sum::<f64>() - 1.0).abs() < 1e-12 && times.iter().all(|t| *t >= 0.0), "{palm}");
        // Each sample stands for the time to the next one, up to one at each change.
        let modes = log.column(&format!("mode_{}", i + 1));
        let sampled = log.rows[..100].iter().filter(|row| row[modes] == "0.0").count();
        assert!((sampled as f64 / 100.0 - times[0]).abs() < 0.1, "{palm} {sampled}");
    }
    let text = scratch.run(&["simulate", "scene.toml", "-o", "log.csv", "--tolerance", "1e-6"]).stdout;
    for part in ["101 samples over 1 s", "lifts 1", "slip begins", "palm 4: off 0."] {
        assert!(text.contains(part), "`{part}` is not in\n{text}");
    }
}

#[test]
fn every_channel_has_the_noise_that_the_scene_states() {
    let scratch = Scratch::new("simulate-noise");
    let spread = |sensors: &str, column: &str, about: f64| {
        let scene = RESTING.replace("rate = 100.0", "rate = 5000.0");
        let run = simulate(&scratch, &format!("{scene}\n[sensors]\n{sensors}\n"));
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let log = Table::parse(&scratch.read("log.csv"));
        let place = log.column(column);
        let value = |row: &Vec<String>| row[place].parse::<f64>().unwrap();
        let steps = log.rows.windows(2).map(|pair| value(&pair[1]) - value(&pair[0]));
        let sum: f64 = match column.starts_with('J') {
            // Of an integral the steps have the noise, beside their own mean.
            true => steps.map(|step| (step - about).powi(2)).sum(),
            false => log.rows[1..].iter().map(|row| (value(row) - about).powi(2)).sum(),
        };
        (sum / (log.rows.len() - 1) as f64).sqrt()
    };
    let weight = 0.1 * 9.81;
    for (sensors, column, about, deviation) in [
        ("contact_std = 1e-4", "px_1", 0.0, 1e-4),
        ("force_std = 0.02", "fx_1", 0.0, 0.02),
        ("force_share = 0.05", "fz_1", weight, 0.05 * weight),
        ("impulse_std = 1e-5", "Jx_1", 0.0, 1e-5),
        ("impulse_share = 0.1", "Jz_1", weight / 5000.0, 0.1 * weight / 5000.0),
    ] {
        // Of 500 samples: the deviation of a deviation is 3.2 %.
        let found = spread(sensors, column, about);
        assert!((found / deviation - 1.0).abs() < 0.13, "{column}: {found:e} for {deviation:e}");
        assert!(spread("", column, about) < 1e-6 * deviation, "{column} is noisy without being told");
    }
}

#[test]
fn torques_of_three_palms_are_noisy_too() {
    let scratch = Scratch::new("simulate-torque");
    let scene = scene() + "\n[palms]\ninertia = [0.1, 0.1, 0.1]\n";
    let torques = |sensors: &str| {
        let run = simulate(&scratch, &(scene.clone() + sensors));
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        let log = Table::parse(&scratch.read("log.csv"));
        let place = log.column("tau_2");
        log.rows.iter().map(|row| row[place].parse::<f64>().unwrap()).collect::<Vec<_>>()
    };
    let (exact, noisy) = (torques(""), torques("[sensors]\ntorque_std = 0.1\n"));
    let sum: f64 = exact.iter().zip(&noisy).map(|(a, b)| (a - b).powi(2)).sum();
    let deviation = (sum / exact.len() as f64).sqrt();
    // Of 211 samples: known to 4.9 %.
    assert!((deviation / 0.1 - 1.0).abs() < 0.2, "{deviation}");
}

#[test]
fn what_has_no_motion_is_told_and_leaves_no_log() {
    let scratch = Scratch::new("simulate-refused");
    let refused = |scene: String, words: &[&str]| {
        let run = simulate(&scratch, &scene);
        scratch.check_refused_scene(&run, words);
    };
    let at = |height: &str| RESTING.replace("[0.0, 0.0, 0.025]", height);
    refused(at("[0.0, 0.0, 0.024]"), &["penetrates palm 1 by 1.000e-3 m"]);
    refused(at("[0.0, 0.0, 0.026]"), &["touches no palm", "gap of 1.000e-3 m"]);
    refused(RESTING.replace("position = [0.0, 0.0, 0.025]\n", ""), &["scene.toml", "`simulation.position`"]);
    refused(RESTING.replace("friction = 0.5\n", ""), &["scene.toml", "`palm[1].friction`"]);
    refused(RESTING.replace("flat", "flat\"\nradius = 0.1\nkin = \""), &["scene.toml"]);
    let loud = RESTING.to_owned() + "\n[sensors]\ncontact_std = 1e308\n";
    refused(loud, &["noise of the scene"]);
}

#[test]
fn a_jam_is_told_and_leaves_no_log() {
    let scratch = Scratch::new("simulate-jam");
    // A plate that closes on the object from above.
    let press = "\n[[palm]]\nkind = \"flat\"\nfriction = 0.5\npose = { position = [0.0, 0.0, 0.05], normal = [0.0, 0.0, -1.0] }\n\
        motion = [{ shift = [0.0, 0.0, -1.0], law = { kind = \"steady\", start = 0.0, rate = 0.01 } }]\n[simulation]";
    let run = simulate(&scratch, &RESTING.replace("\n[simulation]", press));
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("friction wedges the object: a jam"), "{}", run.stderr);
    assert_eq!(scratch.names(), ["scene.toml"]);
}

/// Angle at the end from the vertical, rad, of the body's own axis that pointed up at the start.
fn downwards(log: &Table) -> f64 {
    let places = ["qw", "qx", "qy", "qz"].map(|name| log.column(name));
    // The world's vertical in body axes: the last row of the matrix from body to world.
    let up = |row: &Vec<String>| {
        let [w, x, y, z] = places.map(|place| row[place].parse::<f64>().unwrap());
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
    };
    let [first, last] = [&log.rows[0], &log.rows[log.rows.len() - 1]].map(up);
    (0..3).map(|k| first[k] * last[k]).sum::<f64>().acos()
}

#[test]
fn tilting_palms_turn_the_object_over_and_a_page_shows_it() {
    let scratch = Scratch::new("demo-tilting");
    if few_or_all(true, false) {
        // The demo takes eight digits: to five the object turns over as far, in a fifth of the time.
        scratch.write("scene.toml", include_str!("../../scenes/three-tilting-palms.toml"));
        let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv", "--tolerance", "1e-5", "--json"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_turned_over(&run, &scratch.read("log.csv"));
        let run = scratch.run(&["demo", "--scene", "pick-up", "-o", "out", "--json"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_shown(&scratch, &run, "Three fingertips");
        return;
    }
    let run = scratch.run(&["demo", "--scene", "three-tilting-palms", "-o", "out", "--json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert_turned_over(&run, &scratch.read("out/log.csv"));
    let summary = assert_shown(&scratch, &run, "Three tilting palms");
    // All three palms have friction: each is rolled on for a while.
    let sticks = [0, 1, 2].map(|i| summary["palms"][i]["sticks_s"].as_f64().unwrap());
    assert!(sticks.iter().all(|seconds| *seconds > 0.5), "{sticks:?}");
    // Its own scene goes on.
    let again = scratch.run(&["simulate", "out/scene.toml", "-o", "again.csv", "--tolerance", "1e-8"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);
    assert!(scratch.read("again.csv") == scratch.read("out/log.csv"));
}

fn assert_turned_over(run: &Run, log: &str) {
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    let turn = said["turn_rad"].as_f64().unwrap().to_degrees();
    assert!((turn - 177.9373).abs() < 1e-3, "{turn}");
    let over = downwards(&Table::parse(log)).to_degrees();
    assert!(over > 90.0 && (over - 140.4991).abs() < 1e-3, "{over}");
}

/// Checks the folder of a demo, and gives its summary.
fn assert_shown(scratch: &Scratch, run: &Run, title: &str) -> Value {
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    let names = ["log.csv", "manifest.json", "report.html", "scene.toml", "scene.xml", "summary.json"];
    for name in names {
        assert!(scratch.path().join("out").join(name).exists(), "{name}");
    }
    let summary: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    assert_eq!((&summary["palms"], &summary["turn_rad"]), (&said["palms"], &said["turn_rad"]));
    let page = scratch.read("out/report.html");
    assert!(page.contains(&format!("<title>{title}")) && page.matches("<figure").count() == 1 + 6);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    summary
}
