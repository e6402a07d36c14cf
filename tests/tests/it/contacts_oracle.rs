//! Contacts with palms of every shape against numerical differentiation of the gap at 60 digits.

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{
    BodyPlace, Direction, Ellipsoid, MotionLaw, MotionPart, PalmSurface, SurfaceContact, SurfaceMotion,
    SurfacePose, SurfaceState, Translated,
};
use recon::object_dynamics::{
    BodyState, ContactMode, ContactScene, MassProperties, PalmDrive, ScenePalm, SceneState,
};
use serde_json::Value;

const TOLERANCE: f64 = 1e-10;

fn oracle() -> Value {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/data/contacts.json");
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap())
}

fn vector(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

/// A matrix given row by row.
fn matrix(value: &Value) -> DMat3 {
    DMat3::from_cols(vector(&value[0]), vector(&value[1]), vector(&value[2])).transpose()
}

struct Body {
    shape: Translated<Ellipsoid>,
    place: BodyPlace,
    v: DVec3,
    w: DVec3,
    mass: MassProperties,
}

fn body(oracle: &Value) -> Body {
    let state = &oracle["state"];
    let q = &state["quaternion_unnormalised"];
    let R_WO = DQuat::from_xyzw(number(&q[1]), number(&q[2]), number(&q[3]), number(&q[0])).normalize();
    let ellipsoid = Ellipsoid::new(vector(&state["semi_axes"])).unwrap();
    Body {
        shape: Translated { body: ellipsoid, offset: vector(&state["body_offset"]) },
        place: BodyPlace { p_WCm: vector(&state["cm"]), R_WO: DMat3::from_quat(R_WO) },
        v: vector(&state["v"]),
        w: vector(&state["w"]),
        mass: MassProperties::new(number(&state["mass"]), matrix(&state["inertia_body"])).unwrap(),
    }
}

fn surface(palm: &Value) -> PalmSurface {
    let radius = number(&palm["radius"]);
    match palm["kind"].as_str().unwrap() {
        "flat" => PalmSurface::Plane,
        "sphere" => PalmSurface::Sphere { radius },
        "cup" => PalmSurface::Cup { radius },
        "cylinder" => PalmSurface::Cylinder { radius },
        other => panic!("{other}"),
    }
}

fn state(palm: &Value) -> SurfaceState {
    SurfaceState {
        p_WP: vector(&palm["position"]),
        R_WP: matrix(&palm["R_palm"]),
        v_WP: vector(&palm["velocity"]),
        w_WP: vector(&palm["angular_velocity"]),
        a_WP: vector(&palm["acceleration"]),
        alpha_WP: vector(&palm["angular_acceleration"]),
    }
}

#[test]
fn contacts_and_their_rates_are_those_of_the_gap() {
    let oracle = oracle();
    let body = body(&oracle);
    let cases = oracle["kernels"].as_array().unwrap();
    assert_eq!(cases.len(), 8);
    for case in cases {
        let (surface, palm) = (surface(&case["palm"]), state(&case["palm"]));
        let contact = SurfaceContact::new(&body.shape, &body.place, surface, &palm, None).unwrap();
        let rates = contact.rates(&palm, body.v, body.w).unwrap();
        let (a, alpha) = (vector(&case["a"]), vector(&case["alpha"]));
        let accelerated = a + alpha.cross(contact.b_W);
        let differences = [
            ("gap", (contact.gap - number(&case["gap"])).abs()),
            ("c", (contact.p_WC - vector(&case["c"])).length()),
            ("n", (contact.n - vector(&case["n"])).length()),
            ("gap rate", (rates.gap_rate - number(&case["gap_rate"])).abs()),
            ("slip", (rates.slip - vector(&case["slip"])).length()),
            ("c'", (rates.p_dot_WC - vector(&case["c_rate"])).length()),
            ("n'", (rates.n_dot - vector(&case["n_rate"])).length()),
            ("bias of gap''", (rates.gap_bias - number(&case["gap_acceleration_bias"])).abs()),
            (
                "gap''",
                (contact.n.dot(accelerated) + rates.gap_bias - number(&case["gap_acceleration"])).abs(),
            ),
            ("slip'", (accelerated + rates.slip_bias - vector(&case["slip_rate"])).length()),
        ];
        for (what, difference) in differences {
            assert!(difference < TOLERANCE, "{surface:?}: {what} is off by {difference:.1e}");
        }
    }
}

/// A motion that has the given state at `t = 0`: sinusoids of frequency 1 have any rate and acceleration there.
fn motion(state: &SurfaceState) -> SurfaceMotion {
    let law = |rate: f64, acceleration: f64| {
        let phase = (-acceleration).atan2(rate);
        let amplitude = rate.hypot(acceleration);
        MotionLaw::Sinusoid { mean: -amplitude * phase.sin(), amplitude, frequency: 1.0, phase }
    };
    // Turns about x, then y, then z: the later ones turn the rates of the earlier ones along.
    let w = state.w_WP;
    let carried =
        DVec3::Y.cross(DVec3::X) * w.y * w.x + DVec3::Z.cross(DVec3::X * w.x + DVec3::Y * w.y) * w.z;
    let alpha = state.alpha_WP - carried;
    let mut parts = Vec::new();
    for (axis, k) in [(Direction::X, 0), (Direction::Y, 1), (Direction::Z, 2)] {
        parts.push(MotionPart::Turn { pivot: state.p_WP, axis, law: law(w[k], alpha[k]) });
    }
    for (direction, k) in [(Direction::X, 0), (Direction::Y, 1), (Direction::Z, 2)] {
        parts.push(MotionPart::Shift { direction, law: law(state.v_WP[k], state.a_WP[k]) });
    }
    let pose = SurfacePose::new(state.p_WP, DQuat::from_mat3(&state.R_WP)).unwrap();
    SurfaceMotion::Parts { pose, parts }
}

#[test]
fn accelerations_and_forces_are_those_of_two_other_forms() {
    let oracle = oracle();
    let body = body(&oracle);
    let cases = oracle["dynamics"].as_array().unwrap();
    assert_eq!(cases.len(), 9);
    for case in cases {
        let palms = case["palms"].as_array().unwrap();
        let scene_palm = |(palm, mu): (&Value, &Value)| {
            let drive = PalmDrive::Prescribed(motion(&state(palm)));
            ScenePalm { surface: surface(palm), drive, friction: number(mu) }
        };
        let palms: Vec<_> = palms.iter().zip(case["mu"].as_array().unwrap()).map(scene_palm).collect();
        let gravity = -vector(&oracle["state"]["gravity"]).z;
        let scene = ContactScene::new(&body.shape, body.mass, palms, gravity).unwrap();
        let (p_WCm, R_WO) = (body.place.p_WCm, DQuat::from_mat3(&body.place.R_WO));
        let at = BodyState { p_WCm, R_WO, v_WCm: body.v, w_WO: body.w };
        let palms = scene.palms_at_start();
        let modes: Vec<_> = case["modes"].as_str().unwrap().chars().map(mode).collect();
        let now = scene.instant(&SceneState { t: 0.0, body: at, palms }, &modes).unwrap();
        let name = &case["name"];
        let difference = (now.a_WCm - vector(&case["a"])).length();
        assert!(difference < TOLERANCE, "{name}: a is off by {difference:.1e}");
        let difference = (now.alpha_WO - vector(&case["alpha"])).length();
        assert!(difference < TOLERANCE, "{name}: alpha is off by {difference:.1e} of some 100");
        for (i, force) in case["forces"].as_array().unwrap().iter().enumerate() {
            let difference = (now.forces[i] - vector(force)).length();
            assert!(difference < TOLERANCE, "{name}: force {i} is off by {difference:.1e}");
        }
    }
}

fn mode(letter: char) -> ContactMode {
    ContactMode::ALL.into_iter().find(|mode| mode.letter() == letter).unwrap()
}
