//! Bounds of contacts in the plane, fitted shapes, and bodies that are not convex.

use crate::common::Scratch;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Deterministic numbers that look like noise: within 1 of zero, mean square about 1/3.
fn wobble(k: usize) -> f64 {
    2.0 * ((k as f64 * 12.9898).sin() * 43_758.545_3).rem_euclid(1.0) - 1.0
}

/// Contacts all round the ellipse 2, 1 about (0.3, -0.1), points off by up to `noise`, contact 41 by `wrong` more.
fn ellipse(noise: f64, wrong: f64) -> String {
    let mut text = String::from("x,y,nx,ny\n");
    for k in 0..200 {
        let (s, c) = (TAU * k as f64 / 200.0).sin_cos();
        let h = (4.0 * c * c + s * s).sqrt();
        let off = |i: usize| noise * wobble(2 * k + i) + if k == 40 && i == 0 { wrong } else { 0.0 };
        writeln!(text, "{},{},{c},{s}", 0.3 + 4.0 * c / h + off(0), -0.1 + s / h + off(1)).unwrap();
    }
    text
}

/// Contacts on a square with sides of 2 m grown by a disc of 0.4 m, five degrees of turning apart and on the flats.
fn rounded_square() -> String {
    let mut text = String::from("x,y,nx,ny\n");
    for corner in 0..4 {
        let turn = |x: f64, y: f64| [[x, y], [-y, x], [-x, -y], [y, -x]][corner];
        for k in 0..18 {
            let (s, c) = (f64::from(k) * PI / 36.0).sin_cos();
            // The flat before the corner, touched at places along it, then the corner.
            let flat = (turn(1.4, -1.0 + 2.0 * f64::from(k) / 18.0), turn(1.0, 0.0));
            let round = (turn(1.0 + 0.4 * c, 1.0 + 0.4 * s), turn(c, s));
            for (p, n) in [flat, round] {
                writeln!(text, "{},{},{},{}", p[0], p[1], n[0], n[1]).unwrap();
            }
        }
    }
    text
}

/// Directions spread evenly over the sphere.
fn directions(count: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(move |k| {
        let z = 1.0 - (2 * k + 1) as f64 / count as f64;
        let (s, c) = (k as f64 * 2.399_963_229_728_653).sin_cos();
        [(1.0 - z * z).sqrt() * c, (1.0 - z * z).sqrt() * s, z]
    })
}

/// Contacts on the ellipsoid 2, 1.5, 1, points off by up to `noise`.
fn ellipsoid(noise: f64) -> String {
    let mut text = String::from("x,y,z,nx,ny,nz\n");
    for (k, n) in directions(200).enumerate() {
        let axes = [2.0, 1.5, 1.0];
        let h = (0..3).map(|i| (axes[i] * n[i]).powi(2)).sum::<f64>().sqrt();
        let x = |i: usize| axes[i] * axes[i] * n[i] / h + noise * wobble(3 * k + i);
        writeln!(text, "{},{},{},{},{},{}", x(0), x(1), x(2), n[0], n[1], n[2]).unwrap();
    }
    text
}

const WAIST: usize = 220;

/// Contacts on a body of revolution with a waist: `r = 1 + 0.35 cos 2 polar`.
fn waist() -> String {
    let mut text = String::from("x,y,z,nx,ny,nz\n");
    for u in directions(WAIST) {
        let (sine, cosine) = (u[0].hypot(u[1]), u[2]);
        let polar = sine.atan2(cosine);
        let (r, slope) = (1.0 + 0.35 * (2.0 * polar).cos(), -0.7 * (2.0 * polar).sin());
        // Outward normal in the meridian: the tangent (slope, r) of the profile turned by a quarter.
        let (radial, axial) = (r * sine - slope * cosine, r * cosine + slope * sine);
        let length = radial.hypot(axial);
        let n = [radial * u[0] / sine / length, radial * u[1] / sine / length, axial / length];
        writeln!(text, "{},{},{},{},{},{}", r * u[0], r * u[1], r * u[2], n[0], n[1], n[2]).unwrap();
    }
    text
}

