//! Bounds on a shape.

use crate::arrays::{Numbers, flat2, from_json, slices, table};
use crate::errors::raised;
use crate::mesh::Mesh;
use crate::unlocked::unlocked;
use pyo3::prelude::*;
use recon_cli::Bounded;
use std::path::PathBuf;

/// What contacts or poses guarantee about a shape.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Bounds {
    made: Bounded,
}

/// Bounds from columns in memory.
#[pyfunction]
#[pyo3(signature = (names, columns, words, progress=None))]
pub(crate) fn bounds_of_columns(
    py: Python<'_>,
    names: Vec<String>,
    columns: Vec<Numbers>,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bounds> {
    let made = unlocked(py, progress, move |_| Bounded::of_columns(&names, &slices(&columns), &words))?;
    Ok(Bounds { made })
}

/// Bounds from a CSV file.
#[pyfunction]
#[pyo3(signature = (path, words, progress=None))]
pub(crate) fn bounds_of_file(
    py: Python<'_>,
    path: PathBuf,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bounds> {
    let made = unlocked(py, progress, move |_| Bounded::read(&path, &words))?;
    Ok(Bounds { made })
}

#[pymethods]
impl Bounds {
    /// Whether both bounds are there, do not contradict each other, and a fit was not refused.
    #[getter]
    fn is_whole(&self) -> bool {
        self.made.is_whole()
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

    /// What summary.json of the command holds.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        from_json(py, self.made.summary())
    }

    /// Volume of the lower bound, m^3; None in the plane.
    #[getter]
    fn lower_volume(&self) -> Option<f64> {
        self.made.bounds().map(|bounds| bounds.lower.volume)
    }

    /// Volume of the upper bound, m^3; None in the plane, or where there is none.
    #[getter]
    fn upper_volume(&self) -> Option<f64> {
        self.made.bounds().and_then(|bounds| Some(bounds.upper.as_ref()?.volume))
    }

    /// Areas of the lower and the upper bound, m^2; None in space. The second is inf where a side is open.
    #[getter]
    fn areas(&self) -> Option<[f64; 2]> {
        self.made.outlines().map(|outlines| outlines.areas)
    }

    /// Largest distance between the bounds, m.
    #[getter]
    fn largest_gap(&self) -> Option<f64> {
        match self.made.outlines() {
            Some(outlines) => outlines.largest_gap,
            None => self.made.bounds()?.largest_gap.map(|gap| gap.distance),
        }
    }

    /// Surface of the bound that lies inside of the object, in space.
    #[getter]
    fn lower_bound(&self) -> Option<Mesh> {
        self.made.surfaces()[0].map(|mesh| Mesh::new(mesh, self.lower_volume()))
    }

    /// Surface of the bound that holds the object, in space.
    #[getter]
    fn upper_bound(&self) -> Option<Mesh> {
        self.made.surfaces()[1].map(|mesh| Mesh::new(mesh, self.upper_volume()))
    }

    /// Corners of the lower and the upper bound in the plane, (n, 2) and (m, 2), m; None in space.
    #[getter]
    fn outlines<'py>(&self, py: Python<'py>) -> PyResult<Option<[Bound<'py, PyAny>; 2]>> {
        let Some(of) = self.made.outlines() else { return Ok(None) };
        Ok(Some([table(py, flat2(of.lower), 2)?, table(py, flat2(of.upper), 2)?]))
    }

    /// Corners of the fitted outline in the plane, (n, 2), m; None where there is none.
    #[getter]
    fn fitted_outline<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let Some(of) = self.made.outlines().filter(|of| !of.fitted.is_empty()) else { return Ok(None) };
        table(py, flat2(of.fitted), 2).map(Some)
    }

    /// Surface of the fitted shape, in space; None where none was asked for, or the contacts refute it.
    #[getter]
    fn fitted(&self) -> Option<Mesh> {
        self.made.surface("fitted_shape.ply").map(|mesh| Mesh::new(mesh, None))
    }

    /// Alpha shape of a body that need not be convex; an approximation.
    #[getter]
    fn alpha_shape(&self) -> Option<Mesh> {
        self.made.surface("alpha_shape.ply").map(|mesh| Mesh::new(mesh, None))
    }

    /// Smooth surface through points and normals of a body that need not be convex; an approximation.
    #[getter]
    fn smooth_surface(&self) -> Option<Mesh> {
        self.made.surface("smooth_surface.ply").map(|mesh| Mesh::new(mesh, None))
    }

    /// Writes the folder that the command writes; `mesh` names formats beside PLY ("stl", "glb"), `force` writes beside files that recon did
    /// not write.
    #[pyo3(signature = (folder, *, mesh=Vec::new(), force=false))]
    fn write(&self, py: Python<'_>, folder: PathBuf, mesh: Vec<String>, force: bool) -> PyResult<()> {
        let mut words: Vec<String> = mesh.iter().map(|format| format!("--mesh={format}")).collect();
        words.extend(force.then(|| "--force".to_owned()));
        py.detach(|| self.made.write(&folder, &words)).map_err(raised)
    }

    fn __repr__(&self) -> String {
        format!("<recon.Bounds\n{}>", self.made.text())
    }
}
