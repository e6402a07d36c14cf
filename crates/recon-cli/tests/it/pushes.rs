//! `recon pushes`: a simulated log to a folder and its page, and bad input.

use crate::common::{Scratch, Table};
use glam::DVec2;
use recon::object_dynamics::pushing::{ClosedLine, PushDisturbances, PushScene, simulate_pushes};
use serde_json::Value;
use std::collections::BTreeMap;

const TRIANGLE: [[f64; 2]; 3] = [[-0.05, -0.05], [0.1, -0.05], [-0.05, 0.1]];
const COMMAND: [&str; 6] = ["pushes", "pushes.csv", "--poses", "poses.csv", "--radius", "0.002"];

/// A folder with a log of pushes of a triangle, friction 0.4.
fn pushed(name: &str) -> Scratch {
    let scene = PushScene {
        outline: ClosedLine::new(TRIANGLE.map(DVec2::from).to_vec()).unwrap(),
        finger_radius: 0.002,
        friction: 0.4,
        length: 0.05,
        sliding_force: 4.0,
        compliance: 5e-5,
    };
    let log = simulate_pushes(&scene, &PushDisturbances::default(), 16, 5).unwrap().log;
    let logs = BTreeMap::from([(3, log)]);
    let (mut samples, mut poses) = (Vec::new(), Vec::new());
    recon_io::write_push_samples(&logs, &mut samples).unwrap();
    recon_io::write_push_poses(&logs, &mut poses).unwrap();
    let scratch = Scratch::new(name);
    scratch.write("pushes.csv", &String::from_utf8(samples).unwrap());
    scratch.write("poses.csv", &String::from_utf8(poses).unwrap());
    scratch
}

#[test]
fn a_log_becomes_an_outline_friction_modes_and_a_page() {
    let scratch = pushed("pushes");
    let run = scratch.run(&[&COMMAND[..], &["-o", "out", "--json"]].concat());
    assert!(matches!(run.code, Some(0 | 4)), "{}{}", run.stdout, run.stderr);
    let summary: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    let log = &summary["logs"][0];
    assert_eq!((&log["log"], &log["outline"]), (&3.into(), &"3 corners".into()), "{}", log["candidates"]);
    let friction = |key: &str| log["friction"][key].as_f64().unwrap();
    let (value, deviation) = (friction("coefficient"), friction("std"));
    assert!((value - 0.4).abs() < 3.0 * deviation && deviation < 0.05, "{value} +- {deviation}");
    // Four deviations of the sum of two variances are passed less than once in two thousand.
    for corner in log["corners"].as_array().unwrap() {
        let at = [0, 1].map(|i| corner["point_m"][i].as_f64().unwrap());
        let off = TRIANGLE.iter().map(|c| DVec2::from(*c).distance(DVec2::from(at)));
        let off = off.fold(f64::INFINITY, f64::min);
        assert!(off < 4.0 * corner["std_m"].as_f64().unwrap(), "{corner}: {off}");
    }
    let modes = Table::parse(&scratch.read("out/modes.csv"));
    let column = |name: &str| modes.header.iter().position(|h| h == name).unwrap();
    for row in &modes.rows {
        let odds = ["stick", "left", "right"].map(|name| row[column(name)].parse::<f64>().unwrap());
        assert!((odds.iter().sum::<f64>() - 1.0).abs() < 1e-6, "{odds:?}");
    }
    let page = scratch.read("out/report.html");
    assert!(page.contains("Angle of the force") && page.contains("class=\"band\""));
    assert!(!page.contains("NaN") && !page.contains("{{") && !page.contains("src="));
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    // Every column is told of.
    let formats: Value = serde_json::from_str(&scratch.run(&["formats", "--json"]).stdout).unwrap();
    for (file, format) in [
        ("pushes.csv", "push-samples"),
        ("poses.csv", "push-poses"),
        ("out/outline.csv", "push-outline"),
        ("out/corners.csv", "push-corners"),
        ("out/touches.csv", "push-touches"),
        ("out/modes.csv", "push-modes"),
    ] {
        let known = formats.as_array().unwrap().iter().find(|f| f["name"] == format).unwrap();
        let groups = known["columns"].as_array().unwrap().iter().map(|g| g["name"].as_str().unwrap());
        let known: Vec<&str> = groups.flat_map(|group| group.split(", ")).collect();
        for name in Table::parse(&scratch.read(file)).header {
            assert!(known.contains(&name.as_str()), "{file}: {name} is not in {known:?}");
        }
    }
}

#[test]
fn bad_pushes_are_refused_with_place_and_mend() {
    let scratch = pushed("pushes-bad");
    let samples = scratch.read("pushes.csv");
    let refused = |words: &[&str], said: &[&str]| {
        let run = scratch.run(&[words, &["-o", "out"]].concat());
        assert!(run.code == Some(3) || run.code == Some(2), "{:?} {}", run.code, run.stderr);
        assert!(said.iter().all(|word| run.stderr.contains(word)), "{}: {said:?}", run.stderr);
        assert!(!scratch.path().join("out").exists());
    };
    refused(&[&COMMAND[..], &["--log", "7"]].concat(), &["no log 7", "it has 3"]);
    refused(&[&COMMAND[..5], &["0.5"]].concat(), &["radius is 0.5 m", "below 0.0"]);
    refused(&[&COMMAND[..5], &["-1"]].concat(), &["--radius"]);
    let few: String = samples.lines().take(3 * 660 + 1).map(|line| format!("{line}\n")).collect();
    scratch.write("pushes.csv", &few);
    refused(&COMMAND, &["poses.csv", "line 5", "push 3 of log 3", "no sample"]);
    let poses = scratch.read("poses.csv");
    let three: String = poses.lines().take(4).map(|line| format!("{line}\n")).collect();
    scratch.write("poses.csv", &three);
    refused(&COMMAND, &["touched in 3 of 3", "needs 6"]);
    scratch.write("pushes.csv", &few.replace(",fy,", ",force_y,"));
    refused(&COMMAND, &["pushes.csv", "`fy` is missing"]);
}
