use super::{PalmError, PalmFrame};
use glam::DVec3;

/// Slope of a palm against the horizontal as a function of time, with two exact derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SlopeMotion {
    /// The palm does not move: slope in rad.
    Fixed {
        /// Slope in rad.
        slope: f64,
    },
    /// `slope + rate t`.
    Steady {
        /// Slope at `t = 0`, in rad.
        slope: f64,
        /// Rate in rad/s.
        rate: f64,
    },
    /// `slope + amplitude sin(frequency t + phase)`.
    Sinusoid {
        /// Mean slope in rad.
        slope: f64,
        /// Amplitude in rad.
        amplitude: f64,
        /// Angular frequency in rad/s.
        frequency: f64,
        /// Phase in rad.
        phase: f64,
    },
}

impl SlopeMotion {
    /// Slope, rate and acceleration at time `t` (rad, rad/s, rad/s^2).
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 3] {
        match *self {
            Self::Fixed { slope } => [slope, 0.0, 0.0],
            Self::Steady { slope, rate } => [rate.mul_add(t, slope), rate, 0.0],
            Self::Sinusoid { slope, amplitude, frequency, phase } => {
                let (sin, cos) = frequency.mul_add(t, phase).sin_cos();
                let (a1, a2) = (amplitude * frequency, amplitude * frequency * frequency);
                [amplitude.mul_add(sin, slope), a1 * cos, -a2 * sin]
            }
        }
    }

    fn parameters(&self) -> [(&'static str, f64); 4] {
        match *self {
            Self::Fixed { slope } => [("slope", slope), ("rate", 0.0), ("frequency", 0.0), ("phase", 0.0)],
            Self::Steady { slope, rate } => {
                [("slope", slope), ("rate", rate), ("frequency", 0.0), ("phase", 0.0)]
            }
            Self::Sinusoid { slope, amplitude, frequency, phase } => {
                [("slope", slope), ("amplitude", amplitude), ("frequency", frequency), ("phase", phase)]
            }
        }
    }
}

/// A flat palm through the origin that turns about its horizontal axis in a prescribed way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palm {
    azimuth: f64,
    motion: SlopeMotion,
}

/// Where a palm is and how it moves at one instant, in world axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmState {
    /// Frame `[t1 t2 n]`.
    pub frame: PalmFrame,
    /// Rotation rate about `t1`, in rad/s: `w_WP = rate t1`.
    pub rate: f64,
    /// Rotational acceleration about `t1`, in rad/s^2.
    pub acceleration: f64,
}

impl Palm {
    /// A palm that rises in the horizontal direction `azimuth` (rad) with the given slope over time.
    ///
    /// # Errors
    /// [`PalmError::NotFinite`] when a parameter is NaN or infinite.
    pub fn new(azimuth: f64, motion: SlopeMotion) -> Result<Self, PalmError> {
        let bad =
            std::iter::once(("azimuth", azimuth)).chain(motion.parameters()).find(|(_, v)| !v.is_finite());
        match bad {
            Some((what, value)) => Err(PalmError::NotFinite { what, value }),
            None => Ok(Self { azimuth, motion }),
        }
    }

    /// An immobile palm of the given azimuth and slope, both in rad.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn fixed(azimuth: f64, slope: f64) -> Result<Self, PalmError> {
        Self::new(azimuth, SlopeMotion::Fixed { slope })
    }

    /// State of the palm at time `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> PalmState {
        let [slope, rate, acceleration] = self.motion.at(t);
        PalmState { frame: PalmFrame::from_azimuth_slope(self.azimuth, slope), rate, acceleration }
    }

    /// Direction in which the palm rises, in rad.
    #[must_use]
    pub fn azimuth(&self) -> f64 {
        self.azimuth
    }

    /// The palm's prescribed slope.
    #[must_use]
    pub fn motion(&self) -> SlopeMotion {
        self.motion
    }

    /// Whether the palm never moves.
    #[must_use]
    pub fn is_immobile(&self) -> bool {
        matches!(self.motion, SlopeMotion::Fixed { .. })
    }
}

impl PalmState {
    /// Angular velocity of the palm `w_WP`, in rad/s, world axes.
    #[must_use]
    pub fn omega(&self) -> DVec3 {
        self.rate * self.frame.t1
    }

    /// Angular acceleration of the palm, in rad/s^2, world axes.
    #[must_use]
    pub fn alpha(&self) -> DVec3 {
        self.acceleration * self.frame.t1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_the_motion_match_differences() {
        let motion = SlopeMotion::Sinusoid { slope: 0.9, amplitude: 0.08, frequency: 1.7, phase: 0.3 };
        let (t, h) = (0.7, 1e-5);
        let [_, rate, acceleration] = motion.at(t);
        let (before, after) = (motion.at(t - h), motion.at(t + h));
        assert!(((after[0] - before[0]) / (2.0 * h) - rate).abs() < 1e-10);
        assert!(((after[1] - before[1]) / (2.0 * h) - acceleration).abs() < 1e-10);
    }

    #[test]
    fn normal_turns_with_the_palm() {
        let palm = Palm::new(0.4, SlopeMotion::Steady { slope: 0.8, rate: 0.3 }).unwrap();
        let (t, h) = (0.5, 1e-5);
        let state = palm.at(t);
        let difference = (palm.at(t + h).frame.n - palm.at(t - h).frame.n) / (2.0 * h);
        assert!((difference - state.omega().cross(state.frame.n)).length() < 1e-10);
    }

    #[test]
    fn parameters_must_be_finite() {
        let bad = Palm::new(f64::NAN, SlopeMotion::Fixed { slope: 1.0 });
        assert!(matches!(bad, Err(PalmError::NotFinite { what: "azimuth", .. })));
    }
}
