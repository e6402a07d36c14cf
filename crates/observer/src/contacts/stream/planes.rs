//! Samples of three flat palms through the origin, as a stream of any palms takes them.

use super::estimate::StreamError;
use super::sample::{ForceReading, PalmSensed, StreamPalm};
use contact_kinematics::{PalmFrame, PalmSurface, SurfacePose};
use glam::{DQuat, DVec3};
use object_dynamics::{PalmReading, Sample};
use std::collections::VecDeque;

/// Shares of a torque's arm below which it tells no force: on the axis nothing turns.
const SHORTEST_ARM: f64 = 1e-9;

/// Rates of palms, and what accelerates them, come from the samples on either side: a sample is ready when the next one comes.
#[derive(Debug, Default)]
pub struct PlaneReadings {
    /// Moments of inertia of the palms about their axes, kg m^2: needed only for torques.
    palm_inertias: Option<[f64; 3]>,
    /// The latest three samples as they came.
    raw: VecDeque<Sample>,
}

impl PlaneReadings {
    /// Of palms of these moments of inertia about their axes, kg m^2, which torques in place of forces need.
    #[must_use]
    pub fn new(palm_inertias: Option<[f64; 3]>) -> Self {
        Self { palm_inertias, raw: VecDeque::with_capacity(4) }
    }

    /// The palms as a stream takes them: planes without friction.
    #[must_use]
    pub fn palms() -> Vec<StreamPalm> {
        vec![StreamPalm { surface: PalmSurface::Plane, friction: Some(0.0) }; 3]
    }

    /// Takes a sample and returns the one before it; none for the very first one.
    ///
    /// # Errors
    /// [`StreamError::Time`], [`StreamError::Frame`] or [`StreamError::NoForce`] for a sample that cannot be used (it is left out).
    pub fn push(&mut self, sample: &Sample) -> Result<Option<(f64, [PalmSensed; 3])>, StreamError> {
        let previous = self.raw.back().map_or(f64::NEG_INFINITY, |s| s.t);
        let t = sample.t;
        if !(t > previous && t.is_finite()) {
            return Err(StreamError::Time { t, previous });
        }
        for (i, palm) in sample.palms.iter().enumerate() {
            check(palm, i + 1, t)?;
        }
        if self.raw.len() == 3 {
            self.raw.pop_front();
        }
        self.raw.push_back(*sample);
        let Some(middle) = self.raw.len().checked_sub(2) else { return Ok(None) };
        self.sample(middle)
    }

    /// The sample that was pushed last, its rates from those before it; none where there is none.
    ///
    /// # Errors
    /// As [`Self::push`].
    pub fn last(&self) -> Result<Option<(f64, [PalmSensed; 3])>, StreamError> {
        self.raw.len().checked_sub(1).map_or(Ok(None), |last| self.sample(last))
    }

    fn sample(&self, middle: usize) -> Result<Option<(f64, [PalmSensed; 3])>, StreamError> {
        let mut sensed = [None; 3];
        for (i, place) in sensed.iter_mut().enumerate() {
            *place = Some(self.palm(middle, i)?);
        }
        let [Some(a), Some(b), Some(c)] = sensed else { return Ok(None) };
        Ok(Some((self.raw[middle].t, [a, b, c])))
    }

    fn palm(&self, middle: usize, i: usize) -> Result<PalmSensed, StreamError> {
        let (before, here, after) = (
            &self.raw[middle.saturating_sub(1)],
            &self.raw[middle],
            &self.raw[(middle + 1).min(self.raw.len() - 1)],
        );
        let reading = &here.palms[i];
        let frame = PalmFrame::from_normal(reading.normal).map_err(|source| StreamError::Frame {
            palm: i + 1,
            t: here.t,
            source,
        })?;
        // Of a single sample nothing is known to move.
        let time = after.t - before.t;
        let slope = |change: f64| if time > 0.0 { change / time } else { 0.0 };
        let rate = |s: &Sample| s.palms[i].rate;
        // n' = rate t1 x n = -rate t2.
        let turned =
            |a: &Sample, b: &Sample| -frame.t2.dot(b.palms[i].normal.get() - a.palms[i].normal.get());
        let acceleration = match (rate(before), rate(after)) {
            (Some(a), Some(b)) => slope(b - a),
            _ if middle == 0 || middle + 1 == self.raw.len() => 0.0,
            _ => {
                let (first, second) = (here.t - before.t, after.t - here.t);
                2.0 * (turned(here, after) / second - turned(before, here) / first) / time
            }
        };
        let spin = rate(here).unwrap_or_else(|| slope(turned(before, after)));
        let force = match (reading.contact, reading.force) {
            (None, _) => 0.0,
            (_, Some(force)) => force,
            (Some([_, arm]), None) => self
                .of_torque(reading, i, arm, acceleration)
                .ok_or(StreamError::NoForce { palm: i + 1, t: here.t })?,
        };
        let R_WP = DQuat::from_mat3(&frame.rotation()).normalize();
        Ok(PalmSensed {
            pose: SurfacePose { p_WP: DVec3::ZERO, R_WP },
            twist: Some([DVec3::ZERO, spin * frame.t1]),
            contact: reading.contact.map(|s| frame.contact_from_sensor(s)),
            force: ForceReading::Normal(force),
        })
    }

    /// The normal force that a motor's torque tells: what does not turn the palm, over the arm of the contact.
    fn of_torque(&self, reading: &PalmReading, i: usize, arm: f64, acceleration: f64) -> Option<f64> {
        let left = reading.torque? - self.palm_inertias?[i] * acceleration;
        (arm.abs() > SHORTEST_ARM).then(|| left / arm)
    }
}

/// Refuses what is no number.
fn check(palm: &PalmReading, number: usize, t: f64) -> Result<(), StreamError> {
    let [s1, s2] = palm.contact.unwrap_or_default();
    let readings = [
        ("contact s1", Some(s1)),
        ("contact s2", Some(s2)),
        ("force", palm.force),
        ("torque", palm.torque),
        ("rate", palm.rate),
    ];
    let wrong = readings.into_iter().find_map(|(what, v)| Some((what, v?)).filter(|(_, v)| !v.is_finite()));
    wrong.map_or(Ok(()), |(what, value)| Err(StreamError::Reading { what, palm: number, t, value }))
}
