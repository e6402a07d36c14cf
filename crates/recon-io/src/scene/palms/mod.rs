//! Palms of any shape, pose, motion and friction in a scene file.

mod build;
mod drive;
mod file;

#[cfg(test)]
mod tests;

pub(super) use build::palms;
pub(super) use drive::law;
pub(super) use file::{LawTable, PalmTable};

use super::{Scene, SceneErrorKind as Kind, Sensors};
use crate::PalmSetup;
use recon::contact_kinematics::{PalmSurface, SupportFunction};
use recon::object_dynamics::{
    BodyState, ChannelNoise, ContactNoise, ContactScene, ContactStart, PalmDrive, PalmHinge, SampleTimes,
    ScenePalm,
};

/// A closed-form shape whose kind is known when the program runs.
pub type BoxedShape = Box<dyn SupportFunction + Send + Sync>;

/// What is known of a palm of any shape.
///
/// In the scene file, one table for each palm, in the order of the log's columns:
/// ```
/// # fn main() -> Result<(), recon_io::SceneErrorKind> {
/// let scene = recon_io::Scene::parse(r#"
/// gravity = 9.81
///
/// [[palm]]
/// kind = "flat"                             # the plane z = 0 of its frame, object at z > 0; or sphere, cup, cylinder
/// friction = 0.3                            # else `palms.friction`; simulations need it, logs do not
/// pose = { position = [0.0, 0.0, 0.0], orientation = [1.0, 0.0, 0.0, 0.0] }  # w first; logs may have columns instead
///
/// [[palm]]
/// kind = "sphere"                           # a fingertip
/// radius = 0.012
/// friction = 0.8
/// pose = { position = [0.0, 0.0, 0.1], normal = [0.0, 0.0, -1.0] }  # z axis of the frame, turned as little as can be
/// ## How it moves, part after part, each about axes fixed in the world. law: constant (value), steady (start, rate),
/// ## sinusoid (amplitude, frequency in rad/s, phase, mean) or ramp (height, start, duration), in m or rad.
/// motion = [
///   { shift = [0.0, 0.0, 1.0], law = { kind = "ramp", height = 0.02, start = 0.2, duration = 0.5 } },
///   { turn = [1.0, 0.0, 0.0], pivot = [0.0, 0.0, 0.1], law = { kind = "sinusoid", amplitude = 0.1, frequency = 6.0 } },
/// ]
/// ## Springs between it and that motion; it gives way without turning. stiffness and damping: a number, three, or 3 x 3.
/// spring = { stiffness = 2000.0, damping = [8.0, 8.0, 10.0], mass = 0.02 }
///
/// [[palm]]
/// kind = "cylinder"                         # its axis is the x axis of its frame
/// radius = 0.02
/// friction = 0.4
/// pose = { position = [0.1, 0.0, 0.0], axis = [0.0, 1.0, 0.0] }
/// ## A motor on a hinge, in place of a motion; the law is the torque in N m.
/// motor = { pivot = [0.2, 0.0, 0.0], axis = [0.0, 1.0, 0.0], inertia = 1e-3, law = { kind = "constant", value = 0.05 } }
/// "#)?;
/// assert_eq!(scene.palms.map(|palms| palms.len()), Some(3));
/// # Ok(())
/// # }
/// ```
/// In place of `pose` and `motion`, `poses = "file.csv"` names a table of poses beside the scene file with the columns
/// `t, Px, Py, Pz, Qw, Qx, Qy, Qz`, through which a smooth curve is laid.
#[derive(Clone, Debug, PartialEq)]
pub struct KnownPalm {
    /// Its shape.
    pub surface: PalmSurface,
    /// Coefficient of friction between it and the object.
    pub friction: Option<f64>,
    /// What moves it; none where the scene says nothing of its pose.
    pub drive: Option<PalmDrive>,
}

