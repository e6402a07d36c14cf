//! Seeded random pushes, with what real ones are disturbed by.

use super::log::{Push, PushLog, PushPose, PushSample};
use super::simulate::{PushScene, PushSceneError, PushStep, PushStroke, simulate_push};
use glam::DVec2;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Samples a second of force sensors as they are common on arms.
const RATE: f64 = 101.0;
/// Samples of a push.
const SAMPLES: u32 = 660;
/// Speed of the finger, m/s.
const SPEED: f64 = 2.75e-3;
/// How far from the object it begins, m: from and to.
const AHEAD: [f64; 2] = [1.5e-3, 5e-3];
/// Largest angle between its way and the inward normal, rad.
const OBLIQUE: f64 = 0.9;
/// Time in which friction changes by itself, s.
const SLOW: f64 = 0.3;

/// What disturbs pushes; standard deviations, but where something else is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushDisturbances {
    /// White noise of each component of the force, N.
    pub force: f64,
    /// Each coordinate of the finger against the frame of the poses, the same throughout a push, m.
    pub place: f64,
    /// Each coordinate of a pose, m.
    pub position: f64,
    /// Angle of a pose, rad.
    pub angle: f64,
    /// Friction at the finger, from push to push, as a share.
    pub friction_of_push: f64,
    /// Friction at the finger, within 0.3 s, as a share.
    pub friction_in_push: f64,
    /// Friction of the table, within 0.3 s, as a share.
    pub table: f64,
    /// How far the finger's clock is ahead of that of the force, s.
    pub finger_ahead: f64,
    /// How long the finger moves on after the last sample, s.
    pub moves_on: f64,
    /// Step to which the finger's coordinates are rounded, m.
    pub rounding: f64,
}

impl Default for PushDisturbances {
    /// As large as they are in pushes with an arm under motion capture.
    fn default() -> Self {
        Self {
            force: 3e-3,
            place: 5e-4,
            position: 1e-4,
            angle: 1e-3,
            friction_of_push: 0.06,
            friction_in_push: 0.05,
            table: 0.05,
            finger_ahead: 0.0,
            moves_on: 0.0,
            rounding: 1e-4,
        }
    }
}

/// Simulated pushes with their truth.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedPushes {
    /// As it would be recorded.
    pub log: PushLog,
    /// Truth of each sample of each push.
    pub truth: Vec<Vec<PushStep>>,
}

struct Random(Pcg64);

impl Random {
    fn normal(&mut self, deviation: f64) -> f64 {
        let unit: f64 = StandardNormal.sample(&mut self.0);
        deviation * unit
    }

    /// Between two values, each as likely.
    fn between(&mut self, [from, to]: [f64; 2]) -> f64 {
        from + (to - from) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, deviation: f64) -> DVec2 {
        DVec2::new(self.normal(deviation), self.normal(deviation))
    }

    fn pose(&mut self, pose: PushPose, noise: &PushDisturbances) -> PushPose {
        let shift = self.vector(noise.position);
        PushPose { p_WO: pose.p_WO + shift, theta: pose.theta + self.normal(noise.angle) }
    }
}

