//! Observers for any system with a flow, an output and their linearisations; nothing here knows palms.

mod bank;
mod batch;
mod density;
mod eigen;
mod ekf;
mod kalman;
mod model;
mod newton;
mod node;
mod report;
mod rk4;
mod window;

pub use bank::{
    Bank, BankError, BankOptions, Branch, Gaussian, Hypothesis, Jump, KalmanMember, Landing, Member, Memory,
    ModeLabel, ModeState, Modes, Odds, jump, match_rotations, rotation_difference, rotation_retract,
    rotation_slope, smooth_backward,
};
pub use batch::{BatchOptions, BatchSolution, solve_batch, solve_batch_along, solve_batch_from};
pub use ekf::{EkfEstimate, ExtendedKalmanFilter};
pub use model::{Model, Sample};
pub use newton::{Arrival, NewtonEstimate, NewtonObserver, NewtonOptions};
pub use node::Link;
#[cfg(feature = "palms")]
pub(crate) use report::direction_words;
pub use report::{ObserverError, Report, Status, describe_direction};
pub use rk4::{rk4, rk4_linearised};
pub use window::Start;
