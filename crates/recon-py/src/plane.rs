//! Scenes and logs in the plane.

use crate::arrays::{Numbers, from_json, slices, vector};
use crate::errors::raised;
use crate::reconstruction::in_notebook;
use crate::unlocked::unlocked;
use pyo3::prelude::*;
use recon_cli::{PlaneLog as Log, PlaneScene as Known, PlaneSimulated};
use std::path::PathBuf;

/// What is known beside a log in the plane: gravity (along -y), the object's mass and inertia, palms, and the noise of the sensors.
#[pyclass(frozen, module = "recon.plane", name = "Scene")]
pub(crate) struct PlaneScene {
    pub(crate) scene: Known,
}

#[pymethods]
impl PlaneScene {
    /// Reads a scene file (TOML) with `plane = true`.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Self> {
        Known::read(&path).map(|scene| Self { scene }).map_err(raised)
    }

    /// A scene from TOML text.
    #[staticmethod]
    fn parse(text: String) -> PyResult<Self> {
        Known::parse(text).map(|scene| Self { scene }).map_err(raised)
    }

    /// A scene from the JSON of a dictionary with the keys of a scene file.
    #[staticmethod]
    fn _of_json(text: &str) -> PyResult<Self> {
        Self::parse(crate::scene::toml_of_json(text)?)
    }

    /// Gravity, m/s^2, along -y.
    #[getter]
    fn gravity(&self) -> f64 {
        self.scene.known().gravity
    }

    /// Mass of the object, kg, where it is known.
    #[getter]
    fn mass(&self) -> Option<f64> {
        self.scene.known().mass.map(|mass| mass.mass())
    }

    /// Moment of inertia about the centre of mass, kg m^2, where it is known.
    #[getter]
    fn inertia(&self) -> Option<f64> {
        self.scene.known().mass.map(|mass| mass.inertia())
    }

    /// Number of palms; where the scene describes none, they are two hinged ones.
    #[getter]
    fn palms(&self) -> usize {
        match self.scene.known().palms.len() {
            0 => 2,
            count => count,
        }
    }

    fn __repr__(&self) -> String {
        let mass = self.mass().map_or("unknown".to_owned(), |mass| format!("{mass} kg"));
        format!("<recon.plane.Scene: gravity {} m/s^2, mass {mass}, {} palms>", self.gravity(), self.palms())
    }
}

/// A sensor log in the plane.
#[pyclass(frozen, module = "recon.plane", name = "Log")]
pub(crate) struct PlaneLog {
    pub(crate) log: Log,
}

#[pymethods]
impl PlaneLog {
    /// Reads a CSV file.
    #[staticmethod]
    fn _read(py: Python<'_>, path: PathBuf, scene: &PlaneScene) -> PyResult<Self> {
        let scene = &scene.scene;
        py.detach(|| Log::read(&path, scene)).map(|log| Self { log }).map_err(raised)
    }

    /// A log from its columns.
    #[staticmethod]
    fn _of_columns(names: Vec<String>, columns: Vec<Numbers>, scene: &PlaneScene) -> PyResult<Self> {
        Ok(Self { log: Log::of_columns(&names, &slices(&columns), &scene.scene).map_err(raised)? })
    }

    /// Times of the samples, (n,), s.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        vector(py, self.log.times())
    }

    /// Number of palms.
    #[getter]
    fn palms(&self) -> usize {
        self.log.palms()
    }

    /// The log as CSV text in the columns of version 2, which reads back bit for bit.
    fn to_csv(&self, py: Python<'_>) -> PyResult<String> {
        let text = py.detach(|| {
            let mut text = Vec::new();
            self.log.write_to(&mut text).map(|()| String::from_utf8_lossy(&text).into_owned())
        });
        Ok(text?)
    }

    /// Writes the log as a CSV file, whole or not at all.
    fn write(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        py.detach(|| self.log.write(&path)).map_err(raised)
    }

    fn __len__(&self) -> usize {
        self.log.times().len()
    }

    fn __repr__(&self) -> String {
        let times = self.log.times();
        let over = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
        let (count, over, palms) = (times.len(), recon_io::brief(over), self.log.palms());
        format!("<recon.plane.Log: {count} samples over {over} s, {palms} palms>")
    }
}

/// A simulated log in the plane, and what is said of it.
#[pyclass(frozen, module = "recon.plane", name = "Simulation")]
pub(crate) struct PlaneSimulation {
    made: PlaneSimulated,
}

#[pymethods]
impl PlaneSimulation {
    /// The log, with the truth beside the readings.
    #[getter]
    fn log(&self) -> PlaneLog {
        PlaneLog { log: self.made.log.clone() }
    }

    /// What the command says of it.
    #[getter]
    fn text(&self) -> &str {
        &self.made.text
    }

    /// What the command says of it, in numbers.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, &self.made.summary)
    }

    /// The page that shows it (HTML), where it was asked for; else None.
    #[getter]
    fn report_html(&self) -> Option<String> {
        self.made.report.as_ref().map(|page| String::from_utf8_lossy(page).into_owned())
    }

    /// The page that shows it, in a notebook; where there is none, the words.
    fn _repr_html_(&self) -> String {
        in_notebook(self.report_html().as_deref(), &self.made.text)
    }

    fn __repr__(&self) -> String {
        format!("<recon.plane.Simulation: {}>", self.made.text)
    }
}

/// Simulates a scene in the plane.
#[pyfunction]
#[pyo3(signature = (scene, words, report, progress=None))]
pub(crate) fn simulate_plane(
    py: Python<'_>,
    scene: &PlaneScene,
    words: Vec<String>,
    report: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<PlaneSimulation> {
    let scene = scene.scene.clone();
    let made = unlocked(py, progress, move |_| PlaneSimulated::of(&scene, &words, report))?;
    Ok(PlaneSimulation { made })
}
