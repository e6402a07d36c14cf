//! The stream of one kind of body.

use super::estimate::{StreamError, StreamEstimate, StreamOptions, StreamStage};
use super::front::{Falling, Front};
use super::kind::{Gathered, Kind};
use super::pieces::{Pieces, Reading};
use super::search::StreamSearch;
use super::settling::{Settled, Settling};
use super::tracker::Tracked;
use super::tracking::{Latest, Tracking};
use crate::three_palms::cold_start::{natural_time, rest_state};
use crate::three_palms::momentum::Scales;
use crate::three_palms::state_space::{Block, MOTION_STATES, NodeInput, NodeInputs, Touch};
use crate::three_palms::track::Track;
use glam::DMat3;
use nalgebra::{SMatrix, SVector};
use object_dynamics::Sample;
use std::collections::VecDeque;

/// Longest track that a search works on, s; then it begins anew with later data.
const LONGEST_SEARCH: f64 = 6.0;
/// The same for a motion that explains the data so far.
const LONGEST_SETTLING: f64 = 12.0;
/// Fewest nodes that a cold start begins with.
const FEWEST: usize = 8;
/// Growth of the data after which a motion that is open is looked at again.
const PATIENCE: f64 = 1.15;
/// Nodes that a sample's work goes through, times the square of the states: about the work of a step of the tracker.
const PORTION: usize = 3600;
/// Natural times over which contacts are smoothed, on either side, where derivatives are taken.
const SMOOTHED_NATURAL_TIMES: f64 = 0.125;
/// Nodes that a motion must have foretold before it is stated.
const PROBATION: usize = 15;
/// Pieces of work in a second: where samples are few, each does more.
const WORK_PER_SECOND: f64 = 1000.0;
/// Pieces that a sample does at most: below 10 Hz no motion can be followed.
const MOST_WORK: f64 = 100.0;
/// Room for nodes that wait for the tracker: it takes more than come.
const WAITING: usize = 64;

/// A stream of which `N` numbers are estimated; `P` are searched for.
pub(super) struct Stream<K: Kind<N, P>, const N: usize, const P: usize> {
    kind: K,
    options: StreamOptions,
    stride: usize,
    pieces: Pieces,
    gathered: Option<Gathered>,
    inputs: NodeInputs,
    /// The touch at the node before.
    before: Option<Touch>,
    search: StreamSearch<K::Point, P>,
    scales: Option<Scales>,
    /// A motion that the search has found, and what it rests on.
    settling: Option<Settling<N>>,
    /// Length of the data, s, at which it is looked at again.
    patience: f64,
    tracking: Option<Tracking<N>>,
    /// A motion that was found since, and has not caught up with the newest node.
    next: Option<Tracking<N>>,
    touching: [bool; 3],
    /// Pieces of work that a sample does.
    pieces_of_work: usize,
}

impl<K: Kind<N, P>, const N: usize, const P: usize> Stream<K, N, P> {
    pub(super) fn new(kind: K, options: StreamOptions) -> Result<Self, StreamError> {
        let stride = options.stride()?;
        Ok(Self {
            pieces: Pieces::new(stride, options.palm_inertias, kind.nominal_mass(), options.gravity),
            kind,
            inputs: NodeInputs::default(),
            gathered: None,
            before: None,
            search: StreamSearch::new(),
            scales: None,
            settling: None,
            patience: 0.0,
            tracking: None,
            next: None,
            touching: [true; 3],
            stride,
            pieces_of_work: (WORK_PER_SECOND / options.sample_rate).ceil().clamp(1.0, MOST_WORK) as usize,
            options,
        })
    }

    pub(super) fn push(&mut self, sample: &Sample) -> Result<Option<StreamEstimate>, StreamError> {
        let Some(reading) = self.pieces.push(sample)? else { return Ok(None) };
        self.touching = reading.touching;
        if let Some(latest) = self.tracking.as_mut().and_then(|t| t.latest.as_mut()) {
            latest.front.advance(&latest.body, &reading);
        }
        // The end of a block is work as well.
        let ended = self.pieces.piece();
        if let Some(touching) = ended {
            self.node(touching);
        }
        for _ in usize::from(ended.is_some())..self.pieces_of_work {
            self.work();
        }
        Ok(Some(self.estimate(&reading)))
    }

    /// A block is complete, throughout which some palms were in contact.
    fn node(&mut self, touching: [bool; 3]) {
        let half = self.stride / 2;
        let (first, here) = (Block { start: 0, reach: 0 }, Block { start: self.stride - half, reach: half });
        let mut input = self.inputs.after(self.pieces.track(), &first, &here);
        if let Some(before) = self.before {
            // The block about the node before, whole.
            input.from = before;
        }
        self.before = Some(input.here);
        for tracking in self.tracking.iter_mut().chain(&mut self.next) {
            tracking.nodes.push_back((input, touching));
        }
        // A motion that is contradicted is followed while another one is searched for.
        if self.next.is_none() && self.tracking.as_ref().is_none_or(|t| t.contradicted) {
            self.gather(touching, input);
        } else {
            self.restart();
        }
    }

