//! One instant for given modes: the equations of motion without a simulation.

use super::field::Stretch;
use super::packed::{Tallies, Units};
use super::result::ContactInstant;
use crate::ContactMode;
use crate::contacts::{ContactScene, MOST_PALMS, ModeError, PalmContactError, SceneState};
use contact_kinematics::{Direction, SupportFunction};
use glam::DVec3;
use thiserror::Error;

/// Why an instant has no forces.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactInstantError {
    /// As many modes as palms are needed.
    #[error("{found} modes for {expected} palms")]
    ModeCount {
        /// Number of palms.
        expected: usize,
        /// Number of modes.
        found: usize,
    },
    /// A contact could not be found.
    #[error(transparent)]
    Contact(#[from] PalmContactError),
    /// The modes contradict each other or the friction is critical.
    #[error(transparent)]
    Modes(#[from] ModeError),
}

impl<S: SupportFunction> ContactScene<S> {
    /// Contacts, forces and accelerations of a state whose contacts have the given modes, whether those are consistent or
    /// not: a force that pulls or leaves its cone is returned as it comes out.
    ///
    /// # Errors
    /// [`ContactInstantError`].
    pub fn instant(
        &self,
        state: &SceneState,
        modes: &[ContactMode],
    ) -> Result<ContactInstant, ContactInstantError> {
        let (stretch, units) = self.stretch(modes)?;
        let now = stretch.evaluate(self, &units, (*state, Tallies::default()))?;
        Ok(now.into_instant(modes, 0.0).ok_or(ModeError::Inconsistent)?)
    }

    /// The smallest principal minor of the sliding contacts' matrix in a state with the given modes, dimensionless: above zero
    /// (a P-matrix) motion exists and is one. Infinite where nothing slides with friction.
    ///
    /// # Errors
    /// [`ContactInstantError`].
    pub fn wedging(&self, state: &SceneState, modes: &[ContactMode]) -> Result<f64, ContactInstantError> {
        let (stretch, units) = self.stretch(modes)?;
        let now = stretch.evaluate(self, &units, (*state, Tallies::default()))?;
        Ok(now.problem.smallest_sliding_minor(&stretch.modes, &now.directions))
    }

    fn stretch(&self, modes: &[ContactMode]) -> Result<(Stretch, Units), ContactInstantError> {
        let expected = self.palms().len();
        if modes.len() != expected {
            return Err(ContactInstantError::ModeCount { expected, found: modes.len() });
        }
        let mut all = [ContactMode::Off; MOST_PALMS];
        all[..expected].copy_from_slice(modes);
        let none = [None::<Direction>; MOST_PALMS];
        let stretch = Stretch {
            modes: all,
            towards: [DVec3::ZERO; MOST_PALMS],
            starting: [false; MOST_PALMS],
            guesses: none,
        };
        Ok((stretch, Units::new(self.size(), self.mass().mass(), -self.gravity().z)))
    }
}
