//! Constants of the body that may join the motion as states.

use super::inertia::{INERTIA_NUMBERS, inertia_of_numbers, numbers_of_inertia};
use crate::three_palms::momentum::Scales;
use glam::DMat3;
use object_dynamics::MassProperties;

/// A constant that may be unknown. Palms count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Constant {
    /// Logarithm of the mass in kg.
    LogMass,
    /// One of the six free numbers of the inertia tensor, body axes.
    Inertia(usize),
}

/// Mass and inertia: the seven constants of a body of which nothing is known.
pub(crate) const BODY: [Constant; 1 + INERTIA_NUMBERS] = [
    Constant::LogMass,
    Constant::Inertia(0),
    Constant::Inertia(1),
    Constant::Inertia(2),
    Constant::Inertia(3),
    Constant::Inertia(4),
    Constant::Inertia(5),
];

impl Constant {
    /// As a report calls it.
    pub(crate) fn name(self) -> &'static str {
        const INERTIA: [&str; INERTIA_NUMBERS] = [
            "second moment along x",
            "second moment along y",
            "second moment along z",
            "product of inertia xy",
            "product of inertia xz",
            "product of inertia yz",
        ];
        match self {
            Self::LogMass => "mass",
            Self::Inertia(number) => INERTIA[number],
        }
    }

    /// Natural size of a change.
    pub(crate) fn scale(self, scales: &Scales) -> f64 {
        match self {
            // Off the diagonal of the factor: its own size, the root of a moment.
            Self::Inertia(number) if number >= 3 => {
                (scales.momentum * scales.length / scales.velocity).sqrt()
            }
            Self::LogMass | Self::Inertia(_) => 1.0,
        }
    }
}

/// Values of all constants.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Parameters {
    /// kg.
    pub(crate) mass: f64,
    /// Free numbers of the inertia tensor.
    pub(crate) inertia: [f64; INERTIA_NUMBERS],
    /// Inverse of the inertia tensor, body axes.
    pub(crate) inverse_inertia: DMat3,
}

impl Parameters {
    /// Of a body.
    pub(crate) fn new(mass: &MassProperties) -> Self {
        Self {
            mass: mass.mass(),
            inertia: numbers_of_inertia(mass.inertia()),
            inverse_inertia: mass.inverse_inertia(),
        }
    }

    /// The number that stands for a constant among the states.
    pub(crate) fn get(&self, constant: Constant) -> f64 {
        match constant {
            Constant::LogMass => self.mass.ln(),
            Constant::Inertia(number) => self.inertia[number],
        }
    }

    /// The parameters with some of them replaced.
    pub(crate) fn with(mut self, values: impl Iterator<Item = (Constant, f64)>) -> Self {
        let mut inertia_changed = false;
        for (constant, value) in values {
            match constant {
                Constant::LogMass => self.mass = value.exp(),
                Constant::Inertia(number) => {
                    self.inertia[number] = value;
                    inertia_changed = true;
                }
            }
        }
        if inertia_changed {
            // Positive definite whatever the numbers are.
            self.inverse_inertia = inertia_of_numbers(&self.inertia).inverse();
        }
        self
    }
}
