//! Banks: several modes of a system side by side, weighed by how well each predicts the outputs.
//!
//! [`Modes`] holds what does not change with the data: a [`Member`] for each mode, the probabilities of switches, and the
//! [`jump`]s that say what a switch does to the state. A [`Bank`] takes samples. `bank.rs` is the way of a sample,
//! `answers.rs` what can be asked.

mod answers;
mod backward;
#[expect(clippy::module_inception, reason = "the bank of the module of banks")]
mod bank;
mod error;
mod gaussian;
mod hypothesis;
mod jump;
mod label;
mod log_weights;
mod member;
mod merge;
mod mixture;
mod odds;
mod options;
mod rotation;
mod system;

pub use backward::smooth_backward;
pub use bank::{Bank, ModeState};
pub use error::BankError;
pub use gaussian::{Branch, Gaussian};
pub use hypothesis::Hypothesis;
pub use jump::{Jump, Landing, jump};
pub use label::ModeLabel;
pub use member::{KalmanMember, Member};
pub use odds::Odds;
pub use options::{BankOptions, Memory};
pub use rotation::{match_rotations, rotation_difference, rotation_retract, rotation_slope};
pub use system::Modes;