fn bounds(scratch: &Scratch, arguments: &[&str]) -> Value {
    let run = scratch.run(&[&["bounds", "--json"], arguments].concat());
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

fn areas(summary: &Value) -> [f64; 2] {
    ["lower_area_m2", "upper_area_m2"].map(|name| summary["bounds"][name].as_f64().unwrap())
}

/// Names of a fit's parameters with values and deviations.
fn parameters(fit: &Value) -> Vec<(String, f64, f64)> {
    let one = |p: &Value| {
        let of = |name: &str| p[name].as_f64().unwrap();
        (p["name"].as_str().unwrap().to_owned(), of("value"), of("std"))
    };
    fit["parameters"].as_array().unwrap().iter().map(one).collect()
}

#[test]
fn an_outline_is_bounded_drawn_and_fitted() {
    let scratch = Scratch::new("plane");
    scratch.write("clean.csv", &ellipse(0.0, 0.0)).write("noisy.csv", &ellipse(1e-3, 0.1));
    let truth = 2.0 * PI;
    let exact = bounds(&scratch, &["clean.csv", "--fit", "auto", "-o", "out"]);
    let [lower, upper] = areas(&exact);
    assert!(lower < truth && truth < upper && upper - lower < 2e-3 * truth, "{lower} {upper}");
    let fit = &exact["about"]["fit"];
    assert_eq!(fit["family"], "ellipse");
    let centre: Vec<f64> = parameters(fit).iter().take(2).map(|p| p.1).collect();
    assert!((centre[0] - 0.3).abs() < 1e-9 && (centre[1] + 0.1).abs() < 1e-9, "{centre:?}");
    assert!(fit["tried"].as_array().unwrap().len() > 5);
    let files = ["bounds.svg", "lower_bound.csv", "upper_bound.csv", "fitted_shape.csv", "summary.json"];
    for name in files {
        assert!(scratch.path().join("out").join(name).is_file(), "{name}");
    }
    let svg = scratch.read("out/bounds.svg");
    assert!(svg.contains("upper bound") && svg.contains("fit") && !svg.contains("NaN"));

    let sharp = areas(&bounds(&scratch, &["clean.csv", "--rho-min", "0.5", "--rho-max", "4", "-o", "sharp"]));
    assert!(lower < sharp[0] && sharp[0] < truth && truth < sharp[1] && sharp[1] < upper, "{sharp:?}");
    for noise in
        [&["--contact-noise", "1e-3", "--normal-noise", "1e-3"][..], &["--estimate-noise", "--fit", "auto"]]
    {
        let summary = bounds(&scratch, &[&["noisy.csv"], noise].concat());
        let wide = areas(&summary);
        assert!(wide[0] < lower && upper < wide[1], "{wide:?}");
        let outliers = summary["about"]["outliers"].as_array().unwrap();
        assert!(outliers.iter().any(|o| o["contact"] == 41), "{outliers:?}");
        if let Some(fit) = summary["about"].get("fit") {
            let [x, y] = [0, 1].map(|i| parameters(fit)[i].clone());
            assert!(
                (x.1 - 0.3).abs() < 5.0 * x.2 && (y.1 + 0.1).abs() < 5.0 * y.2 && x.2 < 1e-3,
                "{x:?} {y:?}"
            );
        }
    }
}

#[test]
fn shapes_are_fitted_in_space_with_their_covariance() {
    let scratch = Scratch::new("fits");
    scratch.write("clean.csv", &ellipsoid(0.0)).write("noisy.csv", &ellipsoid(1e-3));
    let auto = bounds(&scratch, &["noisy.csv", "--fit", "auto", "-o", "out"]);
    let fit = &auto["about"]["fit"];
    assert_eq!(fit["family"], "ellipsoid");
    let known = parameters(fit);
    assert_eq!(known.len(), 9);
    assert!(known.iter().all(|p| p.2 > 0.0 && p.2 < 1e-3), "{known:?}");
    for (i, p) in known.iter().enumerate() {
        let variance = fit["covariance"][i][i].as_f64().unwrap();
        assert!((variance - p.2 * p.2).abs() < 1e-12 * variance);
    }
    assert!(scratch.path().join("out/fitted_shape.ply").is_file());
    assert_eq!(fit["status"], "fitted");
    let run = scratch.run(&["bounds", "clean.csv", "--fit", "ellipsoid"]);
    assert!(run.stdout.contains("ellipsoid") && run.stdout.contains("+-"), "{}", run.stdout);
    let exact = bounds(&scratch, &["clean.csv", "--fit", "auto"]);
    assert_eq!(exact["about"]["fit"]["family"], "ellipsoid");
}

#[test]
fn a_shape_that_the_contacts_refute_is_refused_and_bounds_are_written() {
    let scratch = Scratch::new("refuted");
    scratch.write("clean.csv", &ellipsoid(0.0));
    let stated = ["--contact-noise", "1e-3", "--normal-noise", "1e-3"];
    for noise in [&[][..], &stated[..]] {
        let run =
            scratch.run(&[&["bounds", "clean.csv", "--json", "--fit", "ball", "-o", "out"], noise].concat());
        assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
        let summary: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        let fit = &summary["about"]["fit"];
        assert_eq!(fit["status"], "refused");
        assert!(fit["reason"].as_str().unwrap().starts_with("sphere: refuted by the contacts"), "{fit}");
        assert!(summary["warnings"].to_string().contains("No shape is written"));
        assert!(scratch.path().join("out/upper_bound.ply").is_file());
        assert!(!scratch.path().join("out/fitted_shape.ply").is_file());
    }
}

#[test]
fn an_outline_that_the_contacts_refute_is_refused_and_bounds_are_written() {
    let scratch = Scratch::new("refuted-outline");
    scratch.write("ellipse.csv", &ellipse(0.0, 0.0)).write("square.csv", &rounded_square());
    let stated = ["--contact-noise", "1e-3", "--normal-noise", "1e-3"];
    for (arguments, reason, warning) in [
        (["ellipse.csv", "--fit", "circle"], "circle: refuted by the contacts", "No shape is written"),
        (
            ["square.csv", "--fit", "auto"],
            "no family fits the contacts: circle: refuted",
            "No family of shapes",
        ),
    ] {
        for noise in [&[][..], &stated[..]] {
            let run = scratch.run(&[&["bounds", "--json", "-o", "out"], &arguments[..], noise].concat());
            assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
            let summary: Value = serde_json::from_str(&run.stdout).unwrap();
            let fit = &summary["about"]["fit"];
            assert_eq!(fit["status"], "refused");
            assert!(fit["reason"].as_str().unwrap().starts_with(reason), "{fit}");
            assert!(summary["warnings"].to_string().contains(warning), "{}", summary["warnings"]);
            assert!(scratch.path().join("out/upper_bound.csv").is_file());
            assert!(!scratch.path().join("out/fitted_shape.csv").is_file());
        }
    }
    let words = scratch.run(&["bounds", "ellipse.csv", "--fit", "circle"]);
    assert_eq!(words.code, Some(4));
    assert!(words.stdout.contains("none: refused"), "{}", words.stdout);
}

#[test]
fn a_waist_is_approximated_inside_of_the_bounds_of_its_hull() {
    let scratch = Scratch::new("waist");
    scratch.write("waist.csv", &waist());
    let summary = bounds(&scratch, &["waist.csv", "--concave", "-o", "out"]);
    let volume = |name: &str| summary["bounds"][name].as_f64().unwrap();
    let concave = &summary["about"]["concave"];
    let alpha = concave["alpha_volume_m3"].as_f64().unwrap();
    assert!(alpha < volume("lower_volume_m3") && volume("lower_volume_m3") < volume("upper_volume_m3"));
    // Larger balls leave more: with the size of the body's hollow, about its volume of 3.395 m^3.
    let wide = bounds(&scratch, &["waist.csv", "--concave", "--alpha", "0.8"]);
    let wide = wide["about"]["concave"]["alpha_volume_m3"].as_f64().unwrap();
    assert!(alpha < wide && (3.0..3.45).contains(&wide), "{alpha} {wide}");
    let kept = concave["contacts_kept_for_the_upper_bound"].as_u64().unwrap();
    assert!((50..WAIST as u64).contains(&kept), "{kept}");
    let warnings = summary["warnings"].to_string();
    assert!(warnings.contains("approximations") && warnings.contains("cannot prove"), "{warnings}");
    for name in ["lower_bound.ply", "upper_bound.ply", "alpha_shape.ply", "smooth_surface.ply"] {
        assert!(scratch.path().join("out").join(name).is_file(), "{name}");
    }
    assert_eq!(summary["about"]["surface"]["kind"], "hermite");
}

#[test]
fn smooth_surfaces_are_written_beside_the_bounds() {
    let scratch = Scratch::new("surfaces");
    scratch.write("exact.csv", &ellipsoid(0.0)).write("noisy.csv", &ellipsoid(1e-3));
    let noise = ["--contact-noise", "1e-3", "--normal-noise", "1e-3"];
    let spline = bounds(&scratch, &["exact.csv", "--surface", "spline", "-o", "spline"]);
    let principal =
        bounds(&scratch, &[&["noisy.csv", "--surface", "principal", "-o", "principal"], &noise[..]].concat());
    for (kind, summary) in [("spline", &spline), ("principal", &principal)] {
        let about = &summary["about"]["surface"];
        assert_eq!((&about["kind"], &about["is_closed"]), (&kind.into(), &true.into()));
        assert!(scratch.path().join(kind).join("smooth_surface.ply").is_file());
    }
    // An ellipsoid is nearly a constant in round coordinates.
    assert!(spline["about"]["surface"]["residual_m"].as_f64().unwrap() < 1e-5);
    let residual = principal["about"]["surface"]["residual_m"].as_f64().unwrap();
    // Uniform within 1 mm: a deviation of 0.58 mm.
    assert!((0.4e-3..0.75e-3).contains(&residual), "{residual}");
}

#[test]
fn what_does_not_go_together_is_named() {
    let scratch = Scratch::new("mismatch");
    scratch
        .write("plane.csv", &ellipse(0.0, 0.0))
        .write("space.csv", &ellipsoid(0.0))
        .write("few.csv", &ellipsoid(0.0).lines().take(6).collect::<Vec<_>>().join("\n"))
        .write("bad.csv", &ellipse(0.0, 0.0).replacen("nx,ny\n", "nx,ny\n1,0,2,0\n", 1));
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let run = scratch.run(&[&["bounds", "-o", "out"], arguments].concat());
        assert_eq!(run.code, Some(code), "{}{}", run.stdout, run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{}", run.stderr);
        assert!(!scratch.path().join("out").exists() && run.stdout.is_empty());
    };
    refused(&["plane.csv", "--concave"], 2, &["--concave", "in the plane"]);
    refused(&["plane.csv", "--surface", "spline"], 2, &["--surface", "in the plane"]);
    refused(&["space.csv", "--surface", "spline", "--estimate-noise"], 2, &["spline", "take principal"]);
    refused(&["plane.csv", "--fit", "ball"], 2, &["ball", "in the plane"]);
    refused(&["plane.csv", "--plane-height", "1"], 2, &["--plane-height"]);
    let limits = ["--rho-max", "5", "--estimate-noise"];
    refused(&[&["plane.csv"], &limits[..]].concat(), 2, &["--rho-max beside noise"]);
    refused(&["plane.csv", "--rho-min", "1", "--rho-max", "2"], 3, &["contact", "limit says"]);
    refused(&["space.csv", "--fit", "waves:3"], 2, &["waves", "in the plane"]);
    refused(&["space.csv", "--fit", "harmonics"], 2, &["number from 1 to 32"]);
    refused(&["space.csv", "--fit", "cube"], 2, &["superquadric"]);
    refused(&["space.csv", "--concave", "--rho-max", "3"], 2, &["cannot be used with"]);
    refused(&["few.csv", "--fit", "harmonics:4"], 3, &["no shape can be fitted", "at least"]);
    refused(&["bad.csv"], 3, &["line 2", "length 2"]);
}

/// A cone touched all round: all planes of its side meet in the apex, whose corner there is once for each three of them.
#[test]
fn a_cone_has_bounds_that_hold() {
    let scratch = Scratch::new("cone");
    let mut text = String::from("x,y,z,nx,ny,nz\n");
    for k in 0..150 {
        let (s, c) = (2.4 * f64::from(k)).sin_cos();
        let z = f64::from(k % 29) / 29.0;
        let n = std::f64::consts::FRAC_1_SQRT_2;
        writeln!(text, "{},{},{z},{},{},{n}", (1.0 - z) * c, (1.0 - z) * s, n * c, n * s).unwrap();
        writeln!(text, "{},{},0,0,0,-1", z * c, z * s).unwrap();
    }
    scratch.write("cone.csv", &text);
    // The command's own certificate judges whether the surface has dents.
    let run = scratch.run(&["bounds", "cone.csv", "--json", "-o", "out"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let figures: Value = serde_json::from_str(&run.stdout).unwrap();
    let [lower, upper] =
        ["lower_volume_m3", "upper_volume_m3"].map(|name| figures["bounds"][name].as_f64().unwrap());
    let cone = std::f64::consts::PI / 3.0;
    assert!(0.95 * cone < lower && lower < cone && cone < upper && upper < 1.001 * cone, "{lower} {upper}");
}

/// Straight sides that are touched many times give lines that are one but for the last digits: where they meet is nowhere.
#[test]
fn straight_sides_touched_many_times_give_a_polygon() {
    let scratch = Scratch::new("straight");
    for (case, spread) in [0.0, 1e-16, 1e-15, 1e-13, 1e-11, 1e-9].into_iter().enumerate() {
        let sides = 3 + case;
        let mut text = String::from("x,y,nx,ny\n");
        for k in 0..20 * sides {
            let (s, c) = (TAU * (k / 20) as f64 / sides as f64 + 0.3 + case as f64).sin_cos();
            // The apothem is 1; half a side is its tangent.
            let along = (TAU / 2.0 / sides as f64).tan() * wobble(k);
            let n = [c + spread * wobble(2 * k), s + spread * wobble(2 * k + 1)];
            let length = n[0].hypot(n[1]);
            writeln!(text, "{},{},{},{}", c - along * s, s + along * c, n[0] / length, n[1] / length)
                .unwrap();
        }
        scratch.write("sides.csv", &text);
        let run = scratch.run(&["bounds", "sides.csv", "--json", "-o", "out"]);
        assert_eq!(run.code, Some(0), "{spread}: {}{}", run.stdout, run.stderr);
        let figures: Value = serde_json::from_str(&run.stdout).unwrap();
        let area = sides as f64 * (TAU / 2.0 / sides as f64).tan();
        let upper = figures["bounds"]["upper_area_m2"].as_f64().unwrap();
        assert!((upper / area - 1.0).abs() < 1e-7, "{spread}: {upper} {area}");
    }
}
