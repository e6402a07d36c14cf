use super::{KnownInertia, Scene, SceneErrorKind as Kind, Shape};
use glam::DVec3;
use recon::contact_kinematics::PalmError;
use recon::object_dynamics::MassError;

const GOOD: &str = r#"
gravity = 9.81

[object]
mass = 1.0
principal_moments = [1.0, 1.45, 2.05]
curvature_radii = [0.4, 6.25]

[sensors]
contact_std = 0.001
force_std = 0.05
sample_rate = 1000

[palms]
inertia = [0.1, 0.1, 0.1]
friction = 0.0

[simulation]
duration = 4.2
angular_velocity = [0.0, 0.3, 0.3]
shape = { kind = "ellipsoid", semi_axes = [2.5, 2.0, 1.0] }
palms = [
  { azimuth_deg = 270, slope_deg = 60 },
  { azimuth_deg = 30, slope_deg = 60, sinusoid = { amplitude = 0.05, frequency = 3.0 } },
  { azimuth_deg = 150, slope = 1.0471975511965976 },
]
"#;

#[test]
fn good_scene_is_read() {
    let scene = Scene::parse(GOOD).unwrap();
    assert_eq!(scene.inertia, Some(KnownInertia::PrincipalMoments(DVec3::new(1.0, 1.45, 2.05))));
    let simulation = scene.simulation.unwrap();
    assert_eq!(simulation.shape, Shape::Ellipsoid { semi_axes: DVec3::new(2.5, 2.0, 1.0) });
    assert_eq!(simulation.sample_rate, 1000.0);
    let palms = simulation.palms.unwrap();
    let n = palms[0].at(0.0).frame.n;
    assert!(
        (n - DVec3::new(0.0, 0.75_f64.sqrt(), 0.5)).length() < 1e-15,
        "normal of palm 1 of the Fig. 5 logs"
    );
    assert!(!palms[1].is_immobile() && palms[2].is_immobile());
}

#[test]
fn gravity_alone_is_a_scene_and_nothing_less_is() {
    let scene = Scene::parse("gravity = 9.81").unwrap();
    assert!(scene.mass_properties().unwrap().is_none() && scene.simulation.is_none());
    let error = Scene::parse("").unwrap_err();
    assert!(error.to_string().contains("gravity"), "{error}");
}

/// The good scene with one piece of text replaced.
fn with(from: &str, to: &str) -> Result<Scene, Kind> {
    assert!(GOOD.contains(from));
    Scene::parse(&GOOD.replacen(from, to, 1))
}

#[test]
fn unknown_keys_and_wrong_types_are_shown_in_place() {
    let unknown = with("mass = 1.0", "mas = 1.0").unwrap_err().to_string();
    assert!(
        unknown.contains("mas = 1.0") && unknown.contains("`mass`") && unknown.contains("line 5"),
        "{unknown}"
    );
    let kind = with("gravity = 9.81", "gravity = \"9.81\"").unwrap_err().to_string();
    assert!(kind.contains("line 2"), "{kind}");
    assert!(matches!(with("\"ellipsoid\"", "\"cube\""), Err(Kind::Toml(_))));
    let typed = with("mass = 1.0", "mass = \"heavy\"").unwrap_err().to_string();
    assert!(typed.contains("mass = \"heavy\"") && typed.contains("expected a number"), "{typed}");
}

#[test]
fn impossible_bodies_are_named() {
    assert!(
        matches!(with("mass = 1.0", "mass = -1.0"), Err(Kind::Value { key, .. }) if key == "object.mass")
    );
    let moments = |m: &str| with("[1.0, 1.45, 2.05]", m);
    assert!(matches!(moments("[1.0, 1.45, 3.05]"), Err(Kind::Mass(MassError::Triangle { .. }))));
    assert!(matches!(moments("[-1.0, 1.45, 2.05]"), Err(Kind::Mass(MassError::NotPositive { .. }))));
    let both = with("mass = 1.0", "radii_of_gyration = [1.0, 1.0, 1.0]");
    assert!(matches!(both, Err(Kind::Ambiguous { keys }) if keys.len() == 2));
    let skew = with("principal_moments = [1.0, 1.45, 2.05]", "inertia = [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]");
    assert!(matches!(skew, Err(Kind::Mass(MassError::NotSymmetric { .. }))), "{skew:?}");
}

