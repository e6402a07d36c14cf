//! Arrays of numpy: their bytes cross the border, one copy each way. What Rust made stands on `bytes`, which nobody can write to: all who
//! ask for an array get the same one.

use glam::{DMat3, DQuat, DVec2, DVec3};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyAny, PyBytes, PySlice};
use serde_json::Value;

/// An array's numbers, row by row, as Rust's own: work goes on without the interpreter, under which arrays may change.
pub(crate) struct Numbers(pub(crate) Vec<f64>);

impl<'py> FromPyObject<'_, 'py> for Numbers {
    type Error = PyErr;

    fn extract(array: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let kind = array.getattr("dtype")?;
        if !kind.eq("float64")? {
            return Err(PyTypeError::new_err(format!("an array of {kind}; float64 is taken")));
        }
        let bytes = array.call_method0("tobytes")?;
        let (numbers, _) = bytes.cast::<PyBytes>()?.as_bytes().as_chunks();
        Ok(Self(numbers.iter().copied().map(f64::from_ne_bytes).collect()))
    }
}

/// Columns, as what computes takes them.
pub(crate) fn slices(columns: &[Numbers]) -> Vec<&[f64]> {
    columns.iter().map(|Numbers(numbers)| numbers.as_slice()).collect()
}

/// What an array holds.
pub(crate) trait Element: Copy {
    /// numpy's name of the type.
    const NAME: &str;

    /// Writes the bytes that numpy reads.
    fn write(self, to: &mut [u8]);
}

macro_rules! element {
    ($($kind:ty, $name:literal;)*) => {$(
        impl Element for $kind {
            const NAME: &str = $name;

            fn write(self, to: &mut [u8]) {
                to.copy_from_slice(&self.to_ne_bytes());
            }
        }
    )*};
}

element! { f64, "f8"; u32, "u4"; u8, "u1"; }

impl Element for bool {
    const NAME: &str = "?";

    fn write(self, to: &mut [u8]) {
        to.fill(self.into());
    }
}

/// An array with one axis.
pub(crate) fn vector<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let length = size_of_val(values.as_slice());
    let bytes = PyBytes::new_with(py, length, |bytes| {
        for (to, value) in bytes.chunks_exact_mut(size_of::<T>()).zip(&values) {
            value.write(to);
        }
        Ok(())
    })?;
    py.import("numpy")?.call_method1("frombuffer", (bytes, T::NAME))
}

/// The same with two axes, row by row.
pub(crate) fn table<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    columns: usize,
) -> PyResult<Bound<'_, PyAny>> {
    let rows = values.len() / columns.max(1);
    vector(py, values)?.call_method1("reshape", (rows, columns))
}

/// The same with three axes.
pub(crate) fn block<T: Element>(
    py: Python<'_>,
    values: Vec<T>,
    [middle, last]: [usize; 2],
) -> PyResult<Bound<'_, PyAny>> {
    let first = values.len() / (middle * last).max(1);
    vector(py, values)?.call_method1("reshape", (first, middle, last))
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
pub(crate) fn matrix<'py>(py: Python<'py>, of: &DMat3) -> PyResult<Bound<'py, PyAny>> {
    table(py, of.transpose().to_cols_array().to_vec(), 3)
}

/// What JSON says, as Python's own.
pub(crate) fn from_json<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    py.import("json")?.getattr("loads")?.call1((value.to_string(),))
}
