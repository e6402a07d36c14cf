//! What any number of planar palms sensed, in memory.

use super::contacts::ContactScene;
use super::hybrid::{ContactInstant, ContactSimulation};
use super::log::PlanarTruth;
use crate::contact_log::some;
use crate::series::{MOST_READING, check_lengths, check_order, is_taken};
use crate::{ContactMode, MOST_PALMS, SeriesError};
use contact_kinematics::planar::{PalmSurface, RadiusBounds, RadiusFunction, SurfaceError, SurfacePose};
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
    /// Its integral since a time that is one for the whole log, N s, where it was measured: exact through blows, which samples
    /// of the force miss.
    pub impulse: Option<DVec2>,
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
    surfaces: Vec<PalmSurface>,
    samples: Vec<ContactLogSample>,
    truth: Option<Vec<PlanarTruth>>,
}

/// Why samples are not a log of palms.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactLogError {
    /// Too few samples, out of order, or with truth of another length.
    #[error(transparent)]
    Series(#[from] SeriesError),
    /// No palm, or too many.
    #[error("log has {found} palms; 1 to {MOST_PALMS} are possible")]
    PalmCount {
        /// How many.
        found: usize,
    },
    /// A sample has not one reading of each palm.
    #[error("sample {sample} has readings of {found} palms; the log has {expected}")]
    Readings {
        /// Index from 0.
        sample: usize,
        /// Number of palms.
        expected: usize,
        /// How many it has.
        found: usize,
    },
    /// A palm's surface.
    #[error("palm {palm}: {source}")]
    Surface {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: SurfaceError,
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
    /// A reading is larger than any.
    #[error(
        "{what} of sample {sample} is {value:.3e}; {MOST_READING:e} is the most that is taken; check its unit"
    )]
    TooLarge {
        /// Which reading.
        what: &'static str,
        /// Index from 0.
        sample: usize,
        /// As given.
        value: f64,
    },
}

impl ContactLog {
    /// Checks the surfaces of the palms and the samples, and takes them.
    ///
    /// # Errors
    /// [`ContactLogError`] names the first sample that cannot be used.
    pub fn new(
        surfaces: Vec<PalmSurface>,
        samples: Vec<ContactLogSample>,
        truth: Option<Vec<PlanarTruth>>,
    ) -> Result<Self, ContactLogError> {
        check_lengths(samples.len(), truth.as_ref().map(Vec::len))?;
        let expected = surfaces.len();
        if !(1..=MOST_PALMS).contains(&expected) {
            return Err(ContactLogError::PalmCount { found: expected });
        }
        for (index, surface) in surfaces.iter().enumerate() {
            // Whether a cup is wide enough depends on a body that no log knows: any is for a point.
            let checked = surface.check(RadiusBounds { min: 0.0, max: 0.0 });
            checked.map_err(|source| ContactLogError::Surface { palm: index + 1, source })?;
        }
        for (index, sample) in samples.iter().enumerate() {
            let found = sample.palms.len();
            if found != expected {
                return Err(ContactLogError::Readings { sample: index, expected, found });
            }
            check_sample(index, sample)?;
            let previous = index.checked_sub(1).map(|before| samples[before].t);
            check_order(index, previous, sample.t)?;
        }
        Ok(Self { surfaces, samples, truth })
    }

    /// The surfaces of the palms, in the order of the readings.
    #[must_use]
    pub fn surfaces(&self) -> &[PalmSurface] {
        &self.surfaces
    }

    /// The samples, in time order.
    #[must_use]
    pub fn samples(&self) -> &[ContactLogSample] {
        &self.samples
    }

