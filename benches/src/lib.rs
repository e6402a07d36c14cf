//! Charts of cost against error, the atlas of failures, and the timing that feeds them.
//!
//! A *work-precision* chart has one curve per method and one point per setting, error against cost, both
//! logarithmic: a method is better where its curve is lower and further to the left. It is written as CSV, SVG and PNG. Where methods fail, and what
//! they say of themselves there, is in the [`atlas`].
//!
//! [`Study`] runs methods, asks for their error and times them side by side; [`charts`] lists the diagrams of this
//! project, which `cargo xtask chart` draws into `docs/charts/`.
//!
//! ```
//! use recon_benches::{Axis, Budget, Study, WorkPrecision};
//!
//! let mut study = Study::new();
//! for n in [10_u32, 100, 1000] {
//!     let mean = move || (0..n).map(|i| (f64::from(i) / f64::from(n)).exp()).sum::<f64>() / f64::from(n);
//!     study.case("left sum", format!("n = {n}"), mean, |mean| (mean - (1.0_f64.exp() - 1.0)).abs());
//! }
//! let chart = WorkPrecision::new("quadrature", "Integral of exp over the unit interval")
//!     .axes(Axis::log("error", "1"), Axis::log("time", "ms"))
//!     .methods(study.measure(Budget::quick(), 1.0));
//! assert!(chart.csv().starts_with("method,setting,"));
//! ```

pub mod atlas;
pub mod bound;
pub mod departures;
mod diagram;
pub mod fault;
pub mod fig5;
pub mod instructions;
mod machine;
pub mod multipliers;
pub mod noisy_contacts;
pub mod palms;
pub mod parallel;
pub mod planar;
pub mod reaching;
pub mod rolling;
pub mod rolling_sensed;
pub mod rows;
pub mod streaming;
mod timing;

pub mod charts;

#[cfg(test)]
extern crate self as recon_benches;
#[cfg(test)]
mod self_check;

pub use diagram::{
    Axis, ChartError, Diagram, Goal, Method, Outcome, Outlines, Point, Scale, Stroke, WorkPrecision,
    WrittenChart,
};
pub use machine::{load, machine_line};
pub use timing::{Budget, SideBySide, Study, Timing};
