//! What a log tells.

use crate::arrays::{block, columns, flat3, from_json, matrix, table, vector, wxyz};
use crate::errors::raised;
use crate::log::Log;
use crate::mesh::Mesh;
use crate::scene::Scene;
use crate::unlocked::unlocked;
use glam::DVec3;
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::PyDict;
use recon_cli::{Body, Reconstructed};
use recon_io::{Evidence, EvidenceValue, PalmContact};
use std::path::PathBuf;

/// Everything that a log tells.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Reconstruction {
    made: Reconstructed,
    times: PyOnceLock<Py<PyAny>>,
    motion: PyOnceLock<Py<PyAny>>,
    deviations: PyOnceLock<Py<PyAny>>,
}

/// Estimates motion, contacts, bounds and, where asked, mass and inertia.
#[pyfunction]
#[pyo3(signature = (log, scene, words, progress=None))]
pub(crate) fn reconstruct(
    py: Python<'_>,
    log: &Log,
    scene: &Scene,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Reconstruction> {
    let (log, scene) = (log.log.clone(), scene.scene.clone());
    let made = unlocked(py, progress, move |watch| Reconstructed::of(&log, &scene, &words, watch))?;
    let (times, motion, deviations) = (PyOnceLock::new(), PyOnceLock::new(), PyOnceLock::new());
    Ok(Reconstruction { made, times, motion, deviations })
}

/// A page in a frame of its own, whose styles and scripts touch nothing else of the notebook; words where there is none.
pub(crate) fn in_notebook(page: Option<&str>, text: &str) -> String {
    let escaped = |text: &str| text.replace('&', "&amp;").replace('"', "&quot;").replace('<', "&lt;");
    match page {
        Some(page) => {
            let style = "width: 100%; height: 720px; border: 0";
            format!("<iframe srcdoc=\"{}\" style=\"{style}\"></iframe>", escaped(page))
        }
        None => format!("<pre>{}</pre>", escaped(text)),
    }
}

/// Evidence as dictionaries.
pub(crate) fn evidence_rows<'py>(py: Python<'py>, of: &[Evidence]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let row = |of: &Evidence| {
        let row = PyDict::new(py);
        row.set_item("key", &of.key)?;
        row.set_item("name", &of.name)?;
        match &of.value {
            EvidenceValue::Number(value) => row.set_item("value", value)?,
            EvidenceValue::Count(value) => row.set_item("value", value)?,
            EvidenceValue::Text(value) => row.set_item("value", value)?,
        }
        row.set_item("unit", &of.unit)?;
        row.set_item("level", Reconstructed::level(of))?;
        row.set_item("meaning", &of.meaning)?;
        Ok(row)
    };
    of.iter().map(row).collect()
}

impl Reconstruction {
    fn motion_part<'py>(&self, py: Python<'py>, from: isize, to: isize) -> PyResult<Bound<'py, PyAny>> {
        columns(self.motion(py)?.bind(py), from, to)
    }

    fn deviation_part<'py>(&self, py: Python<'py>, which: isize) -> PyResult<Bound<'py, PyAny>> {
        let of = self.made.deviations();
        let made = || table(py, flat3(of.iter().flatten().copied()), 12).map(Bound::unbind);
        let all = self.deviations.get_or_try_init(py, made)?;
        columns(all.bind(py), 3 * which, 3 * which + 3)
    }

    fn of_contacts<'py>(
        &self,
        py: Python<'py>,
        what: fn(&PalmContact) -> DVec3,
    ) -> PyResult<Bound<'py, PyAny>> {
        let palms = self.made.contacts();
        let samples = palms.first().map_or(0, |palm| palm.len());
        let at = |k: usize| {
            let of = move |palm: &&[Option<PalmContact>]| {
                palm.get(k).and_then(Option::as_ref).map_or(DVec3::NAN, what)
            };
            palms.iter().map(of).collect::<Vec<_>>()
        };
        block(py, flat3((0..samples).flat_map(at)), [palms.len(), 3])
    }

    fn body(&self) -> Option<Body> {
        self.made.body()
    }
}

