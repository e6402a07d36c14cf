//! Three palms as a [`Model`](crate::Model): the momentum form in state space, with constants of the body as
//! states where they are unknown.

mod blocks;
mod constants;
mod flow;
mod inertia;
mod input;
mod model;
#[cfg(test)]
mod tests;

pub(crate) use blocks::{Block, NodeInputs, set_adjusted_arms};
#[cfg(test)]
use constants::Constant;
pub(crate) use constants::{BODY, Parameters};
pub(crate) use inertia::{INERTIA_NUMBERS, inertia_of_numbers, inertia_slope, numbers_of_inertia};
pub(crate) use input::{NodeInput, Touch};
pub(crate) use model::{MOTION_STATES, ThreePalmModel};
