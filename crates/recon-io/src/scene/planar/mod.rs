//! Scenes in the vertical plane: a smooth convex object on palms of any number, shape and motion, with friction.

mod build;
mod file;

#[cfg(test)]
mod tests;

pub(super) use file::Whether;

use super::{SceneError, SceneErrorKind, Sensors};
use recon::contact_kinematics::planar::{
    Circle, Ellipse, FourierBody, PalmSurface, RadiusBounds, RadiusFunction, RadiusJet, RoundedPolygon,
};
use recon::object_dynamics::planar::{BodyState, ContactNoise, ContactScene, PlanarMass};
use recon::object_dynamics::{ChannelNoise, SampleTimes};
use std::path::Path;

/// A scene in the plane, checked: x to the right, y up, angles counter-clockwise.
///
/// ```
/// # fn main() -> Result<(), recon_io::SceneErrorKind> {
/// let scene = recon_io::PlanarScene::parse(r#"
/// plane = true
/// gravity = 9.81                            # along -y
///
/// [object]
/// mass = 0.2
/// inertia = 1e-4                            # kg m^2, about the centre of mass; or radius_of_gyration, m
///
/// [palms]
/// friction = 0.3                            # of palms that do not say their own
///
/// [[palm]]
/// kind = "line"                             # the line y = 0 of its frame, object at y > 0; or arc (outside of it), cup (inside)
/// pose = { position = [0.0, 0.0], angle_deg = 10.0 }
/// ## How it moves, part after part: along a direction, or about a pivot; laws as in scenes of space.
/// motion = [{ pivot = [0.0, 0.0], law = { kind = "sinusoid", amplitude = 0.05, frequency = 6.0 } }]
///
/// [[palm]]
/// kind = "arc"
/// radius = 0.012
/// friction = 0.8
/// pose = { position = [0.0, 0.2] }
/// motion = [{ shift = [0.0, -1.0], law = { kind = "ramp", height = 0.02, start = 0.2, duration = 0.5 } }]
///
/// [simulation]
/// duration = 1.0
/// sample_rate = 1000.0
/// position = [0.0, 0.05]
/// touches = [1]                             # palms on which the object is laid, by the least move; [] for one that flies
/// shape = { kind = "ellipse", semi_axes = [0.05, 0.04] }    # or circle, fourier, polygon
/// "#)?;
/// assert_eq!(scene.world.palms().len(), 2);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct PlanarScene {
    /// Object, palms and gravity.
    pub world: ContactScene<PlanarBody>,
    /// The sensors.
    pub sensors: Sensors,
    /// Where the object starts, but for the move that lays it on palms.
    pub start: BodyState,
    /// Palms (from 0) on which it is laid.
    pub touches: Vec<usize>,
    /// When samples are taken.
    pub times: SampleTimes,
    /// Seed of the sensor noise.
    pub seed: u64,
}

/// What a scene of the plane tells an estimate: whoever has a log needs no `[simulation]`, and no pose of a palm.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanarKnown {
    /// Gravity, m/s^2, along -y.
    pub gravity: f64,
    /// Mass and moment of inertia, where they are stated.
    pub mass: Option<PlanarMass>,
    /// Mean radius, about, m, where it is stated.
    pub size: Option<f64>,
    /// Shape of each palm, and its coefficient of friction where it is stated.
    pub palms: Vec<(PalmSurface, Option<f64>)>,
    /// The sensors.
    pub sensors: Sensors,
}

/// An outline of a kind that is known when the program runs.
#[derive(Clone, Debug, PartialEq)]
pub enum PlanarBody {
    /// Disc.
    Circle(Circle),
    /// Ellipse along the body axes.
    Ellipse(Ellipse),
    /// By the Fourier series of its radius function.
    Fourier(FourierBody),
    /// Polygon with rounded corners and bulging edges.
    Polygon(RoundedPolygon),
}

impl RadiusFunction for PlanarBody {
    fn jet(&self, theta: f64) -> RadiusJet {
        match self {
            Self::Circle(body) => body.jet(theta),
            Self::Ellipse(body) => body.jet(theta),
            Self::Fourier(body) => body.jet(theta),
            Self::Polygon(body) => body.jet(theta),
        }
    }

    fn radius_bounds(&self) -> RadiusBounds {
        match self {
            Self::Circle(body) => body.radius_bounds(),
            Self::Ellipse(body) => body.radius_bounds(),
            Self::Fourier(body) => body.radius_bounds(),
            Self::Polygon(body) => body.radius_bounds(),
        }
    }
}

impl PlanarScene {
    /// Reads a scene file of the plane.
    ///
    /// # Errors
    /// [`SceneError`] names the file and the key.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        SceneError::in_file(path.as_ref(), Self::parse)
    }

    /// Reads a scene of the plane from TOML text.
    ///
    /// # Errors
    /// [`SceneErrorKind`] names the key.
    pub fn parse(text: &str) -> Result<Self, SceneErrorKind> {
        build::scene(toml::from_str(text)?)
    }

    /// Reads what a scene file of the plane tells an estimate.
    ///
    /// # Errors
    /// [`SceneError`] names the file and the key.
    pub fn read_known(path: impl AsRef<Path>) -> Result<PlanarKnown, SceneError> {
        SceneError::in_file(path.as_ref(), Self::parse_known)
    }

    /// The same from TOML text.
    ///
    /// # Errors
    /// [`SceneErrorKind`] names the key.
    pub fn parse_known(text: &str) -> Result<PlanarKnown, SceneErrorKind> {
        build::known(&toml::from_str(text)?)
    }

    /// Noise on every channel of its log; zero where the scene says nothing.
    #[must_use]
    pub fn noise(&self) -> ContactNoise {
        let or_none = |value: Option<f64>| value.unwrap_or(0.0);
        let Sensors { contact_std, force_std, force_share, impulse_std, impulse_share, .. } = self.sensors;
        ContactNoise {
            contact: or_none(contact_std),
            force: ChannelNoise { fixed: or_none(force_std), share: or_none(force_share) },
            impulse: ChannelNoise { fixed: or_none(impulse_std), share: or_none(impulse_share) },
        }
    }
}
