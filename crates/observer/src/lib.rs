//! Newton-method observers, and estimators of the shape and motion of a body from touch.

mod least_squares;
#[cfg(feature = "palms")]
mod three_palms;

pub use least_squares::{Fit, FitStatus, LeastSquares, LevenbergMarquardt, NormalEquations, Observability};
#[cfg(feature = "palms")]
pub use three_palms::*;
