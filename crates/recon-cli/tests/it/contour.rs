//! An outline that need not be convex, from a scene to what is known of it.

use crate::common::{Scratch, json, number};
use serde_json::Value;
use std::f64::consts::PI;

const SIZE: f64 = 0.05;
const DEPTH: f64 = 0.25;
/// Radius of the hollows of `SIZE (1 + DEPTH cos 3 t)`: `r^2 / (r'' - r)`.
const HOLLOW: f64 = SIZE * 0.75 * 0.75 / (9.0 * DEPTH - 0.75);

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let waves = format!(
        "[finger]\nradius = 0.012\n[outline]\nwaves = {{ size = {SIZE}, depth = {DEPTH}, count = 3 }}\n"
    );
    scratch.write("waves.toml", &waves);
    let bean = "[outline]\npoints = [[0.05, 0.0], [0.03, 0.04], [0.0, 0.01], [-0.03, 0.04], [-0.05, 0.0], [0.0, -0.04]]\n";
    scratch.write("bean.toml", bean);
    scratch
}

/// The support function of the waves at 0 is their farthest point; the hull is larger than they are.
fn hull() -> f64 {
    let points: Vec<[f64; 2]> = (0..5_000)
        .map(|k| {
            let t = 2.0 * PI * f64::from(k) / 5_000.0;
            let r = SIZE * (1.0 + DEPTH * (3.0 * t).cos());
            [r * t.cos(), r * t.sin()]
        })
        .collect();
    // By its support function: the area is half of the integral of h (h + h'') over the normal; Cauchy's formula for the polygon of tangents.
    let h = |u: f64| {
        let (sin, cos) = u.sin_cos();
        points.iter().map(|[x, y]| x * cos + y * sin).fold(f64::NEG_INFINITY, f64::max)
    };
    let count = 720;
    let heights: Vec<f64> = (0..count).map(|k| h(2.0 * PI * f64::from(k) / f64::from(count))).collect();
    let step = 2.0 * PI / f64::from(count);
    let edge = |k: usize| {
        let [before, here, after] = [k + heights.len() - 1, k, k + 1].map(|k| heights[k % heights.len()]);
        (before + after - 2.0 * here * step.cos()) / step.sin()
    };
    0.5 * (0..heights.len()).map(|k| heights[k] * edge(k)).sum::<f64>()
}

#[test]
fn a_finger_that_gets_in_feels_everything_and_one_that_does_not_says_so() {
    let scratch = scratch("contour");
    let small = json(&scratch, &["explore", "waves.toml", "--contour", "-o", "out", "--json"], 0);
    assert_eq!((&small["schema"], &small["closed"]), (&"contour/1".into(), &true.into()));
    assert_eq!(
        (small["jumps"].as_array().unwrap().len(), &small["settings"]["finger_m"]),
        (0, &0.012.into())
    );
    assert!((number(&small["least_hollow_m"]) / HOLLOW - 1.0).abs() < 0.05, "{small}");
    let area = PI * SIZE * SIZE * (1.0 + 0.5 * DEPTH * DEPTH);
    assert!((number(&small["area_within_touches_m2"]) / area - 1.0).abs() < 1e-3);
    let hull = hull();
    let between = |of: &Value, most: f64| {
        let [lower, upper] = ["lower_area_m2", "upper_area_m2"].map(|key| number(&of["bounds"][key]));
        assert!(lower < hull && hull < upper && 1.0 - lower / upper < most, "{lower} {hull} {upper}");
    };
    between(&small, 5e-3);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let page = scratch.read("out/report.html");
    assert!(
        page.contains("No jump")
            && page.contains("Curvature along the way")
            && !page.contains("Where it jumped")
    );
    assert_eq!(
        scratch.read("out/contour.csv").lines().count() as u64,
        2 + small["touches"].as_u64().unwrap()
    );
    // A finger of half a size more than the hollows jumps once in each.
    let finger = format!("{}", 1.5 * HOLLOW);
    let large = ["explore", "waves.toml", "--contour", "--finger", &finger, "-o", "large", "--json"];
    let large = json(&scratch, &large, 4);
    let jumps = large["jumps"].as_array().unwrap();
    assert_eq!(jumps.len(), 3);
    for jump in jumps {
        let radius = number(&jump["radius_at_most_m"]);
        assert!(HOLLOW < radius && radius < 1.52 * HOLLOW, "{radius} {HOLLOW}");
    }
    assert!(large["warnings"][0].as_str().unwrap().contains("jumped at 3 places"));
    between(&large, 5e-3);
    assert_eq!(scratch.run(&["check", "large"]).code, Some(0));
    assert!(scratch.read("large/report.html").contains("Where it jumped"));
    assert_eq!(scratch.read("large/jumps.csv").lines().count(), 4);
    // With noise the bounds hold at the confidence, and are wider.
    let noise = ["--contact-noise", "5e-5", "--normal-noise", "2e-3"];
    let noisy = [&["explore", "waves.toml", "--contour", "--json"], &noise[..]].concat();
    let noisy = json(&scratch, &noisy, 0);
    assert_eq!(noisy["settings"]["confidence"], 0.95);
    between(&noisy, 5e-2);
    assert!(number(&noisy["bounds"]["largest_gap_m"]) > 2.0 * number(&small["bounds"]["largest_gap_m"]));
}

