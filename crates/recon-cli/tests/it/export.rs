//! The exported object: its files, and MuJoCo's motion of it on palms as in the log.

use crate::common::{Scratch, fig5, scratch_reconstructed, scratch_with_log, scratch_with_log_of};
use recon_tests::mujoco_is_there;
use serde_json::Value;
use std::process::Command;

const REPLAY: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/mujoco/replay.py");

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
    let (scratch, _) = scratch_reconstructed("export", false);
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

/// Mass and inertia are estimated; the exported numbers and their deviations are those of the summary.
#[test]
fn an_identified_body_is_exported_with_its_deviations() {
    let scratch = scratch_with_log("identify");
    // Nothing of the body is told.
    let blind = crate::common::scene();
    let blind: Vec<_> =
        blind.lines().filter(|l| !l.starts_with("mass =") && !l.starts_with("principal_moments")).collect();
    scratch.write("blind.toml", &(blind.join("\n") + "\n"));
    let arguments = ["reconstruct", "log.csv", "--scene", "blind.toml", "-o", "out", "--export", "mjcf,urdf"];
    let refused = scratch.run(&arguments);
    assert!(refused.code == Some(3) && refused.stderr.contains("--identify"), "{}", refused.stderr);
    let run = scratch.run(&[&arguments[..], &["--identify"]].concat());
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let summary: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    let value = |key: &str| summary["evidence"][key]["value"].as_f64().unwrap();
    // At 100 Hz the quadrature of the readings is good to some 1e-6.
    assert!((value("mass") - 1.0).abs() < 1e-4, "{summary:#}");
    for (key, moment) in [("moment_x", 1.0), ("moment_y", 1.45), ("moment_z", 2.05)] {
        assert!((value(key) - moment).abs() < 1e-3, "{key} {summary:#}");
    }
    let mjcf = scratch.read("out/object.xml");
    let (_, after) = mjcf.split_once(r#"name="object_mass_std" data=""#).unwrap();
    let exported: f64 = after.split_once('"').unwrap().0.parse().unwrap();
    assert!(
        (exported / value("std_mass") - 1.0).abs() < 1e-12 && mjcf.contains("object_inertia_std"),
        "{mjcf}"
    );
    assert!(scratch.read("out/object.urdf").contains("Standard deviations"));
}

/// MuJoCo's contacts sink in by (1 - d) / d a / k = 9 x 10 / 1e6, about 1e-5 m, and the motion of Fig. 5 amplifies errors
/// of the start up to 240-fold over its 4.2 s: 2.4e-3 m. Forces change by about 10 N a metre: 2.4e-2 N.
#[test]
fn mujoco_repeats_the_log_with_the_exported_ellipsoid() {
    if !mujoco_is_there() {
        return;
    }
    let scratch = reconstructed(scratch_with_log_of("replay", &fig5()), "auto");
    let found = replay(&scratch, "out/object.xml", &[]);
    assert!(found["seconds"].as_f64().unwrap() > 4.15 && found["mass_kg"] == 1.0, "{found}");
    assert_eq!(found["parted"], 0, "{found}");
    assert!(found["contact_m"].as_f64().unwrap() < 2.4e-3, "{found}");
    assert!(found["force_n"].as_f64().unwrap() < 2.4e-2, "{found}");
}

/// The same with palms that swing, over 2 s in which errors grow to the same bound.
#[test]
fn mujoco_repeats_the_log_on_moving_palms() {
    if !mujoco_is_there() {
        return;
    }
    let scratch = Scratch::new("replay-moving");
    let mut scene =
        fig5().replace("duration = 4.2", "duration = 2.0").replace("rate = 100.0", "rate = 200.0");
    for (azimuth, frequency, phase) in [("270.0", 3.0, 0.0), ("30.0", 2.0, 1.0), ("150.0", 2.5, 2.0)] {
        let still = format!("azimuth_deg = {azimuth}, slope_deg = 60.0");
        let swing =
            format!("sinusoid = {{ amplitude = 0.05, frequency = {frequency:?}, phase = {phase:?} }}");
        scene = scene.replace(&format!("{still} }}"), &format!("{still}, {swing} }}"));
    }
    assert_eq!(scene.matches("sinusoid").count(), 3);
    scratch.write("scene.toml", &scene);
    assert_eq!(scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]).code, Some(0));
    let found = replay(&reconstructed(scratch, "auto"), "out/object.xml", &[]);
    assert!(found["seconds"].as_f64().unwrap() > 1.95 && found["parted"] == 0, "{found}");
    assert!(found["contact_m"].as_f64().unwrap() < 2.4e-3, "{found}");
    assert!(found["force_n"].as_f64().unwrap() < 2.4e-2, "{found}");
}

