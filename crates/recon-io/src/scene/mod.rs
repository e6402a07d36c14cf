//! Scene files: what is known beside a sensor log, and what a simulation starts from.

mod build;
mod error;
mod file;
mod outline;
mod palms;
mod planar;
mod possible;
mod shape;
mod surface;

#[cfg(test)]
mod tests;

#[cfg(feature = "mcap")]
pub(crate) use error::in_words;
pub use error::{SceneError, SceneErrorKind};
pub use outline::{AnyOutline, OutlineScene};
pub use palms::{BoxedShape, KnownPalm};
pub use planar::{PlanarBody, PlanarKnown, PlanarScene};
pub use surface::SurfaceScene;

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{CurvatureRadii, Palm};
use recon::object_dynamics::{MassError, MassProperties};
use std::path::Path;

/// What is known of a scene. Everything but gravity may be unknown.
///
/// As a TOML file, in SI units (angles of palms in degrees where the key says so):
/// ```
/// # fn main() -> Result<(), recon_io::SceneErrorKind> {
/// let scene = recon_io::Scene::parse(r#"
/// gravity = 9.81                            # m/s^2, along -Z
///
/// [object]                                  # what is known of the object; all optional
/// mass = 1.0
/// principal_moments = [1.0, 1.45, 2.05]     # or `inertia`, a 3 x 3 tensor in body axes, or `radii_of_gyration`
/// curvature_radii = [0.4, 6.25]             # bounds on the principal radii of curvature
/// size = 1.8                                # mean radius, about: where all contacts are on one palm, nothing else tells it
///
/// [sensors]                                 # all optional; `recon simulate` puts this noise on its logs
/// contact_std = 1e-3                        # standard deviation of s1 and s2
/// force_std = 0.05                          # standard deviation of f
/// sample_rate = 1000.0
///
/// [palms]                                   # all optional
/// inertia = [0.1, 0.1, 0.1]                 # of each palm about its axis: with it, logs hold motor torques
/// friction = 0.0
///
/// [simulation]                              # only for `recon simulate`, and as the truth to compare with
/// duration = 4.2
/// sample_rate = 1000.0                      # else that of the sensors, else 1000
/// orientation = [1.0, 0.0, 0.0, 0.0]        # w first, body to world; the palms determine the position
/// angular_velocity = [0.0, 0.3, 0.3]        # world axes
/// seed = 1                                  # of the sensor noise
/// ## kind: sphere (radius), ellipsoid (semi_axes), ellipsoid-plus-ball (semi_axes, radius), polytope (corners, radius of
/// ## the rounding, sharpness of the sides), or polynomial (terms, each with a coefficient in m and the powers of n_x,
/// ## n_y, n_z); offset: of the shape from the centre of mass.
/// shape = { kind = "ellipsoid", semi_axes = [2.5, 2.0, 1.0], offset = [0.0, 0.0, 0.0] }
/// ## azimuth: the horizontal direction in which a palm rises; slope: against the horizontal. In rad without `_deg`.
/// palms = [
///   { azimuth_deg = 270.0, slope_deg = 60.0 },
///   { azimuth_deg = 30.0, slope_deg = 60.0, rate = 0.01 },
///   { azimuth_deg = 150.0, slope_deg = 60.0, sinusoid = { amplitude = 0.05, frequency = 3.0, phase = 0.0 } },
/// ]
/// "#)?;
/// assert!(scene.simulation.is_some());
/// # Ok(())
/// # }
/// ```
/// Palms of any number, shape, pose and motion stand in `[[palm]]` tables ([`KnownPalm`]) in place of `simulation.palms`.
/// They do not determine where the object is: `[simulation]` then has `position` and may have `velocity` (world axes) and
/// `in_flight = true` for an object that touches nothing yet. `[sensors]` may then have `force_share`, `impulse_std`, `impulse_share` and
/// `torque_std`, `contact_off_palm`, the largest distance of a contact point from its palm that a log may have, and
/// `contact_speed_std`, by which a contact's speed is off beside noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// Gravitational acceleration `g` in m/s^2, at least zero; gravity is `(0, 0, -g)`.
    pub gravity: f64,
    /// Mass of the object in kg.
    pub mass: Option<f64>,
    /// Its rotational inertia.
    pub inertia: Option<KnownInertia>,
    /// Bounds on its principal radii of curvature, in m.
    pub curvature: Option<CurvatureRadii>,
    /// Its mean radius, in m.
    pub size: Option<f64>,
    /// The sensors.
    pub sensors: Sensors,
    /// Moments of inertia of the palms about their axes, in kg m^2.
    pub palm_inertia: Option<[f64; 3]>,
    /// Coefficient of friction between object and palms.
    pub friction: Option<f64>,
    /// Palms of any shape, pose and motion; none where the scene has three flat ones through the origin.
    pub palms: Option<Vec<KnownPalm>>,
    /// What a simulation starts from.
    pub simulation: Option<Simulation>,
}

/// The way in which the rotational inertia about the centre of mass is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum KnownInertia {
    /// Tensor in body axes, kg m^2.
    Tensor(DMat3),
    /// Principal moments along the body axes, kg m^2.
    PrincipalMoments(DVec3),
    /// Radii of gyration about the body axes, m: inertia per mass, which needs no mass.
    RadiiOfGyration(DVec3),
}

