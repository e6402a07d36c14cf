//! Planar oracle scenes from `tests/data/planar_oracles.json`.

use glam::DVec2;
use recon::contact_kinematics::planar::{Ellipse, FourierBody, RadiusBounds, RadiusFunction, RadiusJet};
use recon::object_dynamics::planar::{ConstantRates, PlanarMass, PlanarObject, PlanarStart};
use serde_json::Value;

/// Shape of a scene.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Trigonometric polynomial.
    Fourier(FourierBody),
    /// Ellipse.
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

/// The oracles.
///
/// # Panics
/// Never: the file is part of the sources.
#[must_use]
pub fn oracle_file() -> Value {
    serde_json::from_str(include_str!("../data/planar_oracles.json")).unwrap()
}

/// A number that stands as a number or as a string.
///
/// # Panics
/// When it is none.
#[must_use]
pub fn number(value: &Value) -> f64 {
    value.as_f64().or_else(|| value.as_str().and_then(|s| s.parse().ok())).unwrap()
}

/// Two numbers.
///
/// # Panics
/// When they are none.
#[must_use]
pub fn pair(value: &Value) -> [f64; 2] {
    [number(&value[0]), number(&value[1])]
}

/// Numbers of an array.
///
/// # Panics
/// When it is none.
#[must_use]
pub fn list(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// The shape of a scene.
///
/// # Panics
/// When it has none.
#[must_use]
pub fn shape(scene: &Value) -> Shape {
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
///
/// # Panics
/// When there is no such scene.
#[must_use]
pub fn scene(name: &str) -> (PlanarObject<Shape>, ConstantRates, PlanarStart) {
    let file = oracle_file();
    let scene = &file["scenes"][name];
    let mass = PlanarMass::from_gyration(number(&scene["m"]), number(&scene["kappa2"])).unwrap();
    let object = PlanarObject { shape: shape(scene), mass, gravity: number(&scene["g"]) };
    let angles = ["phi1_deg", "phi2_deg"].map(|k| number(&scene[k]).to_radians());
    let rates = ["w1", "w2"].map(|k| number(&scene[k]));
    let start = PlanarStart { phi0: number(&scene["phi0"]), omega0: number(&scene["omega0"]) };
    (object, ConstantRates { angles, rates }, start)
}
