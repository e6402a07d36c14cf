//! Bags of ROS 2 through the command: looked over, mapped, reconstructed, written.

use crate::common::{Run, Scratch};
use recon_tests::few_or_all;
use serde_json::Value;
use std::path::PathBuf;

fn bag(name: &str) -> String {
    let path: PathBuf =
        [env!("CARGO_MANIFEST_DIR"), "..", "..", "tests", "data", "mcap", name].iter().collect();
    path.to_str().unwrap().to_owned()
}

fn json(run: &Run) -> Value {
    serde_json::from_str(&run.stdout).unwrap_or_else(|e| panic!("{e}: {}{}", run.stdout, run.stderr))
}

const FINGERTIPS: &str = "\
gravity = 9.81
[sensors]
contact_std = 1e-5
force_std = 1e-3
[[palm]]
kind = \"sphere\"
radius = 0.012
[[palm]]
kind = \"sphere\"
radius = 0.012
[[palm]]
kind = \"sphere\"
radius = 0.012
";

/// The same log comes out of the CSV that is made of the bag.
#[test]
fn a_robots_log_becomes_motion_mass_a_bag_and_a_table() {
    let dir = Scratch::new("bag-fingertips");
    dir.write("scene.toml", FINGERTIPS);
    let (bag, map) = (bag("s4_fingertips.mcap"), "map.toml");
    let looked = dir.run(&["inspect", &bag, "-o", map, "--csv", "log.csv"]);
    assert_eq!(looked.code, Some(0), "{}", looked.stderr);
    for words in
        ["the clocks disagree", "40 messages are missing (numbers 600 to 639)", "kind sphere", "map.toml"]
    {
        assert!(looked.stdout.contains(words), "`{words}` is not in\n{}", looked.stdout);
    }
    assert!(dir.read(map).contains("ahead = 0.003 "), "{}", dir.read(map));
    let made =
        dir.run(&["reconstruct", &bag, "-m", map, "-s", "scene.toml", "-o", "out", "--mcap", "--json"]);
    assert_eq!(made.code, Some(0), "{}{}", made.stdout, made.stderr);
    let figures = json(&made);
    // The truth of the scene is 0.1 kg.
    let mass =
        figures["mass_kg"].as_f64().or(figures["mass"].as_f64()).or(figures["object"]["mass"].as_f64());
    assert!(mass.is_some_and(|mass| (mass - 0.1).abs() < 1e-3), "{figures}");
    assert!(figures["warnings"].to_string().contains("10 of 251 samples are left out"), "{figures}");
    assert_eq!(dir.run(&["check", "out"]).code, Some(0));
    // The bag of results is one that is read, at the stamps of the other.
    let result = dir.path().join("out/result.mcap");
    let result = json(&dir.run(&["inspect", result.to_str().unwrap(), "--json"]));
    let of = |name: &str| {
        result["topics"].as_array().unwrap().iter().find(|topic| topic["name"] == name).unwrap().clone()
    };
    assert_eq!(of("/recon/pose")["messages"], 241);
    assert_eq!(of("/tf")["span_s"][0], 0.0);
    assert_eq!(of("/recon/bounds")["messages"], 1);
    assert_table(&dir, &bag);
}

