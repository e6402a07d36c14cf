//! Frames that stand in each other: the transforms of a bag.

use super::clock::Clock;
use super::error::BagErrorKind as Kind;
use super::message::{BagTransform, Reading};
use super::read::Bag;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::SurfacePose;
use recon::object_dynamics::{PoseTrack, Rhythm, TurnAndShift};
use std::collections::BTreeMap;

/// The transforms of a bag, by the frame that stands in another.
pub(super) struct Frames {
    edges: BTreeMap<String, Edge>,
}

/// A frame in its parent.
struct Edge {
    parent: String,
    place: Place,
    /// Topic that says it.
    topic: String,
}

enum Place {
    Fixed(SurfacePose),
    Moving { track: PoseTrack, longest: f64 },
}

/// The way from one frame to another.
pub(super) struct Way<'a> {
    /// From the frame upwards to the common ancestor, and from the other one.
    up: Vec<&'a Edge>,
    down: Vec<&'a Edge>,
}

impl Frames {
    /// All transforms of a bag, at times of its clock.
    pub(super) fn of(bag: &Bag, clock: &Clock) -> Result<Self, Kind> {
        let mut gathered: BTreeMap<String, Gathered> = BTreeMap::new();
        for topic in bag.topics.values() {
            for message in &topic.messages {
                let Reading::Transforms(all) = &message.reading else { break };
                for transform in all {
                    let t = clock.of_transform(&topic.name, message, transform.stamp);
                    gather(&mut gathered, &topic.name, t, transform)?;
                }
            }
        }
        let edges = gathered.into_iter().map(|(child, gathered)| (child, gathered.edge())).collect();
        let frames = Self { edges };
        for frame in frames.edges.keys() {
            if frames.above(frame).len() > frames.edges.len() {
                return Err(Kind::Circle { frame: frame.clone() });
            }
        }
        Ok(frames)
    }

    /// Names of all frames.
    pub(super) fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> =
            self.edges.iter().flat_map(|(child, edge)| [child.as_str(), edge.parent.as_str()]).collect();
        names.sort_unstable();
        names.dedup();
        names
    }

    /// The frame in which a frame and all above it stand; itself where nothing says where it is.
    pub(super) fn root<'a>(&'a self, frame: &'a str) -> &'a str {
        self.above(frame).last().map_or(frame, |edge| edge.parent.as_str())
    }

    /// Whether a frame is another, or stands in it.
    pub(super) fn is_in(&self, frame: &str, other: &str) -> bool {
        plain(frame) == other || self.above(plain(frame)).iter().any(|edge| edge.parent == other)
    }

    /// The way from a frame to another, if they are joined.
    pub(super) fn way(&self, from: &str, to: &str) -> Option<Way<'_>> {
        let (from, to) = (plain(from), plain(to));
        let (mut up, mut down) = (self.above(from), self.above(to));
        let tops = [root_of(&up, from).to_owned(), root_of(&down, to).to_owned()];
        if tops[0] != tops[1] {
            return None;
        }
        while let (Some(a), Some(b)) = (up.last(), down.last()) {
            if !std::ptr::eq(*a, *b) {
                break;
            }
            up.pop();
            down.pop();
        }
        Some(Way { up, down })
    }

    /// The transforms from a frame upwards. More than there are in a circle.
    fn above(&self, frame: &str) -> Vec<&Edge> {
        let mut above: Vec<&Edge> = Vec::new();
        let mut frame = frame;
        while let Some(edge) = self.edges.get(frame) {
            above.push(edge);
            if above.len() > self.edges.len() {
                break;
            }
            frame = &edge.parent;
        }
        above
    }
}

fn root_of<'a>(above: &[&'a Edge], frame: &'a str) -> &'a str {
    above.last().map_or(frame, |edge| edge.parent.as_str())
}

/// Frames of the first version of tf began with a slash.
pub(super) fn plain(frame: &str) -> &str {
    frame.trim_start_matches('/')
}

/// Poses of a frame in its parent, as they come.
struct Gathered {
    parent: String,
    topic: String,
    poses: Vec<(f64, SurfacePose)>,
}

impl Gathered {
    fn edge(self) -> Edge {
        let Self { parent, topic, poses } = self;
        Edge { place: place(topic.ends_with("tf_static"), poses), parent, topic }
    }
}

