//! From nothing to a report, and from a log to its motion.

use crate::common::{Scratch, Table, scene, scratch_reconstructed};
use serde_json::Value;

const FILES: [&str; 7] = [
    "contact_curves.csv",
    "lower_bound.ply",
    "motion.csv",
    "radius_functions.csv",
    "report.html",
    "summary.json",
    "upper_bound.ply",
];

/// Largest difference of two equally named columns of two tables.
fn difference(a: &Table, b: &Table, column: &str) -> f64 {
    let values =
        |t: &Table| -> Vec<f64> { t.rows.iter().map(|r| r[t.column(column)].parse().unwrap()).collect() };
    values(a).iter().zip(values(b)).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

/// To 1e-9 of its size, the ellipsoid of Fig. 5 holds every contact (so it holds their hull) and is held by every
/// half-space (so it is held by their intersection). Half turns about its axes leave it as it is.
fn assert_curves_bound_the_ellipsoid(curves: &Table) {
    let axes = [2.5, 2.0, 1.0];
    for row in &curves.rows {
        let values: Vec<f64> = row[2..].iter().map(|cell| cell.parse().unwrap()).collect();
        let (x, n) = values.split_at(3);
        let sum = |term: &dyn Fn(usize) -> f64| term(0) + term(1) + term(2);
        let gauge = sum(&|i| (x[i] / axes[i]).powi(2)).sqrt();
        assert!(gauge < 1.0 + 1e-9, "contact outside: {row:?}");
        let support = sum(&|i| (axes[i] * n[i]).powi(2)).sqrt();
        assert!(sum(&|i| n[i] * x[i]) > support - 2.5e-9, "half-space cuts: {row:?}");
    }
}

#[test]
fn demo_reconstructs_what_it_simulated() {
    let scratch = Scratch::new("demo");
    let run = scratch.run(&["demo", "-o", "demo", "--json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    for name in FILES.iter().chain(&["log.csv", "scene.toml"]) {
        assert!(scratch.path().join("demo").join(name).is_file(), "{name}");
    }
    let summary: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(summary["verdict"]["level"], "good");
    // The log is exact to its 17 digits, so what is left is rounding and quadrature at 1 kHz.
    assert!(summary["largest_error"]["position_m"].as_f64().unwrap() < 1e-9);
    assert!(summary["largest_error"]["angular_velocity_rad_per_s"].as_f64().unwrap() < 1e-9);
    let (lower, upper) = (
        &summary["bounds"]["lower_volume_m3"].as_f64().unwrap(),
        &summary["bounds"]["upper_volume_m3"].as_f64().unwrap(),
    );
    let volume = 4.0 / 3.0 * std::f64::consts::PI * 5.0;
    assert!(*lower < volume && volume < *upper, "{lower} {upper}");
    assert_curves_bound_the_ellipsoid(&Table::parse(&scratch.read("demo/contact_curves.csv")));
    let report = scratch.read("demo/report.html");
    assert!(report.len() < 3_000_000, "{} bytes", report.len());
    assert_eq!(scratch.names(), ["demo"], "nothing is left beside the folder");
}

/// A log of three palms with torques about their axes in place of forces.
fn with_torques(log: String) -> String {
    let mut table = Table::parse(&log);
    for i in 1..=3 {
        let (f, s2) = (table.column(&format!("f_{i}")), table.column(&format!("s2_{i}")));
        table.header[f] = format!("tau_{i}");
        for row in &mut table.rows {
            row[f] = (row[f].parse::<f64>().unwrap() * row[s2].parse::<f64>().unwrap()).to_string();
        }
    }
    table.text()
}

#[test]
fn motion_has_the_columns_of_the_truth_and_its_values() {
    let (scratch, _) = scratch_reconstructed("motion", false);
    let (log, motion) =
        (Table::parse(&scratch.read("log.csv")), Table::parse(&scratch.read("out/motion.csv")));
    let header = motion.header.join(",");
    assert!(header.starts_with("t,cmx,cmy,cmz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,std_cmx,"), "{header}");
    assert!(header.ends_with("mode_1,mode_2,mode_3,relied_on"), "{header}");
    assert_eq!(motion.rows.len(), log.rows.len());
    // At 100 Hz the quadrature of the readings is good to some 1e-7 of a 2 m, 1 rad/s scene.
    for column in ["t", "cmx", "cmy", "cmz", "vx", "vy", "vz", "wx", "wy", "wz"] {
        assert!(difference(&log, &motion, column) < 1e-6, "{column}");
    }
    let summary = scratch.read("out/summary.json");
    // A second run replaces the first: torques of motors that hold the palms tell their forces, and no inertia is needed for that.
    scratch.write("torques.csv", &with_torques(log.text()));
    let again = scratch.run(&["reconstruct", "torques.csv", "--scene", "scene.toml", "-o", "out"]);
    assert_eq!(again.code, Some(0), "{}{}", again.stdout, again.stderr);
    assert_eq!(scratch.names(), ["log.csv", "out", "scene.toml", "torques.csv"]);
    let of_torques = Table::parse(&scratch.read("out/motion.csv"));
    for column in ["cmx", "cmy", "cmz", "wx", "wy", "wz"] {
        assert!(difference(&motion, &of_torques, column) < 1e-8, "{column}");
    }
    let curves = scratch.run(&["bounds", "out/contact_curves.csv", "--json"]);
    let again: Value = serde_json::from_str(&curves.stdout).unwrap();
    let first: Value = serde_json::from_str(&summary).unwrap();
    // Taken as exact the same contacts give slightly narrower bounds than with the margins of a motion at 100 Hz.
    for (key, widened) in [("lower_volume_m3", -1.0), ("upper_volume_m3", 1.0), ("largest_gap_m", 1.0)] {
        let [read, made] = [&again, &first].map(|v| v["bounds"][key].as_f64().unwrap());
        assert!((0.0..1e-2 * made).contains(&(widened * (made - read))), "{key}: {read} {made}");
    }
}

#[test]
fn truth_in_the_log_has_no_influence() {
    let (scratch, _) = scratch_reconstructed("truth", false);
    let mut table = Table::parse(&scratch.read("log.csv"));
    let first_of_truth = table.column("cmx");
    table.header.truncate(first_of_truth);
    table.rows.iter_mut().for_each(|row| row.truncate(first_of_truth));
    scratch.write("blind.csv", &table.text());
    let blind = ["reconstruct", "blind.csv", "--scene", "scene.toml", "-o", "blind"];
    assert_eq!(scratch.run(&blind).code, Some(0));
    assert_eq!(scratch.read("out/motion.csv"), scratch.read("blind/motion.csv"));
    let blind: Value = serde_json::from_str(&scratch.read("blind/summary.json")).unwrap();
    assert!(blind["largest_error"].is_null());
}

#[test]
fn loss_of_contact_ends_a_simulation_and_is_said_in_a_reconstruction() {
    let scratch = Scratch::new("loss");
    let gentle = scene().replace("gravity = 9.81", "gravity = 1.0").replace("rate = 100.0", "rate = 1000.0");
    scratch.write("scene.toml", &gentle);
    let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]);
    assert_eq!(run.code, Some(4), "{}", run.stderr);
    // Palm 2 is left at 1.25888 s in the exact dynamics.
    assert!(
        run.stdout.contains("t = 1.25888") && run.stdout.contains("palm 2 loses contact"),
        "{}",
        run.stdout
    );
    // A log that goes on: two samples more, without contact on palm 2.
    let mut table = Table::parse(&scratch.read("log.csv"));
    for t in ["1.259", "1.26"] {
        let mut row = table.rows.last().unwrap().clone();
        row[table.column("t")] = t.to_owned();
        table.rows.push(row);
        let last = table.rows.len() - 1;
        for (column, value) in [("s1_2", "nan"), ("s2_2", "nan"), ("f_2", "0")] {
            table.set(last, column, value);
        }
    }
    scratch.write("log.csv", &table.text());
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"]);
    // The last rows say that the body stood still, which is not true; over so short a time that is enough to refuse.
    assert_eq!(run.code, Some(4), "{}", run.stdout);
    let motion = Table::parse(&scratch.read("out/motion.csv"));
    assert_eq!(motion.rows.len(), 1261);
    let mode = motion.column("mode_2");
    assert!(motion.rows[..1259].iter().all(|row| row[mode] == "1"), "it slides up to there");
    assert!(motion.rows[1259..].iter().all(|row| row[mode] == "0"), "and is off from there on");
}