#[test]
fn numbers_out_of_range_are_named() {
    let key_of = |from, to| match with(from, to) {
        Err(Kind::Value { key, .. }) => key,
        other => format!("{other:?}"),
    };
    assert_eq!(key_of("gravity = 9.81", "gravity = -9.81"), "gravity");
    assert_eq!(key_of("[0.4, 6.25]", "[6.25, 0.4]"), "object.curvature_radii[1]");
    assert_eq!(key_of("contact_std = 0.001", "contact_std = nan"), "sensors.contact_std");
    assert_eq!(key_of("mass = 1.0", "mass = 1.0\nsize = 0.0"), "object.size");
    assert_eq!(key_of("contact_std = 0.001", "contact_speed_std = 0.0"), "sensors.contact_speed_std");
    assert_eq!(key_of("duration = 4.2", "duration = 0"), "simulation.duration");
    assert_eq!(key_of("duration = 4.2", "duration = 1e300"), "simulation.duration");
    assert_eq!(key_of("[2.5, 2.0, 1.0]", "[2.5, 0.0, 1.0]"), "simulation.shape.semi_axes[1]");
    assert_eq!(
        key_of("duration = 4.2", "duration = 4.2\norientation = [1, 1, 0, 0]"),
        "simulation.orientation (its length)"
    );
}

#[test]
fn numbers_that_no_object_has_are_named() {
    for mass in ["1e300", "1e-300", "2e9", "1e-10"] {
        let refused = with("mass = 1.0", &format!("mass = {mass}")).unwrap_err();
        assert!(matches!(&refused, Kind::Value { key, .. } if key == "object.mass"), "{refused}");
        assert!(refused.to_string().contains("kg"), "{refused}");
    }
    // Half a kilogram with moments of a whole one may be a shell; a gram may not.
    assert!(with("mass = 1.0", "mass = 0.5").is_ok());
    let outside = with("mass = 1.0", "mass = 1e-3").unwrap_err();
    assert!(matches!(outside, Kind::MassOutside { reach, spread, .. } if spread > reach), "{outside}");
    assert!(outside.to_string().contains("check the units"), "{outside}");
    let heavy = with("gravity = 9.81", "gravity = 9810").unwrap_err();
    assert!(
        heavy.to_string().contains("`gravity` is 9810") && heavy.to_string().contains("m/s^2"),
        "{heavy}"
    );
    let spins = with("[0.0, 0.3, 0.3]", "[0.0, 0.0, 3e5]").unwrap_err();
    assert!(
        matches!(&spins, Kind::Value { key, value, .. } if key.contains("angular_velocity") && *value == 3e5),
        "{spins}"
    );
}

#[test]
fn palms_that_cannot_hold_an_object_are_named() {
    let parallel = with("azimuth_deg = 30, slope_deg = 60", "azimuth_deg = 270, slope_deg = 60");
    assert!(matches!(parallel, Err(Kind::Palms(PalmError::Parallel { .. }))));
    let flat = with("azimuth_deg = 270, slope_deg = 60", "azimuth_deg = 270, slope_deg = 0");
    assert!(matches!(flat, Err(Kind::Palm { palm: 1, source: PalmError::VerticalNormal { .. } })));
    let none = with("azimuth_deg = 270, slope_deg = 60", "slope_deg = 60");
    assert!(matches!(none, Err(Kind::Missing { .. })));
    let two = with("  { azimuth_deg = 270, slope_deg = 60 },\n", "");
    assert!(matches!(two, Err(Kind::PalmCount { found: 2 })));
}

/// Who forgot to say so is told, and a mistake in a scene of space is not blamed on that.
#[test]
fn a_scene_of_the_plane_that_does_not_say_so_is_told_from_a_mistake() {
    let known = "gravity = 9.81\n[object]\nmass = 1.0\ninertia = 0.02\n";
    let told = Scene::parse(known).unwrap_err().to_string();
    assert!(told.contains("write `plane = true`"), "{told}");
    assert!(matches!(Scene::parse(&format!("plane = true\n{known}")), Err(Kind::InPlane)));
    for mistake in [
        "gravit = 9.81",
        "gravity = 9.81\n[object]\nmass = \"1\"",
        "gravity = 9.81\n[object]\nprincipal_moments = [1, 2]",
    ] {
        assert!(matches!(Scene::parse(mistake), Err(Kind::Toml(_))), "{mistake}");
    }
}
