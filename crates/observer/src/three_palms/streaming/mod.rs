//! The motion sample by sample, in bounded memory and time, from no guess.

mod estimate;
mod front;
mod pieces;
mod search;
mod tracker;

#[cfg(test)]
mod tests;

pub use estimate::{StreamError, StreamEstimate, StreamOptions, StreamStage};

use super::cold_start::rest_state;
use super::momentum::StartState;
use super::state_space::{NodeInput, Parameters, ThreePalmModel, block_inputs};
use super::track::Track;
use crate::core::Start;
use front::{Falling, Front};
use nalgebra::{SMatrix, SVector};
use object_dynamics::Sample;
use pieces::{Piece, Pieces, Reading};
use search::{Scene, StreamSearch};
use std::collections::VecDeque;
use tracker::Tracker;

/// States of the motion.
const STATES: usize = 12;
/// Longest track that a cold start works on, s; then it begins anew with later data.
const LONGEST_SEARCH: f64 = 5.0;
/// Mean squared innovation, over what is expected, beyond which model and data contradict each other. A hundred channels
/// have a deviation of 0.14 about one; linearisation adds to it.
const CONTRADICTION: f64 = 2.5;

/// The motion of a body of known mass and inertia on three palms, sample by sample.
///
/// Samples are gathered into blocks; a node of the state-space model stands for each. The cold start of the batch method
/// runs beside them, one Levenberg-Marquardt step a sample, on the track as it grows. The motion that it finds starts a
/// windowed Gauss-Newton observer at the *first* node (as a point to linearise at, not as evidence), which is then taken
/// through all nodes since: its estimate rests on all data, each counted once. From the latest node to the newest
/// sample the motion follows the measured forces. Memory is bounded, and so is the work of a sample; buffers are made at
/// the start, and small ones at the end of each block.
///
/// A palm that loses contact carries no force and gives no condition; the estimate goes on with what is left, and says
/// so. When contact returns, the blow is too short for the samples: velocity and momentum are taken to be unknown
/// again.
pub struct MotionStream {
    options: StreamOptions,
    stride: usize,
    pieces: Pieces,
    track: Option<Track>,
    nodes: VecDeque<(NodeInput, [bool; 3])>,
    before: Option<NodeInput>,
    search: StreamSearch,
    tracker: Option<Tracker<STATES>>,
    latest: Option<Latest>,
    front: Option<Front>,
    touching: [bool; 3],
    taken: usize,
}

/// The latest node that the tracker has taken.
struct Latest {
    covariance: SMatrix<f64, STATES, STATES>,
    observed: bool,
}

impl MotionStream {
    /// A stream that has seen no sample yet.
    ///
    /// # Errors
    /// [`StreamError::Option`] names the option that is not a usable number.
    pub fn new(options: StreamOptions) -> Result<Self, StreamError> {
        let stride = options.stride()?;
        let nodes = (LONGEST_SEARCH * options.sample_rate / stride as f64).ceil() as usize + 2;
        Ok(Self {
            pieces: Pieces::new(stride, options.palm_inertias),
            track: None,
            nodes: VecDeque::with_capacity(nodes),
            before: None,
            search: StreamSearch::new(),
            tracker: None,
            latest: None,
            front: None,
            touching: [true; 3],
            taken: 0,
            stride,
            options,
        })
    }

    /// Takes a sample and returns the motion at the sample before it: rates of palms come from differences. None for
    /// the very first one.
    ///
    /// # Errors
    /// [`StreamError::Sample`] for a sample that cannot be used (it is left out).
    pub fn push(&mut self, sample: &Sample) -> Result<Option<StreamEstimate>, StreamError> {
        let Some(reading) = self.pieces.push(sample).map_err(StreamError::Sample)? else { return Ok(None) };
        self.taken += 1;
        self.touching = reading.touching;
        let body = self.body();
        if let Some(front) = &mut self.front {
            front.advance(&body, &reading);
        }
        if let Some(piece) = self.pieces.piece(self.options.mass.mass(), self.options.gravity) {
            self.node(&piece);
        } else {
            self.work();
        }
        Ok(Some(self.estimate(&reading)))
    }

    fn body(&self) -> Falling {
        Falling {
            mass: self.options.mass.mass(),
            inverse_inertia: self.options.mass.inverse_inertia(),
            gravity: self.options.gravity,
        }
    }