/// Checks that the table that was made of the bag is made again by what is told of it, and gives the motion that the bag gave.
fn assert_table(dir: &Scratch, bag: &str) {
    // What stands on the console is a mapping too, as a whole.
    let told = dir.run(&["inspect", bag, "-q"]).stdout;
    dir.write("told.toml", &told);
    assert!(told.contains("the clocks disagree") && told.ends_with(&dir.read("map.toml")), "{told}");
    let again = dir.run(&["inspect", bag, "-m", "told.toml", "-s", "scene.toml", "--csv", "again.csv"]);
    assert_eq!(
        (again.code, dir.read("log.csv") == dir.read("again.csv")),
        (Some(0), true),
        "{}",
        again.stderr
    );
    assert!(again.stdout.contains("241 samples over 1 s"), "{}", again.stdout);
    // It is the same log: what else is made of it is another second.
    if few_or_all(true, false) {
        return;
    }
    let run = dir.run(&["reconstruct", "log.csv", "-s", "scene.toml", "-o", "again"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let [of_bag, of_csv] = ["out", "again"].map(|out| dir.read(&format!("{out}/motion.csv")));
    // Points were turned into the palms' axes and back: the last digits differ.
    let numbers = |text: &str| -> Vec<f64> {
        text.lines()
            .skip(1)
            .flat_map(|line| line.split(',').map(|v| v.parse().unwrap()).collect::<Vec<f64>>())
            .collect()
    };
    let (of_bag, of_csv) = (numbers(&of_bag), numbers(&of_csv));
    assert_eq!(of_bag.len(), of_csv.len());
    for (a, b) in of_bag.iter().zip(&of_csv) {
        assert!((a - b).abs() <= 1e-6 * (1.0 + a.abs()), "{a} {b}");
    }
}

#[test]
fn a_bag_of_three_planes_goes_to_their_estimator() {
    let dir = Scratch::new("bag-planes");
    dir.write("scene.toml", include_str!("../../scenes/fig5.toml"));
    // Two tenths of a second, or four seconds of the same: the first is too short to rely on.
    let (name, code) = few_or_all(("whole_short.mcap", 4), ("fig5.mcap", 0));
    let bag = bag(name);
    assert_eq!(dir.run(&["inspect", &bag, "-o", "map.toml"]).code, Some(0));
    let made = dir.run(&[
        "reconstruct",
        &bag,
        "-m",
        "map.toml",
        "-s",
        "scene.toml",
        "-o",
        "out",
        "--mcap",
        "--json",
    ]);
    assert_eq!(made.code, Some(code), "{}{}", made.stdout, made.stderr);
    if code == 0 {
        // The simulator that made the log departs from exact dynamics by 9e-7 m over 4 s.
        let error = json(&made)["largest_error"]["position_m"].as_f64().unwrap();
        assert!(error < 3e-6, "{error}");
    }
    assert!(dir.path().join("out/result.mcap").is_file());
    assert_eq!(dir.run(&["check", "out"]).code, Some(0));
}

#[test]
fn bags_that_cannot_be_used_say_why_and_leave_nothing() {
    let dir = Scratch::new("bag-bad");
    dir.write("scene.toml", include_str!("../../scenes/fig5.toml"));
    let whole = bag("whole_short.mcap");
    assert_eq!(dir.run(&["inspect", &whole, "-o", "map.toml"]).code, Some(0));
    // Without what was found of the clocks.
    let s4 = bag("s4_fingertips.mcap");
    assert_eq!(dir.run(&["inspect", &s4, "-o", "s4.toml"]).code, Some(0));
    dir.write("s4.toml", dir.read("s4.toml").split("[[clock]]").next().unwrap());
    dir.write("fingertips.toml", FINGERTIPS);
    let before = dir.names();
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let run = dir.run(arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}\n{}{}", run.stdout, run.stderr);
        for word in words {
            assert!(run.stderr.contains(word), "`{word}` is not in\n{}", run.stderr);
        }
        assert_eq!(dir.names(), before);
    };
    let mapped = |file: &str, words: &[&str]| {
        let broken = bag(file);
        refused(&["reconstruct", &broken, "-m", "map.toml", "-s", "scene.toml", "-o", "out"], 3, words);
    };
    mapped("broken_nan.mcap", &["/palm_1/wrench", "t = 0.05 s", "force.z is NaN", "broken_nan.mcap"]);
    mapped("broken_truncated.mcap", &["byte 29112", "627 whole messages", "cut_off = true"]);
    mapped("broken_frames.mcap", &["palm_7", "palm[2].wrench_frame"]);
    mapped("broken_empty_topic.mcap", &["/palm_3/wrench", "no message"]);
    let words = ["clocks disagree", "/palm_1/contact", "ahead = 0.00299"];
    refused(&["reconstruct", &s4, "-m", "s4.toml", "-s", "fingertips.toml", "-o", "out"], 3, &words);
    refused(&["reconstruct", &whole, "-s", "scene.toml"], 3, &["--mapping", "recon inspect"]);
    refused(
        &["reconstruct", "none.mcap", "-s", "scene.toml", "-m", "map.toml"],
        3,
        &["none.mcap", "cannot be read"],
    );
    refused(&["reconstruct", "map.toml", "-m", "map.toml", "-s", "scene.toml"], 2, &["MCAP", "is none"]);
    refused(
        &["follow", &s4, "-s", "scene.toml", "--contact-noise", "1e-3", "--force-noise", "1e-3"],
        3,
        &["MCAP bag", "--csv"],
    );
    refused(&["inspect", "scene.toml"], 3, &["is not an MCAP bag"]);
    refused(&["inspect", &whole, "-m", "scene.toml"], 3, &["mapping of topics", "gravity"]);
    refused(&["inspect", &whole, "-m", "map.toml", "-o", "map.toml"], 2, &["--mapping"]);
    // There is nothing to make a log of.
    let empty = recon_io::ResultBag::default().bytes().unwrap();
    std::fs::write(dir.path().join("result.mcap"), empty).unwrap();
    let run = dir.run(&["inspect", "result.mcap"]);
    assert!(run.code == Some(4) && run.stdout.contains("No palm was found"), "{:?} {}", run.code, run.stdout);
    // What is broken is looked over all the same, and said to be.
    for (name, said) in [
        ("truncated", "was cut off"),
        ("schema_encoding", "ros9msg"),
        ("message_encoding", "xyzcdr"),
        ("empty_topic", "has no message"),
        ("frames", "without a frame"),
        ("nan", "NaN"),
    ] {
        let run = dir.run(&["inspect", &bag(&format!("broken_{name}.mcap"))]);
        assert!(run.code == Some(4) && run.stdout.contains(said), "{name}: {:?} {}", run.code, run.stdout);
    }
}
