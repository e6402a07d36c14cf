//! The size and time that are natural to a scene.

use crate::planar::PlanarEstimateError;
use object_dynamics::planar::PlanarSample;

/// Length of the object and the time in which gravity moves it by that length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct NaturalScale {
    /// Length in m.
    pub(super) length: f64,
    /// Gravity in m/s^2.
    pub(super) gravity: f64,
}

impl NaturalScale {
    /// From what the sensors say: a disc that touches at `s` has the radius `s tan(phi2 / 2)`.
    ///
    /// # Errors
    /// [`PlanarEstimateError::LostContact`] where a contact is missing, [`PlanarEstimateError::Value`] for a gravity or a
    /// contact that is not positive.
    pub(super) fn from_sample(sample: &PlanarSample, gravity: f64) -> Result<Self, PlanarEstimateError> {
        if !(gravity > 0.0 && gravity.is_finite()) {
            return Err(PlanarEstimateError::Value { what: "gravity", value: gravity, needed: "positive" });
        }
        let mut sum = 0.0;
        for (i, contact) in sample.contacts.iter().enumerate() {
            sum += contact.ok_or(PlanarEstimateError::LostContact { palm: i + 1, t: sample.t })?;
        }
        let length = 0.5 * sum * (0.5 * sample.angles[1]).tan();
        if !(length > 0.0 && length.is_finite()) {
            return Err(PlanarEstimateError::Value {
                what: "size from the contacts",
                value: length,
                needed: "positive",
            });
        }
        Ok(Self { length, gravity })
    }

    /// Natural time `sqrt(L / g)` in s.
    #[must_use]
    pub(super) fn time(&self) -> f64 {
        (self.length / self.gravity).sqrt()
    }

    /// Natural angular velocity `sqrt(g / L)` in rad/s.
    #[must_use]
    pub(super) fn rate(&self) -> f64 {
        (self.gravity / self.length).sqrt()
    }
}
