//! Everything about a body and its contacts at one instant, whatever their modes.

use super::drive::{PalmDrive, PalmSpring, PalmTorque};
use super::problem::{ContactProblem, ProblemContact, Yields};
use super::{ContactScene, MOST_PALMS};
use crate::BodyState;
use contact_kinematics::{
    BodyPlace, ContactError, Direction, SupportFunction, SurfaceContact, SurfaceRates, SurfaceState,
};
use glam::{DMat3, DVec3};
use thiserror::Error;

/// Coordinates of a palm that gives way, and their rates; of a prescribed palm they mean nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PalmCoordinates {
    /// Position of a palm on springs, world, m; the angle of a driven one in `x`, rad.
    pub position: DVec3,
    /// Their rates.
    pub velocity: DVec3,
}

/// A contact could not be found.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("palm {palm}: {source}")]
pub struct PalmContactError {
    /// Palm number from 1.
    pub palm: usize,
    /// Why.
    pub source: ContactError,
}

/// State of body and palms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneState {
    /// Time in s.
    pub t: f64,
    /// The body.
    pub body: BodyState,
    /// The palms that give way.
    pub palms: [PalmCoordinates; MOST_PALMS],
}

/// A body next to its palms: where they touch and how the contacts move.
#[derive(Clone, Debug)]
pub(crate) struct Contacts {
    pub(crate) palms: Vec<SurfaceState>,
    pub(crate) contacts: Vec<SurfaceContact>,
    pub(crate) rates: Vec<SurfaceRates>,
}

/// Free accelerations of contacts below this share of their terms are rounding.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

impl<S: SupportFunction> ContactScene<S> {
    /// Pose and motion of palm `i` (from 0), with the acceleration that it would have without contact force.
    #[must_use]
    pub fn palm_state(&self, i: usize, t: f64, coordinates: &PalmCoordinates) -> SurfaceState {
        match &self.palms()[i].drive {
            PalmDrive::Prescribed(motion) => motion.at(t),
            PalmDrive::Spring(spring) => spring_state(spring, t, coordinates),
            PalmDrive::Torque(drive) => drive.state(t, coordinates.position.x, coordinates.velocity.x),
        }
    }

    /// Coordinates of the palms at `t = 0`: springs without load, hinges at their first angle.
    #[must_use]
    pub fn palms_at_start(&self) -> [PalmCoordinates; MOST_PALMS] {
        let mut all = [PalmCoordinates::default(); MOST_PALMS];
        for (palm, coordinates) in self.palms().iter().zip(&mut all) {
            *coordinates = match &palm.drive {
                PalmDrive::Prescribed(_) => PalmCoordinates::default(),
                PalmDrive::Spring(spring) => {
                    let command = spring.command.at(0.0);
                    PalmCoordinates { position: command.p_WP, velocity: command.v_WP }
                }
                PalmDrive::Torque(drive) => {
                    PalmCoordinates { position: drive.angle * DVec3::X, velocity: drive.rate * DVec3::X }
                }
            };
        }
        all
    }

    /// Contacts and their rates. `guesses` are the body's normals at the contacts, body axes, where they are known.
    pub(crate) fn contacts_at(
        &self,
        state: &SceneState,
        guesses: &[Option<Direction>; MOST_PALMS],
    ) -> Result<Contacts, PalmContactError> {
        let body = &state.body;
        let place = BodyPlace { p_WCm: body.p_WCm, R_WO: DMat3::from_quat(body.R_WO) };
        let count = self.palms().len();
        let (mut palms, mut contacts, mut rates) =
            (Vec::with_capacity(count), Vec::with_capacity(count), Vec::with_capacity(count));
        for (i, palm) in self.palms().iter().enumerate() {
            let at = |source| PalmContactError { palm: i + 1, source };
            let surface = self.palm_state(i, state.t, &state.palms[i]);
            let contact =
                SurfaceContact::new(self.body(), &place, palm.surface, &surface, guesses[i]).map_err(at)?;
            rates.push(contact.rates(&surface, body.v_WCm, body.w_WO).map_err(at)?);
            palms.push(surface);
            contacts.push(contact);
        }
        Ok(Contacts { palms, contacts, rates })
    }

