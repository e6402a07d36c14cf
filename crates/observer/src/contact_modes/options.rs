//! What is stated about contacts whose modes are told.

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
    /// Power to which densities of slips are raised, above 0 up to 1: 1 where the errors of slips are independent from sample
    /// to sample; else how many samples tell as much as one. At 1 kHz, errors that last for 50 ms: 0.1.
    pub slip_weight: f64,
    /// Probability above which a label changes, from 0.5 to below 1 (see [`ModeLabel`](crate::ModeLabel)).
    pub label_level: f64,
}

impl ContactModesOptions {
    /// Independent errors of slips, and labels that change at 0.75.
    #[must_use]
    pub fn new(natural_speed: f64, unloaded_deviation: f64, typical_force: f64) -> Self {
        Self { natural_speed, unloaded_deviation, typical_force, slip_weight: 1.0, label_level: 0.75 }
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
        if !(self.slip_weight > 0.0 && self.slip_weight <= 1.0) {
            let (what, value) = ("weight of the slips", self.slip_weight);
            return Err(ContactModesError::Option { what, value, needed: "above zero and at most one" });
        }
        Ok(())
    }
}
