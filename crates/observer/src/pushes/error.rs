//! Pushes from which nothing can be told.

use super::touches::{FEWEST_TOUCHED, NoTouch};
use thiserror::Error;

/// Why pushes tell no outline.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PushesError {
    /// A radius that no finger has, or none for this object.
    #[error(
        "the finger's radius is {value} m; it must be above zero and, by the places it touched, below {most:.4} m"
    )]
    Radius {
        /// As given, m.
        value: f64,
        /// Half the extent of the touched places, m.
        most: f64,
    },
    /// Too few pushes in which the object was touched.
    #[error(
        "the object was touched in {touched} of {pushes} push(es); an outline needs {FEWEST_TOUCHED}{}",
        first.map_or(String::new(), |(push, why)| format!(": push {push} {why}"))
    )]
    TooFew {
        /// Pushes that touched.
        touched: usize,
        /// All pushes.
        pushes: usize,
        /// The first that did not, and why.
        first: Option<(u32, NoTouch)>,
    },
    /// Forces that do not push.
    #[error(
        "in {against} of {pushes} pushes the force does not push the object: the finger, or the object, goes against it or not at all; look at the sign and the \
         axes of the force, at the unit and the sense of the poses' angle, and which pose is the one before the push"
    )]
    Against {
        /// Pushes in which it does not.
        against: usize,
        /// Pushes that touched.
        pushes: usize,
    },
    /// No outline fits.
    #[error(
        "no closed outline goes through the {touches} touches; look whether poses and finger are in one frame, in m and rad"
    )]
    NoOutline {
        /// Touches at hand.
        touches: usize,
    },
}
