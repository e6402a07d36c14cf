//! recon for Python: the module `recon._recon`, which the package in `python/recon` gives names, keywords and units.
//!
//! Everything that computes is in `recon-cli`, which the command runs too. Here are the border alone: arrays, exceptions, and who may run
//! while it computes.

#![cfg(feature = "extension")]

mod arrays;
mod bounds;
mod errors;
mod follower;
mod log;
mod mesh;
mod plan;
mod plane;
mod plane_reconstruction;
mod reconstruction;
mod scene;
mod unlocked;

use pyo3::prelude::*;

/// Runs the command `recon` with these arguments, the first of which is its name; returns its exit code.
#[pyfunction]
fn main(py: Python<'_>, args: Vec<String>) -> u8 {
    py.detach(|| recon_cli::main(args.into_iter().map(Into::into)))
}

/// Checks a folder of results by its files alone; returns what held.
#[pyfunction]
fn check(py: Python<'_>, folder: std::path::PathBuf) -> PyResult<Vec<String>> {
    py.detach(|| recon_cli::check(&folder)).map_err(errors::raised)
}

/// The native half of the package `recon`.
#[pymodule]
fn _recon(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    errors::add(module)?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<log::Log>()?;
    module.add_class::<log::Simulation>()?;
    module.add_class::<reconstruction::Reconstruction>()?;
    module.add_class::<bounds::Bounds>()?;
    module.add_class::<mesh::Mesh>()?;
    module.add_class::<follower::Follower>()?;
    module.add_function(wrap_pyfunction!(log::simulate, module)?)?;
    module.add_function(wrap_pyfunction!(reconstruction::reconstruct, module)?)?;
    module.add_function(wrap_pyfunction!(bounds::bounds_of_columns, module)?)?;
    module.add_function(wrap_pyfunction!(bounds::bounds_of_file, module)?)?;
    module.add_function(wrap_pyfunction!(plan::plan_of_columns, module)?)?;
    module.add_function(wrap_pyfunction!(plan::plan_of_file, module)?)?;
    // Classes of the same names as those of space.
    module.add("PlaneScene", module.py().get_type::<plane::PlaneScene>())?;
    module.add("PlaneLog", module.py().get_type::<plane::PlaneLog>())?;
    module.add("PlaneSimulation", module.py().get_type::<plane::PlaneSimulation>())?;
    module.add("PlaneReconstruction", module.py().get_type::<plane_reconstruction::PlaneReconstruction>())?;
    module.add_function(wrap_pyfunction!(plane::simulate_plane, module)?)?;
    module.add_function(wrap_pyfunction!(plane_reconstruction::reconstruct_plane, module)?)?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(check, module)?)
}
