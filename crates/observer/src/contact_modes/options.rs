//! What is stated about contacts whose modes are told.

use super::classifier::LONGEST;
use super::error::ContactModesError;

/// What is stated about contacts whose modes are told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactModesOptions {
    /// The natural speed `sqrt(g l)` with the body's mean extent `l`, m/s: slips and their changes are measured by it.
    pub natural_speed: f64,
    /// Deviation of each component of the force that a sensor reads when nothing touches it, N. Only what a contact's loss
    /// looks like rests on it.
    pub unloaded_deviation: f64,
    /// Mean normal force of a contact that touches, N, to its order of magnitude.
    pub typical_force: f64,
    /// Time for which errors of slips last, s: 0 where they are independent from sample to sample. Samples within twice this time tell as
    /// much as one.
    pub slip_errors_last: f64,
    /// Probability above which a label changes, from 0.5 to below 1 (see [`ModeLabel`](crate::bank::ModeLabel)).
    pub label_level: f64,
}

impl ContactModesOptions {
    /// Independent errors of slips, and labels that change at 0.75.
    #[must_use]
    pub fn new(natural_speed: f64, unloaded_deviation: f64, typical_force: f64) -> Self {
        Self { natural_speed, unloaded_deviation, typical_force, slip_errors_last: 0.0, label_level: 0.75 }
    }

    pub(super) fn check(&self) -> Result<(), ContactModesError> {
        for (what, value) in [
            ("natural speed", self.natural_speed),
            ("deviation of an unloaded force", self.unloaded_deviation),
            ("typical force", self.typical_force),
        ] {
            if !(1e-9..=1e9).contains(&value) {
                return Err(ContactModesError::Option {
                    what,
                    value,
                    needed: "from 1e-9 to 1e9 in SI units",
                });
            }
        }
        let (what, value) = ("time for which errors of slips last", self.slip_errors_last);
        if !(0.0..LONGEST).contains(&value) {
            return Err(ContactModesError::Option { what, value, needed: "from zero to below 1000 s" });
        }
        Ok(())
    }

    /// Power to which the density of a slip is raised that comes `dt` after the one before, s.
    pub(super) fn slip_weight(&self, dt: f64) -> f64 {
        let twice = 2.0 * self.slip_errors_last;
        if dt < twice { dt / twice } else { 1.0 }
    }
}
