//! Where to touch next, from a scene to a proof.

use crate::common::{Scratch, json};
use recon_tests::few_or_all;
use serde_json::Value;

const SPACE: &str = include_str!("../../scenes/fig5.toml");
pub(super) const PLANE: &str = r#"
plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 1e-4
[palms]
friction = 0.3
[[palm]]
kind = "line"
pose = { position = [0.0, 0.0], angle_deg = 10.0 }
[simulation]
duration = 1.0
sample_rate = 1000.0
position = [0.0, 0.05]
touches = [1]
shape = { kind = "ellipse", semi_axes = [0.05, 0.03] }
"#;

fn scratch(name: &str) -> Scratch {
    let scratch = Scratch::new(name);
    scratch.write("space.toml", SPACE).write("plane.toml", PLANE);
    scratch
}

#[test]
fn an_object_is_touched_until_its_gap_is_proven_and_the_folder_holds() {
    let scratch = scratch("explore");
    for (scene, gap, most, size, truth) in [
        ("plane.toml", "gap=0.1", 12, "area_m2", std::f64::consts::PI * 0.05 * 0.03),
        ("space.toml", "gap=0.25", 40, "volume_m3", 4.0 / 3.0 * std::f64::consts::PI * 2.5 * 2.0),
    ] {
        let made = json(&scratch, &["explore", scene, "--until", gap, "-o", "out", "--json"], 0);
        assert_eq!(made["proof"]["reached"], true);
        let touches = made["proof"]["touches"].as_u64().unwrap();
        assert!(touches <= most && made["touches"].as_array().unwrap().len() as u64 == touches);
        let [lower, upper] =
            ["lower", "upper"].map(|name| made["bounds"][format!("{name}_{size}")].as_f64().unwrap());
        assert!(lower < truth && truth < upper, "{lower} {truth} {upper}");
        let proven = made["proof"]["at_most"].as_f64().unwrap();
        assert!((1.0 - lower / upper - proven).abs() < 1e-12);
        assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
        let page = scratch.read("out/report.html");
        assert!(page.contains("Gap over touches") && page.contains("Bounds over touches"));
        assert!(page.contains("<td>next</td>"));
        // What is done needs no further touch; a finer goal does, and the folder's settings are kept.
        assert_eq!(json(&scratch, &["next", "out"], 0)["done"], true);
        let next = json(&scratch, &["next", "out", "--until", "gap=0.05"], 0);
        assert_eq!((&next["done"], next["touches"].as_u64()), (&Value::Bool(false), Some(touches)));
        assert!(next["touches_predicted"].as_u64().unwrap() > touches);
        let along: Vec<f64> =
            next["action"]["along"].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
        assert!((along.iter().map(|c| c * c).sum::<f64>() - 1.0).abs() < 1e-12, "{along:?}");
        assert!(next["action"]["ray"]["from_m"].is_array());
    }
}

/// `next` after each touch, by hand, is what `explore` does in one go.
#[test]
fn the_loop_can_be_closed_by_whoever_has_the_finger() {
    let scratch = scratch("explore-by-hand");
    let made = json(&scratch, &["explore", "plane.toml", "--until", "gap=0.1", "-o", "out", "--json"], 0);
    let all = scratch.read("out/contacts.csv");
    let lines: Vec<&str> = all.lines().collect();
    for known in 5..lines.len() - 1 {
        scratch.write("so-far.csv", &(lines[..=known].join("\n") + "\n"));
        let next = json(&scratch, &["next", "so-far.csv", "--until", "gap=0.1"], 0);
        let along = |value: &Value| -> Vec<f64> {
            value.as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect()
        };
        let (told, made) = (along(&next["action"]["along"]), along(&made["touches"][known]["along"]));
        assert!(
            told.iter().zip(&made).all(|(a, b)| (a - b).abs() < 1e-9),
            "touch {known}: {told:?} {made:?}"
        );
    }
}