#[pymethods]
impl Reconstruction {
    /// Whether the result may be relied on; `verdict` says why or why not.
    #[getter]
    fn reliable(&self) -> bool {
        self.made.verdict().0
    }

    /// Whether everything that was asked for is there and may be relied on: what exit code 0 of the command says.
    #[getter]
    fn is_whole(&self) -> bool {
        self.made.is_whole()
    }

    /// Whether the result may be relied on, in a sentence.
    #[getter]
    fn verdict(&self) -> String {
        self.made.verdict().1
    }

    /// What the reader must know.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.made.warnings().to_vec()
    }

    /// What the command prints.
    #[getter]
    fn text(&self) -> &str {
        self.made.text()
    }

    /// What the estimate rests on: dictionaries with key, name, value, unit, level and meaning.
    #[getter]
    fn evidence<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        evidence_rows(py, self.made.evidence())
    }

    /// What summary.json of the command holds.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, self.made.summary())
    }

    /// Times of the motion, (n,), s.
    #[getter]
    fn times(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = || vector(py, self.made.times()).map(Bound::unbind);
        Ok(self.times.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// The motion, (n, 13), in the columns of motion.csv: position, orientation (w first), velocity, angular velocity.
    #[getter]
    fn motion(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = || {
            let motion = self.made.motion();
            let mut values = Vec::with_capacity(13 * motion.len());
            for state in &motion {
                values.extend(state.p_WCm.to_array());
                values.extend(wxyz(state.R_WO));
                values.extend(state.v_WCm.to_array());
                values.extend(state.w_WO.to_array());
            }
            table(py, values, 13).map(Bound::unbind)
        };
        Ok(self.motion.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// Centre of mass, (n, 3), m, world axes.
    #[getter]
    fn position<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.motion_part(py, 0, 3)
    }

    /// Orientation, (n, 4), unit quaternions with the scalar first, body to world.
    #[getter]
    fn orientation<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.motion_part(py, 3, 7)
    }

    /// Velocity of the centre of mass, (n, 3), m/s, world axes.
    #[getter]
    fn velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.motion_part(py, 7, 10)
    }

    /// Angular velocity, (n, 3), rad/s, world axes.
    #[getter]
    fn angular_velocity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.motion_part(py, 10, 13)
    }

    /// Standard deviations of the centre of mass, (n, 3), m, world axes.
    #[getter]
    fn position_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.deviation_part(py, 0)
    }

    /// Standard deviations of the velocity, (n, 3), m/s, world axes.
    #[getter]
    fn velocity_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.deviation_part(py, 1)
    }

    /// Standard deviations of the angular velocity, (n, 3), rad/s, world axes.
    #[getter]
    fn angular_velocity_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.deviation_part(py, 2)
    }

    /// Standard deviations of the turn since the first sample, (n, 3), rad, world axes.
    #[getter]
    fn turn_std<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.deviation_part(py, 3)
    }

    /// Covariances of position and turn together, (n, 6, 6), m and rad, world axes; None without forces.
    #[getter]
    fn pose_covariance<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let all = self.made.pose_covariances();
        let numbers = all.as_flattened().as_flattened();
        if all.is_empty() { Ok(None) } else { block(py, numbers.to_vec(), [6, 6]).map(Some) }
    }

    /// Whether the motion of a sample is relied on to within its deviations, (n,), bool; of an estimate with one verdict for all samples,
    /// that.
    #[getter]
    fn relied_on<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all = || vec![self.made.verdict().0; self.made.times().len()];
        vector(py, self.made.relied_on().map_or_else(all, <[bool]>::to_vec))
    }

    /// Contact modes, (n, palms), uint8: 0 off, 1 slides, 2 sticks; None of three planes without friction.
    #[getter]
    fn modes<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(modes) = self.made.modes() else { return Ok(None) };
        let palms = modes.first().map_or(0, Vec::len);
        table(py, modes.concat(), palms).map(Some)
    }

    /// How probable it is that each palm slides and that it sticks, (n, palms, 2), to a millionth; the rest is that it is off. None where it is
    /// not estimated.
    #[getter]
    fn mode_probabilities<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(all) = self.made.mode_probabilities() else { return Ok(None) };
        let palms = all.first().map_or(0, Vec::len);
        let values = all.iter().flatten().flatten().copied().collect();
        block(py, values, [palms, 2]).map(Some)
    }

    /// Where the palms touched the object, (n, palms, 3), m, body axes from the centre of mass; nan where they did not.
    #[getter]
    fn contacts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.of_contacts(py, |contact| contact.p_OC)
    }

    /// The same points in the world, (n, palms, 3), m.
    #[getter]
    fn contacts_world<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.of_contacts(py, |contact| contact.p_WC)
    }

    /// Outward normals there, (n, palms, 3), body axes.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.of_contacts(py, |contact| contact.normal)
    }

    /// Mass, kg; None without forces.
    #[getter]
    fn mass(&self) -> Option<f64> {
        self.body().map(|body| body.mass)
    }

    /// Its standard deviation, kg, where it was estimated.
    #[getter]
    fn mass_std(&self) -> Option<f64> {
        self.body()?.deviations.map(|of| of.0)
    }

    /// Inertia about the centre of mass, (3, 3), kg m^2, body axes; None without forces.
    #[getter]
    fn inertia<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.body().map(|body| matrix(py, &body.inertia)).transpose()
    }

    /// Standard deviations of its entries, (3, 3), kg m^2, where it was estimated.
    #[getter]
    fn inertia_std<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let deviations = self.body().and_then(|body| body.deviations);
        deviations.map(|of| matrix(py, &of.1)).transpose()
    }

    /// Surface of the bound that lies inside of the object; None where there is none.
    #[getter]
    fn lower_bound(&self) -> Option<Mesh> {
        let volume = self.made.bounds().map(|bounds| bounds.lower.volume);
        self.made.surfaces()[0].map(|mesh| Mesh::new(mesh, volume))
    }

    /// Surface of the bound that holds the object; None where there is none.
    #[getter]
    fn upper_bound(&self) -> Option<Mesh> {
        let volume = self.made.bounds().and_then(|bounds| Some(bounds.upper.as_ref()?.volume));
        self.made.surfaces()[1].map(|mesh| Mesh::new(mesh, volume))
    }

    /// The page that the command writes (HTML, which loads nothing).
    #[getter]
    fn report_html(&self, py: Python<'_>) -> PyResult<String> {
        let page = py.detach(|| self.made.report()).map_err(raised)?;
        Ok(String::from_utf8_lossy(&page).into_owned())
    }

    /// Writes the folder that the command writes, whole or not at all: motion.csv, contact_curves.csv, summary.json, meshes, report.html.
    ///
    /// export: "mjcf", "urdf": the object for simulators, with export_shape "auto", "ellipsoid", "inner" or "outer". mesh: "stl", "glb": the
    /// bounds in these formats beside PLY. mcap: a bag for Foxglove too. covariance: that of the pose at all samples too. force: write beside files that recon did not write, which are never replaced. Raises OutputError.
    #[pyo3(signature = (folder, *, export=Vec::new(), export_shape="auto", mesh=Vec::new(), mcap=false, covariance=false, force=false))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn write(
        &self,
        py: Python<'_>,
        folder: PathBuf,
        export: Vec<String>,
        export_shape: &str,
        mesh: Vec<String>,
        mcap: bool,
        covariance: bool,
        force: bool,
    ) -> PyResult<()> {
        let mut words: Vec<String> = export.iter().map(|format| format!("--export={format}")).collect();
        if !export.is_empty() {
            words.push(format!("--export-shape={export_shape}"));
        }
        words.extend(mesh.iter().map(|format| format!("--mesh={format}")));
        words.extend(mcap.then(|| "--mcap".to_owned()));
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
        format!("<recon.Reconstruction\n{}>", self.made.text())
    }
}
