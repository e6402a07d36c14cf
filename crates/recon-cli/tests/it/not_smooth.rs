//! A cube: corners and faces in the summary, the marks and the page.

use crate::common::{Scratch, Table};
use serde_json::Value;
use std::fmt::Write;

/// Normal numbers, near enough: sums of twelve that are spread evenly.
fn noise(state: &mut u64) -> f64 {
    let mut one = || {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / (1_u64 << 53) as f64
    };
    (0..12).map(|_| one()).sum::<f64>() - 6.0
}

/// A cube of edge 2 m: a palm that goes over all corners, and a fingertip over three of its faces.
fn cube_contacts(level: f64) -> String {
    let mut text = String::from("curve,x,y,z,nx,ny,nz\n");
    let mut state = 7;
    for curve in 1..=2 {
        for k in 0..400 {
            let t = f64::from(k) * 0.02;
            let u = [(3.1 * t).sin(), (2.3 * t + 1.0).sin(), (1.7 * t + 0.4).sin()];
            let sized = |v: [f64; 3]| {
                let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
                v.map(|x| x / length)
            };
            let u = sized(u);
            let (point, normal) = if curve == 1 {
                (u.map(f64::signum), u)
            } else {
                let centre = u.map(|x| 1.9 * x);
                let point = centre.map(|x| x.clamp(-1.0, 1.0));
                (point, sized([0, 1, 2].map(|i| centre[i] - point[i])))
            };
            let point = point.map(|x| x + level * noise(&mut state));
            let normal = sized(normal.map(|x| x + 0.5 * level * noise(&mut state)));
            let cells: Vec<String> = point.iter().chain(&normal).map(ToString::to_string).collect();
            writeln!(text, "{curve},{}", cells.join(",")).unwrap();
        }
    }
    text
}

#[test]
fn corners_and_faces_of_a_cube_are_told_marked_and_written() {
    let scratch = Scratch::new("cube");
    scratch.write("cube.csv", &cube_contacts(2e-3));
    let arguments = ["bounds", "cube.csv", "--contact-noise", "2e-3", "--normal-noise", "1e-3", "-o", "out"];
    let run = scratch.run(&arguments);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("corner(s)") && run.stdout.contains("polyhedron"), "{}", run.stdout);
    let summary: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    let features = &summary["about"]["features"];
    let corners = features["corners"].as_array().unwrap();
    assert_eq!(corners.len(), 8, "{corners:?}");
    for corner in corners {
        let at = corner["point_m"].as_array().unwrap().iter().map(|x| x.as_f64().unwrap());
        assert!(at.into_iter().all(|x| (x.abs() - 1.0).abs() < 2e-3), "{corner}");
    }
    let volume = features["polyhedron"]["volume_m3"].as_f64().unwrap();
    assert!((volume - 8.0).abs() < 0.02, "{volume}");
    // A palm touches corners alone.
    let marks = Table::parse(&scratch.read("out/contact_marks.csv"));
    assert_eq!(marks.header[8..], ["kind", "feature", "log_odds"]);
    let text = scratch.read("out/contact_marks.csv");
    let of_palm = text.lines().skip(1).filter(|row| row.starts_with("1,"));
    let corner = of_palm.clone().filter(|row| row.split(',').nth(8) == Some("2")).count();
    assert!(corner as f64 > 0.95 * of_palm.count() as f64, "{corner}");
    assert!(scratch.read("out/report.html").contains(">Corners<"));
    assert!(scratch.path().join("out/polyhedron.ply").is_file());
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    // What is read again says the same.
    let again = scratch.run(&[
        "bounds",
        "out/contact_marks.csv",
        "--contact-noise",
        "2e-3",
        "--normal-noise",
        "1e-3",
        "--json",
    ]);
    let again: Value = serde_json::from_str(&again.stdout).unwrap();
    assert_eq!(again["about"]["features"]["contacts"], features["contacts"]);
}