    /// A block is complete.
    fn node(&mut self, piece: &Piece) {
        let inputs = block_inputs(&piece.track, self.stride);
        let (Some(first), Some(middle)) = (inputs.first(), inputs.get(1)) else { return };
        if self.tracker.is_none() {
            self.extend_search(piece, first);
        }
        let mut input = *middle;
        if let Some(before) = &self.before {
            // The block about the node before, whole.
            input.from = before.here;
        }
        self.before = Some(input);
        self.nodes.push_back((input, piece.touching));
    }

    /// Makes the track of the cold start longer; one that is too long, or in which contact was lost, begins anew.
    fn extend_search(&mut self, piece: &Piece, first: &NodeInput) {
        let lost = piece.touching.contains(&false);
        let long = self.track.as_ref().is_some_and(|t| t.duration() >= LONGEST_SEARCH);
        if lost || long {
            self.track = None;
            self.search = StreamSearch::new();
        }
        if lost {
            self.nodes.clear();
            self.before = None;
            return;
        }
        let reach = self.stride / 2;
        let track = self.track.get_or_insert_with(|| {
            let room = self.nodes.capacity();
            let start = piece.track.times().next().unwrap_or_default();
            let mut track = Track::growing(self.options.mass.mass(), self.options.gravity, start, room);
            track.extend(&piece.track, 0, reach);
            self.nodes.clear();
            self.nodes.push_back((*first, piece.touching));
            track
        });
        track.extend(&piece.track, self.stride, reach);
    }

    /// What is to be done between the ends of blocks.
    fn work(&mut self) {
        if self.tracker.is_some() {
            self.take_node();
            return;
        }
        let Some(track) = &self.track else { return };
        let scene =
            Scene { track, mass: &self.options.mass, noise: self.options.noise, stride: self.stride };
        let Some(start) = self.search.step(&scene) else { return };
        let Some(scales) = self.search.scales() else { return };
        let parameters = Parameters::new(&self.options.mass);
        let (gravity, noise) = (self.options.gravity, self.options.noise);
        let Some(model) = ThreePalmModel::new(parameters, &[], gravity, noise, scales) else { return };
        let start = Start::guess(model.state(&start, &parameters));
        self.tracker = Tracker::new(model, start).ok();
        self.track = None;
    }

    /// Takes the tracker through the next node.
    fn take_node(&mut self) {
        let (Some(tracker), Some((input, touching))) = (&mut self.tracker, self.nodes.pop_front()) else {
            return;
        };
        if !self.nodes.is_empty() {
            tracker.catch_up(input, touching);
            return;
        }
        let tracked = tracker.take(input, touching);
        let observed = tracked.report.rank == STATES;
        self.latest = Some(Latest { covariance: tracked.report.covariance, observed });
        self.follow(tracked.motion);
    }

    /// Lets the front start from the latest node, which is one block before the newest sample.
    fn follow(&mut self, motion: StartState) {
        let body = self.body();
        let mut readings = self.pieces.newest(self.stride + 1 + self.pieces.since());
        let Some(at) = readings.next() else { return };
        let mut front = Front::new(motion, *at);
        for next in readings {
            front.advance(&body, next);
        }
        self.front = Some(front);
    }

    fn estimate(&self, reading: &Reading) -> StreamEstimate {
        let lost = self.touching.map(|touches| !touches);
        let tracked = self.front.as_ref().zip(self.latest.as_ref()).zip(self.tracker.as_ref());
        let Some(((front, latest), tracker)) = tracked else { return self.from_rest(reading, lost) };
        let innovation = tracker.innovation();
        let stage = if innovation > CONTRADICTION {
            StreamStage::Contradicted
        } else if latest.observed {
            StreamStage::Tracking
        } else {
            StreamStage::Searching { rounds: self.search.rounds() }
        };
        StreamEstimate { motion: front.motion(&self.body()), covariance: latest.covariance, stage, innovation, lost }
    }

    /// Before a motion is found: the body at rest where the contact wrench balances, known to its own size.
    fn from_rest(&self, reading: &Reading, lost: [bool; 3]) -> StreamEstimate {
        let rounds = self.search.rounds();
        let stage = if rounds == 0 { StreamStage::Gathering } else { StreamStage::Searching { rounds } };
        let single = Track::assemble(
            vec![0.0],
            vec![reading.node],
            self.options.mass.mass(),
            self.options.gravity,
            reading.t,
        );
        let state = rest_state(&single, 0.0);
        let scales = super::cold_start::scales(&single, &self.options.mass).by_block();
        let covariance = SMatrix::from_diagonal(&SVector::from_fn(|i, _| scales[i / 3] * scales[i / 3]));
        let motion = Front::new(state, *reading).motion(&self.body());
        StreamEstimate { motion, covariance, stage, innovation: f64::NAN, lost }
    }
}
