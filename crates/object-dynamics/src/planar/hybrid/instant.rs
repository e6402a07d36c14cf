//! One instant for given modes: the equations of motion without a simulation.

use super::error::FieldError;
use super::phase::Phase;
use super::result::ContactInstant;
use super::state::{BodyState, FRICTION_WORK, LENGTH, PALM_WORK, TIME, Vector, impulse};
use super::tracker::Tracker;
use crate::ContactMode;
use crate::planar::contacts::{ContactScene, PlanarMode};
use contact_kinematics::planar::RadiusFunction;
use glam::DVec2;
use thiserror::Error;

/// Why an instant has no forces.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
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
    /// A contact, or a jam.
    #[error(transparent)]
    Field(#[from] FieldError),
}

impl<S: RadiusFunction> ContactScene<S> {
    /// Contacts, forces and accelerations at time `t` (s) of a body whose contacts have the given modes, whether
    /// those are consistent or not: a force that pulls or leaves its cone is returned as it comes out. Friction acts
    /// against the slip, and not at all where there is none to slide.
    ///
    /// # Errors
    /// [`ContactInstantError`].
    pub fn instant(
        &self,
        t: f64,
        body: &BodyState,
        modes: &[ContactMode],
    ) -> Result<ContactInstant, ContactInstantError> {
        let tracker = Tracker::new(self);
        let mut y = [0.0; LENGTH];
        body.write(&mut y);
        y[TIME] = t;
        let phase = sliding_phase(&tracker, t, body, modes)?;
        Ok(phase.instant(&y, 0.0)?)
    }

    /// The smallest principal minor of the sliding contacts' matrix of a body with the given modes, dimensionless:
    /// above zero (a P-matrix) motion exists and is one. Infinite where nothing slides, or the forces are not unique.
    ///
    /// # Errors
    /// [`ContactInstantError`].
    pub fn wedging(
        &self,
        t: f64,
        body: &BodyState,
        modes: &[ContactMode],
    ) -> Result<f64, ContactInstantError> {
        let tracker = Tracker::new(self);
        let reading = sliding_phase(&tracker, t, body, modes)?.reading(t, body)?;
        Ok(reading.smallest_minor())
    }
}

/// The modes with the senses of the slips that there are.
fn sliding_phase<'a, S: RadiusFunction>(
    tracker: &'a Tracker<'a, S>,
    t: f64,
    body: &BodyState,
    modes: &[ContactMode],
) -> Result<Phase<'a, S>, ContactInstantError> {
    let expected = tracker.scene.palms().len();
    if modes.len() != expected {
        return Err(ContactInstantError::ModeCount { expected, found: modes.len() });
    }
    let with_sense = |(palm, mode): (usize, &ContactMode)| match mode {
        ContactMode::Off => Ok(PlanarMode::Off),
        ContactMode::Stick => Ok(PlanarMode::Stick),
        ContactMode::Slide => {
            let touch = tracker.touch(palm, t, body).map_err(FieldError::from)?;
            let slip = touch.contact.t.dot(touch.slip(body));
            let rubs = slip != 0.0 && tracker.friction(palm) > 0.0;
            Ok(PlanarMode::Slide { sense: if rubs { slip.signum() } else { 0.0 } })
        }
    };
    let modes: Result<Vec<_>, ContactInstantError> = modes.iter().enumerate().map(with_sense).collect();
    Ok(Phase { tracker, modes: modes? })
}

impl<S: RadiusFunction> Phase<'_, S> {
    /// What is told of the state in `y`.
    pub(super) fn instant(&self, y: &Vector, blow_work: f64) -> Result<ContactInstant, FieldError> {
        let (t, body, count) = (y[TIME], BodyState::of(y), self.modes.len());
        let reading = self.reading(t, &body)?;
        let mut forces = vec![DVec2::ZERO; count];
        for ((touch, _), force) in reading.touches.iter().zip(reading.forces()) {
            forces[touch.palm] = force;
        }
        let (mut palms, mut contacts) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for palm in 0..count {
            let touch = self.tracker.touch(palm, t, &body)?;
            palms.push(touch.surface);
            contacts.push(touch.contact);
        }
        Ok(ContactInstant {
            t,
            body,
            modes: self.modes.iter().map(|mode| mode.mode()).collect(),
            palms,
            contacts,
            forces,
            impulses: (0..count).map(|palm| impulse(y, palm)).collect(),
            a_WCm: reading.response.a_WCm,
            alpha0: reading.response.alpha0,
            friction_work: y[FRICTION_WORK],
            palm_work: y[PALM_WORK],
            blow_work,
        })
    }
}
