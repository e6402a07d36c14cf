use super::*;
use crate::Scene;
use SceneErrorKind as Kind;
use glam::DVec2;
use recon::contact_kinematics::planar::{MotionPart, PalmSurface};

const GOOD: &str = r#"
plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 1e-4
[sensors]
force_share = 0.02
[palms]
friction = 0.3
[[palm]]
kind = "line"
pose = { position = [0.0, 0.0], angle_deg = 90.0 }
motion = [{ pivot = [0.1, 0.0], law = { kind = "steady", rate = 0.1 } }, { shift = [0.0, 2.0], law = { kind = "constant", value = 0.5 } }]
[[palm]]
kind = "arc"
radius = 0.012
friction = 0.8
pose = { position = [0.0, 0.2] }
[simulation]
duration = 0.5
sample_rate = 100.0
position = [0.0, 0.05]
velocity = [0.1, 0.0]
touches = [2]
seed = 7
shape = { kind = "ellipse", semi_axes = [0.05, 0.04], centre = [0.001, 0.0] }
"#;

fn with(from: &str, to: &str) -> Result<PlanarScene, Kind> {
    assert!(GOOD.contains(from), "{from}");
    PlanarScene::parse(&GOOD.replacen(from, to, 1))
}

#[test]
fn what_stands_in_the_file_is_taken() {
    let scene = PlanarScene::parse(GOOD).unwrap();
    let [line, arc] = scene.world.palms() else { panic!("two palms") };
    assert_eq!((line.surface, line.friction), (PalmSurface::Line, 0.3));
    assert_eq!((arc.surface, arc.friction), (PalmSurface::Arc { radius: 0.012 }, 0.8));
    assert!((line.motion.pose.angle - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    // Turned about the pivot by 0.2 rad after 2 s, then shifted half a metre up.
    let state = line.motion.at(2.0);
    let expected = DVec2::X * 0.1 - DVec2::from_angle(0.2) * 0.1 + DVec2::Y * 0.5;
    assert!((state.p_WP - expected).length() < 1e-15, "{}", state.p_WP);
    assert!(matches!(line.motion.parts[1], MotionPart::Shift { .. }));
    assert_eq!((scene.start.p_WCm, scene.start.v_WCm.x, scene.touches), (DVec2::Y * 0.05, 0.1, vec![1]));
    assert_eq!((scene.times.duration, scene.times.rate, scene.seed), (0.5, 100.0, 7));
    let object = scene.world.object();
    assert_eq!((object.mass.mass(), object.mass.inertia(), object.gravity), (0.2, 1e-4, 9.81));
    assert!((object.shape.jet(0.0).r - 0.051).abs() < 1e-15);
    assert_eq!(PlanarScene::parse(GOOD).unwrap().noise().force.share, 0.02);
    for shape in [
        r#"{ kind = "circle", radius = 0.05 }"#,
        r#"{ kind = "fourier", cosines = [0.05, 0.0, 0.002], sines = [0.0, 0.0, 0.001] }"#,
        r#"{ kind = "polygon", corners = [[0, 0], [0.1, 0], [0, 0.1]], corner_radius = 0.01, edge_half_angle = 0.1 }"#,
    ] {
        let bounds = with(r#"{ kind = "ellipse", semi_axes = [0.05, 0.04], centre = [0.001, 0.0] }"#, shape)
            .map(|scene| scene.world.object().shape.radius_bounds());
        assert!(bounds.as_ref().is_ok_and(|b| b.min > 0.0), "{shape}: {bounds:?}");
    }
    let gyration = with("inertia = 1e-4", "radius_of_gyration = 0.1").unwrap();
    assert!((gyration.world.object().mass.inertia() - 0.002).abs() < 1e-17);
}

#[test]
fn bad_keys_are_named() {
    let key = |from, to| match with(from, to) {
        Err(Kind::Value { key, .. }) => key,
        other => panic!("{to}: {other:?}"),
    };
    assert_eq!(key("gravity = 9.81", "gravity = -1.0"), "gravity");
    assert_eq!(key("mass = 0.2", "mass = 0.0"), "object.mass");
    assert_eq!(key("friction = 0.8", "friction = -0.1"), "palm[2].friction");
    assert_eq!(key("radius = 0.012", "radius = nan"), "palm[2].radius");
    assert_eq!(key("kind = \"line\"", "kind = \"line\"\nradius = 1.0"), "palm[1].radius");
    assert_eq!(key("position = [0.0, 0.2]", "position = [0.0, inf]"), "palm[2].pose.position[1]");
    assert_eq!(key("shift = [0.0, 2.0]", "shift = [0.0, 0.0]"), "palm[1].motion[2].shift (its length)");
    assert_eq!(key("touches = [2]", "touches = [2, 3]"), "simulation.touches[1]");
    assert_eq!(key("touches = [2]", "touches = [2, 2]"), "simulation.touches[1]");
    assert_eq!(key("touches = [2]", "touches = [0]"), "simulation.touches[0]");
    assert_eq!(key("duration = 0.5", "duration = 1e9"), "simulation.duration");
    let text = |from, to| with(from, to).unwrap_err().to_string();
    assert!(text("friction = 0.3\n", "").contains("`palm[1].friction` is not given"));
    assert!(text("radius = 0.012\n", "").contains("`palm[2].radius` is not given"));
    assert!(text("inertia = 1e-4\n", "").contains("`object.inertia` is not given"));
    assert!(
        text("shift = [0.0, 2.0]", "shift = [0.0, 2.0], pivot = [0.0, 0.0]")
            .contains("`palm[1].motion[2].pivot`")
    );
    assert!(text("angle_deg = 90.0", "angle_deg = 90.0, angle = 1.0").contains("`palm[1].pose.angle_deg`"));
    assert!(text("semi_axes = [0.05, 0.04]", "semi_axes = [0.05, -0.04]").contains("`simulation.shape`: "));
    assert!(text("touches = [2]\n", "").contains("missing field `touches`"));
    assert!(text("kind = \"arc\"", "kind = \"cup\"").contains("palm 2: "), "a cup smaller than the object");
}

#[test]
fn plane_and_space_are_told_apart() {
    assert!(matches!(Scene::parse(GOOD), Err(Kind::InPlane)));
    assert!(Scene::parse(GOOD).unwrap_err().to_string().contains("recon simulate"));
    assert!(matches!(
        with("plane = true", "plane = false"),
        Err(Kind::Missing { what: "`plane = true`", .. })
    ));
    assert!(PlanarScene::parse("gravity = 9.81").is_err());
}

/// A log on one palm needs the size of a body of which nothing else need be known.
#[test]
fn a_size_may_be_stated_without_a_mass() {
    let object =
        |table: &str| PlanarScene::parse_known(&format!("plane = true\ngravity = 9.81\n[object]\n{table}"));
    let known = object("size = 0.05").unwrap();
    assert_eq!((known.size, known.mass), (Some(0.05), None));
    assert!(object("size = 0.0").unwrap_err().to_string().contains("object.size"));
    assert!(object("inertia = 1.0").unwrap_err().to_string().contains("object.mass"));
}
