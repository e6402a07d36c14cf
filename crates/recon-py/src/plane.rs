//! Scenes, logs and results in the plane.

use crate::arrays::{block, column, columns, flat2, from_json, table, vector};
use crate::errors::raised;
use crate::reconstruction::{evidence_rows, in_notebook};
use crate::unlocked::unlocked;
use glam::DVec2;
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use recon_cli::{PlaneLog as Log, PlaneReconstructed, PlaneScene as Known, PlaneSimulated};
use std::path::PathBuf;

/// What is known beside a log in the plane: gravity (along -y), the object's mass and inertia, palms, and the noise of the sensors.
#[pyclass(frozen, module = "recon.plane", name = "Scene")]
pub(crate) struct PlaneScene {
    scene: Known,
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
    log: Log,
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
    fn _of_columns(
        names: Vec<String>,
        columns: Vec<PyReadonlyArray1<'_, f64>>,
        scene: &PlaneScene,
    ) -> PyResult<Self> {
        let columns = columns.iter().map(|column| column.as_slice()).collect::<Result<Vec<_>, _>>()?;
        Ok(Self { log: Log::of_columns(&names, &columns, &scene.scene).map_err(raised)? })
    }

    /// Times of the samples, (n,), s.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
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

/// Estimates motion, mass and bounds on the outline.
#[pyfunction]
#[pyo3(signature = (log, scene, identify, progress=None))]
pub(crate) fn reconstruct_plane(
    py: Python<'_>,
    log: &PlaneLog,
    scene: &PlaneScene,
    identify: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<PlaneReconstruction> {
    let (log, scene) = (log.log.clone(), scene.scene.clone());
    let made = unlocked(py, progress, move |watch| PlaneReconstructed::of(&log, &scene, identify, watch))?;
    Ok(PlaneReconstruction { made, motion: PyOnceLock::new(), deviations: PyOnceLock::new() })
}

/// Everything that a log in the plane tells.
#[pyclass(frozen, module = "recon.plane", name = "Reconstruction")]
pub(crate) struct PlaneReconstruction {
    made: PlaneReconstructed,
    motion: PyOnceLock<Py<PyArray2<f64>>>,
    deviations: PyOnceLock<Py<PyArray2<f64>>>,
}

impl PlaneReconstruction {
    fn all_deviations<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PyArray2<f64>>> {
        let made = || table(py, self.made.deviations().concat(), 6).map(Bound::unbind);
        Ok(self.deviations.get_or_try_init(py, made)?.bind(py))
    }

    fn of_contacts<'py>(&self, py: Python<'py>, which: usize) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let palms = self.made.contacts();
        let mut points = Vec::new();
        for k in 0..palms.first().map_or(0, Vec::len) {
            points.extend(palms.iter().map(|palm| palm[k].map_or(DVec2::NAN, |of| of[which])));
        }
        block(py, flat2(&points), [palms.len(), 2])
    }
}

#[pymethods]
impl PlaneReconstruction {
    /// Whether the result may be relied on; `verdict` says why or why not.
    #[getter]
    fn reliable(&self) -> bool {
        self.made.verdict().0
    }

    /// Whether the result may be relied on, in a sentence.
    #[getter]
    fn verdict(&self) -> String {
        self.made.verdict().1
    }

