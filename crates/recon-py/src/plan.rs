//! Where to touch next.

use crate::arrays::{Numbers, from_json, slices};
use crate::unlocked::unlocked;
use pyo3::prelude::*;
use std::path::PathBuf;

/// Where to touch next after contacts in memory.
#[pyfunction]
#[pyo3(signature = (names, columns, words, progress=None))]
pub(crate) fn plan_of_columns<'py>(
    py: Python<'py>,
    names: Vec<String>,
    columns: Vec<Numbers>,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let told =
        unlocked(py, progress, move |_| recon_cli::plan_of_columns(&names, &slices(&columns), &words))?;
    from_json(py, &told)
}

/// Where to touch next after those of a CSV file, or of a folder of `recon explore`.
#[pyfunction]
#[pyo3(signature = (path, words, progress=None))]
pub(crate) fn plan_of_file<'py>(
    py: Python<'py>,
    path: PathBuf,
    words: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let told = unlocked(py, progress, move |_| recon_cli::plan_of_file(&path, &words))?;
    from_json(py, &told)
}
