use crate::scene::{Scene, SceneErrorKind as Kind};
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{PalmSurface, SurfaceError, SurfaceMotion};
use recon::object_dynamics::{ContactSceneError, DriveError, PalmDrive};

/// One palm of each kind and drive.
const GOOD: &str = r#"
gravity = 9.81

[object]
mass = 0.2
principal_moments = [1.0e-4, 1.36e-4, 1.64e-4]

[sensors]
contact_std = 2e-4
force_share = 0.02
impulse_std = 1e-5
torque_std = 1e-3
contact_off_palm = 1e-3

[palms]
friction = 0.25

[[palm]]
kind = "flat"
friction = 0.3
pose = { position = [0.0, 0.0, -0.03] }
motion = [
  { turn = [0.0, 2.0, 0.0], pivot = [0.1, 0.0, 0.0], law = { kind = "ramp", height = 0.2, start = 0.4, duration = 0.5 } },
  { shift = [0.0, 0.0, 1.0], law = { kind = "sinusoid", amplitude = 0.01, frequency = 6.0 } },
]

[[palm]]
kind = "sphere"
radius = 0.012
pose = { position = [0.0, 0.0, 0.1], normal = [0.0, 0.0, -1.0] }
spring = { stiffness = [[2500, 1, 0], [1, 1500, 235], [0, 235, 2440]], damping = [8, 9, 10], mass = 0.02 }

[[palm]]
kind = "cup"
radius = 0.12
pose = { position = [0.0, 0.0, 1.0], orientation = [0.6, 0.8, 0.0, 0.0] }

[[palm]]
kind = "cylinder"
radius = 0.02
pose = { position = [0.5, 0.0, 0.0], axis = [0.0, 3.0, 0.0] }
motor = { pivot = [0.6, 0.0, 0.0], axis = [0.0, 1.0, 0.0], inertia = 1e-3, law = { kind = "constant", value = 0.05 } }

[simulation]
duration = 0.5
position = [0.0, 0.0, 0.001]
velocity = [0.1, 0.0, 0.0]
shape = { kind = "ellipsoid", semi_axes = [0.05, 0.04, 0.03] }
"#;

/// The good scene with one piece of text replaced.
fn with(from: &str, to: &str) -> Result<Scene, Kind> {
    assert!(GOOD.contains(from), "{from}");
    Scene::parse(&GOOD.replacen(from, to, 1))
}

#[test]
fn palms_of_every_kind_and_drive_are_read() {
    let scene = Scene::parse(GOOD).unwrap();
    let world = scene.contact_scene().unwrap();
    let [flat, tip, cup, cylinder] = world.palms() else { panic!("four palms") };
    assert_eq!((flat.surface, flat.friction), (PalmSurface::Plane, 0.3));
    // Palms that say nothing of friction have that of all.
    assert_eq!((tip.surface, tip.friction), (PalmSurface::Sphere { radius: 0.012 }, 0.25));
    let PalmDrive::Prescribed(motion) = &flat.drive else { panic!("{:?}", flat.drive) };
    // After the ramp it has turned about the pivot, and then it shakes.
    let state = motion.at(1.0);
    let (arm, turn) = (DVec3::new(-0.1, 0.0, -0.03), DQuat::from_rotation_y(0.2));
    let expected = DVec3::new(0.1, 0.0, 0.01 * 6.0_f64.sin()) + turn * arm;
    assert!((state.p_WP - expected).length() < 1e-15, "{}", state.p_WP);
    assert!((state.R_WP.z_axis - turn * DVec3::Z).length() < 1e-15);
    let PalmDrive::Spring(spring) = &tip.drive else { panic!("{:?}", tip.drive) };
    assert_eq!(spring.stiffness.col(2), DVec3::new(0.0, 235.0, 2440.0));
    assert_eq!(spring.damping, DMat3::from_diagonal(DVec3::new(8.0, 9.0, 10.0)));
    assert!((spring.command.at(0.0).R_WP.z_axis + DVec3::Z).length() < 1e-15);
    let PalmDrive::Prescribed(motion) = &cup.drive else { panic!("{:?}", cup.drive) };
    assert!(motion.is_immobile());
    assert!((motion.at(0.0).R_WP.z_axis - DVec3::new(0.0, -0.96, -0.28)).length() < 1e-15);
    let PalmDrive::Torque(motor) = &cylinder.drive else { panic!("{:?}", cylinder.drive) };
    assert!((motor.pose.R_WP * DVec3::X - DVec3::Y).length() < 1e-15 && motor.torque.at(0.1)[0] == 0.05);
    let (start, times) = scene.contact_start().unwrap();
    assert_eq!((start.body.p_WCm.z, start.body.v_WCm.x, start.in_flight), (0.001, 0.1, false));
    assert_eq!((times.duration, times.rate), (0.5, 1000.0));
    let noise = scene.sensors.contact_noise();
    assert_eq!((noise.contact, noise.force.share, noise.force.fixed), (2e-4, 0.02, 0.0));
    assert_eq!((noise.impulse.fixed, noise.torque), (1e-5, 1e-3));
}

