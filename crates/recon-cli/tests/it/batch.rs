//! Many logs: each as if it were alone, what is broken named, what is done kept.

use crate::common::{Scratch, Table, scene, wait_for};
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::process::Stdio;
use std::time::SystemTime;

/// A folder `logs` of two logs with spins of their own and one that was spoiled.
fn logs(test: &str) -> Scratch {
    let scratch = Scratch::new(test);
    fs::create_dir(scratch.path().join("logs")).unwrap();
    scratch.write("scene.toml", &scene());
    for (name, spin) in [("slow", "[0.0, 0.3, 0.3]"), ("fast one", "[0.0, 0.4, 0.2]")] {
        scratch.write("made.toml", &scene().replace("[0.0, 0.3, 0.3]", spin));
        let run = scratch.run(&["simulate", "made.toml", "-o", &format!("logs/{name}.csv")]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
    let mut spoiled = Table::parse(&scratch.read("logs/slow.csv"));
    spoiled.set(7, "f_2", "strong");
    scratch.write("logs/spoiled.csv", &spoiled.text());
    scratch.write("logs/notes.txt", "no log");
    scratch
}

fn batch(scratch: &Scratch, more: &[&str]) -> (Option<i32>, Value) {
    let run =
        scratch.run(&[&["batch", "logs", "--scene", "scene.toml", "-o", "out", "--json"], more].concat());
    (run.code, serde_json::from_str(&run.stdout).unwrap_or_else(|_| panic!("{}{}", run.stdout, run.stderr)))
}

/// The table without the times it took.
fn table(scratch: &Scratch) -> Vec<String> {
    let text = scratch.read("out/results.csv");
    let columns = Table::parse(&text);
    let seconds = columns.column("seconds");
    let without = |line: &str| {
        let cells = line.split(',').enumerate().filter(|(i, _)| *i != seconds);
        cells.map(|(_, cell)| cell).collect::<Vec<_>>().join(",")
    };
    text.lines().map(without).collect()
}

#[test]
fn each_log_is_as_if_it_were_alone_and_a_broken_one_is_named() {
    let scratch = logs("batch");
    let (code, said) = batch(&scratch, &["--identify"]);
    assert_eq!(code, Some(4));
    assert_eq!([&said["logs"], &said["relied_on"], &said["skipped"]], [3, 2, 1]);
    // Of logs that are all skipped there is a table as well.
    scratch.write("none.toml", "");
    let none = scratch.run(&["batch", "logs", "--scene", "none.toml", "-o", "nothing"]);
    assert!(none.code == Some(4) && none.stdout.contains("3 skipped"), "{}{}", none.stdout, none.stderr);
    assert_eq!(scratch.read("nothing/results.csv").lines().count(), 4);
    let rows = said["rows"].as_array().unwrap();
    assert_eq!(rows[2]["log"], "spoiled.csv");
    let why = rows[2]["why"].as_str().unwrap();
    assert!(why.contains("line 9") && why.contains("f_2") && why.contains("strong"), "{why}");
    assert!(!scratch.path().join("out/spoiled").exists());
    // Alone.
    let alone =
        scratch.run(&["reconstruct", "logs/slow.csv", "--scene", "scene.toml", "--identify", "-o", "alone"]);
    assert_eq!(alone.code, Some(0), "{}", alone.stderr);
    for file in ["motion.csv", "summary.json", "lower_bound.ply", "report.html"] {
        let bytes = |folder: &str| fs::read(scratch.path().join(folder).join(file)).unwrap();
        assert_eq!(bytes("alone"), bytes("out/slow"), "{file}");
    }
    let summary: Value = serde_json::from_str(&scratch.read("alone/summary.json")).unwrap();
    let told = Table::parse(&scratch.read("out/results.csv"));
    let cell = |name: &str| told.rows[1][told.column(name)].parse::<f64>().unwrap();
    assert_eq!(Some(cell("mass_kg")), summary["evidence"]["mass"]["value"].as_f64());
    assert!(cell("std_mass_kg") > 0.0 && cell("lower_volume_m3") > 0.0);
    // The page shows all of them, and where to go on.
    let page = scratch.read("out/index.html");
    assert_eq!(page.matches("<article").count(), 3);
    assert_eq!(page.matches("<svg").count(), 2, "a picture of each motion");
    for axis in ["x", "y", "z"] {
        assert_eq!(page.matches(&format!(">{axis}</text>")).count(), 2, "{axis} of two motions");
    }
    assert!(
        page.contains("fast%20one/report.html") && !page.contains("src=") && !page.contains("href=\"http")
    );
}

#[test]
fn what_is_done_is_kept_and_what_has_changed_is_done_again() {
    let scratch = logs("batch-again");
    let (_, first) = batch(&scratch, &["--jobs", "2"]);
    assert_eq!(first["done_before"], 0);
    let (made, written) = (table(&scratch), || -> SystemTime {
        fs::metadata(scratch.path().join("out/slow/motion.csv")).unwrap().modified().unwrap()
    });
    let before = written();
    let (code, again) = batch(&scratch, &["--jobs", "1"]);
    assert_eq!((code, &again["done_before"]), (Some(4), &2.into()));
    assert_eq!((written(), table(&scratch)), (before, made), "kept, with the same table");
    // A folder that no longer holds, as after an interruption elsewhere; and another log of the same name.
    let motion = scratch.read("out/slow/motion.csv");
    fs::remove_dir_all(scratch.path().join("out/slow")).unwrap();
    let fast = scratch.read("logs/fast one.csv");
    scratch.write("logs/fast one.csv", &scratch.read("logs/slow.csv"));
    let (_, third) = batch(&scratch, &[]);
    assert_eq!(third["done_before"], 0);
    assert_eq!(scratch.read("out/slow/motion.csv"), motion);
    assert_eq!(scratch.read("out/fast one/motion.csv"), motion);
    // Other options: nothing of it is taken as done.
    scratch.write("logs/fast one.csv", &fast);
    assert_eq!(batch(&scratch, &["--identify"]).1["done_before"], 0);
}

/// Before any work: two dots as a name would be the folder above, and the table has the name of a folder then.
#[test]
fn a_log_whose_name_is_that_of_something_else_is_named() {
    for name in ["...csv", "..csv", "results.csv.csv", "index.html.mcap"] {
        let scratch = logs("batch-named");
        scratch.write(&format!("logs/{name}"), &scratch.read("logs/slow.csv"));
        let run = scratch.run(&["batch", "logs", "--scene", "scene.toml", "-o", "out"]);
        assert!(run.code == Some(3) && run.stderr.contains(name), "{:?} {}", run.code, run.stderr);
        assert!(!scratch.path().join("out").exists());
    }
}

/// Killed without a chance to tidy up, at whatever it was: what is whole is kept, the rest is done, and nothing else stays.
#[test]
fn killed_in_the_middle_it_goes_on_to_the_same_table() {
    let scratch = logs("batch-killed");
    for k in 0..2 {
        scratch.write(&format!("logs/more {k}.csv"), &scratch.read("logs/slow.csv"));
    }
    batch(&scratch, &["--jobs", "1"]);
    let whole = table(&scratch);
    fs::rename(scratch.path().join("out"), scratch.path().join("whole")).unwrap();
    let words = ["batch", "logs", "--scene", "scene.toml", "-o", "out", "--jobs", "1"];
    let mut child = scratch.command(&words).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let is_begun = || scratch.path().join("out/more 0").exists();
    assert!(wait_for(&mut child, is_begun), "it was done before it could be killed");
    child.kill().unwrap(); // SIGKILL
    child.wait().unwrap();
    assert!(!scratch.path().join("out/results.csv").exists(), "no table of a part");
    // As if it had been killed while it wrote one of a log that is skipped now, too.
    fs::create_dir(scratch.path().join("out/.spoiled.partial-1")).unwrap();
    scratch.write("out/.spoiled.partial-1/.in-use", "").write("out/.spoiled.partial-1/motion.csv", "half");
    let (code, said) = batch(&scratch, &["--jobs", "2"]);
    let before = said["done_before"].as_u64().unwrap();
    assert!(code == Some(4) && (1..4).contains(&before), "{before}");
    assert_eq!(table(&scratch), whole);
    let names = |folder: &str| -> BTreeSet<_> {
        fs::read_dir(scratch.path().join(folder)).unwrap().map(|entry| entry.unwrap().file_name()).collect()
    };
    assert_eq!(names("out"), names("whole"));
    for name in ["slow", "more 1"] {
        let summary = |folder: &str| scratch.read(&format!("{folder}/{name}/summary.json"));
        assert_eq!(summary("out"), summary("whole"));
    }
}

#[test]
fn a_log_has_the_scene_of_its_name_and_bad_folders_are_named() {
    let scratch = logs("batch-scenes");
    // A scene of the log's name that cannot be, where the one of all logs can.
    scratch.write("logs/slow.toml", &scene().replace("gravity = 9.81", "gravity = -9.81"));
    let (_, said) = batch(&scratch, &[]);
    assert_eq!([&said["relied_on"], &said["skipped"]], [1, 2], "{said}");
    let rows = said["rows"].as_array().unwrap();
    let why = rows.iter().find(|row| row["log"] == "slow.csv").unwrap()["why"].as_str().unwrap();
    assert!(why.contains("slow.toml") && why.contains("gravity"), "{why}");
    let refused = |folder: &str, word: &str| {
        let run = scratch.run(&["batch", folder, "--scene", "scene.toml", "-o", "other"]);
        assert_eq!(run.code, Some(3));
        assert!(run.stderr.contains(word), "{}", run.stderr);
    };
    refused("nowhere", "nowhere");
    fs::create_dir(scratch.path().join("empty")).unwrap();
    refused("empty", "no logs");
    scratch.write("logs/slow.mcap", "");
    refused("logs", "rename one");
}

#[test]
fn logs_in_the_plane_are_done_as_if_alone() {
    let scratch = Scratch::new("batch-plane");
    assert_eq!(scratch.run(&["planar", "-q"]).code, Some(0));
    fs::create_dir(scratch.path().join("logs")).unwrap();
    scratch.write("logs/turned.csv", &scratch.read("recon-planar/log.csv"));
    scratch.write("scene.toml", "plane = true\ngravity = 9.81\n");
    let (code, said) = batch(&scratch, &[]);
    assert_eq!((code, &said["relied_on"]), (Some(0), &1.into()), "{said}");
    let alone = scratch.run(&["reconstruct", "logs/turned.csv", "--scene", "scene.toml", "-o", "alone"]);
    assert_eq!(alone.code, Some(0), "{}", alone.stderr);
    for file in ["motion.csv", "summary.json", "report.html"] {
        assert_eq!(
            scratch.read(&format!("alone/{file}")),
            scratch.read(&format!("out/turned/{file}")),
            "{file}"
        );
    }
    let summary: Value = serde_json::from_str(&scratch.read("alone/summary.json")).unwrap();
    let told = Table::parse(&scratch.read("out/results.csv"));
    let number = |name: &str| told.rows[0][told.column(name)].parse::<f64>().unwrap();
    assert_eq!(summary["mass_kg"].as_f64(), Some(number("mass_kg")));
    assert_eq!(summary["inertia_kg_m2"].as_f64(), Some(number("inertia_kg_m2")));
    assert_eq!(summary["bounds"]["upper_area_m2"].as_f64(), Some(number("upper_area_m2")));
    assert!(number("lower_volume_m3").is_nan() && number("relied_on_share") > 0.99);
    // What is done is kept; what simulators take has no plane.
    let (_, again) = batch(&scratch, &[]);
    assert_eq!(again["rows"][0]["done_before"], true, "{again}");
    let (code, refused) = batch(&scratch, &["--export", "urdf"]);
    assert!(
        code == Some(0) || refused["rows"][0]["why"].as_str().unwrap().contains("in the plane"),
        "{refused}"
    );
}
