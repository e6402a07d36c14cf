//! Sensor logs, and simulations that make them.

use crate::arrays::{Numbers, from_json, slices, vector};
use crate::errors::raised;
use crate::reconstruction::in_notebook;
use crate::scene::Scene;
use crate::unlocked::unlocked;
use pyo3::prelude::*;
use recon_cli::{Log as Made, Simulated};
use std::path::PathBuf;

/// A sensor log: what palms with tactile sensors felt, sample by sample.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Log {
    pub(crate) log: Made,
}

#[pymethods]
impl Log {
    /// Reads a CSV file, or a bag of ROS 2 (MCAP) by its mapping.
    #[staticmethod]
    #[pyo3(signature = (path, scene, mapping=None))]
    fn _read(py: Python<'_>, path: PathBuf, scene: &Scene, mapping: Option<PathBuf>) -> PyResult<Self> {
        let scene = &scene.scene;
        let log = py.detach(|| Made::read(&path, scene, mapping.as_deref())).map_err(raised)?;
        Ok(Self { log })
    }

    /// A log from its columns.
    #[staticmethod]
    fn _of_columns(names: Vec<String>, columns: Vec<Numbers>, scene: &Scene) -> PyResult<Self> {
        Ok(Self { log: Made::of_columns(&names, &slices(&columns), &scene.scene).map_err(raised)? })
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

    /// What was done to a bag, and what the reader must know.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.log.notes()
    }

    /// The log as CSV text in the columns of the format, which reads back bit for bit.
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
        format!(
            "<recon.Log: {} samples over {} s, {} palms>",
            times.len(),
            recon_io::brief(over),
            self.log.palms()
        )
    }
}

/// A simulated log, and what is said of it.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Simulation {
    made: Simulated,
}

#[pymethods]
impl Simulation {
    /// The log, with the truth beside the readings.
    #[getter]
    fn log(&self) -> Log {
        Log { log: self.made.log.clone() }
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

    /// Whether it goes on to the end that was asked for.
    #[getter]
    fn is_whole(&self) -> bool {
        self.made.is_whole
    }

    /// The page that shows it (HTML), of scenes with `[[palm]]` tables; else None.
    #[getter]
    fn report_html(&self) -> Option<String> {
        self.made.report.as_ref().map(|page| String::from_utf8_lossy(page).into_owned())
    }

    /// The page that shows it, in a notebook; where there is none, the words.
    fn _repr_html_(&self) -> String {
        in_notebook(self.report_html().as_deref(), &self.made.text)
    }

    fn __repr__(&self) -> String {
        format!("<recon.Simulation: {}>", self.made.text)
    }
}

/// Simulates a scene.
#[pyfunction]
#[pyo3(signature = (scene, words, report, progress=None))]
pub(crate) fn simulate(
    py: Python<'_>,
    scene: &Scene,
    words: Vec<String>,
    report: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<Simulation> {
    let scene = scene.scene.clone();
    let made = unlocked(py, progress, move |_| Simulated::of(&scene, &words, report))?;
    Ok(Simulation { made })
}
