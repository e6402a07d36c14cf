use crate::MOST_PALMS;
use crate::modes::{FrictionError, check_friction};
use crate::planar::reaction::PlanarObject;
use contact_kinematics::planar::{PalmSurface, RadiusFunction, SurfaceError, SurfaceMotion};
use thiserror::Error;

/// One palm of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenePalm {
    /// Its shape.
    pub surface: PalmSurface,
    /// How it moves, whatever the object does.
    pub motion: SurfaceMotion,
    /// Coefficient of friction between it and the object.
    pub friction: f64,
}

/// A planar object, the palms around it and gravity.
#[derive(Clone, Debug)]
pub struct ContactScene<S> {
    object: PlanarObject<S>,
    palms: Vec<ScenePalm>,
}

/// Why a scene cannot be used as given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactSceneError {
    /// No palm, or more than can be treated.
    #[error("scene has {found} palms; 1 to {MOST_PALMS} are possible")]
    PalmCount {
        /// How many.
        found: usize,
    },
    /// A palm's surface or motion.
    #[error("palm {palm}: {source}")]
    Surface {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: SurfaceError,
    },
    /// A palm's friction.
    #[error("palm {palm}: {source}")]
    Friction {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: FrictionError,
    },
    /// Gravity is negative or not a number; world Y is up.
    #[error("gravity is {value} m/s^2; it must be finite and not negative (it acts along -Y)")]
    Gravity {
        /// As given, in m/s^2.
        value: f64,
    },
}

impl<S: RadiusFunction> ContactScene<S> {
    /// Checks palms and gravity.
    ///
    /// # Errors
    /// [`ContactSceneError`].
    pub fn new(object: PlanarObject<S>, palms: Vec<ScenePalm>) -> Result<Self, ContactSceneError> {
        if !(object.gravity >= 0.0 && object.gravity.is_finite()) {
            return Err(ContactSceneError::Gravity { value: object.gravity });
        }
        if !(1..=MOST_PALMS).contains(&palms.len()) {
            return Err(ContactSceneError::PalmCount { found: palms.len() });
        }
        let radii = object.shape.radius_bounds();
        for (index, palm) in palms.iter().enumerate() {
            let number = index + 1;
            let surface = palm.surface.check(radii).and(palm.motion.check());
            surface.map_err(|source| ContactSceneError::Surface { palm: number, source })?;
            check_friction(palm.friction)
                .map_err(|source| ContactSceneError::Friction { palm: number, source })?;
        }
        Ok(Self { object, palms })
    }

    /// The object.
    #[must_use]
    pub fn object(&self) -> &PlanarObject<S> {
        &self.object
    }

    /// The palms.
    #[must_use]
    pub fn palms(&self) -> &[ScenePalm] {
        &self.palms
    }
}
