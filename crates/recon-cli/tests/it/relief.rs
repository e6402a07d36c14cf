//! A body in space that need not be convex, from a scene to what is known of it.

use crate::common::{Scratch, json, number};

/// `r = 0.05 (1 + 0.3 cos 2 theta)`: a groove once round whose least radius of curvature is `r^2 / (r'' - r)` at `r = 0.035`, `r'' = 0.06`.
const GROOVE: f64 = 0.035 * 0.035 / (0.06 - 0.035);

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    let body = "[finger]\nradius = 0.02\n[surface]\nsize = 0.05\nwaves = [{ axis = [0, 0, 2], depth = 0.3, count = 2 }]\n";
    scratch.write("body.toml", body);
    scratch
}

/// Volume of the body, by the cube of its radius over the cosine of the angle.
fn volume() -> f64 {
    let count = 2000;
    let cube = |k: i32| {
        let c = (f64::from(k) + 0.5) / f64::from(count);
        (0.05 * (1.0 + 0.3 * (2.0 * c * c - 1.0))).powi(3)
    };
    4.0 * std::f64::consts::PI / 3.0 * (0..count).map(cube).sum::<f64>() / f64::from(count)
}

#[test]
fn a_finger_that_gets_in_feels_everything_and_one_that_does_not_says_so() {
    let scratch = scratch("relief");
    let explore = ["explore", "body.toml", "--relief", "--step", "0.012", "--json"];
    let small = json(&scratch, &[&explore[..], &["-o", "out"]].concat(), 0);
    assert_eq!((&small["schema"], &small["all_felt"]), (&"relief/1".into(), &true.into()));
    assert_eq!((&small["jumps"], &small["rims"]), (&0.into(), &0.into()));
    // A mean between two lines, which are not along the meridian: what is told is wider.
    let told = number(&small["least_hollow_m"]) / GROOVE;
    assert!(0.99 < told && told < 1.25, "{small}");
    let most = number(&small["volume_at_most_m3"]);
    assert!(volume() < most && most < 1.2 * volume(), "{most} {}", volume());
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let page = scratch.read("out/report.html");
    assert!(page.contains("Section at z = 0") && !page.contains("Where it jumped"));
    assert_eq!(scratch.read("out/relief.csv").lines().count() as u64, 1 + small["touches"].as_u64().unwrap());
    assert!(scratch.run(&["next", "out"]).stderr.contains("relief"), "it is not gone on from");
    // A finger that is larger than the groove jumps in it, all round.
    let finger = format!("{}", 1.3 * GROOVE);
    let large = json(&scratch, &[&explore[..], &["--finger", &finger, "-o", "large"]].concat(), 4);
    assert!(number(&large["jumps"]) > 3.0 && large["warnings"][0].as_str().unwrap().contains("jumped at"));
    for place in large["jumped_at"].as_array().unwrap() {
        let radius = number(&place["radius_at_most_m"]);
        assert!(GROOVE < radius && radius < 1.35 * GROOVE, "{radius} {GROOVE}");
    }
    assert!(scratch.read("large/report.html").contains("Where it jumped"));
    assert_eq!(scratch.read("large/jumps.csv").lines().count() as u64, 1 + large["jumps"].as_u64().unwrap());
    assert_eq!(scratch.run(&["check", "large"]).code, Some(0));
}

#[test]
fn noise_widens_what_is_proven_and_few_lines_are_said_to_be_few() {
    let scratch = scratch("relief-noise");
    let noise = ["--contact-noise", "5e-5", "--normal-noise", "2e-3"];
    let explore = ["explore", "body.toml", "--relief", "--step", "0.012", "--json"];
    let exact = json(&scratch, &explore, 0);
    let noisy = json(&scratch, &[&explore[..], &noise[..]].concat(), 0);
    assert_eq!(noisy["settings"]["confidence"], 0.95);
    let [exact, noisy] = [exact, noisy].map(|of| number(&of["volume_at_most_m3"]));
    assert!(volume() < exact && exact < noisy, "{exact} {noisy}");
    let short = json(&scratch, &[&explore[..], &["--budget", "300", "-o", "short"]].concat(), 4);
    assert!(short["all_lines"] == false && short["warnings"][0].as_str().unwrap().contains("used up"));
    assert_eq!(scratch.run(&["check", "short"]).code, Some(0));
}

#[test]
fn what_cannot_be_felt_is_named() {
    let scratch = scratch("relief-bad");
    scratch.write("space.toml", include_str!("../../scenes/fig5.toml"));
    scratch.write("bare.toml", "[surface]\nsize = 0.05\n");
    scratch.write(
        "deep.toml",
        "[surface]\nsize = 0.05\nwaves = [{ axis = [0, 0, 1], depth = 1.5, count = 2 }]\n",
    );
    for (arguments, says, code) in [
        (vec!["explore", "bare.toml", "--relief"], "no finger", 3),
        (vec!["explore", "bare.toml", "--relief", "--finger", "-1"], "positive", 2),
        (vec!["explore", "bare.toml", "--relief", "--finger", "1e-4"], "radius of the finger is 0.0001", 3),
        (
            vec!["explore", "bare.toml", "--relief", "--finger", "0.01", "--step", "0.02"],
            "spacing is 0.02",
            3,
        ),
        (vec!["explore", "space.toml", "--relief", "--finger", "1"], "`[surface]` is not given", 3),
        (vec!["explore", "deep.toml", "--relief", "--finger", "1"], "surface.waves[0].depth", 3),
        (vec!["explore", "nowhere.toml", "--relief"], "cannot be read", 3),
        (vec!["explore", "bare.toml", "--relief", "--contour"], "cannot be used with", 2),
        (vec!["explore", "bare.toml", "--finger", "0.01", "--until", "gap=0.1"], "--contour", 2),
        (
            vec!["explore", "bare.toml", "--relief", "--finger", "0.01", "--contact-noise", "1e-4"],
            "half of the noise",
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
}
