//! Readings that stay the same to the last digit though their noise never lets them: of a sensor that is frozen, or at the end of its range.

use super::{ContactLog, ForceChannel, LoggedPalm, SensedAxes};
use contact_kinematics::SurfacePose;
use glam::DVec3;
use std::fmt;
use std::ops::Range;

/// How improbable so many repetitions in a row must be, by how often readings repeat otherwise.
const BY_CHANCE: f64 = 1e-9;
/// Readings that must have come before it is told what is usual.
const FEWEST: usize = 50;
/// Repetitions in a row that count at most for what is usual.
const COUNTED: usize = 3;
/// Share of second differences that turn about in what is noise: of white noise it is three quarters, of what is smooth nearly none.
const NOISY: f64 = 0.25;
/// Share of a reading by which one that was turned into other axes and back differs from itself.
pub(super) const ROUNDING: f64 = 1e-12;

/// Follows one axis of the readings of a sensor.
#[derive(Clone, Copy, Debug, Default)]
struct Channel {
    before: Option<f64>,
    /// First and second difference of the latest readings that were new.
    step: f64,
    bend: f64,
    /// Readings that were new, second differences that turned about, and readings that were as the one before while the sensor was not stuck.
    new: usize,
    turned: usize,
    again: usize,
    /// Repetitions in a row.
    run: usize,
}

impl Channel {
    /// Takes the next reading; gives how many repetitions there are in a row where they tell that the sensor is stuck. One that says nothing but zero is
    /// taken for one that feels nothing.
    fn take(&mut self, reading: Option<f64>) -> Option<usize> {
        let Some(now) = reading.filter(|reading| *reading != 0.0) else {
            *self = Self { before: None, run: 0, ..*self };
            return None;
        };
        let Some(before) = self.before.replace(now) else {
            (self.step, self.bend, self.run) = (0.0, 0.0, 0);
            return None;
        };
        if (now - before).abs() <= ROUNDING * now.abs() {
            self.run += 1;
            return Some(self.run).filter(|run| self.is_stuck(*run));
        }
        // A stuck sensor does not make repetitions usual, nor one that was stuck before anything was usual.
        if self.run > 0 && !self.is_stuck(self.run) {
            self.again += self.run.min(COUNTED);
        }
        let (step, bend) = (now - before, now - before - self.step);
        self.turned += usize::from(bend * self.bend < 0.0);
        self.new += 1;
        (self.step, self.bend, self.run) = (step, bend, 0);
        None
    }

    fn is_stuck(&self, run: usize) -> bool {
        let usual = (self.again + 1) as f64 / (self.new + self.again + 2) as f64;
        let noisy = self.turned as f64 >= NOISY * self.new as f64;
        self.new >= FEWEST && noisy && run as f64 * usual.ln() < BY_CHANCE.ln()
    }
}

/// What of a palm repeats.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum RepeatedReading {
    /// Its force.
    Force,
    /// Its contact.
    Contact,
}

impl fmt::Display for RepeatedReading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if *self == Self::Force { "force" } else { "contact" })
    }
}

/// Follows the readings of a palm sample by sample, and tells where its force or its contact is stuck along an axis, of the world or its own.
#[derive(Clone, Copy, Debug, Default)]
pub struct StuckWatch {
    forces: [[Channel; 3]; 2],
    contacts: [[Channel; 3]; 2],
}

impl StuckWatch {
    /// Takes the next sample of a palm at `pose`: where it is touched (world, m; none where it is not) and the force there: a vector in world axes, or
    /// along the palm's normal one along X. Gives what is stuck, with how many samples in a row repeat the one before.
    pub fn take(
        &mut self,
        pose: &SurfacePose,
        contact: Option<DVec3>,
        (force, axes): (DVec3, SensedAxes),
    ) -> Option<(RepeatedReading, usize)> {
        let own_force = if axes == SensedAxes::Three { pose.R_WP.conjugate() * force } else { force };
        let longest = |axes: &mut [[Channel; 3]; 2], readings: [DVec3; 2]| {
            let each = axes.iter_mut().flatten().zip(readings.into_iter().flat_map(told));
            each.filter_map(|(axis, of)| axis.take(contact.map(|_| of))).max()
        };
        let force = longest(&mut self.forces, [force, own_force]);
        let at = contact.unwrap_or_default();
        let contact = longest(&mut self.contacts, [at, on_palm(pose, at)]);
        let named = |reading: RepeatedReading| move |run: usize| (reading, run);
        force.map(named(RepeatedReading::Force)).or(contact.map(named(RepeatedReading::Contact)))
    }
}

/// The axes of a reading, without what is rounding against all of it: across a palm in an axis of the world that has few values, which repeat.
fn told(reading: DVec3) -> [f64; 3] {
    let least = ROUNDING * reading.length();
    reading.to_array().map(|axis| if axis.abs() > least { axis } else { 0.0 })
}

/// Samples over which a reading of a palm is stuck: from the first repetition to the last.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Stuck {
    /// From 1.
    pub palm: usize,
    /// Which of its readings.
    pub reading: RepeatedReading,
    /// Their numbers.
    pub samples: Range<usize>,
}