impl KnownPalm {
    /// What its motor turns it about, if it has one.
    #[must_use]
    pub fn hinge(&self) -> Option<PalmHinge> {
        match &self.drive {
            Some(PalmDrive::Torque(motor)) => Some(motor.into()),
            _ => None,
        }
    }
}

impl Scene {
    /// What a log of version 2 does not say of the palms; none where the scene has no `[[palm]]`.
    #[must_use]
    pub fn palm_setups(&self) -> Option<Vec<PalmSetup>> {
        let largest_offset = self.sensors.contact_off_palm.unwrap_or(f64::INFINITY);
        let setup = |palm: &KnownPalm| PalmSetup {
            surface: palm.surface,
            friction: palm.friction,
            pose: palm.drive.as_ref().and_then(drive::fixed_pose),
            hinge: palm.hinge(),
            largest_offset,
        };
        Some(self.palms.as_ref()?.iter().map(setup).collect())
    }

    /// The body on its palms.
    ///
    /// # Errors
    /// [`SceneErrorKind::Missing`](Kind::Missing) names what a simulation needs beside what the scene says, other kinds what
    /// cannot be.
    pub fn contact_scene(&self) -> Result<ContactScene<BoxedShape>, Kind> {
        let palms = self.palms.as_ref().ok_or(Kind::Missing {
            what: "any [[palm]]",
            mend: "give one for each palm, with `kind`, `friction` and `pose`",
        })?;
        let simulation = self.simulation.as_ref().ok_or(NO_SIMULATION)?;
        let mass = self.mass_properties()?.ok_or(Kind::Missing {
            what: "mass or inertia of the object",
            mend: "give `object.mass` and one of `object.inertia`, `object.principal_moments` and \
                   `object.radii_of_gyration`",
        })?;
        let body = simulation.body().map_err(Kind::Shape)?;
        let palm = |(i, palm): (usize, &KnownPalm)| {
            let missing = |key| Kind::MissingOfPalm { palm: i + 1, key };
            Ok(ScenePalm {
                surface: palm.surface,
                friction: palm.friction.ok_or(missing("friction"))?,
                drive: palm.drive.clone().ok_or(missing("pose"))?,
            })
        };
        let palms = palms.iter().enumerate().map(palm).collect::<Result<_, Kind>>()?;
        ContactScene::new(body, mass, palms, self.gravity).map_err(Kind::Contacts)
    }

    /// How the body of [`Self::contact_scene`] starts, and when samples are taken.
    ///
    /// # Errors
    /// [`SceneErrorKind::Missing`](Kind::Missing) where the scene does not say where the body is.
    pub fn contact_start(&self) -> Result<(ContactStart, SampleTimes), Kind> {
        let simulation = self.simulation.as_ref().ok_or(NO_SIMULATION)?;
        let body = BodyState {
            p_WCm: simulation.p_WCm.ok_or(Kind::Missing {
                what: "`simulation.position`",
                mend: "palms of any shape do not determine where the object is; give its centre of mass in m, world axes",
            })?,
            R_WO: simulation.R_WO,
            v_WCm: simulation.v_WCm,
            w_WO: simulation.w_WO,
        };
        let times = SampleTimes { duration: simulation.duration, rate: simulation.sample_rate };
        Ok((ContactStart { body, palms: None, in_flight: simulation.in_flight }, times))
    }
}

impl Sensors {
    /// Noise on every channel of a log of version 2; zero where the scene says nothing.
    #[must_use]
    pub fn contact_noise(&self) -> ContactNoise {
        let or_none = |value: Option<f64>| value.unwrap_or(0.0);
        ContactNoise {
            contact: or_none(self.contact_std),
            force: ChannelNoise { fixed: or_none(self.force_std), share: or_none(self.force_share) },
            impulse: ChannelNoise { fixed: or_none(self.impulse_std), share: or_none(self.impulse_share) },
            torque: or_none(self.torque_std),
        }
    }
}

const NO_SIMULATION: Kind =
    Kind::Missing { what: "[simulation]", mend: "give shape, position and duration there" };
