//! From samples to short pieces of a track, one a block, in a buffer of fixed size.

use super::estimate::StreamError;
use crate::three_palms::track::{Node, Track, TrackError};
use contact_kinematics::{PalmFrame, PalmState};
use glam::DVec3;
use object_dynamics::{PalmReading, Sample};
use std::collections::VecDeque;

/// A sample with its palms' frames and rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reading {
    pub(super) t: f64,
    pub(super) node: Node,
    pub(super) touching: [bool; 3],
}

/// The samples of the latest two blocks and more.
#[derive(Debug)]
pub(super) struct Pieces {
    stride: usize,
    palm_inertias: Option<[f64; 3]>,
    /// The latest three samples as they came: rates of palms come from differences.
    raw: VecDeque<Sample>,
    ready: VecDeque<Reading>,
    /// Contact that was felt last, by palm, in sensor coordinates.
    held: [[f64; 2]; 3],
    /// Readings since the last piece ended.
    since: usize,
    /// Nodes of the latest piece.
    track: Track,
}

impl Pieces {
    /// `mass` and `gravity` are those of the tracks.
    pub(super) fn new(stride: usize, palm_inertias: Option<[f64; 3]>, mass: f64, gravity: DVec3) -> Self {
        Self {
            stride,
            palm_inertias,
            raw: VecDeque::with_capacity(4),
            ready: VecDeque::with_capacity(3 * stride + 2),
            held: [[0.0; 2]; 3],
            since: 0,
            track: Track::growing(mass, gravity, 0.0, 2 * stride + 1),
        }
    }

    /// Takes a sample; it becomes a reading when the next one comes.
    pub(super) fn push(&mut self, sample: &Sample) -> Result<Option<Reading>, StreamError> {
        check(sample, self.raw.back().map_or(f64::NEG_INFINITY, |s| s.t))?;
        if self.raw.len() == 3 {
            self.raw.pop_front();
        }
        self.raw.push_back(*sample);
        let middle = match self.raw.len() {
            1 => return Ok(None),
            count => count - 2,
        };
        let reading = self.reading(middle).map_err(StreamError::Sample)?;
        if self.ready.len() == 3 * self.stride {
            self.ready.pop_front();
        }
        self.ready.push_back(reading);
        self.since += 1;
        Ok(Some(reading))
    }

    /// The newest readings, latest last.
    pub(super) fn newest(&self, count: usize) -> impl Iterator<Item = &Reading> {
        self.ready.iter().skip(self.ready.len().saturating_sub(count))
    }

    /// Readings since the latest piece ended.
    pub(super) fn since(&self) -> usize {
        self.since
    }

    /// A piece of two blocks, once a block has come since the last one: its middle is the next node. The palms that were
    /// in contact throughout the block about it; none before the first two blocks, and between the ends of blocks.
    pub(super) fn piece(&mut self) -> Option<[bool; 3]> {
        let long = 2 * self.stride + 1;
        if self.ready.len() < long || self.since < self.stride {
            return None;
        }
        self.since = 0;
        let newest = self.ready.iter().skip(self.ready.len() - long);
        self.track.set_nodes(newest.clone().map(|r| (r.t, r.node)));
        let block = newest.skip(self.stride - self.stride / 2).take(self.stride);
        Some(block.fold([true; 3], |all, r| std::array::from_fn(|i| all[i] && r.touching[i])))
    }

    /// The latest piece as a track of its own, without integrals.
    pub(super) fn track(&self) -> &Track {
        &self.track
    }

    fn reading(&mut self, middle: usize) -> Result<Reading, TrackError> {
        let mut sample = self.raw[middle];
        let mut palms = [None; 3];
        let mut touching = [true; 3];
        for i in 0..3 {
            palms[i] = Some(self.palm(middle, i)?);
            let palm = &mut sample.palms[i];
            // A palm that carries no force has lost contact, whatever its sensor still says.
            touching[i] = palm.contact.is_some() && palm.force.is_none_or(|f| f > 0.0);
            self.held[i] = palm.contact.unwrap_or(self.held[i]);
            if !touching[i] {
                *palm = PalmReading { contact: Some(self.held[i]), force: Some(0.0), ..*palm };
            }
        }
        let [Some(a), Some(b), Some(c)] = palms else {
            return Err(TrackError::TooFewSamples { found: 0 });
        };
        let node = Node::new(&sample, [a, b, c], self.palm_inertias)?;
        Ok(Reading { t: sample.t, node, touching })
    }

    /// Frame, rate and acceleration of a palm, from the samples on either side.
    fn palm(&self, middle: usize, i: usize) -> Result<PalmState, TrackError> {
        let (before, here, after) = (
            &self.raw[middle.saturating_sub(1)],
            &self.raw[middle],
            &self.raw[(middle + 1).min(self.raw.len() - 1)],
        );
        let frame = PalmFrame::from_normal(here.palms[i].normal).map_err(|source| TrackError::Palm {
            palm: i + 1,
            t: here.t,
            source,
        })?;
        // Times increase, so this is above zero.
        let time = after.t - before.t;
        let rate = |s: &Sample| s.palms[i].rate;
        // n' = rate t1 x n = -rate t2.
        let turned =
            |a: &Sample, b: &Sample| -frame.t2.dot(b.palms[i].normal.get() - a.palms[i].normal.get());
        let acceleration = match (rate(before), rate(after)) {
            (Some(a), Some(b)) => (b - a) / time,
            _ if middle == 0 => 0.0,
            _ => {
                let (first, second) = (here.t - before.t, after.t - here.t);
                2.0 * (turned(here, after) / second - turned(before, here) / first) / time
            }
        };
        Ok(PalmState { frame, rate: rate(here).unwrap_or(turned(before, after) / time), acceleration })
    }
}

/// Refuses what is no number, which would spread from here to everything.
fn check(sample: &Sample, previous: f64) -> Result<(), StreamError> {
    let t = sample.t;
    if !(t > previous && t.is_finite()) {
        return Err(StreamError::Time { t, previous });
    }
    for (i, palm) in sample.palms.iter().enumerate() {
        let [s1, s2] = palm.contact.unwrap_or_default();
        let readings = [
            ("contact s1", Some(s1)),
            ("contact s2", Some(s2)),
            ("force", palm.force),
            ("torque", palm.torque),
            ("rate", palm.rate),
        ];
        let wrong =
            readings.into_iter().find_map(|(what, v)| Some((what, v?)).filter(|(_, v)| !v.is_finite()));
        if let Some((what, value)) = wrong {
            return Err(StreamError::Reading { what, palm: i + 1, t, value });
        }
    }
    Ok(())
}
