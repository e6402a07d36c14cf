//! Surfaces.

use crate::arrays::{flat3, table};
use crate::errors::{input, output};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use recon_io::{FileTarget, TriangleMesh, write_glb, write_ply, write_stl};
use std::io::Write;
use std::path::PathBuf;

/// A surface of triangles.
#[pyclass(frozen, module = "recon")]
pub(crate) struct Mesh {
    mesh: TriangleMesh,
    volume: Option<f64>,
    vertices: PyOnceLock<Py<PyAny>>,
    triangles: PyOnceLock<Py<PyAny>>,
}

impl Mesh {
    /// With the volume of what it bounds, m^3, where that is known otherwise than from its corners.
    pub(crate) fn new(mesh: &TriangleMesh, volume: Option<f64>) -> Self {
        Self { mesh: mesh.clone(), volume, vertices: PyOnceLock::new(), triangles: PyOnceLock::new() }
    }
}

#[pymethods]
impl Mesh {
    /// Corners, (v, 3), m, body axes.
    #[getter]
    fn vertices(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made = || table(py, flat3(self.mesh.vertices.iter().copied()), 3).map(Bound::unbind);
        Ok(self.vertices.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// Numbers of the corners of each triangle, (t, 3), counter-clockwise from outside.
    #[getter]
    fn triangles(&self, py: Python<'_>) -> PyResult<Py<PyAny>> {
        let made =
            || table(py, self.mesh.triangles.iter().flatten().copied().collect(), 3).map(Bound::unbind);
        Ok(self.triangles.get_or_try_init(py, made)?.clone_ref(py))
    }

    /// Volume, m^3; None of surfaces that are no bounds.
    #[getter]
    fn volume(&self) -> Option<f64> {
        self.volume
    }

    /// Writes the surface as `.ply` (with all digits), `.stl` or `.glb` (both with seven), m, whole or not at all.
    fn write(&self, path: PathBuf) -> PyResult<()> {
        let ending =
            path.extension().map(|ending| ending.to_string_lossy().to_lowercase()).unwrap_or_default();
        let name = path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
        let failed = |error: std::io::Error| output(format!("{}: {error}", path.display()));
        let mut bytes = Vec::new();
        match ending.as_str() {
            "ply" => write_ply(&self.mesh, "metres", &mut bytes).map_err(failed)?,
            "stl" => write_stl(&self.mesh, &name, &mut bytes).map_err(failed)?,
            "glb" => write_glb(&self.mesh, &name, &mut bytes).map_err(failed)?,
            _ => {
                return Err(input(format!("{} ends in `{ending}`; give .ply, .stl or .glb", path.display())));
            }
        }
        let target = FileTarget::new(&path, &[]).and_then(FileTarget::begin);
        let mut file = target.map_err(|error| output(error.to_string()))?;
        file.write_all(&bytes).map_err(failed)?;
        file.commit().map_err(|error| output(error.to_string()))
    }

    fn __repr__(&self) -> String {
        let (corners, triangles) = (self.mesh.vertices.len(), self.mesh.triangles.len());
        let volume = self.volume.map_or(String::new(), |volume| format!(", {} m^3", recon_io::brief(volume)));
        format!("<recon.Mesh: {corners} corners, {triangles} triangles{volume}>")
    }
}
