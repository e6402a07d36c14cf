//! The stream of one kind of body.

use super::estimate::{StreamBody, StreamError, StreamEstimate, StreamOptions, StreamStage};
use super::front::{Falling, Front};
use super::kind::{Gathered, Kind};
use super::pieces::{Piece, Pieces, Reading};
use super::search::StreamSearch;
use super::tracker::{Tracked, Tracker};
use crate::three_palms::cold_start::rest_state;
use crate::three_palms::momentum::Scales;
use crate::three_palms::state_space::{Block, MOTION_STATES, NodeInput, block_inputs};
use crate::three_palms::track::Track;
use glam::DMat3;
use nalgebra::{SMatrix, SVector};
use object_dynamics::Sample;
use std::collections::VecDeque;

/// Longest track that a cold start works on, s; then it begins anew with later data.
const LONGEST_SEARCH: f64 = 6.0;
/// Fewest nodes that a cold start begins with.
const FEWEST: usize = 8;
/// Mean squared innovation, over what is expected, beyond which model and data contradict each other. A hundred channels
/// have a deviation of 0.14 about one; linearisation adds to it.
const CONTRADICTION: f64 = 2.5;

/// A stream of which `N` numbers are estimated; `P` are searched for.
pub(super) struct Stream<K: Kind<N, P>, const N: usize, const P: usize> {
    kind: K,
    options: StreamOptions,
    stride: usize,
    pieces: Pieces,
    gathered: Option<Gathered>,
    before: Option<NodeInput>,
    search: StreamSearch<K::Point, P>,
    scales: Option<Scales>,
    tracking: Option<Tracking<N>>,
    /// A motion that was found since, and has not caught up with the newest node.
    next: Option<Tracking<N>>,
    touching: [bool; 3],
}

/// A motion that was found.
struct Tracking<const N: usize> {
    tracker: Tracker<N>,
    /// Nodes that the tracker has not taken yet.
    nodes: VecDeque<(NodeInput, [bool; 3])>,
    latest: Option<Latest>,
}

impl<const N: usize> Tracking<N> {
    /// Takes the tracker through the next node; a state once it has taken the newest.
    fn advance(&mut self) -> Option<Tracked<N>> {
        let (input, touching) = self.nodes.pop_front()?;
        let tracked = self.tracker.take(input, touching);
        self.nodes.is_empty().then_some(tracked)
    }

    fn contradicted(&self) -> bool {
        self.tracker.innovation() > CONTRADICTION
    }
}

/// The latest node that the tracker has taken, and the motion since.
struct Latest {
    covariance: SMatrix<f64, MOTION_STATES, MOTION_STATES>,
    observed: bool,
    body: Falling,
    found: Option<StreamBody>,
    front: Front,
}

impl<K: Kind<N, P>, const N: usize, const P: usize> Stream<K, N, P> {
    pub(super) fn new(kind: K, options: StreamOptions) -> Result<Self, StreamError> {
        let stride = options.stride()?;
        Ok(Self {
            kind,
            pieces: Pieces::new(stride, options.palm_inertias),
            gathered: None,
            before: None,
            search: StreamSearch::new(),
            scales: None,
            tracking: None,
            next: None,
            touching: [true; 3],
            stride,
            options,
        })
    }

    pub(super) fn push(&mut self, sample: &Sample) -> Result<Option<StreamEstimate>, StreamError> {
        let Some(reading) = self.pieces.push(sample).map_err(StreamError::Sample)? else { return Ok(None) };
        self.touching = reading.touching;
        if let Some(latest) = self.tracking.as_mut().and_then(|t| t.latest.as_mut()) {
            latest.front.advance(&latest.body, &reading);
        }
        if let Some(piece) = self.pieces.piece(self.kind.nominal_mass(), self.options.gravity) {
            self.node(&piece);
        } else {
            self.work();
        }
        Ok(Some(self.estimate(&reading)))
    }

    /// A block is complete.
    fn node(&mut self, piece: &Piece) {
        let half = self.stride / 2;
        let single = |start: usize| Block { start, reach: 0 };
        let cut = [single(0), Block { start: self.stride - half, reach: half }, single(2 * self.stride)];
        // Three nodes: nothing is smoothed.
        let inputs = block_inputs(&piece.track, &cut, 0.0);
        let (Some(first), Some(middle)) = (inputs.first(), inputs.get(1)) else { return };
        let mut input = *middle;
        if let Some(before) = &self.before {
            // The block about the node before, whole.
            input.from = before.here;
        }
        self.before = Some(input);
        for tracking in self.tracking.iter_mut().chain(&mut self.next) {
            tracking.nodes.push_back((input, piece.touching));
        }
        // A motion that is contradicted is followed while another one is searched for.
        if self.next.is_none() && self.tracking.as_ref().is_none_or(Tracking::contradicted) {
            self.gather(piece, first, input);
        } else {
            self.restart();
        }
    }

