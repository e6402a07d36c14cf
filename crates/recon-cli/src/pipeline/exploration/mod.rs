//! Explorations, in space and in the plane: what is asked for, what was done, where the next touch would be.

mod contour;
mod contour_page;
mod finger;
mod groups;
mod motions;
mod page;
mod parallel;
mod parallel_state;
mod plane;
mod relief;
mod relief_files;
mod relief_page;
mod rolling;
mod sensed;
mod settings;
mod side;
mod space;
mod state;
mod story;

pub(crate) use contour::{Following, followed};
pub(crate) use parallel::{next_stroke, stroked};
pub(crate) use parallel_state::Placed;
pub(crate) use plane::InPlane;
pub(crate) use relief::{Descending, felt};
pub(crate) use rolling::{next_motion, rolled};
pub(crate) use sensed::sensed;
pub(crate) use settings::{CONFIDENCE, Settings, goal_of, until_of};
pub(crate) use side::Side;
pub(crate) use space::InSpace;
pub(crate) use state::{STATE, State};
pub(crate) use story::{Explored, explored, next_touch};