#[test]
fn noise_is_proven_against_and_what_it_forbids_is_refused() {
    let scratch = scratch("explore-noise");
    let noise = ["--contact-noise", "4.5e-3", "--normal-noise", "2e-3"];
    let with = |rest: &[&'static str]| [&["explore", "space.toml", "--json"], rest, &noise].concat();
    let made = json(&scratch, &with(&["--until", "gap=0.3", "-o", "out"]), 0);
    assert_eq!(made["proof"]["confidence"], 0.95);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    assert_eq!(json(&scratch, &["next", "out"], 0)["confidence"], 0.95);
    let refused = scratch.run(&with(&["--until", "gap=0.01"]));
    assert_eq!(refused.code, Some(3));
    assert!(refused.stderr.contains("below what the noise leaves"), "{}", refused.stderr);
    // A budget that is too small ends with what is proven, and says so.
    let short = json(&scratch, &with(&["--until", "gap=0.2", "--budget", "12"]), 4);
    assert_eq!(
        (short["proof"]["reached"].as_bool(), short["proof"]["touches"].as_u64()),
        (Some(false), Some(12))
    );
    assert!(short["warnings"][0].as_str().unwrap().contains("all touches that were allowed for"));
}

#[test]
fn other_goals_planners_and_fingers_are_taken_and_bad_ones_named() {
    let scratch = scratch("explore-goals");
    let width = json(&scratch, &["explore", "space.toml", "--until", "width=1e-6@0,0,1", "--json"], 0);
    assert_eq!(width["proof"]["touches"], 6);
    for planner in ["volume", "hausdorff", "gaussian", "sweep", "random"] {
        let arguments =
            ["explore", "plane.toml", "--until", "gap=0.3", "--planner", planner, "--rays", "--json"];
        assert_eq!(json(&scratch, &arguments, 0)["settings"]["planner"], planner);
    }
    for (goal, words, code) in [
        ("gap=0", "goal 0", 3),
        ("gap=-1", "no gap is below 0", 3),
        ("gap", "is no goal", 2),
        ("width=0.1@0,1", "in space it has three", 3),
        ("width=0.1@0,0,0", "direction", 3),
    ] {
        let run = scratch.run(&["explore", "space.toml", "--until", goal]);
        assert_eq!(run.code, Some(code), "{goal}: {}", run.stderr);
        assert!(run.stderr.contains(words), "{goal}: {}", run.stderr);
    }
    let run = scratch.run(&["next", "nothing-here.csv", "--until", "gap=0.1"]);
    assert_eq!(run.code, Some(3));
    scratch.write("contacts.csv", "x,y,nx,ny\n1,0,1,0\n");
    let run = scratch.run(&["next", "contacts.csv"]);
    assert!(run.code == Some(3) && run.stderr.contains("--until"), "{}", run.stderr);
    let run = scratch.run(&["next", "contacts.csv", "--until", "gap=0.1", "--contact-noise", "1e-3"]);
    assert!(run.code == Some(3) && run.stderr.contains("half of the noise"), "{}", run.stderr);
}

/// Two palms turn, and the object between them, which rolls, lies between what they prove.
#[test]
fn palms_turn_until_the_gap_is_proven_and_say_what_they_cannot() {
    let scratch = scratch("explore-rolling");
    let rolling = |rest: &[&'static str]| [&["explore", "plane.toml", "--rolling"], rest].concat();
    let made = json(&scratch, &rolling(&["--until", "gap=0.2", "-o", "out", "--json"]), 0);
    assert_eq!((&made["schema"], &made["proof"]["reached"]), (&"rolling/1".into(), &true.into()));
    let [lower, upper] =
        ["lower_area_m2", "upper_area_m2"].map(|name| made["bounds"][name].as_f64().unwrap());
    let truth = std::f64::consts::PI * 0.05 * 0.03;
    assert!(lower < truth && truth < upper && upper - lower <= 0.2 * upper, "{lower} {truth} {upper}");
    let motions = made["motions"].as_array().unwrap();
    assert_eq!((&motions[0]["why"], &motions[0]["radians"]), (&"felt at the start".into(), &0.0.into()));
    assert_eq!(motions.last().unwrap()["radians"], made["radians"]);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let page = scratch.read("out/report.html");
    assert!(page.contains("Motion by motion") && page.contains("after motion 1"), "shown in turn");
    // What is done needs no further motion; a finer goal does, from where the palms are.
    assert_eq!(json(&scratch, &["next", "out"], 0)["done"], true);
    let next = json(&scratch, &["next", "out", "--until", "gap=0.05"], 0);
    assert_eq!(next["done"], false);
    let to = |k: usize| next["action"]["palms_rad"][0][k].as_f64().unwrap();
    assert!(to(0) > 0.0 && to(1) < 3.1 && to(1) - to(0) > 0.5, "{next}");
    assert!(next["action"]["expected"]["area_m2"].as_f64().unwrap() > 0.0);
    // The same seed gives the same folder, to the last byte.
    if few_or_all(false, true) {
        scratch.run(&rolling(&["--until", "gap=0.2", "-o", "again"]));
        assert_eq!(scratch.read("again/report.html"), page);
    }
    let refusals = [
        (rolling(&["--until", "gap=0.2", "--friction", "0.3"]), "--force-noise as well"),
        (rolling(&["--planner", "gaussian", "--until", "gap=0.2"]), "use per-second"),
        (vec!["explore", "plane.toml", "--planner", "per-second", "--until", "gap=0.2"], "use path-aware"),
        (rolling(&["--until", "gap=0"]), "goal 0"),
        (rolling(&["--until", "gap=0.2", "--contact-noise", "1e-4"]), "half of the noise"),
        (vec!["explore", "plane.toml", "--until", "gap=0.2", "--contact-noise", "1e-4"], "half of the noise"),
        (rolling(&["--until", "gap=0.2", "--width", "1e-9"]), "beyond its end"),
    ];
    for (arguments, says) in refusals {
        let run = scratch.run(&arguments);
        assert!(
            run.code == Some(3) && run.stderr.contains(says),
            "{arguments:?} {:?} {}",
            run.code,
            run.stderr
        );
    }
}

/// Between parallel palms in space an object rolls as far as friction lets it, and what it does not let be reached is said.
#[test]
fn a_palm_rolls_an_object_in_space_until_the_gap_is_proven_or_friction_ends_it() {
    let scratch = scratch("explore-strokes");
    let rolling = |rest: &[&'static str]| [&["explore", "space.toml", "--rolling"], rest].concat();
    let made = json(&scratch, &rolling(&["--until", "gap=0.4", "--friction", "2", "-o", "out", "--json"]), 0);
    assert_eq!((&made["schema"], &made["proof"]["reached"]), (&"strokes/1".into(), &true.into()));
    let [lower, upper] =
        ["lower_volume_m3", "upper_volume_m3"].map(|name| made["bounds"][name].as_f64().unwrap());
    let truth = 4.0 / 3.0 * std::f64::consts::PI * 2.5 * 2.0;
    assert!(lower < truth && truth < upper && upper - lower <= 0.4 * upper, "{lower} {truth} {upper}");
    let strokes = made["strokes"].as_array().unwrap();
    assert_eq!((&strokes[0]["why"], &strokes[0]["way_m"]), (&"felt at the start".into(), &0.0.into()));
    assert_eq!(strokes.last().unwrap()["way_m"], made["way_m"]);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let page = scratch.read("out/report.html");
    assert!(page.contains("Stroke by stroke") && page.contains("after stroke 1"), "shown in turn");
    assert_eq!(json(&scratch, &["next", "out"], 0)["done"], true);
    let next = json(&scratch, &["next", "out", "--until", "gap=0.2"], 0);
    assert_eq!(next["done"], false);
    assert!(
        next["action"]["heading_rad"].is_number() && next["action"]["expected"]["gain"].as_f64() > Some(0.0)
    );
    let stopped = |all: &str| {
        format!(
            r#"{{"orientation_xyzw": [0, 0, 0, 1], "pads_m": [[0, 0], [0, 0]], "width_m": 1, "friction": 1, "stroke": 3, "stopped_by_friction": {all}}}"#
        )
    };
    for (state, says) in [
        ("{}", "orientation_xyzw"),
        ("none", "expected"),
        (r#"{"orientation_xyzw": [0, 0, 0, 1]}"#, "pads_m"),
        (&stopped("7"), "`stopped_by_friction` is no list"),
        (&stopped(r#"[{"up_normal": [0, 0, 1]}]"#), "`stopped_by_friction` is not all numbers"),
        (&stopped(r#"[{"up_normal": [0, 0, 0], "along": [1, 0, 0]}]"#), "no length"),
    ] {
        scratch.write("out/state.json", state);
        let run = scratch.run(&["next", "out", "--until", "gap=0.2"]);
        assert!(run.code == Some(3) && run.stderr.contains(says), "{state}: {}", run.stderr);
    }
    let end = ["--until", "gap=0.1", "--friction", "0.05", "-o", "short", "--json"];
    let short = json(&scratch, &rolling(&end), 4);
    assert!(short["warnings"][0].as_str().unwrap().contains("more friction"), "{short}");
    // Whoever goes on from there is not sent the same ways again.
    let next = json(&scratch, &["next", "short"], 4);
    assert!(next["why_none"].as_str().unwrap().contains("no stroke uncovers what is left"), "{next}");
    let noise = ["--until", "gap=0.2", "--contact-noise", "1e-4"];
    for (arguments, says) in [
        (rolling(&noise), "half of the noise"),
        (rolling(&[&noise[..], &["--force-noise", "1"]].concat()), "--force-noise is not"),
        (rolling(&[&noise[..], &["--normal-noise", "1"]].concat()), "--normal-noise is not"),
        (
            vec![
                "explore",
                "plane.toml",
                "--rolling",
                "--until",
                "gap=0.2",
                "--contact-noise",
                "1e-4",
                "--palm-noise",
                "1e-4",
            ],
            "in space",
        ),
        (rolling(&["--until", "gap=0.2", "--friction", "0"]), "coefficient of friction is 0"),
        (rolling(&["--until", "gap=0.2", "--planner", "hausdorff"]), "use per-second"),
        (rolling(&["--until", "gap=0"]), "goal 0"),
        (
            rolling(&["--until", "gap=1e-6", "--contact-noise", "1e-4", "--palm-noise", "1e-4"]),
            "below what the noise",
        ),
    ] {
        let run = scratch.run(&arguments);
        assert!(
            run.code == Some(3) && run.stderr.contains(says),
            "{arguments:?} {:?} {}",
            run.code,
            run.stderr
        );
    }
}

/// Between parallel palms that sense with noise nothing is known of the object but what is estimated.
#[test]
fn parallel_palms_with_noisy_sensors_prove_a_gap_by_an_estimate() {
    let scratch = scratch("explore-strokes-sensed");
    let noise = ["--contact-noise", "2e-3", "--palm-noise", "2e-4", "--spin-noise", "1e-3"];
    let rest = ["--friction", "2", "--until", "gap=0.45", "-o", "out", "--json"];
    let made = json(&scratch, &[&["explore", "space.toml", "--rolling"], &noise[..], &rest].concat(), 0);
    assert_eq!((&made["proof"]["reached"], &made["proof"]["confidence"]), (&true.into(), &0.95.into()));
    assert_eq!(made["settings"]["palm_noise_m"], 2e-4);
    let [lower, upper] =
        ["lower_volume_m3", "upper_volume_m3"].map(|name| made["bounds"][name].as_f64().unwrap());
    let truth = 4.0 / 3.0 * std::f64::consts::PI * 2.5 * 2.0;
    assert!(lower < truth && truth < upper && upper - lower <= 0.45 * upper, "{lower} {truth} {upper}");
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    assert_eq!(json(&scratch, &["next", "out"], 0)["done"], true);
    // Of a finer goal it is known what was proven of the other.
    let next = json(&scratch, &["next", "out", "--until", "gap=0.2"], 0);
    assert_eq!((&next["done"], &next["at_most"]), (&false.into(), &made["proof"]["at_most"]));
    assert!(next["action"]["heading_rad"].is_number(), "{next}");
}

/// With noisy sensors nothing is known of the object but what is estimated, and the certificate is at a confidence.
#[test]
fn palms_with_noisy_sensors_prove_a_gap_by_an_estimate() {
    let scratch = scratch("explore-sensed");
    let noise = ["--contact-noise", "4e-5", "--force-noise", "2e-3"];
    let with = |rest: &[&'static str]| [&["explore", "plane.toml", "--rolling"], &noise[..], rest].concat();
    let made = json(&scratch, &with(&["--until", "gap=0.2", "-o", "out", "--json"]), 0);
    assert_eq!((&made["proof"]["reached"], &made["proof"]["confidence"]), (&true.into(), &0.95.into()));
    let [lower, upper] =
        ["lower_area_m2", "upper_area_m2"].map(|name| made["bounds"][name].as_f64().unwrap());
    let truth = std::f64::consts::PI * 0.05 * 0.03;
    assert!(lower < truth && truth < upper && upper - lower <= 0.2 * upper, "{lower} {truth} {upper}");
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    assert_eq!(json(&scratch, &["next", "out"], 0)["done"], true);
    let next = json(&scratch, &["next", "out", "--until", "gap=0.01"], 0);
    assert_eq!((&next["done"], &next["confidence"]), (&false.into(), &0.95.into()));
    assert!(next["action"]["palms_rad"][0][1].is_number(), "{next}");
    // A state that is none is named.
    scratch.write("out/state.json", "{}");
    let run = scratch.run(&["next", "out", "--until", "gap=0.01"]);
    assert!(run.code == Some(3) && run.stderr.contains("motion"), "{}", run.stderr);
}
