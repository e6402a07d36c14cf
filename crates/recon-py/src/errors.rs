//! Failures as exceptions that say by their class whose turn it is.

use pyo3::exceptions::{PyException, PyKeyboardInterrupt, PyOSError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use pyo3::sync::PyOnceLock;
use pyo3::types::{PyDict, PyTuple, PyType};
use recon_cli::{Failure, FailureKind};

/// The classes, in the order in which they are made; they inherit from one another and from what Python calls such errors.
struct Classes {
    input: Py<PyType>,
    option: Py<PyType>,
    output: Py<PyType>,
    fault: Py<PyType>,
}

static CLASSES: PyOnceLock<Classes> = PyOnceLock::new();

/// Makes the classes and adds them to the module.
pub(crate) fn add(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    let class = |name: &str, bases: Bound<'_, PyTuple>, doc: &str| -> PyResult<Py<PyType>> {
        let space = PyDict::new(py);
        space.set_item("__doc__", doc)?;
        space.set_item("__module__", "recon")?;
        let made = py.get_type::<PyType>().call1((name, bases, space))?.cast_into::<PyType>()?;
        module.add(name, &made)?;
        Ok(made.unbind())
    };
    let root = class(
        "ReconError",
        PyTuple::new(py, [py.get_type::<PyException>()])?,
        "Why recon has no result. The message names the value, the place and the mend.",
    )?;
    let root = root.bind(py);
    let both = |other| PyTuple::new(py, [root, &other]);
    let input = class(
        "InputError",
        both(py.get_type::<PyValueError>())?,
        "A log, a scene or contacts that cannot be used: which value, at which row or line, and what to do.",
    )?;
    let option = class(
        "OptionError",
        both(py.get_type::<PyValueError>())?,
        "A keyword whose value is not understood, or that does not go with the input.",
    )?;
    let output = class("OutputError", both(py.get_type::<PyOSError>())?, "A result that cannot be written.")?;
    let fault = class(
        "FaultError",
        both(py.get_type::<PyRuntimeError>())?,
        "A fault of recon itself, as where results fail the check at their end.",
    )?;
    // A module is made once.
    let _ = CLASSES.set(py, Classes { input, option, output, fault });
    Ok(())
}

/// A failure as the exception that is raised.
pub(crate) fn raised(failure: Failure) -> PyErr {
    Python::attach(|py| {
        let Some(classes) = CLASSES.get(py) else { return PyRuntimeError::new_err(failure.message) };
        let class = match failure.kind {
            FailureKind::Input => &classes.input,
            FailureKind::Option => &classes.option,
            FailureKind::Output => &classes.output,
            FailureKind::Fault => &classes.fault,
            FailureKind::Interrupted => return PyKeyboardInterrupt::new_err(failure.message),
        };
        PyErr::from_type(class.bind(py).clone(), failure.message)
    })
}

/// An input that cannot be used.
pub(crate) fn input(message: String) -> PyErr {
    raised(Failure { kind: FailureKind::Input, message })
}

/// A result that cannot be written.
pub(crate) fn output(message: String) -> PyErr {
    raised(Failure { kind: FailureKind::Output, message })
}
