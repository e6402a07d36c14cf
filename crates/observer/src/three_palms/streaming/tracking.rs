//! A motion that was found, and how it stands with the data since.

use super::estimate::StreamBody;
use super::front::{Falling, Front};
use super::tracker::{Tracked, Tracker};
use crate::three_palms::state_space::{MOTION_STATES, NodeInput};
use nalgebra::SMatrix;
use std::collections::VecDeque;

/// Mean squared innovation, over what is expected, beyond which model and data contradict each other. A hundred channels
/// have a deviation of 0.14 about one; linearisation adds to it.
const CONTRADICTION: f64 = 2.0;
/// The same, below which a contradiction has passed: a wrong motion contradicts its data now more, now less.
const RECONCILED: f64 = 1.4;

/// A motion that was found.
pub(super) struct Tracking<const N: usize> {
    pub(super) tracker: Tracker<N>,
    /// Nodes that the tracker has not taken yet.
    pub(super) nodes: VecDeque<(NodeInput, [bool; 3])>,
    pub(super) latest: Option<Latest>,
    /// Nodes that were taken by the tracker, and not fitted before.
    pub(super) fresh: usize,
    pub(super) contradicted: bool,
}

impl<const N: usize> Tracking<N> {
    pub(super) fn new(tracker: Tracker<N>, nodes: VecDeque<(NodeInput, [bool; 3])>) -> Self {
        Self { tracker, nodes, latest: None, fresh: 0, contradicted: false }
    }

    /// Takes the tracker through the next node; a state once it has taken the newest.
    pub(super) fn advance(&mut self) -> Option<Tracked<N>> {
        let (input, touching) = self.nodes.pop_front()?;
        let tracked = self.tracker.take(input, touching);
        self.fresh += 1;
        let bound = if self.contradicted { RECONCILED } else { CONTRADICTION };
        // What is not a number contradicts.
        self.contradicted = self.tracker.innovation().is_nan() || self.tracker.innovation() > bound;
        self.nodes.is_empty().then_some(tracked)
    }
}

/// The latest node that the tracker has taken, and the motion since.
pub(super) struct Latest {
    pub(super) covariance: SMatrix<f64, MOTION_STATES, MOTION_STATES>,
    pub(super) observed: bool,
    pub(super) body: Falling,
    pub(super) found: Option<StreamBody>,
    pub(super) front: Front,
}