/// Pushes at random points of the outline, one after the other. The same seed gives the same pushes.
///
/// # Errors
/// [`PushSceneError`] of the scene.
pub fn simulate_pushes(
    scene: &PushScene,
    noise: &PushDisturbances,
    count: u32,
    seed: u64,
) -> Result<SimulatedPushes, PushSceneError> {
    let mut random = Random(Pcg64::seed_from_u64(seed));
    let mut pose = PushPose { p_WO: DVec2::new(0.5, 0.1), theta: random.between([-3.0, 3.0]) };
    let (mut pushes, mut truth) = (Vec::new(), Vec::new());
    for number in 0..count {
        let stroke = stroke(scene, pose, noise, &mut random);
        let of_push = 1.0 + random.normal(noise.friction_of_push);
        let (mut slow, mut table) = (0.0, 0.0);
        let keeps = (-1.0 / (RATE * SLOW)).exp();
        let fresh = (1.0 - keeps * keeps).sqrt();
        let mut changes = Random(Pcg64::seed_from_u64(random.0.next_u64()));
        let (push, steps) = simulate_push(scene, number, pose, &stroke, |_| {
            slow = keeps * slow + changes.normal(fresh * noise.friction_in_push);
            table = keeps * table + changes.normal(fresh * noise.table);
            [(of_push + slow).max(0.0), (1.0 + table).max(0.1)]
        })?;
        pose = push.after;
        pushes.push(recorded(push, &stroke, noise, &mut random));
        truth.push(steps);
    }
    let log = PushLog::new(pushes)?;
    Ok(SimulatedPushes { log, truth })
}

fn stroke(scene: &PushScene, pose: PushPose, noise: &PushDisturbances, random: &mut Random) -> PushStroke {
    let around: f64 = scene.outline.edges().map(|(a, b)| a.distance(b)).sum();
    let mut left = random.between([0.0, around]);
    let mut at = (scene.outline.corners()[0], DVec2::X);
    for (a, b) in scene.outline.edges() {
        let length = a.distance(b);
        if left <= length {
            at = (a.lerp(b, left / length), -(b - a).perp().normalize_or_zero());
            break;
        }
        left -= length;
    }
    let (point, outward) = at;
    let way = DVec2::from_angle(random.between([-OBLIQUE, OBLIQUE])).rotate(-outward);
    let from = point + outward * scene.finger_radius - way * random.between(AHEAD);
    PushStroke {
        from: pose.p_WO + pose.turn(from),
        velocity: pose.turn(way) * SPEED,
        samples: SAMPLES,
        rate: RATE,
        moves_on: noise.moves_on,
    }
}

/// What sensors make of a push: the offset of the force's first sample is removed, as drivers do.
fn recorded(push: Push, stroke: &PushStroke, noise: &PushDisturbances, random: &mut Random) -> Push {
    let shift = random.vector(noise.place);
    let rounded =
        |v: f64| if noise.rounding > 0.0 { (v / noise.rounding).round() * noise.rounding } else { v };
    let mut first = None;
    let samples = push.samples.iter().map(|s| {
        let force = s.force + random.vector(noise.force);
        let offset = *first.get_or_insert(force);
        let finger = s.finger + shift + stroke.velocity * noise.finger_ahead;
        PushSample { t: s.t, force: force - offset, finger: DVec2::new(rounded(finger.x), rounded(finger.y)) }
    });
    let samples = samples.collect();
    let (before, after) = (random.pose(push.before, noise), random.pose(push.after, noise));
    Push { number: push.number, before, after, samples }
}

#[cfg(test)]
mod tests {
    use super::super::{ClosedLine, PushMode};
    use super::*;

    #[test]
    fn the_same_seed_gives_the_same_pushes_and_the_object_is_touched() {
        let corners = vec![DVec2::new(-0.05, -0.05), DVec2::new(0.1, -0.05), DVec2::new(-0.05, 0.1)];
        let scene = PushScene {
            outline: ClosedLine::new(corners).unwrap(),
            finger_radius: 1e-3,
            friction: 0.5,
            length: 0.05,
            sliding_force: 4.0,
            compliance: 8e-5,
        };
        let made = simulate_pushes(&scene, &PushDisturbances::default(), 6, 1).unwrap();
        assert_eq!(made, simulate_pushes(&scene, &PushDisturbances::default(), 6, 1).unwrap());
        assert_ne!(made, simulate_pushes(&scene, &PushDisturbances::default(), 6, 2).unwrap());
        let moved = made.truth.iter().filter(|t| t.iter().any(|s| s.mode != PushMode::Rest)).count();
        assert_eq!(moved, 6);
    }
}
