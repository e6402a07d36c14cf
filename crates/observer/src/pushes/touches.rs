//! When the finger touches, and where that is in the object's frame: at the first force with the pose before the push, at the last
//! one with the pose after it.

use glam::DVec2;
use object_dynamics::pushing::{Push, PushSample};
use std::fmt;

/// Fewest pushes with a touch that tell an outline: a polygon of three corners has six unknowns, a push gives two touches.
pub(super) const FEWEST_TOUCHED: usize = 6;
/// Shares of the upper quartile of the force above which a contact is loaded, and below which it is lost.
const LOADED: f64 = 0.3;
const LOST: f64 = 0.15;
/// The least force that counts, as a share of the same.
const LEAST_SHARE: f64 = 0.01;
/// Deviations of the noise beyond which a force is one. The length of a vector of white noise exceeds 5 of them once in 270,000 samples.
const NOISE: f64 = 5.0;
/// Median length of a vector of two components of unit noise.
const MEDIAN_LENGTH: f64 = 1.177_41;
/// Samples without contact that tell noise and offset of the force.
const QUIET: usize = 8;
/// Time over which direction of force and place of the finger are averaged, s.
const AVERAGE: f64 = 0.15;

/// Why a push touches nothing.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum NoTouch {
    /// The force stays at its noise.
    NoForce,
    /// The finger stands still while it touches.
    NoWay,
    /// The force is there from the first sample on, so that it is not known where the contact began.
    FromTheStart,
}

impl fmt::Display for NoTouch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NoForce => "has no force above its noise",
            Self::NoWay => "has a finger that stands still while it touches",
            Self::FromTheStart => "begins in contact; begin each push off the object",
        })
    }
}

/// One place where the finger touched, in the object's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Touch {
    /// Centre of the finger, its bend taken off, m.
    pub(super) centre: DVec2,
    /// Velocity of the finger, m/s.
    pub(super) velocity: DVec2,
    /// Unit vector of the force on the object.
    pub(super) force: DVec2,
}

/// A push in which the finger touched.
#[derive(Clone, Debug)]
pub(super) struct Touched<'a> {
    pub(super) push: &'a Push,
    /// First and last sample in contact.
    pub(super) from: usize,
    pub(super) to: usize,
    /// What the force sensor reads of nothing, N.
    pub(super) offset: DVec2,
    /// Noise of each component of the force, N; none without samples that are free of contact.
    pub(super) noise: Option<f64>,
    /// How far the finger gives way, m/N, by the rise of the force.
    pub(super) compliance: f64,
    /// Mean velocity of the finger in contact, m/s, world.
    pub(super) velocity: DVec2,
}

impl<'a> Touched<'a> {
    /// Whether force and motion go along with each other: what pushes over a table does work, at the finger and on the object, which friction takes.
    pub(super) fn is_pushed(&self) -> bool {
        let force = (self.from..=self.to).map(|k| self.force(k)).sum::<DVec2>();
        let (first, last) = (self.finger(self.from), self.finger(self.to));
        // The place on the object at which the finger was last, as it lay before.
        let before = &self.push.before;
        let place = before.p_WO + before.turn(self.push.after.to_object(last));
        force.dot(last - first) > 0.0 && force.dot(last - place) > 0.0
    }

    pub(super) fn find(push: &'a Push) -> Result<Self, NoTouch> {
        let samples = &push.samples;
        let high = quantile(samples.iter().map(|s| s.force.length()).collect(), 0.75);
        // White noise alone has no level above what neighbours differ by.
        let steps = samples.windows(2).map(|pair| pair[1].force.distance(pair[0].force)).collect();
        if high < NOISE * quantile(steps, 0.5) / (MEDIAN_LENGTH * std::f64::consts::SQRT_2) {
            return Err(NoTouch::NoForce);
        }
        let rise = samples.iter().position(|s| s.force.length() > LOADED * high).ok_or(NoTouch::NoForce)?;
        // Half of what is before the rise is surely free of contact.
        let quiet = &samples[..rise / 2];
        let (offset, noise) = free(quiet);
        let size = |k: usize| (samples[k].force - offset).length();
        let least = (LEAST_SHARE * high).max(NOISE * noise.unwrap_or(0.0));
        if high <= 2.0 * least {
            return Err(NoTouch::NoForce);
        }
        let from = (0..rise).rev().find(|&k| size(k) < least).ok_or(NoTouch::FromTheStart)?;
        let to = (0..samples.len()).rev().find(|&k| size(k) > LOST * high).ok_or(NoTouch::NoForce)?;
        let (first, last) = (&samples[from], &samples[to]);
        let velocity = (last.finger - first.finger) / (last.t - first.t);
        if to <= from + 3 || velocity.length_squared() == 0.0 || !velocity.is_finite() {
            return Err(NoTouch::NoWay);
        }
        let compliance = compliance(&samples[from..=to], offset, velocity);
        Ok(Self { push, from, to, offset, noise, compliance, velocity })
    }

