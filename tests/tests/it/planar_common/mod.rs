//! Planar oracle scenes from `tests/data/planar_oracles.json`.
#![allow(clippy::unwrap_used, reason = "helpers of tests, where a panic is the report")]
#![allow(dead_code, reason = "each test file uses its part of the shared scenes")]

use glam::DVec2;
use nalgebra::SVector;
use recon::contact_kinematics::planar::{Ellipse, FourierBody, RadiusBounds, RadiusFunction, RadiusJet};
use recon::object_dynamics::planar::{
    ConstantRates, PlanarMass, PlanarObject, PlanarSample, PlanarStart, PlanarTruth,
};
use recon::observer::planar::{PlanarEstimate, PlanarObserver};
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

/// `(cm, v, omega0)` of the truth.
pub(crate) fn state(truth: &PlanarTruth) -> SVector<f64, 5> {
    let (p, v) = (truth.p_WCm, truth.v_WCm);
    SVector::<f64, 5>::new(p.x, p.y, v.x, v.y, truth.omega0)
}

/// What an observer says at the last of some samples.
pub(crate) fn last_estimate<const N: usize>(
    mut observer: PlanarObserver<N>,
    samples: impl IntoIterator<Item = PlanarSample>,
) -> PlanarEstimate<N> {
    let estimates = samples.into_iter().filter_map(|sample| observer.push(&sample).unwrap());
    estimates.last().unwrap()
}