/// A hull touches at its vertices. Where contacts sink in by 1e-5 m, all of it within sqrt(2 rho 1e-5) of the contact
/// may carry: 1.1e-2 m at the largest radius of curvature, 2.5^2 m. That is under the 6 N of a palm at rest; where a corner strikes, the
/// spring is pressed in by as much more as the force is more. So do the facets of an ellipsoid's mesh in a URDF, by
/// their size, 2.5 m times 3.75 degrees.
#[test]
fn mujoco_holds_the_inner_bound_and_the_urdf_on_the_palms() {
    if !mujoco_is_there() {
        return;
    }
    let scratch = Scratch::new("replay-hull");
    let scene = fig5().replace("duration = 4.2", "duration = 1.0").replace("rate = 100.0", "rate = 1000.0");
    scratch.write("scene.toml", &scene);
    assert_eq!(scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]).code, Some(0));
    let scratch = reconstructed(scratch, "inner");
    let hull = replay(&scratch, "out/object.xml", &[]);
    // From corner to corner a contact parts for a sample: 0 to 4 of a thousand on logs of 0.9 to 1.05 s.
    let parted = hull["parted"].as_u64().unwrap();
    let pressed = 1.0 + hull["force_n"].as_f64().unwrap() / 6.0;
    assert!(parted < 10 && hull["contact_m"].as_f64().unwrap() < 1.1e-2 * pressed.sqrt(), "{hull}");
    let scratch = reconstructed(scratch, "ellipsoid");
    let folder = scratch.path().join("out");
    let urdf =
        replay(&scratch, "out/object.urdf", &["--until", "0.5", "--mesh-dir", folder.to_str().unwrap()]);
    assert!(urdf["mass_kg"] == 1.0 && urdf["contact_m"].as_f64().unwrap() < 0.164, "{urdf}");
}

#[test]
fn a_scene_is_exported_alone() {
    let scratch = Scratch::new("export-scene");
    let scene = include_str!("../../scenes/pick-up.toml");
    scratch.write("scene.toml", scene);
    let run = scratch.run(&["export", "scene.toml", "-o", "model", "--json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(said["files"], serde_json::json!(["scene.xml"]));
    // What the demo writes of it, and the whole folder holds.
    assert_eq!(scratch.run(&["demo", "--scene", "pick-up", "-o", "demo"]).code, Some(0));
    assert!(scratch.read("model/scene.xml") == scratch.read("demo/scene.xml"));
    assert_eq!(scratch.run(&["check", "model"]).code, Some(0));
    // A shape that MuJoCo does not know comes as a mesh.
    let egg = r#"shape = { kind = "polynomial", terms = [{ coefficient = 0.025, powers = [0, 0, 0] }, { coefficient = 0.002, powers = [3, 0, 0] }] }"#;
    let start = scene.find("shape = {").unwrap();
    let end = start + scene[start..].find('\n').unwrap();
    scratch.write("scene.toml", &(scene[..start].to_owned() + egg + &scene[end..]));
    let run = scratch.run(&["export", "scene.toml", "-o", "model"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(scratch.path().join("model/scene_shape.obj").is_file(), "{}", run.stdout);
    // So does a cup, as boxes.
    let cup =
        "\n[[palm]]\nkind = \"cup\"\nradius = 1.0\nfriction = 0.1\npose = { position = [0.0, 0.0, 1.0] }\n";
    scratch.write("scene.toml", &(scene.to_owned() + cup));
    let run = scratch.run(&["export", "scene.toml", "-o", "model"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(scratch.read("model/scene.xml").contains("palm_5 is a cup"));
    // What cannot be exported is named, and what stood there stands.
    let before = scratch.read("model/scene.xml");
    let refused = |scene: &str, words: &[&str]| {
        scratch.write("scene.toml", scene);
        let run = scratch.run(&["export", "scene.toml", "-o", "model"]);
        assert_eq!(run.code, Some(3), "{}", run.stdout);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{}", run.stderr);
        assert!(scratch.read("model/scene.xml") == before);
    };
    let damped = "\n[[palm]]\nkind = \"sphere\"\nradius = 0.01\nfriction = 0.1\npose = { position = [0.0, 0.0, 1.0] }\n\
                  spring = { stiffness = [100, 200, 300], damping = [[1.0, 0.1, 0.0], [0.1, 1.0, 0.0], [0.0, 0.0, 1.0]], \
                  mass = 0.1 }\n";
    refused(&(scene.to_owned() + damped), &["damping of palm 5"]);
    refused(include_str!("../../scenes/fig5.toml"), &["scene.toml", "any [[palm]]"]);
    refused("plane = true", &["scene.toml", "scene in the plane"]);
}