    /// Force at a sample, without the sensor's offset.
    pub(super) fn force(&self, k: usize) -> DVec2 {
        self.push.samples[k].force - self.offset
    }

    /// Where the finger's centre is by all samples nearby, which takes off the rounding of its record.
    pub(super) fn finger(&self, k: usize) -> DVec2 {
        let samples = &self.push.samples;
        let t = samples[k].t;
        let near = samples.iter().filter(|s| (s.t - t).abs() <= 0.5 * AVERAGE);
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        for s in near {
            sum += s.finger - self.velocity * (s.t - t);
            count += 1.0;
        }
        sum / count
    }

    /// The touches at the beginning and at the end, for a finger that gives way by so much, m/N.
    pub(super) fn touches(&self, compliance: f64) -> [Touch; 2] {
        let samples = &self.push.samples;
        let start = samples[self.from].t;
        let until = samples[self.from..=self.to].partition_point(|s| s.t < start + 2.0 * AVERAGE);
        let since = samples[..=self.to].partition_point(|s| s.t < samples[self.to].t - AVERAGE);
        let one = |k: usize, over: std::ops::Range<usize>, pose: object_dynamics::pushing::PushPose, bend| {
            let force: DVec2 = over.map(|k| self.force(k)).sum();
            Touch {
                centre: pose.to_object(self.finger(k) - bend),
                velocity: pose.turn_back(self.velocity),
                force: pose.turn_back(force).normalize_or_zero(),
            }
        };
        let count = (self.to + 1 - since) as f64;
        let last: DVec2 = (since..=self.to).map(|k| self.force(k)).sum::<DVec2>() / count;
        [
            one(self.from, self.from..self.from + until, self.push.before, DVec2::ZERO),
            one(self.to, since..self.to + 1, self.push.after, last * compliance),
        ]
    }
}

/// Offset and noise of the force where nothing touches.
fn free(quiet: &[PushSample]) -> (DVec2, Option<f64>) {
    if quiet.len() < QUIET {
        return (DVec2::ZERO, None);
    }
    let median = |pick: fn(&PushSample) -> f64| quantile(quiet.iter().map(pick).collect(), 0.5);
    let offset = DVec2::new(median(|s| s.force.x), median(|s| s.force.y));
    let length = quantile(quiet.iter().map(|s| (s.force - offset).length()).collect(), 0.5);
    (offset, Some(length / MEDIAN_LENGTH))
}

/// How far the finger goes along the force while that rises from a tenth to six tenths of where it first levels off.
fn compliance(contact: &[PushSample], offset: DVec2, velocity: DVec2) -> f64 {
    let start = contact[0].t;
    let early: Vec<DVec2> =
        contact.iter().take_while(|s| s.t < start + 4.0 * AVERAGE).map(|s| s.force - offset).collect();
    let level = quantile(early.iter().map(|f| f.length()).collect(), 0.75);
    let at = |share: f64| {
        let k = early.iter().position(|f| f.length() >= share * level)?;
        // Between samples along a straight line.
        let (now, before) = (early[k].length(), k.checked_sub(1).map_or(0.0, |j| early[j].length()));
        let part = if now > before { (share * level - before) / (now - before) } else { 1.0 };
        let earlier = k.checked_sub(1).map_or(start, |j| contact[j].t);
        Some((earlier + part * (contact[k].t - earlier), early[k].normalize_or_zero()))
    };
    let (Some((from, _)), Some((to, along))) = (at(0.1), at(0.6)) else { return 0.0 };
    ((to - from) * velocity.dot(along) / (0.5 * level)).max(0.0)
}

/// The value below which a share of all lies; nan of none.
pub(super) fn quantile(mut values: Vec<f64>, share: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let place = share * (values.len().saturating_sub(1)) as f64;
    let (low, part) = (place.floor() as usize, place.fract());
    let at = |k: usize| values.get(k.min(values.len().saturating_sub(1))).copied().unwrap_or(f64::NAN);
    at(low) + part * (at(low + 1) - at(low))
}
