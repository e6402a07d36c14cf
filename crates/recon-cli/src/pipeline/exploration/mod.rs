//! Explorations, in space and in the plane: what is asked for, what was done, where the next touch would be.

mod page;
mod plane;
mod rolling;
mod settings;
mod side;
mod space;
mod story;

pub(crate) use plane::InPlane;
pub(crate) use rolling::rolled;
pub(crate) use settings::{Settings, goal_of, until_of};
pub(crate) use side::Side;
pub(crate) use space::InSpace;
pub(crate) use story::{Explored, explored, next_touch};