    /// Makes the data of the cold start longer; what is too long, or in which contact was lost, begins anew.
    fn gather(&mut self, piece: &Piece, first: &NodeInput, input: NodeInput) {
        let lost = piece.touching.contains(&false);
        let long = self.gathered.as_ref().is_some_and(|g| g.track.duration() >= LONGEST_SEARCH);
        if lost || long {
            self.restart();
        }
        if lost {
            return;
        }
        let reach = self.stride / 2;
        let (mass, gravity, stride) = (self.kind.nominal_mass(), self.options.gravity, self.stride);
        let room = (LONGEST_SEARCH * self.options.sample_rate / stride as f64).ceil() as usize + 2;
        let gathered = self.gathered.get_or_insert_with(|| {
            let start = piece.track.times().next().unwrap_or_default();
            let mut track = Track::growing(mass, gravity, start, room);
            track.extend(&piece.track, 0, reach);
            let mut nodes = VecDeque::with_capacity(room);
            nodes.push_back((*first, piece.touching));
            Gathered { track, nodes, stride }
        });
        gathered.track.extend(&piece.track, stride, reach);
        let mut input = input;
        if gathered.nodes.len() == 1 {
            input.from = first.here;
        }
        gathered.nodes.push_back((input, piece.touching));
    }

    fn restart(&mut self) {
        self.gathered = None;
        self.scales = None;
        self.search = StreamSearch::new();
    }

    /// What is to be done between the ends of blocks: one thing a sample, what is most urgent first.
    fn work(&mut self) {
        if self.tracking.as_ref().is_some_and(|t| !t.nodes.is_empty()) {
            let tracked = self.tracking.as_mut().and_then(Tracking::advance);
            let latest = tracked.and_then(|tracked| self.follow(&tracked));
            if let (Some(tracking), Some(latest)) = (&mut self.tracking, latest) {
                tracking.latest = Some(latest);
            }
        } else if let Some(mut next) = self.next.take() {
            match next.advance() {
                // What contradicts its own data was the wrong motion.
                Some(_) if next.contradicted() => self.restart(),
                Some(tracked) => {
                    next.latest = self.follow(&tracked);
                    self.tracking = Some(next);
                }
                None => self.next = Some(next),
            }
        } else {
            self.search();
        }
    }

    fn search(&mut self) {
        let Some(gathered) = self.gathered.as_ref().filter(|g| g.track.len() >= FEWEST) else { return };
        let scales = self.scales.unwrap_or_else(|| self.kind.scales(&gathered.track));
        self.scales = (self.search.rounds() > 0).then_some(scales);
        let Some(found) = self.search.step(&self.kind.trial(gathered, scales)) else { return };
        let Some(tracker) = self.kind.tracker(&found, scales) else { return };
        let nodes = self.gathered.take().map(|g| g.nodes).unwrap_or_default();
        self.next = Some(Tracking { tracker, nodes, latest: None });
    }

    /// The motion from the latest node, one block before the newest piece's end, to the newest sample.
    fn follow(&self, tracked: &Tracked<N>) -> Option<Latest> {
        let parameters = &tracked.parameters;
        let body = Falling {
            mass: parameters.mass,
            inverse_inertia: parameters.inverse_inertia,
            gravity: self.options.gravity,
        };
        let mut readings = self.pieces.newest(self.stride + 1 + self.pieces.since());
        let mut front = Front::new(tracked.motion, *readings.next()?);
        for next in readings {
            front.advance(&body, next);
        }
        Some(Latest {
            covariance: tracked
                .report
                .covariance
                .fixed_view::<MOTION_STATES, MOTION_STATES>(0, 0)
                .into_owned(),
            observed: tracked.report.rank == N,
            found: tracked.body(),
            body,
            front,
        })
    }

    fn estimate(&self, reading: &Reading) -> StreamEstimate {
        let lost = self.touching.map(|touches| !touches);
        let Some(tracking) = &self.tracking else { return self.at_rest(reading, lost) };
        let Some(latest) = &tracking.latest else { return self.at_rest(reading, lost) };
        let innovation = tracking.tracker.innovation();
        let stage = if tracking.contradicted() {
            StreamStage::Contradicted
        } else if latest.observed {
            StreamStage::Tracking
        } else {
            StreamStage::Searching { rounds: self.search.rounds() }
        };
        StreamEstimate {
            motion: latest.front.motion(&latest.body),
            covariance: latest.covariance,
            body: latest.found,
            stage,
            innovation,
            lost,
        }
    }

    /// Before a motion is found: the body at rest where the contact wrench balances, known to its own size.
    fn at_rest(&self, reading: &Reading, lost: [bool; 3]) -> StreamEstimate {
        let rounds = self.search.rounds();
        let stage = if rounds == 0 { StreamStage::Gathering } else { StreamStage::Searching { rounds } };
        let (mass, gravity) = (self.kind.nominal_mass(), self.options.gravity);
        let single = Track::assemble(vec![0.0], vec![reading.node], mass, gravity, reading.t);
        let scales = self.kind.scales(&single).by_block();
        let covariance = SMatrix::from_diagonal(&SVector::from_fn(|i, _| scales[i / 3] * scales[i / 3]));
        // At rest the inertia does not matter.
        let still = Falling { mass, inverse_inertia: DMat3::IDENTITY, gravity };
        let motion = Front::new(rest_state(&single, 0.0), *reading).motion(&still);
        StreamEstimate { motion, covariance, body: None, stage, innovation: f64::NAN, lost }
    }
}