    /// What the reader must know.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.made.warnings()
    }

    /// What the command prints.
    #[getter]
    fn text(&self) -> &str {
        self.made.text()
    }

    /// What the estimate rests on: dictionaries with key, name, value, unit, level and meaning.
    #[getter]
    fn evidence<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        evidence_rows(py, &self.made.evidence())
    }

    /// What summary.json of the command holds.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, self.made.summary())
    }

    /// Times of the motion, (n,), s.
    #[getter]
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        vector(py, self.made.times())
    }

    /// The motion, (n, 6), in the columns of motion.csv: place, orientation, velocity, angular velocity.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PyArray2<f64>>> {
        let made = || table(py, self.made.motion().concat(), 6).map(Bound::unbind);
        Ok(self.motion.get_or_try_init(py, made)?.bind(py))
    }

    /// Centre of mass, (n, 2), m.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        columns(self.motion(py)?, 0, 2)
    }

    /// Orientation, (n,), rad, counter-clockwise from the first sample.
    #[getter]
    fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        column(self.motion(py)?, 2)
    }

    /// Velocity of the centre of mass, (n, 2), m/s.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        columns(self.motion(py)?, 3, 5)
    }

    /// Angular velocity, (n,), rad/s.
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        column(self.motion(py)?, 5)
    }

    /// Standard deviations of the centre of mass, (n, 2), m.
    #[getter]
    fn position_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        columns(self.all_deviations(py)?, 0, 2)
    }

    /// Standard deviations of the turn since the first sample, (n,), rad.
    #[getter]
    fn turn_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        column(self.all_deviations(py)?, 2)
    }

    /// Standard deviations of the velocity, (n, 2), m/s.
    #[getter]
    fn velocity_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        columns(self.all_deviations(py)?, 3, 5)
    }

    /// Standard deviations of the angular velocity, (n,), rad/s.
    #[getter]
    fn angular_velocity_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        column(self.all_deviations(py)?, 5)
    }

    /// Whether the motion of a sample is relied on to within its deviations, (n,), bool.
    #[getter]
    fn relied_on<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        vector(py, self.made.relied_on().to_vec())
    }

    /// Contact modes, (n, palms), uint8: 0 off, 1 slides, 2 sticks.
    #[getter]
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<u8>>> {
        let modes = self.made.modes();
        let palms = modes.first().map_or(0, Vec::len);
        table(py, modes.concat(), palms)
    }

    /// Where the palms touched the object, (n, palms, 2), m, body axes from the centre of mass; nan where they did not.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.of_contacts(py, 0)
    }

    /// Outward normals there, (n, palms, 2), body axes.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        self.of_contacts(py, 1)
    }

    /// Mass, kg.
    #[getter]
    fn mass(&self) -> f64 {
        self.made.body()[0].0
    }

    /// Its standard deviation, kg, where it was estimated.
    #[getter]
    fn mass_std(&self) -> Option<f64> {
        self.made.body()[0].1
    }

    /// Moment of inertia about the centre of mass, kg m^2.
    #[getter]
    fn inertia(&self) -> f64 {
        self.made.body()[1].0
    }

    /// Its standard deviation, kg m^2, where it was estimated.
    #[getter]
    fn inertia_std(&self) -> Option<f64> {
        self.made.body()[1].1
    }

    /// Areas of the lower and the upper bound, m^2, of which the second is inf where a side is open; None where there are no bounds.
    #[getter]
    fn areas(&self) -> Option<[f64; 2]> {
        self.made.bounds().map(|(_, areas)| areas)
    }

    /// Corners of the lower and the upper bound, (n, 2) and (m, 2), m, world axes of the first sample from the centre of mass; None
    /// where there are no bounds.
    #[getter]
    fn outlines<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyArray2<f64>>; 2]>> {
        let Some(([lower, upper], _)) = self.made.bounds() else { return Ok(None) };
        Ok(Some([table(py, flat2(lower), 2)?, table(py, flat2(upper), 2)?]))
    }

    /// The page that the command writes (HTML, which loads nothing).
    #[getter]
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        let page = py.detach(|| self.made.report()).map_err(raised)?;
        Ok(String::from_utf8_lossy(&page).into_owned())
    }

    /// Writes the folder that the command writes, whole or not at all; force: write beside files that recon did not write. Raises OutputError.
    #[pyo3(signature = (folder, *, force=false))]
    fn write(&self, py: Python<'_>, folder: PathBuf, force: bool) -> PyResult<()> {
        py.detach(|| self.made.write(&folder, force)).map_err(raised)
    }

    /// The report, in a notebook.
    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        Ok(in_notebook(Some(&self.report_html(py)?), self.made.text()))
    }

    fn __len__(&self) -> usize {
        self.made.times().len()
    }

    fn __repr__(&self) -> String {
        format!("<recon.plane.Reconstruction\n{}>", self.made.text())
    }
}