    /// Makes the data of the cold start longer; what is too long, or in which contact was lost, begins anew.
    fn gather(&mut self, touching: [bool; 3], mut input: NodeInput) {
        let lost = touching.contains(&false);
        let longest = if self.settling.is_some() { LONGEST_SETTLING } else { LONGEST_SEARCH };
        let long = self.gathered.as_ref().is_some_and(|g| g.track.duration() >= longest);
        if lost || long {
            self.restart();
        }
        if lost {
            return;
        }
        let (reach, stride) = (self.stride / 2, self.stride);
        let room = (LONGEST_SETTLING * self.options.sample_rate / stride as f64).ceil() as usize + 2;
        let piece = self.pieces.track().integrated();
        let (mass, gravity) = (self.kind.nominal_mass(), self.options.gravity);
        let gathered = self.gathered.get_or_insert_with(|| {
            let start = piece.times().next().unwrap_or_default();
            let mut track = Track::growing(mass, gravity, start, room);
            track.extend(&piece, 0, reach);
            let mut nodes = VecDeque::with_capacity(room);
            let first = NodeInputs::first(&piece, &Block { start: 0, reach: 0 });
            input.from = first.here;
            nodes.push_back((first, touching));
            Gathered { track, nodes, stride }
        });
        gathered.track.extend(&piece, stride, reach);
        gathered.nodes.push_back((input, touching));
    }

    fn restart(&mut self) {
        self.gathered = None;
        self.scales = None;
        self.search = StreamSearch::new();
        self.settling = None;
    }

    /// What is to be done between the ends of blocks: one thing at a time, what is most urgent first.
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
                Some(_) if next.contradicted => self.restart(),
                Some(_) if next.fresh < PROBATION => self.next = Some(next),
                Some(tracked) => {
                    next.latest = self.follow(&tracked);
                    self.tracking = Some(next);
                }
                None => self.next = Some(next),
            }
        } else if self.settling.is_some() {
            self.settle();
        } else {
            self.search();
        }
    }

    /// Goes on with the motion that the search has found.
    fn settle(&mut self) {
        let (Some(settling), Some(gathered)) = (&mut self.settling, &mut self.gathered) else { return };
        let duration = gathered.track.duration();
        if duration < self.patience {
            return;
        }
        match settling.work(&gathered.nodes, PORTION / (N * N)) {
            Settled::Going => {}
            Settled::Open => self.patience = duration * PATIENCE,
            Settled::Refused => self.settling = None,
            Settled::Vague => {
                self.settling = None;
                self.search.keep(PATIENCE);
            }
            Settled::Taken => {
                let taken = settling.taken();
                let mut nodes = gathered.nodes.split_off(taken);
                nodes.reserve(WAITING);
                let tracker = self.settling.take().and_then(Settling::into_tracker);
                self.next = tracker.map(|tracker| Tracking::new(tracker, nodes));
                self.gathered = None;
            }
        }
    }

    fn search(&mut self) {
        let Some(gathered) = self.gathered.as_ref().filter(|g| g.track.len() >= FEWEST) else { return };
        let scales = self.scales.unwrap_or_else(|| self.kind.scales(&gathered.track));
        self.scales = (self.search.rounds() > 0).then_some(scales);
        let Some(found) = self.search.step(&self.kind.trial(gathered, scales)) else { return };
        let Some((model, start)) = self.kind.begin(&found, scales) else { return };
        let reach = SMOOTHED_NATURAL_TIMES * natural_time(&gathered.track, scales.length);
        let room = gathered.nodes.capacity();
        self.settling = Some(Settling::new(model, &start, reach, room));
        self.patience = 0.0;
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
        let stage = if tracking.contradicted {
            StreamStage::Contradicted
        } else if latest.observed {
            StreamStage::Tracking
        } else {
            StreamStage::Searching { rounds: self.search.rounds() }
        };
        StreamEstimate {
            motion: latest.front.motion(&latest.body),
            covariance: latest.front.covariance(
                &latest.body,
                &latest.covariance,
                &self.options.noise,
                1.0 / self.options.sample_rate,
            ),
            body: latest.found,
            stage,
            innovation,
            lost,
        }
    }

    /// Before a motion is found: the body at rest where the contact wrench balances, known to its own size.
    fn at_rest(&self, reading: &Reading, lost: [bool; 3]) -> StreamEstimate {
        // A motion that must still foretell some nodes is the outcome of a round.
        let rounds = self.search.rounds().max(usize::from(self.next.is_some()));
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
