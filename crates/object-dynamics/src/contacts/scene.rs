use super::{DriveError, PalmDrive};
use crate::MassProperties;
use crate::modes::{FrictionError, check_friction};
use contact_kinematics::{PalmSurface, ShapeError, SupportFunction, SurfaceError, check_convex};
use glam::DVec3;
use thiserror::Error;

/// Most palms of a scene: the fingers of a hand. Mode sets are enumerated, 3^5 = 243 of them.
pub const MOST_PALMS: usize = 5;

/// One palm of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenePalm {
    /// Its shape.
    pub surface: PalmSurface,
    /// What moves it.
    pub drive: PalmDrive,
    /// Coefficient of friction between it and the object.
    pub friction: f64,
}

/// A smooth convex body, palms and gravity.
///
/// `S` is the body's support function about its centre of mass.
#[derive(Clone, Debug)]
pub struct ContactScene<S> {
    body: S,
    mass: MassProperties,
    palms: Vec<ScenePalm>,
    gravity: f64,
}

/// Why a scene cannot be used as given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactSceneError {
    /// The body is not smooth and strictly convex.
    #[error(transparent)]
    Shape(ShapeError),
    /// No palm, or more than can be treated.
    #[error("scene has {found} palms; 1 to {MOST_PALMS} are possible")]
    PalmCount {
        /// How many.
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
    /// A palm's drive.
    #[error("palm {palm}: {source}")]
    Drive {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: DriveError,
    },
    /// A palm's friction.
    #[error("palm {palm}: {source}")]
    Friction {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: FrictionError,
    },
    /// Gravity is negative or not a number; world Z is up.
    #[error("gravity is {value} m/s^2; it must be finite and not negative (it acts along -Z)")]
    Gravity {
        /// As given, in m/s^2.
        value: f64,
    },
}

impl<S: SupportFunction> ContactScene<S> {
    /// Checks body, palms and gravity (m/s^2, along -Z).
    ///
    /// # Errors
    /// [`ContactSceneError`].
    pub fn new(
        body: S,
        mass: MassProperties,
        palms: Vec<ScenePalm>,
        gravity: f64,
    ) -> Result<Self, ContactSceneError> {
        let radii = check_convex(&body).map_err(ContactSceneError::Shape)?;
        if !(gravity >= 0.0 && gravity.is_finite()) {
            return Err(ContactSceneError::Gravity { value: gravity });
        }
        if !(1..=MOST_PALMS).contains(&palms.len()) {
            return Err(ContactSceneError::PalmCount { found: palms.len() });
        }
        for (index, palm) in palms.iter().enumerate() {
            let number = index + 1;
            palm.surface
                .check(radii)
                .map_err(|source| ContactSceneError::Surface { palm: number, source })?;
            palm.drive.check().map_err(|source| ContactSceneError::Drive { palm: number, source })?;
            check_friction(palm.friction)
                .map_err(|source| ContactSceneError::Friction { palm: number, source })?;
        }
        Ok(Self { body, mass, palms, gravity })
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
    pub fn palms(&self) -> &[ScenePalm] {
        &self.palms
    }

    /// Acceleration of free fall, world, m/s^2.
    #[must_use]
    pub fn gravity(&self) -> DVec3 {
        DVec3::new(0.0, 0.0, -self.gravity)
    }
}
