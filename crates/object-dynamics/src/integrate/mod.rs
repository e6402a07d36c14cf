//! Integration of ordinary differential equations of fixed small size: adaptive DOP853 with dense output, and
//! classical fixed-step schemes beside it.

mod dop853;
mod fixed;
mod root;
mod tableau;

pub use dop853::{DenseOutput, Dop853, IntegrationError, Statistics, Tolerance};
pub use fixed::{FixedScheme, integrate_fixed};
pub use root::{RootError, find_root};
