//! Where the body is next to the palms of a scene.

use super::error::PalmContactError;
use super::state::BodyState;
use crate::MOST_PALMS;
use crate::planar::contacts::{ContactScene, TouchingContact};
use crate::planar::mass::PlanarMass;
use contact_kinematics::planar::{ContactError, RadiusFunction, SurfaceContact, SurfaceRates, SurfaceState};
use glam::DVec2;
use std::cell::Cell;
use std::f64::consts::{FRAC_PI_2, PI};

/// A gap below this many units of rounding of the lengths that it is a difference of is zero.
const GAP_ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A scene with the last contact directions, from which the next ones are found.
pub(super) struct Tracker<'a, S> {
    pub(super) scene: &'a ContactScene<S>,
    directions: [Cell<Option<f64>>; MOST_PALMS],
    /// Size of the body, m: half the mean of its extents along two axes.
    pub(super) size: f64,
}

/// A contact with one palm at one instant.
#[derive(Clone, Copy)]
pub(super) struct Touch {
    pub(super) palm: usize,
    pub(super) surface: SurfaceState,
    pub(super) contact: SurfaceContact,
}

impl<'a, S: RadiusFunction> Tracker<'a, S> {
    pub(super) fn new(scene: &'a ContactScene<S>) -> Self {
        let shape = &scene.object().shape;
        let extent = |theta: f64| shape.jet(theta).r + shape.jet(theta + PI).r;
        Self { scene, directions: Default::default(), size: 0.25 * (extent(0.0) + extent(FRAC_PI_2)) }
    }

    /// The contact with palm `palm` (from 0).
    pub(super) fn touch(&self, palm: usize, t: f64, state: &BodyState) -> Result<Touch, PalmContactError> {
        let described = &self.scene.palms()[palm];
        let (surface, guess) = (described.motion.at(t), self.directions[palm].get());
        let shape = &self.scene.object().shape;
        let contact = SurfaceContact::new(shape, &state.place(), described.surface, &surface, guess)
            .map_err(|source| PalmContactError { palm: palm + 1, source })?;
        self.directions[palm].set(Some(contact.theta));
        Ok(Touch { palm, surface, contact })
    }

    /// Gap (m) to palm `palm` and its rate (m/s), for any place of the body.
    pub(super) fn gap(&self, palm: usize, t: f64, state: &BodyState) -> Result<[f64; 2], PalmContactError> {
        match self.touch(palm, t, state) {
            Ok(touch) => Ok([touch.contact.gap, touch.contact.n.dot(touch.slip(state))]),
            // Deep inside only the sign is asked for.
            Err(PalmContactError { source: ContactError::CentreInside { depth }, .. }) => {
                let radius = self.scene.palms()[palm].surface.radius().unwrap_or(0.0);
                Ok([-depth - radius, 0.0])
            }
            Err(error) => Err(error),
        }
    }

    pub(super) fn mass(&self) -> PlanarMass {
        self.scene.object().mass
    }

    pub(super) fn friction(&self, palm: usize) -> f64 {
        self.scene.palms()[palm].friction
    }

    /// Acceleration and angular acceleration without contacts.
    pub(super) fn free_fall(&self) -> (DVec2, f64) {
        (DVec2::new(0.0, -self.scene.object().gravity), 0.0)
    }

    /// Time in which the body falls half its size, s; infinite without gravity.
    pub(super) fn natural_time(&self) -> f64 {
        (self.size / self.scene.object().gravity).sqrt()
    }

    /// Size of the velocities at hand, m/s.
    pub(super) fn speed(&self, state: &BodyState) -> f64 {
        let fall = (self.size * self.scene.object().gravity).sqrt();
        fall + state.v_WCm.length() + state.omega0.abs() * self.size
    }

    /// Rounding of the gap to palm `palm`, m.
    pub(super) fn gap_rounding(&self, palm: usize, t: f64, state: &BodyState) -> f64 {
        let described = &self.scene.palms()[palm];
        let radius = described.surface.radius().unwrap_or(0.0);
        let distance = (state.p_WCm - described.motion.at(t).p_WP).length();
        GAP_ROUNDING * (distance + 2.0 * self.size + radius)
    }
}

impl Touch {
    /// Velocity of the body at the contact against the palm, m/s.
    pub(super) fn slip(&self, state: &BodyState) -> DVec2 {
        self.contact.slip(&self.surface, state.v_WCm, state.omega0)
    }

    pub(super) fn rates(&self, state: &BodyState) -> Result<SurfaceRates, PalmContactError> {
        self.contact
            .rates(&self.surface, state.v_WCm, state.omega0)
            .map_err(|source| PalmContactError { palm: self.palm + 1, source })
    }

    /// The contact with given biases, friction and sense of slip.
    pub(super) fn touching(&self, biases: [f64; 2], mu: f64, sense: f64) -> TouchingContact {
        let SurfaceContact { n, t, b_W, .. } = self.contact;
        TouchingContact { n, t, b_W, biases, mu, sense }
    }
}
