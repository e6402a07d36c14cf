//! What two planar palms sensed, in memory.

use super::error::PlanarLogError;
use crate::series::{check_lengths, check_order, is_taken};
use contact_kinematics::planar::{PalmPair, PalmPairError};
use glam::DVec2;

/// One instant of a planar log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarSample {
    /// Time in s.
    pub t: f64,
    /// `phi1` against the world and `phi2` against palm 1, rad.
    pub angles: [f64; 2],
    /// Distances of the contacts from the hinge, m; none while the object does not touch the palm.
    pub contacts: [Option<f64>; 2],
    /// Normal contact forces in N, where they were measured.
    pub forces: Option<[f64; 2]>,
    /// Motor torques in N m, ground-referenced and counter-clockwise, where they were measured.
    pub torques: Option<[f64; 2]>,
}

/// True state of the object, where a simulator knows it. Never read by an estimator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlanarTruth {
    /// Centre of mass, m.
    pub p_WCm: DVec2,
    /// Orientation, rad.
    pub phi0: f64,
    /// Velocity of the centre of mass, m/s.
    pub v_WCm: DVec2,
    /// Angular velocity, rad/s.
    pub omega0: f64,
}

/// A log of two planar palms: at least two samples in strictly increasing time.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarLog {
    samples: Vec<PlanarSample>,
    truth: Option<Vec<PlanarTruth>>,
}

impl PlanarSample {
    /// The palms at this instant.
    ///
    /// # Errors
    /// [`PalmPairError`]; never for a sample of a [`PlanarLog`], which is checked.
    pub fn palms(&self) -> Result<PalmPair, PalmPairError> {
        PalmPair::new(self.angles[0], self.angles[1])
    }
}

impl PlanarLog {
    /// Checks the samples and takes them.
    ///
    /// A force may be negative by noise; only one that is negative beyond a tenth of the largest is refused.
    ///
    /// # Errors
    /// [`PlanarLogError`] names the first sample that cannot be used.
    pub fn new(samples: Vec<PlanarSample>, truth: Option<Vec<PlanarTruth>>) -> Result<Self, PlanarLogError> {
        check_lengths(samples.len(), truth.as_ref().map(Vec::len))?;
        let largest_force = samples.iter().filter_map(|s| s.forces).flatten().fold(0.0_f64, f64::max);
        for (index, sample) in samples.iter().enumerate() {
            check_sample(index, sample, largest_force)?;
            let previous = index.checked_sub(1).map(|before| samples[before].t);
            check_order(index, previous, sample.t)?;
        }
        Ok(Self { samples, truth })
    }

    /// The samples, in time order.
    #[must_use]
    pub fn samples(&self) -> &[PlanarSample] {
        &self.samples
    }

    /// For noise, which keeps what [`Self::new`] has checked: finite numbers and times.
    #[cfg(feature = "noise")]
    pub(super) fn samples_mut(&mut self) -> &mut [PlanarSample] {
        &mut self.samples
    }

    /// The true states, one a sample, where they are known.
    #[must_use]
    pub fn truth(&self) -> Option<&[PlanarTruth]> {
        self.truth.as_deref()
    }

    /// Index of the first sample at which some palm is without contact, with the palm's index from 0.
    #[must_use]
    pub fn first_contact_loss(&self) -> Option<(usize, usize)> {
        self.samples
            .iter()
            .enumerate()
            .find_map(|(k, s)| s.contacts.iter().position(Option::is_none).map(|palm| (k, palm)))
    }
}

fn check_sample(sample: usize, row: &PlanarSample, largest_force: f64) -> Result<(), PlanarLogError> {
    let pair = |name: [&'static str; 2], values: Option<[f64; 2]>| {
        let values = values.map(|v| v.map(Some)).unwrap_or_default();
        [(name[0], values[0]), (name[1], values[1])]
    };
    let readings = [("t", Some(row.t)), ("s1", row.contacts[0]), ("s2", row.contacts[1])]
        .into_iter()
        .chain(pair(["phi1", "phi2"], Some(row.angles)))
        .chain(pair(["f1", "f2"], row.forces))
        .chain(pair(["tau1", "tau2"], row.torques));
    for (what, reading) in readings {
        match reading.filter(|value| !is_taken(*value)) {
            Some(value) if !value.is_finite() => {
                return Err(PlanarLogError::NotFinite { what, sample, value });
            }
            // A time has limits of its own.
            Some(value) if what != "t" => return Err(PlanarLogError::TooLarge { what, sample, value }),
            _ => {}
        }
    }
    for (i, value) in row.forces.into_iter().flatten().enumerate() {
        if value < -0.1 * largest_force {
            return Err(PlanarLogError::NegativeForce { palm: i + 1, sample, value });
        }
    }
    row.palms().map(|_| ()).map_err(|source| PlanarLogError::Palms { sample, source })
}
