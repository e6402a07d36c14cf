//! What differs between bodies that are known and bodies that are not.

use super::search::Trial;
use crate::core::Start;
use crate::three_palms::momentum::Scales;
use crate::three_palms::state_space::{NodeInput, ThreePalmModel};
use crate::three_palms::track::Track;
use std::collections::VecDeque;

/// The data that a cold start works on.
pub(super) struct Gathered {
    /// A node a block, with the wrench's integrals from the start.
    pub(super) track: Track,
    /// The same nodes as the state-space model takes them, with the palms in contact.
    pub(super) nodes: VecDeque<(NodeInput, [bool; 3])>,
    /// Samples in a block.
    pub(super) stride: usize,
}

/// A body, known or not, of which `N` numbers are estimated and `P` are searched for.
pub(super) trait Kind<const N: usize, const P: usize> {
    /// What a search finds.
    type Point: Copy;
    /// The search's problem.
    type Trial<'a>: Trial<P, Point = Self::Point>
    where
        Self: 'a;

    /// Mass that tracks are made with, kg.
    fn nominal_mass(&self) -> f64;
    /// Natural sizes.
    fn scales(&self, track: &Track) -> Scales;
    /// The problem on the data so far.
    fn trial<'a>(&'a self, data: &'a Gathered, scales: Scales) -> Self::Trial<'a>;
    /// The model with the state that the search has found, and what is known of it beforehand.
    fn begin(&self, found: &Self::Point, scales: Scales) -> Option<(ThreePalmModel<N>, Start<N>)>;
}
