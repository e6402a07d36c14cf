//! The diagrams of this project, each in a file of its own.
//!
//! A new diagram is a new file here with a constant of the type [`Chart`], and one line in [`ALL`].

mod bounds;
mod command;
mod fig5_simulation;
mod mujoco;
mod page;
mod planar_bounds;
mod reaching;
mod reconstruction;
mod rolling;
mod shared;
mod streaming;

pub use page::write_page;

use crate::{Budget, Diagram};

/// What a diagram's function gives: one diagram, or several that share their measurements. An error is whatever stops
/// the study; a method that fails at a setting is a point of the diagram and no error.
pub type Drawn = Result<Vec<Diagram>, Box<dyn std::error::Error + Send + Sync>>;

/// An entry of the list.
#[derive(Clone, Copy, Debug)]
pub struct Chart {
    /// The name on the command line.
    pub name: &'static str,
    /// One line for `--list`.
    pub about: &'static str,
    /// Measures within the budget, and draws.
    pub draw: fn(Budget) -> Drawn,
}

/// All of them, in the order of `--list`.
pub const ALL: &[Chart] = &[
    fig5_simulation::CHART,
    reconstruction::BY_WINDOW,
    reconstruction::BY_RATE,
    reconstruction::BY_NOISE,
    reconstruction::PLANE,
    streaming::CHART,
    command::CHART,
    bounds::CHART,
    planar_bounds::CHART,
    reaching::CHART,
    rolling::CHART,
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_given_once() {
        for (index, chart) in ALL.iter().enumerate() {
            assert!(ALL[..index].iter().all(|other| other.name != chart.name), "{} twice", chart.name);
        }
    }
}
