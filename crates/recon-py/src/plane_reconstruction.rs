//! What a log in the plane tells.

use crate::arrays::{block, column, columns, flat2, from_json, table, vector};
use crate::errors::raised;
use crate::plane::{PlaneLog, PlaneScene};
use crate::reconstruction::{evidence_rows, in_notebook};
use crate::unlocked::unlocked;
use glam::DVec2;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use recon_cli::PlaneReconstructed;
use std::path::PathBuf;

/// Estimates motion, mass and bounds on the outline.
#[pyfunction]
#[pyo3(signature = (log, scene, words, progress=None))]
pub(crate) fn reconstruct_plane(
    py: Python<'_>,
    log: &PlaneLog,
    scene: &PlaneScene,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<PlaneReconstruction> {
    let (log, scene) = (log.log.clone(), scene.scene.clone());
    let made = unlocked(py, progress, move |watch| PlaneReconstructed::of(&log, &scene, &words, watch))?;
    Ok(PlaneReconstruction { made, motion: PyOnceLock::new(), deviations: PyOnceLock::new() })
}

/// Everything that a log in the plane tells.
#[pyclass(frozen, module = "recon.plane", name = "Reconstruction")]
pub(crate) struct PlaneReconstruction {
    made: PlaneReconstructed,
    motion: PyOnceLock<Py<PyAny>>,
    deviations: PyOnceLock<Py<PyAny>>,
}

impl PlaneReconstruction {
    fn all_deviations<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PyAny>> {
        let made = || table(py, self.made.deviations().concat(), 6).map(Bound::unbind);
        Ok(self.deviations.get_or_try_init(py, made)?.bind(py))
    }

    fn of_contacts<'py>(&self, py: Python<'py>, which: usize) -> PyResult<Bound<'py, PyAny>> {
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
    fn times<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        vector(py, self.made.times())
    }

    /// The motion, (n, 6), in the columns of motion.csv: place, orientation, velocity, angular velocity.
    #[getter]
    fn motion<'py>(&self, py: Python<'py>) -> PyResult<&Bound<'py, PyAny>> {
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

    /// Covariances of position and turn together, (n, 3, 3), m and rad.
    #[getter]
    fn pose_covariance<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        block(py, self.made.pose_covariances().as_flattened().as_flattened().to_vec(), [3, 3])
    }

    /// Whether the motion of a sample is relied on to within its deviations, (n,), bool.
    #[getter]
    fn relied_on<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        vector(py, self.made.relied_on().to_vec())
    }

    /// Contact modes, (n, palms), uint8: 0 off, 1 slides, 2 sticks.
    #[getter]
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let modes = self.made.modes();
        let palms = modes.first().map_or(0, Vec::len);
        table(py, modes.concat(), palms)
    }

    /// Where the palms touched the object, (n, palms, 2), m, body axes from the centre of mass; nan where they did not.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.of_contacts(py, 0)
    }

    /// Outward normals there, (n, palms, 2), body axes.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
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
    fn outlines<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyAny>; 2]>> {
        let Some(([lower, upper], _)) = self.made.bounds() else { return Ok(None) };
        Ok(Some([table(py, flat2(lower), 2)?, table(py, flat2(upper), 2)?]))
    }

    /// The page that the command writes (HTML, which loads nothing).
    #[getter]
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        let page = py.detach(|| self.made.report()).map_err(raised)?;
        Ok(String::from_utf8_lossy(&page).into_owned())
    }

    /// Writes the folder that the command writes, whole or not at all; covariance: that of the pose at all samples too; force: write beside files that
    /// recon did not write. Raises OutputError.
    #[pyo3(signature = (folder, *, covariance=false, force=false))]
    fn write(&self, py: Python<'_>, folder: PathBuf, covariance: bool, force: bool) -> PyResult<()> {
        let mut words = Vec::new();
        words.extend(covariance.then(|| "--covariance".to_owned()));
        words.extend(force.then(|| "--force".to_owned()));
        py.detach(|| self.made.write(&folder, &words)).map_err(raised)
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
