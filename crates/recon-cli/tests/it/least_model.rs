//! `--accuracy` and `--explain`: the least model that serves, and why.

use crate::common::{Scratch, scratch_reconstructed, scratch_with_log};
use serde_json::Value;

fn chosen<'a>(summary: &'a Value, question: &str) -> &'a Value {
    let decisions = summary["least_model"]["decisions"].as_array().unwrap();
    let of = decisions.iter().find(|of| of["question"] == question).unwrap();
    let all = of["alternatives"].as_array().unwrap();
    let taken: Vec<&Value> = all.iter().filter(|of| of["chosen"] == true).collect();
    assert_eq!(taken.len(), 1, "{of}");
    taken[0]
}

#[test]
fn a_simulation_is_as_exact_as_asked_and_says_why() {
    let scratch = scratch_with_log("least-simulation");
    let simulate = |more: &[&str]| {
        let run = scratch.run(&[&["simulate", "scene.toml", "-o", "near.csv"], more].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        run.stdout
    };
    let said: Value = serde_json::from_str(&simulate(&["--accuracy", "1e-6", "--json"])).unwrap();
    assert_eq!(
        (said["least_model"]["wanted"].as_f64(), &said["least_model"]["is_reached"]),
        (Some(1e-6), &true.into())
    );
    let tolerance = chosen(&said, "tolerance");
    assert!(
        tolerance["accuracy"].as_f64().unwrap() <= 1e-6
            && tolerance["model"]["tolerance"].as_f64().unwrap() > 1e-10
    );
    let text = simulate(&["--accuracy", "1e-6", "--explain"]);
    assert!(text.contains("is reached") && text.contains("Tolerance of a step"), "{text}");
    assert!(!simulate(&["--accuracy", "1e-6"]).contains("Tolerance of a step"));
    for wrong in [["--accuracy", "0"], ["--accuracy", "0.5"], ["--explain", "--quiet"]] {
        let run = scratch.run(&[&["simulate", "scene.toml", "-o", "near.csv"], &wrong[..]].concat());
        assert_eq!(run.code, Some(2), "{}", run.stderr);
    }
}

#[test]
fn an_estimate_says_what_it_left_out() {
    let (scratch, _) = scratch_reconstructed("least-estimate", false);
    let summary =
        |scratch: &Scratch| -> Value { serde_json::from_str(&scratch.read("out/summary.json")).unwrap() };
    assert!(
        summary(&scratch)["least_model"].is_null() && !scratch.read("out/report.html").contains("left out")
    );
    let words =
        ["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out", "--accuracy", "1e-2", "--explain"];
    let run = scratch.run(&words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(
        run.stderr.contains("Mass and inertia:") && run.stderr.contains("* estimated with the motion"),
        "{}",
        run.stderr
    );
    let told = summary(&scratch);
    assert_eq!(told["least_model"]["is_reached"], true);
    assert_eq!(chosen(&told, "body")["model"], "estimated_body");
    assert_eq!(chosen(&told, "axes")["model"], "normal_force");
    assert_eq!(chosen(&told, "space")["model"], "spatial");
    assert!(
        scratch.read("out/report.html").contains("What was modelled, what was left out, what that costs")
    );
}
