//! Constants of a scene: nominal values, and which of them are estimated as states.

use super::error::PlanarEstimateError;
use object_dynamics::planar::PlanarMass;

/// A constant that can be estimated along with the motion, as an extra state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Constant {
    /// Logarithm of the mass over its nominal value; it keeps the mass positive.
    Mass,
    /// Logarithm of the moment of inertia over its nominal value.
    Inertia,
    /// Logarithm of true over measured force. With logarithms throughout, what cannot be seen (a common factor of mass, inertia
    /// and both forces) is one fixed direction of the state space, in which repeated linearisation finds nothing either.
    ForceGain(Side),
    /// Force to add to the sensor's, N.
    ForceBias(Side),
    /// What the contact sensor reads too much, m.
    ContactOffset(Side),
}

/// Which palm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Side {
    /// Palm 1.
    First,
    /// Palm 2.
    Second,
}

impl Side {
    /// Index from 0.
    #[must_use]
    pub fn index(self) -> usize {
        match self {
            Side::First => 0,
            Side::Second => 1,
        }
    }
}

impl Constant {
    /// As a report calls it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Constant::Mass => "log mass",
            Constant::Inertia => "log moment of inertia",
            Constant::ForceGain(Side::First) => "log force gain of palm 1",
            Constant::ForceGain(Side::Second) => "log force gain of palm 2",
            Constant::ForceBias(Side::First) => "force bias of palm 1",
            Constant::ForceBias(Side::Second) => "force bias of palm 2",
            Constant::ContactOffset(Side::First) => "contact offset of palm 1",
            Constant::ContactOffset(Side::Second) => "contact offset of palm 2",
        }
    }
}

/// What is taken as known about the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarNominal {
    /// Mass and inertia; a rough value where they are estimated.
    pub mass: PlanarMass,
    /// Gravity in m/s^2, along world -Y.
    pub gravity: f64,
    /// Standard deviation of a contact reading, m; zero for exact data.
    pub contact_deviation: f64,
    /// Standard deviation of a force reading, N; zero for exact data.
    pub force_deviation: f64,
}

impl PlanarNominal {
    /// Refuses negative or unusable numbers.
    pub(super) fn check(&self) -> Result<(), PlanarEstimateError> {
        for (what, value) in
            [("contact deviation", self.contact_deviation), ("force deviation", self.force_deviation)]
        {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(PlanarEstimateError::Value { what, value, needed: "finite and at least 0" });
            }
        }
        if self.gravity > 0.0 && self.gravity.is_finite() {
            Ok(())
        } else {
            Err(PlanarEstimateError::Value { what: "gravity", value: self.gravity, needed: "positive" })
        }
    }
}