    /// The log with those of its samples, by their numbers in rising order. Impulses are integrals, so that they lose nothing between samples.
    ///
    /// # Errors
    /// Those of a log that is left with less than two samples, or with samples out of order.
    pub fn picked(&self, samples: &[usize]) -> Result<Self, ContactLogError> {
        let truth = self.truth.as_ref().map(|truth| some(truth, samples));
        Self::new(self.surfaces.clone(), some(&self.samples, samples), truth)
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
    /// What the palms of `scene`, which has been simulated, sense, with truth.
    ///
    /// # Errors
    /// [`SeriesError::TooShort`] for a simulation of a single instant, [`ContactLogError::Readings`] for another scene.
    pub fn log<S: RadiusFunction>(&self, scene: &ContactScene<S>) -> Result<ContactLog, ContactLogError> {
        let palm = |at: &ContactInstant, i: usize| PalmSample {
            pose: SurfacePose { p_WP: at.palms[i].p_WP, angle: at.palms[i].angle },
            p_WC: (at.modes[i] != ContactMode::Off).then_some(at.contacts[i].p_WC),
            force: at.forces[i],
            impulse: Some(at.impulses[i]),
        };
        let samples = self.instants.iter().map(|at| {
            let palms = (0..at.palms.len()).map(|i| palm(at, i)).collect();
            ContactLogSample { t: at.t, palms }
        });
        let truth = self.instants.iter().map(|at| at.body.into()).collect();
        let surfaces = scene.palms().iter().map(|palm| palm.surface).collect();
        ContactLog::new(surfaces, samples.collect(), Some(truth))
    }
}

fn check_sample(sample: usize, row: &ContactLogSample) -> Result<(), ContactLogError> {
    let of_palm = |palm: &PalmSample| {
        let SurfacePose { p_WP, angle } = palm.pose;
        let (contact, impulse) = (palm.p_WC.unwrap_or(DVec2::ZERO), palm.impulse.unwrap_or(DVec2::ZERO));
        [
            ("x of a palm", p_WP.x),
            ("y of a palm", p_WP.y),
            ("angle of a palm", angle),
            ("x of a contact", contact.x),
            ("y of a contact", contact.y),
            ("x of a force", palm.force.x),
            ("y of a force", palm.force.y),
            ("x of an impulse", impulse.x),
            ("y of an impulse", impulse.y),
        ]
    };
    let readings = std::iter::once(("t", row.t)).chain(row.palms.iter().flat_map(of_palm));
    // A time has limits of its own.
    let bad = readings
        .into_iter()
        .find(|&(what, value)| if what == "t" { !value.is_finite() } else { !is_taken(value) });
    bad.map_or(Ok(()), |(what, value)| {
        Err(if value.is_finite() {
            ContactLogError::TooLarge { what, sample, value }
        } else {
            ContactLogError::NotFinite { what, sample, value }
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(t: f64, palms: usize) -> ContactLogSample {
        ContactLogSample { t, palms: vec![PalmSample::default(); palms] }
    }

    #[test]
    fn bad_logs_are_named() {
        let lines = |count| vec![PalmSurface::Line; count];
        let new = |samples: Vec<ContactLogSample>| ContactLog::new(lines(1), samples, None).unwrap_err();
        assert!(matches!(new(vec![sample(0.0, 1)]), ContactLogError::Series(SeriesError::TooShort { .. })));
        assert!(matches!(
            new(vec![sample(0.1, 1), sample(0.1, 1)]),
            ContactLogError::Series(SeriesError::TimeNotIncreasing { sample: 1, .. })
        ));
        let mut strong = sample(0.1, 1);
        strong.palms[0].force.y = -1e10;
        let told = new(vec![sample(0.0, 1), strong]);
        assert_eq!(told, ContactLogError::TooLarge { what: "y of a force", sample: 1, value: -1e10 });
        let readings = ContactLogError::Readings { sample: 1, expected: 1, found: 2 };
        assert_eq!(new(vec![sample(0.0, 1), sample(0.1, 2)]), readings);
        for found in [0, 6] {
            let samples = vec![sample(0.0, found), sample(0.1, found)];
            let error = ContactLog::new(lines(found), samples, None).unwrap_err();
            assert_eq!(error, ContactLogError::PalmCount { found });
        }
        let flat = vec![PalmSurface::Line, PalmSurface::Arc { radius: 0.0 }];
        let error = ContactLog::new(flat, vec![sample(0.0, 2), sample(0.1, 2)], None).unwrap_err();
        let source = SurfaceError::Radius { radius: 0.0 };
        assert_eq!(error, ContactLogError::Surface { palm: 2, source });
        let mut lost = sample(0.1, 1);
        lost.palms[0].p_WC = Some(DVec2::new(0.0, f64::NAN));
        assert!(matches!(
            new(vec![sample(0.0, 1), lost]),
            ContactLogError::NotFinite { what: "y of a contact", sample: 1, .. }
        ));
        let truth = Some(vec![PlanarTruth::default()]);
        assert!(matches!(
            ContactLog::new(lines(1), vec![sample(0.0, 1), sample(0.1, 1)], truth),
            Err(ContactLogError::Series(SeriesError::TruthLength { expected: 2, found: 1 }))
        ));
    }
}
