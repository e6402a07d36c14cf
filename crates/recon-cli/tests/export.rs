//! The exported object: its files, and MuJoCo's motion of it on palms as in the log.
#![allow(clippy::unwrap_used, clippy::panic, reason = "helpers of tests, where a panic is the report")]

mod common;

use common::{Scratch, scratch_with_log};
use serde_json::Value;
use std::process::Command;

const REPLAY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/mujoco/replay.py");

/// Whether MuJoCo is installed; says so where it is not.
fn mujoco_is_there() -> bool {
    let found = Command::new("python3").args(["-c", "import mujoco, numpy"]).output();
    let there = found.is_ok_and(|run| run.status.success());
    if !there {
        println!("skipped: python3 with the modules mujoco and numpy is not installed");
    }
    there
}

/// What MuJoCo's motion of an exported model is away from the log.
fn replay(scratch: &Scratch, model: &str, options: &[&str]) -> Value {
    let mut command = Command::new("python3");
    command.arg(REPLAY).args([model, "out/motion.csv", "log.csv"]).args(options).current_dir(scratch.path());
    let run = command.output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&run.stdout).unwrap()
}

/// A folder with a log and its reconstruction, exported.
fn reconstructed(scratch: Scratch, shape: &str) -> Scratch {
    let arguments = ["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out", "--export", "mjcf,urdf"];
    let run = scratch.run(&[&arguments[..], &["--export-shape", shape]].concat());
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    scratch
}

#[test]
fn an_ellipsoid_is_exported_as_one_with_its_bounds_beside_it() {
    let scratch = reconstructed(scratch_with_log("export"), "auto");
    let mjcf = scratch.read("out/object.xml");
    assert!(mjcf.contains(r#"type="ellipsoid""#) && mjcf.contains(r#"mass="1.0""#), "{mjcf}");
    for file in ["object.urdf", "object_inner.obj", "object_outer.obj", "object_ellipsoid.obj"] {
        assert!(scratch.path().join("out").join(file).is_file(), "{file}");
    }
    let inner = reconstructed(scratch, "inner");
    let (mjcf, urdf) = (inner.read("out/object.xml"), inner.read("out/object.urdf"));
    assert!(mjcf.contains(r#"<geom name="object" type="mesh" mesh="object_inner"/>"#), "{mjcf}");
    assert!(urdf.contains(r#"<mesh filename="object_inner.obj"/>"#), "{urdf}");
    assert!(!inner.path().join("out/object_ellipsoid.obj").exists(), "the earlier folder is replaced");
    let refused = inner.run(&["reconstruct", "log.csv", "-o", "out", "--export", "step"]);
    assert_eq!(refused.code, Some(2), "{}", refused.stderr);
}

/// MuJoCo's contacts sink in by (1 - d) / d a / k = 9 x 10 / 1e6, about 1e-5 m, and the motion of Fig. 5 amplifies errors
/// of the start up to 240-fold over its 4.2 s: 2.4e-3 m. Forces change by about 10 N a metre: 2.4e-2 N.
#[test]
fn mujoco_repeats_the_log_with_the_exported_ellipsoid() {
    if !mujoco_is_there() {
        return;
    }
    let scratch = reconstructed(scratch_with_log("replay"), "auto");
    let found = replay(&scratch, "out/object.xml", &[]);
    assert!(found["seconds"].as_f64().unwrap() > 4.15 && found["mass_kg"] == 1.0, "{found}");
    assert_eq!(found["parted"], 0, "{found}");
    assert!(found["contact_m"].as_f64().unwrap() < 2.4e-3, "{found}");
    assert!(found["force_n"].as_f64().unwrap() < 2.4e-2, "{found}");
}