#[test]
fn outlines_through_points_and_convex_ones_are_followed() {
    let scratch = scratch("contour-points");
    let bean = json(&scratch, &["explore", "bean.toml", "--contour", "--finger", "0.05", "--json"], 4);
    assert_eq!(bean["jumps"].as_array().unwrap().len(), 1, "{bean}");
    // The only hollow is about the y axis.
    let [from, to] = ["from_m", "to_m"].map(|key| number(&bean["jumps"][0][key][0]));
    assert!(from > 0.0 && to < 0.0 && (from + to).abs() < 1e-4, "{from} {to}");
    // Of one eight times as large as the outline noise hides the jump, and nothing is claimed.
    let noise = ["--contact-noise", "5e-5", "--normal-noise", "2e-2"];
    let huge = [&["explore", "bean.toml", "--contour", "--finger", "0.4", "--json"], &noise[..]].concat();
    let huge = json(&scratch, &huge, 4);
    assert!(
        number(&huge["unseen_m"]) > 0.05
            && huge["warnings"][0].as_str().unwrap().contains("nothing is said of hollows"),
        "{huge}"
    );
    scratch.write("plane.toml", super::explore::PLANE);
    let convex = ["explore", "plane.toml", "--contour", "--finger", "0.01", "--json"];
    let convex = json(&scratch, &convex, 0);
    assert!(convex["jumps"].as_array().unwrap().is_empty() && convex["least_hollow_m"].is_null());
    assert!((number(&convex["area_within_touches_m2"]) / (PI * 0.05 * 0.03) - 1.0).abs() < 1e-3);
}

#[test]
fn what_cannot_be_followed_is_named() {
    let scratch = scratch("contour-bad");
    scratch.write("space.toml", include_str!("../../scenes/fig5.toml"));
    scratch.write("eight.toml", "[outline]\npoints = [[0, 0], [1, 1], [1, 0], [0, 1]]\n");
    for (arguments, says, code) in [
        (vec!["explore", "bean.toml", "--contour"], "no finger", 3),
        (vec!["explore", "bean.toml", "--contour", "--finger", "0"], "positive", 2),
        (vec!["explore", "space.toml", "--contour", "--finger", "1"], "`[outline]` is not given", 3),
        (vec!["explore", "eight.toml", "--contour", "--finger", "1"], "crosses itself", 3),
        (vec!["explore", "nowhere.toml", "--contour"], "cannot be read", 3),
        (vec!["explore", "bean.toml", "--contour", "--until", "gap=0.1"], "cannot be used with", 2),
        (vec!["explore", "bean.toml"], "--until", 2),
        (vec!["explore", "bean.toml", "--until", "gap=0.1"], "outline", 3),
        (
            vec!["explore", "bean.toml", "--contour", "--finger", "0.01", "--contact-noise", "1e-4"],
            "half of the noise",
            3,
        ),
        (
            vec![
                "explore",
                "bean.toml",
                "--contour",
                "--finger",
                "0.01",
                "--contact-noise",
                "1e-4",
                "--normal-noise",
                "1",
            ],
            "turn is 0.1",
            3,
        ),
    ] {
        let run = scratch.run(&arguments);
        assert!(
            run.code == Some(code) && run.stderr.contains(says),
            "{arguments:?} {:?} {}",
            run.code,
            run.stderr
        );
    }
    // Too few touches prove nothing, and nothing is claimed.
    let short = ["explore", "waves.toml", "--contour", "--budget", "20", "-o", "short", "--json"];
    let short = json(&scratch, &short, 4);
    assert!(short["closed"] == false && short["bounds"].is_null(), "{short}");
    assert!(short["warnings"][0].as_str().unwrap().contains("not followed once round"));
    assert_eq!(scratch.run(&["check", "short"]).code, Some(0));
    assert!(scratch.run(&["next", "short"]).stderr.contains("contour"), "it is not gone on from");
}