    /// How forces accelerate the contacts.
    pub(crate) fn problem(&self, body: &BodyState, touch: &Contacts) -> ContactProblem {
        let rotation = DMat3::from_quat(body.R_WO);
        let K = rotation * self.mass().inverse_inertia() * rotation.transpose();
        let inertia = rotation * self.mass().inertia() * rotation.transpose();
        let alpha = -(K * body.w_WO.cross(inertia * body.w_WO));
        let free_motion = [self.gravity(), alpha];
        let problem = |i: usize| {
            let (contact, rates) = (&touch.contacts[i], &touch.rates[i]);
            let free = self.gravity() + alpha.cross(contact.b_W) + rates.slip_bias;
            let terms = self.gravity().length()
                + body.w_WO.length_squared() * contact.b_W.length()
                + rates.slip_bias.length();
            ProblemContact {
                n: contact.n,
                t: contact.t,
                b: contact.b_W,
                friction: self.palms()[i].friction,
                // What is left of terms that cancel is no scale for what counts as zero.
                free: if free.length() <= ROUNDING * terms { DVec3::ZERO } else { free },
                normal_bias: rates.n_dot.dot(rates.slip),
                yields: self.yields(i, contact.p_WC),
            }
        };
        let mut all = [problem(0); MOST_PALMS];
        for i in 1..self.palms().len() {
            all[i] = problem(i);
        }
        ContactProblem::new(1.0 / self.mass().mass(), K, free_motion, &all[..self.palms().len()])
    }

    fn yields(&self, i: usize, p_WC: DVec3) -> Yields {
        match &self.palms()[i].drive {
            PalmDrive::Prescribed(_) => Yields::No,
            PalmDrive::Spring(spring) => Yields::All(1.0 / spring.mass),
            PalmDrive::Torque(drive) => Yields::Along(drive.lever(p_WC), 1.0 / drive.inertia),
        }
    }

    /// Acceleration of the coordinates of palm `i` without contact force.
    pub(crate) fn free_palm_acceleration(&self, i: usize, palm: &SurfaceState, t: f64) -> DVec3 {
        match &self.palms()[i].drive {
            PalmDrive::Prescribed(_) => DVec3::ZERO,
            PalmDrive::Spring(_) => palm.a_WP,
            PalmDrive::Torque(drive) => DVec3::X * (drive.torque.at(t)[0] / drive.inertia),
        }
    }

    /// Kinetic and potential energy of the body, J; zero height is the world origin.
    #[must_use]
    pub fn energy(&self, body: &BodyState) -> f64 {
        let mass = self.mass().mass();
        let w_O = body.R_WO.inverse() * body.w_WO;
        let kinetic = 0.5 * (mass * body.v_WCm.length_squared() + w_O.dot(self.mass().inertia() * w_O));
        kinetic - mass * self.gravity().dot(body.p_WCm)
    }
}

fn spring_state(spring: &PalmSpring, t: f64, coordinates: &PalmCoordinates) -> SurfaceState {
    let command = spring.command.at(t);
    let (stretch, rate) = (coordinates.position - command.p_WP, coordinates.velocity - command.v_WP);
    SurfaceState {
        p_WP: coordinates.position,
        v_WP: coordinates.velocity,
        a_WP: -(spring.stiffness * stretch + spring.damping * rate) / spring.mass,
        ..command
    }
}

impl PalmTorque {
    /// The palm at an angle (rad) and its rate (rad/s), accelerated by the motor alone.
    fn state(&self, t: f64, angle: f64, rate: f64) -> SurfaceState {
        let acceleration = self.torque.at(t)[0] / self.inertia;
        self.pose.at_rest().turned(self.pivot, self.axis, [angle, rate, acceleration])
    }

    /// Velocity of the palm's material at `p_WC` per unit of angular rate: `axis x (c - pivot)`.
    fn lever(&self, p_WC: DVec3) -> DVec3 {
        self.axis.get().cross(p_WC - self.pivot)
    }
}
