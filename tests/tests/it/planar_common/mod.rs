//! Planar oracle scenes from `tests/data/planar_oracles.json`.
#![allow(clippy::unwrap_used, reason = "helpers of tests, where a panic is the report")]
#![allow(dead_code, reason = "each test file uses its part of the shared scenes")]

use glam::DVec2;
use recon::contact_kinematics::planar::{Ellipse, FourierBody, RadiusBounds, RadiusFunction, RadiusJet};
use recon::object_dynamics::planar::{ConstantRates, PlanarMass, PlanarObject, PlanarStart, PlanarTruth};
use recon::observer::ContactNoiseLevel;
use recon::observer::planar::{PlaneEstimate, PlaneOptions};
use serde_json::Value;

/// Shape of a scene.
#[derive(Clone, Debug)]
pub(crate) enum Shape {
    Fourier(FourierBody),
    Ellipse(Ellipse),
}

impl RadiusFunction for Shape {
    fn jet(&self, theta: f64) -> RadiusJet {
        match self {
            Shape::Fourier(s) => s.jet(theta),
            Shape::Ellipse(s) => s.jet(theta),
        }
    }
    fn radius_bounds(&self) -> RadiusBounds {
        match self {
            Shape::Fourier(s) => s.radius_bounds(),
            Shape::Ellipse(s) => s.radius_bounds(),
        }
    }
}

pub(crate) fn oracle_file() -> Value {
    serde_json::from_str(include_str!("../../../data/planar_oracles.json")).unwrap()
}

/// A number that stands as a number or as a string.
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value.as_str().and_then(|s| s.parse().ok())).unwrap()
}

pub(crate) fn pair(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

pub(crate) fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

pub(crate) fn shape(scene: &Value) -> Shape {
    let shape = &scene["shape"];
    if shape["kind"] == "ellipse" {
        // (px, py) is the centre of mass from the centre of the ellipse.
        let centre = -DVec2::new(number(&shape["px"]), number(&shape["py"]));
        Shape::Ellipse(Ellipse::new(number(&shape["A"]), number(&shape["B"]), centre).unwrap())
    } else {
        Shape::Fourier(FourierBody::new(&list(&shape["a"]), &list(&shape["b"])).unwrap())
    }
}

/// Object, palms and start of a scene with prescribed palms.
pub(crate) fn scene(name: &str) -> (PlanarObject<Shape>, ConstantRates, PlanarStart) {
    let file = oracle_file();
    let scene = &file["scenes"][name];
    let mass = PlanarMass::from_gyration(number(&scene["m"]), number(&scene["kappa2"])).unwrap();
    let object = PlanarObject { shape: shape(scene), mass, gravity: number(&scene["g"]) };
    let angles = ["phi1_deg", "phi2_deg"].map(|k| number(&scene[k]).to_radians());
    let rates = ["w1", "w2"].map(|k| number(&scene[k]));
    let start = PlanarStart { phi0: number(&scene["phi0"]), omega0: number(&scene["omega0"]) };
    (object, ConstantRates { angles, rates }, start)
}

/// `count + 1` sample times from zero, `rate` a second.
pub(crate) fn times(rate: f64, duration: f64) -> Vec<f64> {
    let count = (duration * rate).round() as u32;
    (0..=count).map(|k| f64::from(k) / rate).collect()
}

/// Noise of contacts (m) and forces (N), with what conditions of a body of the size `length` are off by beside that.
pub(crate) fn noise_level(contact: f64, force: f64, length: f64) -> ContactNoiseLevel {
    let floor = 3e-5 * (9.81 * length).sqrt();
    ContactNoiseLevel { contact, force_fixed: force, force_share: 0.0, impulse: None, floor }
}

/// What is told of two palms without friction.
pub(crate) fn options(noise: ContactNoiseLevel, gravity: f64, body: Option<PlanarMass>) -> PlaneOptions {
    PlaneOptions { noise, gravity, friction: vec![Some(0.0); 2], body, size: None, suspects: true }
}

/// Errors of an estimate at the samples that are relied on: largest of the centre of mass (m), of the turn (rad), and of any number in
/// its deviations; mean square of centre, velocity and angular velocity in theirs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Errors {
    pub(crate) place: f64,
    pub(crate) turn: f64,
    pub(crate) worst: f64,
    pub(crate) mean: f64,
    pub(crate) relied_on: usize,
}

pub(crate) fn errors(estimate: &PlaneEstimate, truth: &[PlanarTruth]) -> Errors {
    let (mut all, mut sum) = (Errors::default(), 0.0);
    for (k, truth_now) in truth.iter().enumerate().filter(|(k, _)| estimate.relied_on[*k]) {
        let (state, of) = (&estimate.states[k], &estimate.deviations[k]);
        let (p, v) = (state.p_WCm - truth_now.p_WCm, state.v_WCm - truth_now.v_WCm);
        let turn = state.phi0 - (truth_now.phi0 - truth[0].phi0);
        let [p_in, v_in] = [p / of.p_WCm, v / of.v_WCm];
        let spin = (state.omega0 - truth_now.omega0) / of.omega0;
        let five = [p_in.x, p_in.y, v_in.x, v_in.y, spin];
        all.place = all.place.max(p.length());
        all.turn = all.turn.max(turn.abs());
        all.worst = five.iter().fold(all.worst, |most, e| most.max(e.abs()));
        sum += five.iter().map(|e| e * e).sum::<f64>() / 5.0;
        all.relied_on += 1;
    }
    all.mean = sum / all.relied_on.max(1) as f64;
    all
}