#[test]
fn logs_need_less_than_simulations() {
    let scene = Scene::parse("gravity = 9.81\n[[palm]]\nkind = \"cup\"\nradius = 0.1").unwrap();
    let setups = scene.palm_setups().unwrap();
    assert_eq!(setups.len(), 1);
    assert_eq!((setups[0].friction, setups[0].pose, setups[0].largest_offset), (None, None, f64::INFINITY));
    assert!(matches!(scene.contact_scene(), Err(Kind::Missing { what: "[simulation]", .. })));
    let setups = Scene::parse(GOOD).unwrap().palm_setups().unwrap();
    // A palm that moves has no pose of its own.
    assert_eq!([0, 1, 2, 3].map(|i| setups[i].pose.is_some()), [false, false, true, false]);
    assert_eq!(setups[2].largest_offset, 1e-3);
    // What its motor turns a palm about.
    assert!(setups[..3].iter().all(|setup| setup.hinge.is_none()));
    let hinge = setups[3].hinge.unwrap();
    assert_eq!((hinge.pivot, hinge.axis.get(), hinge.inertia), (DVec3::X * 0.6, DVec3::Y, 1e-3));
    assert!(Scene::parse("gravity = 9.81").unwrap().palm_setups().is_none());
    let no_friction = with("[palms]\nfriction = 0.25\n", "").unwrap().contact_scene();
    assert!(matches!(no_friction, Err(Kind::MissingOfPalm { palm: 2, key: "friction" })));
    let no_mass = with("mass = 0.2\nprincipal", "principal").unwrap().contact_scene();
    assert!(matches!(no_mass, Err(Kind::Missing { what: "mass or inertia of the object", .. })));
    let nowhere = with("position = [0.0, 0.0, 0.001]\n", "").unwrap().contact_start();
    assert!(matches!(nowhere, Err(Kind::Missing { what: "`simulation.position`", .. })));
}

#[test]
fn palms_that_cannot_be_are_named() {
    let value = |from, to| match with(from, to) {
        Err(Kind::Value { key, .. }) => key,
        other => format!("{other:?}"),
    };
    assert_eq!(value("friction = 0.3", "friction = -0.3"), "palm[1].friction");
    assert_eq!(value("kind = \"flat\"", "kind = \"flat\"\nradius = 1.0"), "palm[1].radius");
    assert_eq!(value("force_share = 0.02", "force_share = -1"), "sensors.force_share");
    let radius = with("radius = 0.012", "radius = 0.0");
    let zero = SurfaceError::Radius { radius: 0.0 };
    assert!(matches!(radius, Err(Kind::PalmSurface { palm: 2, source }) if source == zero));
    assert!(matches!(with("radius = 0.012\n", ""), Err(Kind::MissingOfPalm { palm: 2, key: "radius" })));
    let turned = with("[0.6, 0.8, 0.0, 0.0]", "[0.6, 0.9, 0.0, 0.0]");
    assert!(matches!(turned, Err(Kind::PalmSurface { palm: 3, source: SurfaceError::NoRotation { .. } })));
    let normal = with("normal = [0.0, 0.0, -1.0]", "normal = [0.0, 0.0, 0.0]").unwrap_err();
    assert!(matches!(&normal, Kind::Direction { key, .. } if key == "palm[2].pose.normal"), "{normal}");
    let soft = with("stiffness = [[2500, 1, 0], [1, 1500, 235], [0, 235, 2440]], ", "");
    assert!(matches!(soft, Err(Kind::MissingOfPalm { palm: 2, key: "spring.stiffness" })));
    let skew = with("[1, 1500, 235]", "[2, 1500, 235]");
    let unsymmetric =
        |source| matches!(source, DriveError::Spring { what: "stiffness", problem: "not symmetric" });
    assert!(matches!(skew, Err(Kind::PalmDrive { palm: 2, source }) if unsymmetric(source)));
    let ramp = with("duration = 0.5 }", "duration = 0.0 }");
    assert!(matches!(ramp, Err(Kind::PalmDrive { palm: 1, source: DriveError::Motion(_) })));
    let small = with("radius = 0.12", "radius = 0.06").unwrap().contact_scene().err();
    let Some(Kind::Contacts(ContactSceneError::Surface { palm: 3, source })) = small else {
        panic!("{small:?}")
    };
    let too_small =
        |radius: f64, largest: f64| radius == 0.06 && (largest - 0.05 * 0.05 / 0.03).abs() < 1e-15;
    assert!(
        matches!(source, SurfaceError::CupTooSmall { radius, largest } if too_small(radius, largest)),
        "{source}"
    );
    let two_more = "[[palm]]\nkind = \"flat\"\npose = { position = [0, 0, 0] }\n\n".repeat(2);
    let six = with("[simulation]", &format!("{two_more}[simulation]")).unwrap().contact_scene().err();
    assert!(matches!(six, Some(Kind::Contacts(ContactSceneError::PalmCount { found: 6 }))), "{six:?}");
}

