use crate::MassProperties;
use contact_kinematics::{Palm, PalmError, PalmState, PalmTriple, ShapeError, SupportFunction, check_convex};
use glam::DVec3;
use thiserror::Error;

/// A body of known shape and mass on three palms in prescribed motion, under gravity.
///
/// The body's support function is about its centre of mass, in the axes of its inertia tensor.
#[derive(Clone, Debug)]
pub struct ThreePalmScene<S> {
    body: S,
    mass: MassProperties,
    palms: [Palm; 3],
    gravity: f64,
    palm_inertias: Option<[f64; 3]>,
    /// States and normals of palms that never move: computed once.
    immobile: Option<([PalmState; 3], PalmTriple)>,
}

/// Why a scene cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SceneError {
    /// The body is not smooth and convex.
    #[error("body: {0}")]
    Shape(#[source] ShapeError),
    /// The palms cannot hold a body.
    #[error("palms at t = {t} s: {source}")]
    Palms {
        /// Time in s.
        t: f64,
        /// Why.
        source: PalmError,
    },
    /// Gravity is negative or not a number; world Z is up, and gravity is given as a positive magnitude.
    #[error("gravity is {value} m/s^2; it must be finite and not negative (it acts along -Z)")]
    Gravity {
        /// As given, in m/s^2.
        value: f64,
    },
    /// A palm's moment of inertia is negative or not a number.
    #[error("moment of inertia of palm {palm} is {value} kg m^2; it must be finite and not negative")]
    PalmInertia {
        /// Palm number from 1.
        palm: usize,
        /// As given, in kg m^2.
        value: f64,
    },
}

impl<S: SupportFunction> ThreePalmScene<S> {
    /// Checks body, palms and gravity (m/s^2, along -Z).
    ///
    /// # Errors
    /// [`SceneError`].
    pub fn new(body: S, mass: MassProperties, palms: [Palm; 3], gravity: f64) -> Result<Self, SceneError> {
        check_convex(&body).map_err(SceneError::Shape)?;
        if !(gravity >= 0.0 && gravity.is_finite()) {
            return Err(SceneError::Gravity { value: gravity });
        }
        let states = palms.map(|p| p.at(0.0));
        let triple = triple(&states).map_err(|source| SceneError::Palms { t: 0.0, source })?;
        let immobile = palms.iter().all(Palm::is_immobile).then_some((states, triple));
        Ok(Self { body, mass, palms, gravity, palm_inertias: None, immobile })
    }

    /// The same scene with moments of inertia of the palms about their axes (kg m^2), so that logs hold motor torques.
    ///
    /// # Errors
    /// [`SceneError::PalmInertia`].
    pub fn with_palm_inertias(mut self, inertias: [f64; 3]) -> Result<Self, SceneError> {
        if let Some(k) = (0..3).find(|&k| !(inertias[k] >= 0.0 && inertias[k].is_finite())) {
            return Err(SceneError::PalmInertia { palm: k + 1, value: inertias[k] });
        }
        self.palm_inertias = Some(inertias);
        Ok(self)
    }

    /// The body's support function.
    #[must_use]
    pub fn body(&self) -> &S {
        &self.body
    }

    /// Mass and inertia.
    #[must_use]
    pub fn mass(&self) -> &MassProperties {
        &self.mass
    }

    /// The palms.
    #[must_use]
    pub fn palms(&self) -> &[Palm; 3] {
        &self.palms
    }

    /// Acceleration of free fall, world, m/s^2.
    #[must_use]
    pub fn gravity(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, -self.gravity)
    }

    /// Moments of inertia of the palms about their axes, where given.
    #[must_use]
    pub fn palm_inertias(&self) -> Option<[f64; 3]> {
        self.palm_inertias
    }

    /// States of the palms and their normals at time `t`.
    ///
    /// # Errors
    /// [`PalmError::Parallel`] when the palms have turned too close to a common line.
    pub fn palms_at(&self, t: f64) -> Result<([PalmState; 3], PalmTriple), PalmError> {
        if let Some(immobile) = self.immobile {
            return Ok(immobile);
        }
        let states = self.palms.map(|p| p.at(t));
        Ok((states, triple(&states)?))
    }
}

fn triple(states: &[PalmState; 3]) -> Result<PalmTriple, PalmError> {
    PalmTriple::new(states.map(|s| s.frame.n))
}