impl ContactLog {
    /// Where readings are stuck. What a log begins with is not told from one that is.
    #[must_use]
    pub fn stuck(&self) -> Vec<Stuck> {
        let mut all: Vec<Stuck> = Vec::new();
        for (i, palm) in self.palms.iter().enumerate() {
            let mut watch = StuckWatch::default();
            for k in 0..self.times.len() {
                let touch = palm.touch(k).map(|touch| touch.p_WC);
                let Some((reading, run)) = watch.take(&palm.motion(k).pose, touch, sensed(palm, k)) else {
                    continue;
                };
                let samples = k + 1 - run..k + 1;
                match all.last_mut() {
                    Some(last) if last.goes_on_to(i + 1, reading, k) => last.samples.end = k + 1,
                    _ => all.push(Stuck { palm: i + 1, reading, samples }),
                }
            }
        }
        all
    }
}

impl Stuck {
    /// Numbers of the samples of so many at which nothing is stuck.
    #[must_use]
    pub fn left(stuck: &[Self], count: usize) -> Vec<usize> {
        (0..count).filter(|k| stuck.iter().all(|stuck| !stuck.samples.contains(k))).collect()
    }

    /// Whether sample `k` is the next of it.
    fn goes_on_to(&self, palm: usize, reading: RepeatedReading, k: usize) -> bool {
        (self.palm, self.reading, self.samples.end) == (palm, reading, k)
    }
}

/// A place in the world in the palm's axes, m.
pub(super) fn on_palm(pose: &SurfacePose, p_W: DVec3) -> DVec3 {
    pose.R_WP.conjugate() * (p_W - pose.p_WP)
}

/// A force as the sensor reads it; zero where it is not measured.
fn sensed(palm: &LoggedPalm, k: usize) -> (DVec3, SensedAxes) {
    match palm.force_channel() {
        ForceChannel::Missing => (DVec3::ZERO, SensedAxes::Three),
        ForceChannel::Normal(values) => (DVec3::X * values[k], SensedAxes::Normal),
        ForceChannel::Three(vectors) => (vectors[k], SensedAxes::Three),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// What is stuck of readings `of(k)` with noise, of a palm that turns: `(force, contact)` along the normal.
    fn stuck(of: impl Fn(usize) -> (f64, DVec3), count: usize) -> Vec<(usize, RepeatedReading, usize)> {
        let mut watch = StuckWatch::default();
        let take = |k: usize| {
            let R_WP = DQuat::from_rotation_y(1e-3 * k as f64);
            let pose = SurfacePose { p_WP: DVec3::new(0.3, -0.2, 0.1), R_WP };
            let (force, contact) = of(k);
            let contact = pose.p_WP + R_WP * contact;
            let found = watch.take(&pose, Some(contact), (DVec3::X * force, SensedAxes::Normal));
            found.map(|(reading, run)| (k, reading, run))
        };
        (0..count).filter_map(take).collect()
    }

    /// Between -1 and 1, without any pattern that counts here.
    fn noise(k: usize) -> f64 {
        (1e4 * (1.0 + k as f64).sin()).fract()
    }

    fn right(k: usize) -> (f64, DVec3) {
        let t = 0.01 * k as f64;
        let contact = DVec3::new(t.sin() + 1e-3 * noise(k + 500), t.cos() + 1e-3 * noise(k + 900), 0.0);
        (3.0 + t.sin() + 0.01 * noise(k), contact)
    }

    #[test]
    fn readings_with_noise_that_repeat_are_stuck_from_when_that_is_no_chance() {
        assert_eq!(stuck(right, 400), []);
        let held = |k: usize| if (200..260).contains(&k) { 200 } else { k };
        let force = stuck(|k| (right(held(k)).0, right(k).1), 400);
        let contact = stuck(|k| (right(k).0, right(held(k)).1), 400);
        for (found, reading) in [(force, RepeatedReading::Force), (contact, RepeatedReading::Contact)] {
            // Of 200 readings none repeats: four that do are once in 1e9.
            let (first, last) = (found[0], found[found.len() - 1]);
            assert_eq!((first, last), ((204, reading, 4), (259, reading, 59)));
            assert_eq!(found.len(), 56);
        }
        // Every reading twice is a slow sensor, and rest without noise is rest.
        assert_eq!(stuck(|k| right(k - k % 2), 400), []);
        let smooth = |k: usize| ((0.01 * k as f64).sin(), DVec3::new((0.02 * k as f64).cos(), 1.0, 0.0));
        assert_eq!(stuck(|k| smooth(k.min(200)), 400), []);
        // What is rounding along one axis has few values.
        let rounded = |k: usize| 5.6e-17 * (2.0 * noise(k + 700)).round();
        let level =
            |k: usize| (Some(right(k).1.with_y(rounded(k))), (DVec3::X * right(k).0, SensedAxes::Normal));
        let mut watch = StuckWatch::default();
        let found = (0..2000).filter_map(|k| {
            watch.take(&SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }, level(k).0, level(k).1)
        });
        assert_eq!(found.count(), 0);
        // Steps: a sensor of a few of them repeats by chance.
        let steps = |k: usize| ((3.0 * noise(k)).round() + 5.0, right(k).1);
        assert_eq!(stuck(steps, 2000), []);
        // At the end of the range, again and again; zeros are a palm that feels nothing.
        let most = |k: usize| ((3.0 + 2.0 * (0.02 * k as f64).sin() + 0.01 * noise(k)).min(4.5), right(k).1);
        assert!(stuck(most, 1000).iter().all(|(k, ..)| (3.0 + 2.0 * (0.02 * *k as f64).sin()) > 4.48));
        assert!(stuck(most, 1000).len() > 110);
        assert_eq!(stuck(|k| if k > 200 { (0.0, right(k).1) } else { right(k) }, 400), []);
    }
}
