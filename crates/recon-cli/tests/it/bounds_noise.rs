//! Noise that is not as stated: what `recon bounds` says of it.

use crate::common::Scratch;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Numbers as of a standard normal distribution, reproducible: sums of twelve.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> f64 {
        let mut unit = || {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (self.0 >> 11) as f64 / (1_u64 << 53) as f64
        };
        (0..12).map(|_| unit()).sum::<f64>() - 6.0
    }
}

/// Contacts all round the ellipse 2, 1, off by `level(k)` m, and so many times as alike from one to the next.
fn ellipse(count: usize, level: impl Fn(usize) -> f64, alike: f64) -> String {
    let (mut noise, mut last) = (Noise(7), [0.0; 2]);
    let mut text = String::from("x,y,nx,ny\n");
    for k in 0..count {
        let (s, c) = (TAU * k as f64 / count as f64).sin_cos();
        let h = (4.0 * c * c + s * s).sqrt();
        last = last.map(|x| alike * x + (1.0 - alike * alike).sqrt() * noise.next());
        let turn = 1e-3 * noise.next();
        let n = [c - turn * s, s + turn * c];
        writeln!(
            text,
            "{},{},{},{}",
            4.0 * c / h + level(k) * last[0],
            s / h + level(k) * last[1],
            n[0],
            n[1]
        )
        .unwrap();
    }
    text
}

/// Contacts along three curves on the unit sphere, off by `level(k)` m at the k-th of each.
fn sphere(level: impl Fn(usize) -> f64) -> String {
    let mut noise = Noise(3);
    let mut text = String::from("curve,x,y,z,nx,ny,nz\n");
    for k in 0..600 {
        let (curve, place) = (k / 200, k % 200);
        let angle = TAU * place as f64 / 200.0;
        let (s, c, lift) = (angle.sin(), angle.cos(), 0.4 * (2.0 * angle).sin());
        let n = [[c, s, lift], [lift, c, s], [s, lift, c]][curve];
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = n.map(|x| x / length);
        let x = n.map(|n| (n + level(place) * noise.next()).to_string());
        let n = n.map(|n| n + 1e-3 * noise.next());
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = n.map(|x| (x / length).to_string());
        writeln!(text, "{},{},{}", curve + 1, x.join(","), n.join(",")).unwrap();
    }
    text
}

/// What is said of contacts with noise of 1e-3 m and rad as stated, and an ellipse or ellipsoid fitted.
fn told(scratch: &Scratch, file: &str, shape: &str) -> (Vec<Value>, Vec<String>) {
    let stated = ["--contact-noise", "1e-3", "--normal-noise", "1e-3", "--fit", shape];
    let run = scratch.run(&[&["bounds", file, "--json"], &stated[..]].concat());
    assert!(matches!(run.code, Some(0 | 4)), "{}{}", run.stdout, run.stderr);
    let summary: Value = serde_json::from_str(&run.stdout).unwrap();
    let warnings = summary["warnings"].as_array().unwrap();
    (
        summary["about"]["noise_doubts"].as_array().cloned().unwrap_or_default(),
        warnings.iter().map(|w| w.as_str().unwrap().to_owned()).collect(),
    )
}

#[test]
fn a_part_of_a_curve_that_is_rougher_than_stated_is_named_in_space_and_in_the_plane() {
    let scratch = Scratch::new("rougher");
    let rough = |k: usize| if (50..100).contains(&k) { 5e-3 } else { 1e-3 };
    scratch.write("right.csv", &sphere(|_| 1e-3)).write("rough.csv", &sphere(rough));
    scratch.write("right_plane.csv", &ellipse(200, |_| 1e-3, 0.0));
    scratch.write("rough_plane.csv", &ellipse(200, rough, 0.0));
    for (right, rough, shape) in
        [("right.csv", "rough.csv", "ellipsoid"), ("right_plane.csv", "rough_plane.csv", "ellipse")]
    {
        let (doubts, warnings) = told(&scratch, right, shape);
        assert!(doubts.is_empty() && warnings.is_empty(), "{doubts:?} {warnings:?}");
        let (doubts, warnings) = told(&scratch, rough, shape);
        assert!(doubts.iter().all(|d| d["assumption"] == "level" && d["what"] != "normal"), "{doubts:?}");
        assert!(doubts.iter().any(|d| d["found"].as_f64() > Some(2e-3)), "{doubts:?}");
        for word in ["curve 1 (point", "1.0e-3 was stated", "The fit rests on noise that is not as assumed"] {
            assert!(warnings.iter().any(|w| w.contains(word)), "{word}: {warnings:?}");
        }
    }
}

#[test]
fn levels_are_not_read_off_contacts_whose_noise_is_alike() {
    let scratch = Scratch::new("alike");
    scratch.write("alike.csv", &ellipse(1000, |_| 1e-2, 0.95));
    let run = scratch.run(&["bounds", "alike.csv", "--estimate-noise", "-o", "out"]);
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
    for word in ["alike from one to the next", "z-test, p =", "or the body has edges", "--contact-noise"] {
        assert!(run.stderr.contains(word), "{word}: {}", run.stderr);
    }
    assert!(!scratch.path().join("out").exists());
    // Where they are too few to tell, that is said.
    scratch.write("few.csv", &ellipse(200, |_| 1e-2, 0.0));
    let run = scratch.run(&["bounds", "few.csv", "--estimate-noise"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("too few, or too far apart"), "{}", run.stdout);
    let (doubts, warnings) = told(&scratch, "alike.csv", "ellipse");
    assert!(doubts.iter().any(|d| d["assumption"] == "independent"), "{doubts:?}");
    assert!(warnings.iter().any(|w| w.contains("No means are taken")), "{warnings:?}");
}