#[test]
fn what_is_said_twice_or_not_at_all_is_named() {
    let keys = |from, to| match with(from, to) {
        Err(Kind::Ambiguous { keys }) => keys.join(" "),
        other => format!("{other:?}"),
    };
    let motion = "motion = [{ shift = [1, 0, 0], law = { kind = \"steady\", rate = 0.1 } }]\nmotor =";
    assert_eq!(keys("motor =", motion), "`palm[4].motion` `palm[4].motor`");
    let spring = "spring = { stiffness = 1.0, mass = 1.0 }\nmotor =";
    assert_eq!(keys("motor =", spring), "`palm[4].spring` `palm[4].motor`");
    assert_eq!(
        keys("axis = [0.0, 3.0, 0.0]", "axis = [1, 0, 0], normal = [1, 0, 0]"),
        "`palm[4].pose.normal` `palm[4].pose.axis`"
    );
    assert_eq!(
        keys("turn = [0.0, 2.0, 0.0]", "turn = [0, 2, 0], shift = [1, 0, 0]"),
        "`palm[1].motion[1].shift` `palm[1].motion[1].turn`"
    );
    assert_eq!(
        keys("duration = 0.5\nposition", "duration = 0.5\npalms = []\nposition"),
        "[[palm]] `simulation.palms`"
    );
    assert_eq!(
        keys("friction = 0.3\n", "friction = 0.3\nposes = \"a.csv\"\n"),
        "`palm[1].pose` `palm[1].poses`"
    );
    let no_pose = with("pose = { position = [0.0, 0.0, 0.1], normal = [0.0, 0.0, -1.0] }\n", "");
    assert!(matches!(no_pose, Err(Kind::MissingOfPalm { palm: 2, key: "pose" })));
    let no_pivot = with("pivot = [0.1, 0.0, 0.0], ", "").unwrap_err().to_string();
    assert!(no_pivot.contains("pivot") && no_pivot.contains("first"), "{no_pivot}");
    let unknown = with("friction = 0.3", "fricton = 0.3").unwrap_err().to_string();
    assert!(unknown.contains("fricton") && unknown.contains("`friction`"), "{unknown}");
    let three = "gravity = 1.0\n[simulation]\nduration = 1.0\nshape = { kind = \"sphere\", radius = 1.0 }\n";
    assert!(matches!(Scene::parse(three), Err(Kind::Missing { what: "any palm", .. })));
    let placed = Scene::parse(&format!("{three}position = [0, 0, 0]\npalms = []"));
    assert!(matches!(placed, Err(Kind::OtherPalms { key: "simulation.position", .. })));
}

#[test]
fn a_table_of_poses_lies_beside_the_scene() {
    let folder = std::env::temp_dir().join(format!("recon-poses-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let pose = "pose = { position = [0.0, 0.0, 1.0], orientation = [0.6, 0.8, 0.0, 0.0] }";
    let path = folder.join("scene.toml");
    std::fs::write(&path, GOOD.replace(pose, "poses = \"cup.csv\"")).unwrap();
    let read = |rows: &str| {
        std::fs::write(folder.join("cup.csv"), format!("t,Px,Py,Pz,Qw,Qx,Qy,Qz\n{rows}")).unwrap();
        Scene::read(&path).map_err(|error| error.to_string())
    };
    let row = |t: f64, q: &str| format!("{t},{},0,1,{q}\n", 2.0 * t);
    let good: String = [0.0, 0.1, 0.2, 0.3].map(|t| row(t, "1,0,0,0")).concat();
    let palms = read(&good).unwrap().palms.unwrap();
    let Some(PalmDrive::Prescribed(SurfaceMotion::Table(table))) = &palms[2].drive else {
        panic!("{palms:?}")
    };
    assert!((table.at(0.15).v_WP - DVec3::X * 2.0).length() < 1e-12);
    let turned = read(&good.replacen("1,0,0,0", "1,1,0,0", 1)).unwrap_err();
    assert!(turned.contains("palm[3].poses") && turned.contains("cup.csv: line 2"), "{turned}");
    let few = read(&row(0.0, "1,0,0,0")).unwrap_err();
    assert!(few.contains("fewer than 4"), "{few}");
    std::fs::remove_file(folder.join("cup.csv")).unwrap();
    assert!(Scene::read(&path).unwrap_err().to_string().contains("cup.csv: cannot be read"));
    std::fs::remove_dir_all(&folder).unwrap();
}
