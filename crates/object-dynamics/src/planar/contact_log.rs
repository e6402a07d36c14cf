//! What any number of planar palms sensed, in memory.

use super::hybrid::{ContactInstant, ContactSimulation};
use super::log::PlanarTruth;
use crate::series::{check_lengths, check_order};
use crate::{ContactMode, MOST_PALMS, SeriesError};
use contact_kinematics::planar::SurfacePose;
use glam::DVec2;
use thiserror::Error;

/// What one palm knew at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PalmSample {
    /// Where the palm's frame stands. It turns with the palm's material, also where its shape does not change.
    pub pose: SurfacePose,
    /// Contact point, world, m; none while nothing touches.
    pub p_WC: Option<DVec2>,
    /// Force of the palm on the object, world, N.
    pub force: DVec2,
}

/// One instant of a [`ContactLog`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactLogSample {
    /// Time in s.
    pub t: f64,
    /// The palms, always in the same order.
    pub palms: Vec<PalmSample>,
}

/// A log of planar palms: at least two samples in strictly increasing time.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactLog {
    samples: Vec<ContactLogSample>,
    truth: Option<Vec<PlanarTruth>>,
}

/// Why samples are not a log of palms.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ContactLogError {
    /// Too few samples, out of order, or with truth of another length.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// No palm, too many, or not as many as in the first sample.
    #[error("sample {sample} has {found} palms; all samples have the same number, from 1 to {MOST_PALMS}")]
    PalmCount {
        /// Index from 0.
        sample: usize,
        /// How many it has.
        found: usize,
    },
    /// A reading is not a number.
    #[error("{what} of sample {sample} is {value}; it must be finite")]
    NotFinite {
        /// Which reading.
        what: &'static str,
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
}

impl ContactLog {
    /// Checks the samples and takes them.
    ///
    /// # Errors
    /// [`ContactLogError`] names the first sample that cannot be used.
    pub fn new(
        samples: Vec<ContactLogSample>,
        truth: Option<Vec<PlanarTruth>>,
    ) -> Result<Self, ContactLogError> {
        check_lengths(samples.len(), truth.as_ref().map(Vec::len))?;
        let count = samples[0].palms.len();
        for (index, sample) in samples.iter().enumerate() {
            let found = sample.palms.len();
            if found != count || !(1..=MOST_PALMS).contains(&found) {
                return Err(ContactLogError::PalmCount { sample: index, found });
            }
            check_sample(index, sample)?;
            let previous = index.checked_sub(1).map(|before| samples[before].t);
            check_order(index, previous, sample.t)?;
        }
        Ok(Self { samples, truth })
    }

    /// The samples, in time order.
    #[must_use]
    pub fn samples(&self) -> &[ContactLogSample] {
        &self.samples
    }

    /// For noise, which keeps what [`Self::new`] has checked: finite numbers and times.
    #[cfg(feature = "noise")]
    pub(super) fn samples_mut(&mut self) -> &mut [ContactLogSample] {
        &mut self.samples
    }

    /// The true states, one a sample, where they are known.
    #[must_use]
    pub fn truth(&self) -> Option<&[PlanarTruth]> {
        self.truth.as_deref()
    }
}

impl ContactSimulation {
    /// What its palms sense, with truth.
    ///
    /// # Errors
    /// [`SeriesError::TooShort`] for a simulation of a single instant.
    pub fn log(&self) -> Result<ContactLog, ContactLogError> {
        let palm = |at: &ContactInstant, i: usize| PalmSample {
            pose: SurfacePose { p_WP: at.palms[i].p_WP, angle: at.palms[i].angle },
            p_WC: (at.modes[i] != ContactMode::Off).then_some(at.contacts[i].p_WC),
            force: at.forces[i],
        };
        let samples = self.instants.iter().map(|at| {
            let palms = (0..at.palms.len()).map(|i| palm(at, i)).collect();
            ContactLogSample { t: at.t, palms }
        });
        let truth = self.instants.iter().map(|at| at.body.into()).collect();
        ContactLog::new(samples.collect(), Some(truth))
    }
}

fn check_sample(sample: usize, row: &ContactLogSample) -> Result<(), ContactLogError> {
    let of_palm = |palm: &PalmSample| {
        let SurfacePose { p_WP, angle } = palm.pose;
        let contact = palm.p_WC.unwrap_or(DVec2::ZERO);
        [
            ("x of a palm", p_WP.x),
            ("y of a palm", p_WP.y),
            ("angle of a palm", angle),
            ("x of a contact", contact.x),
            ("y of a contact", contact.y),
            ("x of a force", palm.force.x),
            ("y of a force", palm.force.y),
        ]
    };
    let readings = std::iter::once(("t", row.t)).chain(row.palms.iter().flat_map(of_palm));
    let bad = readings.into_iter().find(|(_, value)| !value.is_finite());
    bad.map_or(Ok(()), |(what, value)| Err(ContactLogError::NotFinite { what, sample, value }))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(t: f64, palms: usize) -> ContactLogSample {
        ContactLogSample { t, palms: vec![PalmSample::default(); palms] }
    }

    #[test]
    fn bad_logs_are_named() {
        let new = |samples: Vec<ContactLogSample>| ContactLog::new(samples, None).unwrap_err();
        assert!(matches!(new(vec![sample(0.0, 1)]), ContactLogError::Series(SeriesError::TooShort { .. })));
        assert!(matches!(
            new(vec![sample(0.1, 1), sample(0.1, 1)]),
            ContactLogError::Series(SeriesError::TimeNotIncreasing { sample: 1, .. })
        ));
        let count = |sample, found| ContactLogError::PalmCount { sample, found };
        assert_eq!(new(vec![sample(0.0, 2), sample(0.1, 1)]), count(1, 1));
        assert_eq!(new(vec![sample(0.0, 6), sample(0.1, 6)]), count(0, 6));
        assert_eq!(new(vec![sample(0.0, 0), sample(0.1, 0)]), count(0, 0));
        let mut lost = sample(0.1, 1);
        lost.palms[0].p_WC = Some(DVec2::new(0.0, f64::NAN));
        assert!(matches!(
            new(vec![sample(0.0, 1), lost]),
            ContactLogError::NotFinite { what: "y of a contact", sample: 1, .. }
        ));
        let truth = Some(vec![PlanarTruth::default()]);
        assert!(matches!(
            ContactLog::new(vec![sample(0.0, 1), sample(0.1, 1)], truth),
            Err(ContactLogError::Series(SeriesError::TruthLength { expected: 2, found: 1 }))
        ));
    }
}
