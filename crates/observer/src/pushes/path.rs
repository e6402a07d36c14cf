//! Where the object is between its two poses: it goes as the force drives it on the table, whose friction is an ellipsoidal limit
//! surface, just as fast as the finger allows; what is then left to the pose after the push is spread over the way.

use super::face::Face;
use super::touches::{Touched, quantile};
use glam::DVec2;
use object_dynamics::pushing::{PushPose, limit_twist};

/// Smallest and largest friction length of the table that are looked at, in sizes of the object.
const LENGTHS: [f64; 2] = [0.1, 3.0];
/// Steps of the search for it, each of which leaves 0.62 of what is open: 0.1 % in the end.
const SEARCH: usize = 18;
/// Ratio of the speed of a face under the finger to the force's own, below which a force moves the face hardly at all.
const LEAST_MOVED: f64 = 0.05;

/// What is known when paths are looked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Table<'a> {
    pub(super) face: Face<'a>,
    /// Finger's radius, m.
    pub(super) radius: f64,
    /// Of the finger, m/N.
    pub(super) compliance: f64,
    /// How far the finger's record is ahead at the beginning and at the end, s.
    pub(super) times: [f64; 2],
}

/// One sample of a push in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PathStep {
    pub(super) t: f64,
    pub(super) pose: PushPose,
    /// Where the outline is touched, object's frame, m.
    pub(super) point: DVec2,
    /// Friction over normal force; positive to the left, as the finger looks at the object.
    pub(super) ratio: f64,
    /// Normal force, N.
    pub(super) normal_force: f64,
    /// How far the finger has slipped over the outline since the beginning, m; positive to the left.
    pub(super) slipped: f64,
}

/// The poses of a push, and what was left to the pose after it: a shift in m and a turn in rad.
pub(super) struct Path {
    pub(super) steps: Vec<PathStep>,
    pub(super) missed: (f64, f64),
}

impl Table<'_> {
    /// The tip of the finger at each sample in contact, m, world.
    fn tips(&self, push: &Touched) -> Vec<DVec2> {
        let samples = &push.push.samples;
        let (start, end) = (samples[push.from].t, samples[push.to].t);
        let tip = |k: usize| {
            let share = (samples[k].t - start) / (end - start);
            let ahead = self.times[0] + share * (self.times[1] - self.times[0]);
            push.finger(k) - push.force(k) * self.compliance - push.velocity * ahead
        };
        (push.from..=push.to).map(tip).collect()
    }

    /// Poses as the force drives them, with the pose before the push at first.
    fn driven(&self, push: &Touched, tips: &[DVec2], length: f64) -> Vec<PushPose> {
        let mut pose = push.push.before;
        let mut all = vec![pose];
        for (j, pair) in tips.windows(2).enumerate() {
            let force = push.force(push.from + j) + push.force(push.from + j + 1);
            let direction = force.normalize_or_zero();
            let near = self.face.nearest(pose.to_object(pair[0]));
            let (r, inward) = (pose.turn(near.point), pose.turn(-near.normal));
            let (velocity, spin) = limit_twist(direction, r, length);
            let moved = inward.dot(velocity + r.perp() * spin);
            let share = inward.dot(pair[1] - pair[0]) / moved;
            if moved > LEAST_MOVED && share > 0.0 {
                pose.p_WO += velocity * share;
                pose.theta += spin * share;
            }
            all.push(pose);
        }
        all
    }

    /// The path of a push.
    pub(super) fn path(&self, push: &Touched, length: f64) -> Path {
        let tips = self.tips(push);
        let mut poses = self.driven(push, &tips, length);
        let (shift, turn) = missed(&poses, push);
        let ways: Vec<f64> = tips
            .windows(2)
            .scan(0.0, |way, pair| {
                *way += pair[0].distance(pair[1]);
                Some(*way)
            })
            .collect();
        let whole = ways.last().copied().unwrap_or(1.0).max(f64::MIN_POSITIVE);
        for (pose, way) in poses[1..].iter_mut().zip(&ways) {
            pose.p_WO += shift * (way / whole);
            pose.theta += turn * (way / whole);
        }
        Path { steps: self.steps(push, &tips, &poses), missed: (shift.length(), turn) }
    }

    fn steps(&self, push: &Touched, tips: &[DVec2], poses: &[PushPose]) -> Vec<PathStep> {
        let mut slipped = 0.0;
        let mut last: Option<(DVec2, f64)> = None;
        let one = |(j, (tip, pose)): (usize, (&DVec2, &PushPose))| {
            let centre = pose.to_object(*tip);
            let near = self.face.nearest(centre);
            let left = -near.normal.perp();
            if let Some((before, theta)) = last {
                // Without slip a finger that does not turn rolls over the object by its radius times the object's turn.
                slipped += (centre - before).dot(left) - self.radius * (pose.theta - theta);
            }
            last = Some((centre, pose.theta));
            let force = pose.turn_back(push.force(push.from + j));
            let normal_force = -force.dot(near.normal);
            PathStep {
                t: push.push.samples[push.from + j].t,
                pose: *pose,
                point: near.point,
                ratio: force.dot(left) / normal_force,
                normal_force,
                slipped,
            }
        };
        tips.iter().zip(poses).enumerate().map(one).collect()
    }

    /// The friction length of the table under which pushes end nearest to where they did, in turns: golden sections of its logarithm.
    pub(super) fn length(&self, pushes: &[Touched], size: f64) -> f64 {
        let tips: Vec<_> = pushes.iter().map(|push| self.tips(push)).collect();
        let misses = |log: f64| {
            let turns = pushes.iter().zip(&tips);
            let turns = turns.map(|(push, tips)| missed(&self.driven(push, tips, log.exp()), push).1.abs());
            quantile(turns.collect(), 0.5)
        };
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        let [mut low, mut high] = LENGTHS.map(|l| (l * size).ln());
        let [mut a, mut b] = [high - golden * (high - low), low + golden * (high - low)];
        let (mut at_a, mut at_b) = (misses(a), misses(b));
        for _ in 0..SEARCH {
            if at_a < at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - golden * (high - low);
                at_a = misses(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + golden * (high - low);
                at_b = misses(b);
            }
        }
        (0.5 * (low + high)).exp()
    }
}

/// What the last pose lacks of the one after the push.
fn missed(poses: &[PushPose], push: &Touched) -> (DVec2, f64) {
    let last = poses.last().copied().unwrap_or(push.push.before);
    let turn = push.push.after.theta - last.theta;
    // Angles that were recorded within one turn.
    let turn = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
    (push.push.after.p_WO - last.p_WO, turn)
}
