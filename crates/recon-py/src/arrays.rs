//! Arrays: what Rust filled becomes an array's own memory, and nothing is copied at the border.

use glam::{DMat3, DQuat, DVec2, DVec3};
use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyAny, PySlice};
use serde_json::Value;

/// An array that cannot be written to, since all who ask for it get the same one.
pub(crate) fn vector<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Bound<'_, PyArray1<T>>> {
    let array = PyArray1::from_vec(py, values);
    array.try_readwrite().map_err(borrowed)?.make_nonwriteable();
    Ok(array)
}

/// The same with two axes, row by row.
pub(crate) fn table<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyArray2<T>>> {
    let rows = values.len() / columns.max(1);
    let array = PyArray1::from_vec(py, values).reshape([rows, columns])?;
    array.try_readwrite().map_err(borrowed)?.make_nonwriteable();
    Ok(array)
}

/// The same with three axes.
pub(crate) fn block<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    [middle, last]: [usize; 2],
) -> PyResult<Bound<'_, PyArray3<T>>> {
    let first = values.len() / (middle * last).max(1);
    let array = PyArray1::from_vec(py, values).reshape([first, middle, last])?;
    array.try_readwrite().map_err(borrowed)?.make_nonwriteable();
    Ok(array)
}

/// An array that was just made is nobody else's.
fn borrowed(error: numpy::BorrowError) -> PyErr {
    pyo3::exceptions::PyRuntimeError::new_err(error.to_string())
}

/// The columns `from..to` of an array with two axes, sharing its memory.
pub(crate) fn columns<'py>(of: &Bound<'py, PyAny>, from: isize, to: isize) -> PyResult<Bound<'py, PyAny>> {
    let py = of.py();
    of.get_item((PySlice::full(py), PySlice::new(py, from, to, 1)))
}

/// One column of an array with two axes, sharing its memory.
pub(crate) fn column<'py>(of: &Bound<'py, PyAny>, which: usize) -> PyResult<Bound<'py, PyAny>> {
    of.get_item((PySlice::full(of.py()), which))
}

/// The last axis of vectors in a row.
pub(crate) fn flat3(vectors: impl Iterator<Item = DVec3>) -> Vec<f64> {
    vectors.flat_map(|v| v.to_array()).collect()
}

/// The same in the plane.
pub(crate) fn flat2(vectors: &[DVec2]) -> Vec<f64> {
    vectors.iter().flat_map(|v| v.to_array()).collect()
}

/// A quaternion with the scalar first, as in files.
pub(crate) fn wxyz(q: DQuat) -> [f64; 4] {
    [q.w, q.x, q.y, q.z]
}

/// A matrix row by row.
pub(crate) fn matrix<'py>(py: Python<'py>, of: &DMat3) -> PyResult<Bound<'py, PyArray2<f64>>> {
    table(py, of.transpose().to_cols_array().to_vec(), 3)
}

/// What JSON says, as Python's own.
pub(crate) fn from_json<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.getattr("loads")?.call1((value.to_string(),))
}
