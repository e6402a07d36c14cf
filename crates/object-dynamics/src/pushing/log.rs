//! What is recorded of pushes, and its checks.

use glam::DVec2;
use thiserror::Error;

/// Fewest samples of a push from which anything is told.
pub const FEWEST_SAMPLES: usize = 8;

/// Pose of the object in the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PushPose {
    /// Origin of the object's frame, m, world.
    pub p_WO: DVec2,
    /// Angle of its axes, rad, counter-clockwise.
    pub theta: f64,
}

impl PushPose {
    /// A point of the world in the object's frame.
    #[must_use]
    pub fn to_object(&self, point: DVec2) -> DVec2 {
        self.turn_back(point - self.p_WO)
    }

    /// A vector of the world in the object's axes.
    #[must_use]
    pub fn turn_back(&self, vector: DVec2) -> DVec2 {
        DVec2::from_angle(-self.theta).rotate(vector)
    }

    /// A vector of the object's axes in those of the world.
    #[must_use]
    pub fn turn(&self, vector: DVec2) -> DVec2 {
        DVec2::from_angle(self.theta).rotate(vector)
    }
}

/// What was read at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PushSample {
    /// Time since the push began, s.
    pub t: f64,
    /// Force of the finger on the object, N, world.
    pub force: DVec2,
    /// Centre of the finger, m, world.
    pub finger: DVec2,
}

/// One push.
#[derive(Clone, Debug, PartialEq)]
pub struct Push {
    /// Its number in the log.
    pub number: u32,
    /// Pose before it.
    pub before: PushPose,
    /// Pose after it.
    pub after: PushPose,
    /// In the order of time.
    pub samples: Vec<PushSample>,
}

/// Pushes of one object by one finger on one table.
#[derive(Clone, Debug, PartialEq)]
pub struct PushLog {
    pushes: Vec<Push>,
}

/// Pushes that are no log.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PushLogError {
    /// There is none.
    #[error("there is no push; give the log at least one")]
    Empty,
    /// Two pushes share a number.
    #[error("push {push} occurs twice; number the pushes of a log each by its own")]
    Twice {
        /// Its number.
        push: u32,
    },
    /// A push of too few samples.
    #[error("push {push} has {found} sample(s); it needs at least {FEWEST_SAMPLES}")]
    Short {
        /// Its number.
        push: u32,
        /// Its samples.
        found: usize,
    },
    /// A value that is not finite.
    #[error("push {push}, sample {sample}: {what} is {value}; it must be finite")]
    NotFinite {
        /// Its number.
        push: u32,
        /// Which sample, from 0; for a pose 0.
        sample: usize,
        /// Which value.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// Time that runs backward.
    #[error("push {push}, sample {sample}: time is {t} s after {before} s; it must not run backward")]
    Time {
        /// Its number.
        push: u32,
        /// Which sample, from 0.
        sample: usize,
        /// Its time, s.
        t: f64,
        /// The time before it, s.
        before: f64,
    },
}

impl PushLog {
    /// Checks the pushes.
    ///
    /// # Errors
    /// [`PushLogError`] names the push, the sample and the value.
    pub fn new(pushes: Vec<Push>) -> Result<Self, PushLogError> {
        if pushes.is_empty() {
            return Err(PushLogError::Empty);
        }
        let mut numbers: Vec<u32> = pushes.iter().map(|p| p.number).collect();
        numbers.sort_unstable();
        if let Some(twice) = numbers.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(PushLogError::Twice { push: twice[0] });
        }
        pushes.iter().try_for_each(check)?;
        Ok(Self { pushes })
    }

    /// The pushes.
    #[must_use]
    pub fn pushes(&self) -> &[Push] {
        &self.pushes
    }
}

fn check(push: &Push) -> Result<(), PushLogError> {
    let number = push.number;
    let found = push.samples.len();
    if found < FEWEST_SAMPLES {
        return Err(PushLogError::Short { push: number, found });
    }
    let finite = |sample, what, value: f64| {
        if value.is_finite() {
            Ok(())
        } else {
            Err(PushLogError::NotFinite { push: number, sample, what, value })
        }
    };
    for (names, pose) in
        [(["pre_x", "pre_y", "pre_theta"], push.before), (["post_x", "post_y", "post_theta"], push.after)]
    {
        for (what, value) in names.into_iter().zip([pose.p_WO.x, pose.p_WO.y, pose.theta]) {
            finite(0, what, value)?;
        }
    }
    for (k, s) in push.samples.iter().enumerate() {
        let values = [s.t, s.force.x, s.force.y, s.finger.x, s.finger.y];
        for (what, value) in ["t", "fx", "fy", "finger_x", "finger_y"].into_iter().zip(values) {
            finite(k, what, value)?;
        }
        // Times that are rounded may repeat.
        if k > 0 && s.t < push.samples[k - 1].t {
            let before = push.samples[k - 1].t;
            return Err(PushLogError::Time { push: number, sample: k, t: s.t, before });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn push(number: u32) -> Push {
        let sample = |k: usize| PushSample { t: k as f64, ..PushSample::default() };
        let pose = PushPose::default();
        Push { number, before: pose, after: pose, samples: (0..FEWEST_SAMPLES).map(sample).collect() }
    }

    #[test]
    fn mistakes_are_named_with_push_and_sample() {
        assert!(PushLog::new(vec![push(0), push(4)]).is_ok());
        assert_eq!(PushLog::new(vec![]), Err(PushLogError::Empty));
        assert_eq!(PushLog::new(vec![push(4), push(4)]), Err(PushLogError::Twice { push: 4 }));
        let mut short = push(2);
        short.samples.truncate(3);
        assert_eq!(PushLog::new(vec![short]), Err(PushLogError::Short { push: 2, found: 3 }));
        let mut back = push(2);
        back.samples[3].t = 1.5;
        let error = PushLog::new(vec![back]).unwrap_err();
        assert_eq!(error, PushLogError::Time { push: 2, sample: 3, t: 1.5, before: 2.0 });
        let mut nan = push(7);
        nan.samples[1].force.y = f64::INFINITY;
        let text = PushLog::new(vec![nan]).unwrap_err().to_string();
        assert!(text.contains("push 7, sample 1") && text.contains("fy is inf"), "{text}");
    }

    #[test]
    fn poses_turn_vectors_there_and_back() {
        let pose = PushPose { p_WO: DVec2::new(1.0, 2.0), theta: std::f64::consts::FRAC_PI_2 };
        // A quarter turn takes the object's x axis to the world's y axis.
        assert!(pose.turn(DVec2::X).distance(DVec2::Y) < 1e-15);
        assert!(pose.to_object(DVec2::new(1.0, 5.0)).distance(DVec2::new(3.0, 0.0)) < 1e-15);
    }
}
