use super::*;
use crate::{Scene, SceneErrorKind};
use glam::DMat3;
use recon::contact_kinematics::{PalmSurface, PoseTable, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{PalmDrive, PalmSpring};

const PICK_UP: &str = include_str!("../../../../recon-cli/scenes/pick-up.toml");

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
        r#"friction="0.5 0.005 0.0001""#,
        r#"<geom name="palm_3" type="sphere" size="0.012""#,
        r#"friction="0.8 0.005 0.0001""#,
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
    let motor = "kind = \"cylinder\"\nradius = 0.02\nmotor = { pivot = [0.2, 0, 0], axis = [0, 1, 0], inertia = 1e-3, \
                 angle = 0.1, law = { kind = \"constant\", value = 0.05 } }\npose = { position = [0.5, 0.0, 0.0] }";
    let table = "kind = \"flat\"\nfriction = 0.5\npose = { position = [0.0, 0.0, 0.0] }";
    let scene = PICK_UP.replace(r#"kind = "ellipsoid","#, shape).replace(table, motor);
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
fn what_mujoco_does_not_know_is_refused_by_name() {
    let mut cup = model();
    cup.palms[2].surface = PalmSurface::Cup { radius: 1.0 };
    assert_eq!(cup.files(), Err(ExportError::Cup { palm: 3 }));
    let pose = |x: f64| SurfacePose { p_WP: DVec3::X * x, R_WP: DQuat::IDENTITY };
    let poses: Vec<_> = [0.0, 1.0, 2.0, 3.0].map(|t| (t, pose(t))).to_vec();
    let mut table = model();
    table.palms[0].drive = PalmDrive::Prescribed(SurfaceMotion::Table(PoseTable::new(&poses).unwrap()));
    assert_eq!(table.files(), Err(ExportError::PoseTable { palm: 1 }));
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
