use super::ThreePalmScene;
use contact_kinematics::{ContactRates, PalmState, SupportFunction, ThreeContacts};
use glam::{DQuat, DVec3};

/// Accelerations of the body and the contact forces that cause them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accelerations {
    /// Angular acceleration, rad/s^2, world axes.
    pub alpha_WO: DVec3,
    /// Acceleration of the centre of mass, m/s^2, world.
    pub a_WCm: DVec3,
    /// Normal contact forces, N; negative where the palm would have to pull.
    pub forces: [f64; 3],
}

/// Everything about the body and its contacts at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Time in s.
    pub t: f64,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Angular velocity, rad/s, world axes.
    pub w_WO: DVec3,
    /// The palms.
    pub palms: [PalmState; 3],
    /// Contacts and centre of mass.
    pub touch: ThreeContacts,
    /// Velocities.
    pub rates: ContactRates,
    /// Accelerations and forces.
    pub accelerations: Accelerations,
}

impl Instant {
    /// Kinetic plus potential energy in J; zero height is the world origin.
    #[must_use]
    pub fn energy<S: SupportFunction>(&self, scene: &ThreePalmScene<S>) -> f64 {
        let mass = scene.mass().mass();
        let w_O = self.R_WO.inverse() * self.w_WO;
        let kinetic =
            0.5 * (mass * self.rates.v_WCm.length_squared() + w_O.dot(scene.mass().inertia() * w_O));
        kinetic - mass * scene.gravity().dot(self.touch.p_WCm)
    }

    /// Power of the palms on the body in W: `sum f_i s_i2 rate_i`.
    #[must_use]
    pub fn palm_power(&self) -> f64 {
        (0..3).map(|i| self.accelerations.forces[i] * self.sensor(i)[1] * self.palms[i].rate).sum()
    }

    /// Sensor coordinates of the contact on palm `i` (from 0), in m.
    #[must_use]
    pub fn sensor(&self, i: usize) -> [f64; 2] {
        self.palms[i].frame.sensor_from_contact(self.touch.contacts[i].p_WC)
    }

    /// Motor torque of palm `i` (from 0) of moment of inertia `inertia`, N m (paper, (29)).
    #[must_use]
    pub fn torque(&self, i: usize, inertia: f64) -> f64 {
        self.accelerations.forces[i] * self.sensor(i)[1] + inertia * self.palms[i].acceleration
    }

    /// The palm (from 0) that carries the smallest force, and that force in N.
    #[must_use]
    pub fn weakest_contact(&self) -> (usize, f64) {
        let forces = &self.accelerations.forces;
        let weakest = (1..3).fold(0, |best, i| if forces[i] < forces[best] { i } else { best });
        (weakest, forces[weakest])
    }
}