/// Beside each row of motion.csv there is one of covariances: on the diagonal the squares of the deviations there.
#[test]
fn covariances_are_written_where_they_are_asked_for() {
    let (scratch, _) = scratch_reconstructed("covariance", false);
    assert!(!scratch.path().join("out/covariance.csv").exists());
    let asked = ["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "with", "--covariance"];
    let run = scratch.run(&asked);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let table = |name: &str| {
        let text = scratch.read(&format!("with/{name}"));
        let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<_>>());
        (lines.next().unwrap(), lines.collect::<Vec<_>>())
    };
    let ((names, rows), (of, motion)) = (table("covariance.csv"), table("motion.csv"));
    assert_eq!((names.len(), rows.len()), (22, motion.len()));
    let number = |(names, row): (&Vec<String>, &Vec<String>), name: &str| -> f64 {
        row[names.iter().position(|of| of == name).unwrap()].parse().unwrap()
    };
    for (row, motion) in rows.iter().zip(&motion) {
        for axis in ["cmx", "cmy", "cmz", "turnx", "turny", "turnz"] {
            let variance = number((&names, row), &format!("cov_{axis}_{axis}"));
            let std = number((&of, motion), &format!("std_{axis}"));
            assert!((variance - std * std).abs() <= 1e-9 * variance, "{axis} {variance} {std}");
        }
    }
    assert_eq!(scratch.run(&["check", "with"]).code, Some(0));
}
