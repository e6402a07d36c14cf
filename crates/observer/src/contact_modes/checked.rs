//! What every sample must obey.

use super::classifier::{ContactModes, LONGEST};
use super::error::ContactModesError;
use super::reading::{ContactSeen, Place};
use super::twist::TwistError;
use nalgebra::Matrix6;

/// Largest slope of a slip by the twist times the twist's deviation, in natural speeds.
const MOST: f64 = 1e9;

impl ContactModes {
    pub(super) fn check(&self, dt: f64, seen: &[ContactSeen]) -> Result<(), ContactModesError> {
        let sample = self.samples;
        if !(dt > 0.0 && dt < LONGEST) {
            return Err(ContactModesError::TimeStep { sample, value: dt });
        }
        self.check_count("readings", seen.len())?;
        for (contact, seen) in seen.iter().enumerate() {
            if let ContactSeen::Read(reading) = seen {
                reading.check(Place { contact, sample }, &self.options)?;
            }
        }
        Ok(())
    }

    fn check_count(&self, what: &'static str, found: usize) -> Result<(), ContactModesError> {
        let (sample, needed) = (self.samples, self.contacts.len());
        if found == needed {
            Ok(())
        } else {
            Err(ContactModesError::Contacts { what, sample, found, needed })
        }
    }

    /// The inverse of the twist's covariance.
    pub(super) fn check_twist(&self, twist: &TwistError<'_>) -> Result<Matrix6<f64>, ContactModesError> {
        self.check_count("slopes", twist.slopes.len())?;
        let sample = self.samples;
        let refused = ContactModesError::TwistCovariance { sample };
        let covariance = twist.covariance;
        let asymmetry = (covariance - covariance.transpose()).amax();
        // False of what is not a number as well.
        let symmetric = asymmetry <= 1e-9 * covariance.amax();
        let Some(root) = covariance.cholesky().filter(|_| symmetric) else { return Err(refused) };
        let inverse = root.inverse();
        if !inverse.iter().all(|entry| entry.is_finite()) {
            return Err(refused);
        }
        for (contact, slope) in twist.slopes.iter().enumerate() {
            let at = Place { contact, sample };
            slope.iter().try_for_each(|entry| at.finite("slope of the slip by the twist", *entry))?;
            let speed = slope.amax() * covariance.diagonal().max().sqrt() / self.options.natural_speed;
            at.within("slope of the slip by the twist, in natural speeds a deviation", speed, MOST)?;
        }
        Ok(inverse)
    }
}