/// Noise and rate of the sensors, where known.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sensors {
    /// Standard deviation of `s1` and `s2`, in m.
    pub contact_std: Option<f64>,
    /// Standard deviation of `f`, or of each axis of a force, in N.
    pub force_std: Option<f64>,
    /// What it grows by with the force, as a share of it.
    pub force_share: Option<f64>,
    /// Standard deviation of each axis of an impulse over one interval, in N s.
    pub impulse_std: Option<f64>,
    /// What it grows by with the impulse, as a share of it.
    pub impulse_share: Option<f64>,
    /// Standard deviation of a motor's torque, in N m.
    pub torque_std: Option<f64>,
    /// Largest distance of a contact point from its palm that is taken for noise, in m.
    pub contact_off_palm: Option<f64>,
    /// Standard deviation of what the condition of a contact (it neither parts nor sinks in, nor slips where it sticks) is off by
    /// beside noise, in m/s: palms whose velocity is known no better, creep.
    pub contact_speed_std: Option<f64>,
    /// Samples per second.
    pub sample_rate: Option<f64>,
}

/// What a simulation starts from and how long it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Shape of the object, about its centre of mass.
    pub shape: Shape,
    /// Displacement of the shape's own origin from the centre of mass, body axes, in m.
    pub offset: DVec3,
    /// Three palms through the origin; none where the scene has palms of any shape.
    pub palms: Option<[Palm; 3]>,
    /// Initial centre of mass, in m, world, where the palms do not determine it.
    pub p_WCm: Option<DVec3>,
    /// Initial orientation, body to world.
    pub R_WO: DQuat,
    /// Initial velocity of the centre of mass in m/s, world, where the palms do not determine it.
    pub v_WCm: DVec3,
    /// Initial angular velocity in rad/s, world axes.
    pub w_WO: DVec3,
    /// Whether the object may start without touching a palm.
    pub in_flight: bool,
    /// Length in s.
    pub duration: f64,
    /// Samples per second of the log.
    pub sample_rate: f64,
    /// Seed of the sensor noise.
    pub seed: u64,
}

/// A closed-form smooth convex shape about its own origin, body axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// Ball.
    Sphere {
        /// Radius in m.
        radius: f64,
    },
    /// Ellipsoid along the body axes.
    Ellipsoid {
        /// Semi-axes in m.
        semi_axes: DVec3,
    },
    /// Minkowski sum of an ellipsoid and a ball.
    EllipsoidPlusBall {
        /// Semi-axes of the ellipsoid in m.
        semi_axes: DVec3,
        /// Radius of the ball in m.
        radius: f64,
    },
    /// Polytope with rounded edges and slightly bulging sides: [`recon::contact_kinematics::RoundedPolytope`].
    Polytope {
        /// Corners without the rounding, m.
        corners: Vec<DVec3>,
        /// Radius of the rounding, m.
        radius: f64,
        /// The power by which sides bulge: a contact crosses one while the normal turns by about its inverse, rad.
        sharpness: f64,
    },
    /// Support function `sum c n_x^i n_y^j n_z^k` on unit normals.
    Polynomial {
        /// Terms `(c in m, [i, j, k])`.
        terms: Vec<(f64, [u8; 3])>,
    },
}

impl Scene {
    /// Reads a scene file.
    ///
    /// # Errors
    /// [`SceneError`] names the file and the key.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        SceneError::in_file(path, |text| Self::in_folder(text, folder))
    }

    /// Reads a scene from TOML text. Files that it names are looked for in the present folder.
    ///
    /// # Errors
    /// [`SceneErrorKind`] names the key.
    pub fn parse(text: &str) -> Result<Self, SceneErrorKind> {
        Self::in_folder(text, Path::new(""))
    }

    fn in_folder(text: &str, folder: &Path) -> Result<Self, SceneErrorKind> {
        // Before the numbers are looked at, of which the plane has two where space has three.
        if toml::from_str::<planar::Whether>(text)?.plane {
            return Err(SceneErrorKind::InPlane);
        }
        let file = toml::from_str(text).map_err(|error| {
            match PlanarScene::parse_known(&format!("plane = true\n{text}")) {
                Ok(_) => SceneErrorKind::PlaneNotSaid(error),
                Err(_) => SceneErrorKind::Toml(error),
            }
        })?;
        build::scene(file, folder)
    }

    /// Mass and inertia, where both are known.
    ///
    /// # Errors
    /// Those of [`MassProperties::new`]; a scene that was read from a file has none.
    pub fn mass_properties(&self) -> Result<Option<MassProperties>, MassError> {
        match (self.mass, self.inertia) {
            (Some(mass), Some(inertia)) => inertia.with_mass(mass).map(Some),
            _ => Ok(None),
        }
    }
}

impl KnownInertia {
    /// Mass properties of a body of this inertia and the given mass in kg.
    ///
    /// # Errors
    /// Those of [`MassProperties::new`].
    pub fn with_mass(self, mass: f64) -> Result<MassProperties, MassError> {
        match self {
            Self::Tensor(tensor) => MassProperties::new(mass, tensor),
            Self::PrincipalMoments(moments) => MassProperties::from_principal(mass, moments),
            Self::RadiiOfGyration(radii) => MassProperties::from_gyration(mass, radii),
        }
    }
}
