//! What is known beside a log.

use crate::arrays::matrix;
use crate::errors::input;
use pyo3::prelude::*;
use recon_io::{Scene as Known, SceneError, SceneErrorKind};
use std::path::PathBuf;

/// What is known beside a log: gravity, the object's mass and inertia, palms, and the noise of the sensors.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Scene {
    pub(crate) scene: Known,
}

/// The TOML of a scene whose dictionary came as JSON.
pub(crate) fn toml_of_json(text: &str) -> PyResult<String> {
    let wrong = |why: String| input(format!("the scene: {why}; give the keys of a scene file, without None"));
    let value: toml::Value = serde_json::from_str(text).map_err(|error| wrong(error.to_string()))?;
    toml::to_string(&value).map_err(|error| wrong(error.to_string()))
}

/// Why a scene is none; where it is one of the plane, who takes it.
fn refused(error: &SceneError) -> PyErr {
    match error.kind {
        SceneErrorKind::InPlane => input(format!(
            "{}: is a scene in the plane; give it to the functions of recon.plane",
            error.path.display()
        )),
        _ => input(error.to_string()),
    }
}

#[pymethods]
impl Scene {
    /// Reads a scene file (TOML).
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        Known::read(path).map(|scene| Self { scene }).map_err(|error| refused(&error))
    }

    /// A scene from TOML text.
    #[staticmethod]
    fn parse(text: &str) -> PyResult<Self> {
        let in_text = |kind| SceneError { path: "the scene".into(), kind };
        Known::parse(text).map(|scene| Self { scene }).map_err(|kind| refused(&in_text(kind)))
    }

    /// A scene from the JSON of a dictionary with the keys of a scene file.
    #[staticmethod]
    fn _of_json(text: &str) -> PyResult<Self> {
        Self::parse(&toml_of_json(text)?)
    }

    /// Gravity, m/s^2; the world's z axis points up.
    #[getter]
    fn gravity(&self) -> f64 {
        self.scene.gravity
    }

    /// Mass of the object, kg, where it is known.
    #[getter]
    fn mass(&self) -> Option<f64> {
        self.scene.mass
    }

    /// Inertia of the object about its centre of mass, (3, 3), kg m^2, body axes, where it is known.
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let mass = self.scene.mass_properties().ok().flatten();
        mass.map(|mass| matrix(py, &mass.inertia())).transpose()
    }

    /// Number of palms that the scene describes.
    #[getter]
    fn palms(&self) -> usize {
        match (&self.scene.palms, &self.scene.simulation) {
            (Some(palms), _) => palms.len(),
            (None, Some(simulation)) if simulation.palms.is_some() => 3,
            _ => 0,
        }
    }

    fn __repr__(&self) -> String {
        let mass = self.scene.mass.map_or("unknown".to_owned(), |mass| format!("{mass} kg"));
        format!("<recon.Scene: gravity {} m/s^2, mass {mass}, {} palms>", self.scene.gravity, self.palms())
    }
}
