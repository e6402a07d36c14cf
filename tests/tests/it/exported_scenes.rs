//! Scenes of palms of any shape in MuJoCo, as they were exported.

use glam::DVec3;
use recon_io::{Scene, SceneModel};
use recon_tests::mujoco_is_there;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(path)
}

/// Where the scene ends in MuJoCo.
fn run(name: &str, scene: &Scene, arguments: &[&str]) -> Value {
    let folder = std::env::temp_dir().join(format!("recon-scene-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for file in SceneModel::new(name, scene).unwrap().files().unwrap() {
        std::fs::write(folder.join(file.name), file.contents).unwrap();
    }
    let mut command = Command::new("python3");
    let model = folder.join(format!("{name}.xml"));
    let run = command.arg(repository("tests/mujoco/scene.py")).arg(model).args(arguments).output().unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&run.stdout).unwrap()
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| value[i].as_f64().unwrap()))
}

#[test]
fn fingertips_take_the_object_from_the_table_in_mujoco() {
    if !mujoco_is_there() {
        return;
    }
    let scene = Scene::read(repository("crates/recon-cli/scenes/pick-up.toml")).unwrap();
    let end = run("pick_up", &scene, &["1.0"]);
    let forces = |palm: &str| vector(&end["forces"][palm]);
    assert!(end["forces"]["palm_1"].is_null(), "the table still holds it");
    let tips = ["palm_2", "palm_3", "palm_4"].map(forces);
    // What holds it is its weight; the squeeze is 3 mm of 1500 N/m.
    assert!((tips.iter().sum::<DVec3>() - DVec3::Z * 0.981).length() < 1e-2, "{tips:?}");
    for (i, tip) in tips.iter().enumerate() {
        assert!((tip.truncate().length() - 4.5).abs() < 0.1, "{tips:?}");
        assert!(tip.z < 0.8 * tip.truncate().length());
        // The springs give way by what they carry.
        let palm = format!("palm_{}", i + 2);
        let moved = vector(&end["end"][&palm]) - vector(&end["start"][&palm]);
        assert!((moved.z - (0.03 - tip.z / 1500.0)).abs() < 1e-5, "{palm} {moved}");
    }
    let height = end["end"]["pick_up"][2].as_f64().unwrap();
    assert!((height - 0.055).abs() < 5e-4, "{height}");
}

#[test]
fn a_spring_pulls_as_its_matrix_says_and_a_turned_palm_stands_as_its_law() {
    if !mujoco_is_there() {
        return;
    }
    let scene = r#"
gravity = 9.81
[object]
mass = 0.1
principal_moments = [4e-5, 4e-5, 4e-5]
[[palm]]
kind = "sphere"
radius = 0.01
friction = 0.3
pose = { position = [0.3, 0.0, 0.0], orientation = [0.6, 0.0, 0.8, 0.0] }
spring = { stiffness = [[250, 30, -20], [30, 160, 24], [-20, 24, 240]], damping = 2.0, mass = 0.02 }
[[palm]]
kind = "flat"
friction = 0.3
pose = { position = [0.0, 0.0, -0.5] }
motion = [
  { turn = [0, 0, 1], pivot = [0.1, 0.2, 0.0], law = { kind = "steady", rate = 0.5 } },
  { turn = [1, 0, 0], pivot = [0.0, 0.3, 0.0], law = { kind = "sinusoid", amplitude = 0.4, frequency = 3.0, phase = 0.5 } },
  { shift = [0, 1, 0], law = { kind = "ramp", height = 0.2, start = 0.1, duration = 0.5 } },
]
[simulation]
duration = 1.0
position = [0.0, 0.0, 5.0]
in_flight = true
shape = { kind = "sphere", radius = 0.03 }
"#;
    let scene = Scene::parse(scene).unwrap();
    let end = run("parts", &scene, &["0.8", "--push", "palm_1", "1", "2", "-3"]);
    let moved = vector(&end["end"]["palm_1"]) - vector(&end["start"]["palm_1"]);
    let stiffness =
        glam::DMat3::from_cols_array(&[250.0, 30.0, -20.0, 30.0, 160.0, 24.0, -20.0, 24.0, 240.0]);
    let expected = stiffness.inverse() * DVec3::new(1.0, 2.0, -3.0);
    // Oscillations have died by exp(-50 0.8).
    assert!((moved - expected).length() < 1e-9, "{moved} {expected}");
    let world = scene.contact_scene().unwrap();
    let recon::object_dynamics::PalmDrive::Prescribed(motion) = &world.palms()[1].drive else {
        unreachable!()
    };
    let state = motion.at(end["seconds"].as_f64().unwrap());
    let place = vector(&end["end"]["palm_2"]);
    assert!((place - state.p_WP).length() < 1e-9, "{place} {}", state.p_WP);
    let turn = &end["turn"]["palm_2"];
    let q = glam::DQuat::from_xyzw(
        turn[1].as_f64().unwrap(),
        turn[2].as_f64().unwrap(),
        turn[3].as_f64().unwrap(),
        turn[0].as_f64().unwrap(),
    );
    assert!(
        (q * DVec3::Z - state.R_WP.z_axis).length() < 1e-9
            && (q * DVec3::X - state.R_WP.x_axis).length() < 1e-9
    );
}
