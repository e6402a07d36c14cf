use super::*;
use crate::{Scene, SceneErrorKind};
use glam::DMat3;
use recon::contact_kinematics::{PalmSurface, PoseTable, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{PalmDrive, PalmSpring};

const PICK_UP: &str = include_str!("../../../scenes/pick-up.toml");

fn model() -> SceneModel {
    SceneModel::new("pick_up", &Scene::parse(PICK_UP).unwrap()).unwrap()
}

fn text(model: &SceneModel) -> String {
    String::from_utf8(model.files().unwrap()[0].contents.clone()).unwrap()
}

#[test]
fn palms_have_their_friction_springs_and_joints() {
    let mjcf = text(&model());
    for part in [
        r#"<option gravity="0 0 -9.81""#,
        r#"<geom name="pick_up" type="ellipsoid""#,
        r#"<geom name="palm_1" type="plane" size="0 0 1""#,
        r#"<pair geom1="palm_1" geom2="pick_up" condim="3" friction="0.5 0.5 "#,
        r#"<geom name="palm_3" type="sphere" size="0.012""#,
        r#"<pair geom1="palm_3" geom2="pick_up" condim="3" friction="0.8 0.8 "#,
        r#"<joint name="palm_4_z" type="slide" axis="0.0 0.0 1.0" stiffness="1500.0" damping="11.0""#,
        r#"<numeric name="palm_2_1_ramp" data="0.004 0.05 0.25"/>"#,
        r#"mass="0.1" fullinertia="3.05e-5 3.7e-5 4.25e-5 0.0 0.0 0.0""#,
        r#"qpos="0.0 0.0 0.025 1.0 0.0 0.0 0.0 0.0"#,
    ] {
        assert!(mjcf.contains(part), "{part}\n{mjcf}");
    }
    // What moves last is outermost: its joint comes first, after the springs.
    let place = |name: &str| mjcf.find(&format!("<joint name=\"{name}\"")).unwrap();
    assert!(place("palm_2_z") < place("palm_2_2") && place("palm_2_2") < place("palm_2_1"));
    assert_eq!(mjcf.matches("<joint ").count(), 15);
}

#[test]
fn other_shapes_become_meshes_and_motors_actuators() {
    let shape = r#"kind = "ellipsoid-plus-ball", radius = 0.005,"#;
    let motor = "kind = \"cylinder\"\nradius = 0.02\nmotor = { pivot = [0.2, 0, -0.5], axis = [0, 1, 0], inertia = 1e-3, \
                 angle = 0.1, law = { kind = \"constant\", value = 0.05 } }\npose = { position = [0.5, 0.0, -0.5] }";
    let table = "kind = \"flat\"\nfriction = 0.5\npose = { position = [0.0, 0.0, 0.0] }";
    let scene = PICK_UP.replace(r#"kind = "ellipsoid","#, shape).replace(table, motor);
    let scene =
        scene.replace("position = [0.0, 0.0, 0.025] #", "in_flight = true\nposition = [0.0, 0.0, 0.5] #");
    let model = SceneModel::new("other", &Scene::parse(&scene).unwrap()).unwrap();
    let files = model.files().unwrap();
    assert_eq!(files.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["other.xml", "other_shape.obj"]);
    let mjcf = text(&model);
    for part in [
        r#"<mesh name="other_shape" file="other_shape.obj""#,
        r#"type="cylinder" size="0.02 "#,
        r#"<joint name="palm_1_motor" type="hinge" pos="-0.3 0.0 0.0" axis="0.0 1.0 0.0""#,
        r#"armature="0.001""#,
        r#"<motor name="palm_1_motor" joint="palm_1_motor"/>"#,
        r#"ctrl="0.05""#,
    ] {
        assert!(mjcf.contains(part), "{part}\n{mjcf}");
    }
}

#[test]
fn a_cup_becomes_boxes_outside_of_it() {
    let mut cup = model();
    cup.palms[2].surface = PalmSurface::Cup { radius: 0.1 };
    let mjcf = text(&cup);
    let boxes: Vec<&str> = mjcf.lines().filter(|line| line.contains(r#"<geom name="palm_3_"#)).collect();
    assert!(boxes.len() > 2000 && mjcf.matches(r#"<pair geom1="palm_3_"#).count() == boxes.len());
    for line in boxes {
        let vector = |key: &str| {
            let (_, after) = line.split_once(&format!("{key}=\"")).unwrap();
            let numbers: Vec<f64> =
                after.split('"').next().unwrap().split(' ').map(|v| v.parse().unwrap()).collect();
            DVec3::from_slice(&numbers)
        };
        // Its face stands across the radius to its middle, at the radius.
        let (pos, normal) = (vector("pos"), vector("zaxis"));
        assert!((pos - normal * (0.1 + vector("size").z)).length() < 1e-15);
    }
    // 1 / cos(3 degrees / sqrt 2) - 1 of the radius.
    assert!(mjcf.contains("palm_3 is a cup") && mjcf.contains("6.9e-5 m outside"), "{mjcf}");
}

#[test]
fn a_table_of_poses_becomes_a_file_of_steps() {
    let pose = |x: f64| SurfacePose { p_WP: DVec3::X * x, R_WP: DQuat::from_rotation_z(x) };
    let poses: Vec<_> = [0.0, 0.1, 0.2, 0.3].map(|t| (t, pose(t))).to_vec();
    let table = SurfaceMotion::Table(PoseTable::new(&poses).unwrap());
    let end = table.at(0.3);
    let mut model = model();
    model.palms[0].drive = PalmDrive::Prescribed(table.clone());
    let PalmDrive::Spring(spring) = &mut model.palms[1].drive else { unreachable!() };
    spring.command = table;
    let files = model.files().unwrap();
    let names: Vec<_> = files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["pick_up.xml", "pick_up_palm_1.csv", "pick_up_palm_2.csv"]);
    let rows = String::from_utf8(files[1].contents.clone()).unwrap();
    // 0.3 s at 5 kHz.
    assert_eq!(rows.lines().count(), 1 + 1501);
    let last: Vec<f64> = rows.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    // Time, position, turn, and the rates of the shift and the turn about an axis that both frames have.
    let w = end.w_WP.z;
    for (column, value) in [(0, 0.3), (1, 0.3), (4, 0.15_f64.cos()), (8, end.v_WP.x), (13, w)] {
        assert!((last[column] - value).abs() < 1e-9, "{column} {last:?}");
    }
    let mjcf = text(&model);
    for part in [
        r#"<text name="palm_1_path" data="pick_up_palm_1.csv"/>"#,
        r#"<joint name="palm_1_path_turn" type="ball""#,
        // Six rates are the most that a body may have.
        r#"<body name="palm_2_mount" gravcomp="1">"#,
    ] {
        assert!(mjcf.contains(part), "{part}\n{mjcf}");
    }
}

#[test]
fn what_mujoco_does_not_know_is_refused_by_name() {
    let pose = |x: f64| SurfacePose { p_WP: DVec3::X * x, R_WP: DQuat::IDENTITY };
    let mut damped = model();
    damped.palms[1].drive = PalmDrive::Spring(PalmSpring {
        command: SurfaceMotion::immobile(pose(0.0)),
        stiffness: DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0)),
        damping: DMat3::from_cols_array(&[1.0, 0.1, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0, 1.0]),
        mass: 0.1,
    });
    assert_eq!(damped.files(), Err(ExportError::Damping { palm: 2, coupling: 0.1 }));
    let unplaced = Scene::parse(&PICK_UP.replace("position = [0.0, 0.0, 0.025]", "")).unwrap();
    assert!(matches!(SceneModel::new("none", &unplaced), Err(SceneErrorKind::Missing { .. })));
}

#[test]
fn a_start_that_cannot_be_is_no_model() {
    let refused = |from: &str, to: &str| {
        let scene = Scene::parse(&PICK_UP.replacen(from, to, 1)).unwrap();
        SceneModel::new("refused", &scene).unwrap_err().to_string()
    };
    let sunk = refused("position = [0.0, 0.0, 0.025] #", "position = [0.0, 0.0, 0.02] #");
    assert!(sunk.contains("penetrates palm 1 by 5.000e-3 m"), "{sunk}");
    let lifted = refused("position = [0.0, 0.0, 0.025] #", "position = [0.0, 0.0, 0.026] #");
    assert!(lifted.contains("gap of"), "{lifted}");
    let overlap = refused("position = [-0.0426278, -0.0198061, 0.025]", "position = [0.0, 0.053, 0.025]");
    assert!(overlap.contains("overlap"), "{overlap}");
}