fn gather(
    all: &mut BTreeMap<String, Gathered>,
    topic: &str,
    t: f64,
    transform: &BagTransform,
) -> Result<(), Kind> {
    let (parent, child) = (plain(&transform.parent), plain(&transform.child));
    let [x, y, z, i, j, k, w] = transform.pose;
    let pose = SurfacePose::new(DVec3::new(x, y, z), DQuat::from_xyzw(i, j, k, w))
        .map_err(|source| Kind::Transform { frame: child.to_owned(), t, source })?;
    let Some(known) = all.get_mut(child) else {
        let (parent, topic) = (parent.to_owned(), topic.to_owned());
        all.insert(child.to_owned(), Gathered { parent, topic, poses: vec![(t, pose)] });
        return Ok(());
    };
    if known.parent != parent {
        let (frame, first) = (child.to_owned(), known.parent.clone());
        return Err(Kind::TwoParents { frame, first, second: parent.to_owned() });
    }
    known.poses.push((t, pose));
    Ok(())
}

fn place(fixed: bool, mut poses: Vec<(f64, SurfacePose)>) -> Place {
    poses.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Of repeated stamps the last that came counts.
    poses.reverse();
    poses.dedup_by(|a, b| a.0 == b.0);
    poses.reverse();
    let last = poses.last().map(|(_, pose)| *pose);
    let at_rest = poses.windows(2).all(|pair| pair[0].1 == pair[1].1);
    let (times, poses): (Vec<f64>, Vec<SurfacePose>) = poses.into_iter().unzip();
    let longest = Rhythm::of(&times).longest();
    match (PoseTrack::new(times, poses), last) {
        (Ok(track), _) if !fixed && !at_rest => Place::Moving { track, longest },
        (_, Some(last)) => Place::Fixed(last),
        (_, None) => Place::Fixed(SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }),
    }
}

impl Way<'_> {
    /// The pose of the frame in the other at `t` (s); none where a transform on the way has no readings.
    pub(super) fn at(&self, t: f64) -> Option<SurfacePose> {
        let along = |edges: &[&Edge]| {
            let mut sum = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY };
            for (first, edge) in edges.iter().enumerate() {
                let pose = match &edge.place {
                    Place::Fixed(pose) => *pose,
                    Place::Moving { track, longest } => track.at(t, *longest)?,
                };
                // One transform alone keeps its digits.
                sum = if first == 0 { pose } else { compose(&pose, &sum) };
            }
            Some(sum)
        };
        let (up, down) = (along(&self.up)?, along(&self.down)?);
        if self.down.is_empty() {
            return Some(up);
        }
        let back = down.R_WP.inverse();
        Some(SurfacePose { p_WP: back * (up.p_WP - down.p_WP), R_WP: (back * up.R_WP).normalize() })
    }

    /// Where nothing on the way moves: the pose.
    pub(super) fn fixed(&self) -> Option<SurfacePose> {
        let moves = |edge: &&Edge| matches!(edge.place, Place::Moving { .. });
        if self.up.iter().chain(&self.down).any(moves) { None } else { self.at(0.0) }
    }

    /// Times of the slowest transform that moves, and its topic.
    pub(super) fn slowest(&self) -> Option<(&str, &[f64])> {
        let all = self.up.iter().chain(&self.down).filter_map(|edge| {
            let Edge { topic, place, .. } = *edge;
            match place {
                Place::Moving { track, .. } => Some((topic.as_str(), track.times())),
                Place::Fixed(_) => None,
            }
        });
        all.min_by_key(|(_, times)| times.len())
    }

    /// By how much a pose between two readings is off, at most, over the transforms that move.
    pub(super) fn interpolation_error(&self) -> Option<TurnAndShift> {
        let of = |edge: &&Edge| match &edge.place {
            Place::Moving { track, longest } => track.interpolation_error(*longest),
            Place::Fixed(_) => None,
        };
        let all = self.up.iter().chain(&self.down).filter_map(of);
        all.reduce(|a, b| TurnAndShift { shift: a.shift + b.shift, turn: a.turn + b.turn })
    }
}

fn compose(outer: &SurfacePose, inner: &SurfacePose) -> SurfacePose {
    SurfacePose { p_WP: outer.p_WP + outer.R_WP * inner.p_WP, R_WP: (outer.R_WP * inner.R_WP).normalize() }
}
