//! Constants of body and sensors that may join the motion as states.

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
    /// Factor between the force that a sensor reports and the force, to be multiplied with what is reported.
    ForceGain(usize),
    /// Force, N, to be added to what the sensor reports (times its gain).
    ForceBias(usize),
    /// To be added to the sensor coordinate `s1` or `s2` of a palm, m.
    ContactOffset(usize, usize),
    /// The force at a sample is what was reported so much later, s.
    ForceDelay,
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
        const GAIN: [&str; 3] = ["force gain of palm 1", "force gain of palm 2", "force gain of palm 3"];
        const BIAS: [&str; 3] = ["force bias of palm 1", "force bias of palm 2", "force bias of palm 3"];
        const OFFSET: [[&str; 2]; 3] = [
            ["offset of s1 of palm 1", "offset of s2 of palm 1"],
            ["offset of s1 of palm 2", "offset of s2 of palm 2"],
            ["offset of s1 of palm 3", "offset of s2 of palm 3"],
        ];
        match self {
            Self::LogMass => "mass",
            Self::Inertia(number) => INERTIA[number],
            Self::ForceGain(palm) => GAIN[palm],
            Self::ForceBias(palm) => BIAS[palm],
            Self::ContactOffset(palm, axis) => OFFSET[palm][axis],
            Self::ForceDelay => "delay of the forces",
        }
    }

    /// Natural size of a change.
    pub(crate) fn scale(self, scales: &Scales) -> f64 {
        let time = scales.length / scales.velocity;
        match self {
            // Off the diagonal of the factor: its own size, the root of a moment.
            Self::Inertia(number) if number >= 3 => (scales.momentum * time).sqrt(),
            Self::LogMass | Self::Inertia(_) | Self::ForceGain(_) => 1.0,
            Self::ForceBias(_) => scales.momentum / scales.length / time,
            Self::ContactOffset(..) => scales.length,
            Self::ForceDelay => time,
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
    /// Factors of the forces.
    pub(crate) gains: [f64; 3],
    /// Forces to be added, N.
    pub(crate) biases: [f64; 3],
    /// To be added to the sensor coordinates, m.
    pub(crate) offsets: [[f64; 2]; 3],
    /// Delay of the forces against the contacts, s.
    pub(crate) delay: f64,
}

impl Parameters {
    /// A body on perfect sensors.
    pub(crate) fn new(mass: &MassProperties) -> Self {
        Self {
            mass: mass.mass(),
            inertia: numbers_of_inertia(mass.inertia()),
            inverse_inertia: mass.inverse_inertia(),
            gains: [1.0; 3],
            biases: [0.0; 3],
            offsets: [[0.0; 2]; 3],
            delay: 0.0,
        }
    }

    /// The number that stands for a constant among the states.
    pub(crate) fn get(&self, constant: Constant) -> f64 {
        match constant {
            Constant::LogMass => self.mass.ln(),
            Constant::Inertia(number) => self.inertia[number],
            Constant::ForceGain(palm) => self.gains[palm],
            Constant::ForceBias(palm) => self.biases[palm],
            Constant::ContactOffset(palm, axis) => self.offsets[palm][axis],
            Constant::ForceDelay => self.delay,
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
                Constant::ForceGain(palm) => self.gains[palm] = value,
                Constant::ForceBias(palm) => self.biases[palm] = value,
                Constant::ContactOffset(palm, axis) => self.offsets[palm][axis] = value,
                Constant::ForceDelay => self.delay = value,
            }
        }
        if inertia_changed {
            // Positive definite whatever the numbers are.
            self.inverse_inertia = inertia_of_numbers(&self.inertia).inverse();
        }
        self
    }

    /// Inertia tensor, body axes, kg m^2.
    pub(crate) fn inertia_tensor(&self) -> DMat3 {
        inertia_of_numbers(&self.inertia)
    }
}
