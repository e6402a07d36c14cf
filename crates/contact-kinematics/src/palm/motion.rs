use super::{PalmError, PalmFrame};
use crate::MotionLaw;
use glam::DVec3;

/// A flat palm through the origin that turns about its horizontal axis in a prescribed way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Palm {
    azimuth: f64,
    motion: MotionLaw,
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
    pub fn new(azimuth: f64, motion: MotionLaw) -> Result<Self, PalmError> {
        let bad = Some(("azimuth", azimuth)).filter(|(_, v)| !v.is_finite()).or_else(|| motion.first_bad());
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
        Self::new(azimuth, MotionLaw::Constant { value: slope })
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
    pub fn motion(&self) -> MotionLaw {
        self.motion
    }

    /// Whether the palm never moves.
    #[must_use]
    pub fn is_immobile(&self) -> bool {
        self.motion.is_constant()
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
    fn normal_turns_with_the_palm() {
        let palm = Palm::new(0.4, MotionLaw::Steady { start: 0.8, rate: 0.3 }).unwrap();
        let (t, h) = (0.5, 1e-5);
        let state = palm.at(t);
        let difference = (palm.at(t + h).frame.n - palm.at(t - h).frame.n) / (2.0 * h);
        assert!((difference - state.omega().cross(state.frame.n)).length() < 1e-10);
    }

    #[test]
    fn parameters_must_be_finite() {
        let bad = Palm::new(f64::NAN, MotionLaw::Constant { value: 1.0 });
        assert!(matches!(bad, Err(PalmError::NotFinite { what: "azimuth", .. })));
    }
}
