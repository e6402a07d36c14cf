//! Equations of motion in minimal coordinates: orientation and angular velocity, and nothing to drift.

use super::{Accelerations, Instant, ThreePalmScene};
use crate::MassProperties;
use contact_kinematics::{PalmError, PalmState, PalmTriple, SupportFunction, ThreeContacts};
use glam::{DMat3, DQuat, DVec3};

impl<S: SupportFunction> ThreePalmScene<S> {
    /// Contacts, velocities, accelerations and contact forces at time `t`, orientation and angular velocity.
    ///
    /// # Errors
    /// [`PalmError::Parallel`] when the palms have turned too close to a common line.
    pub fn instant(&self, t: f64, R_WO: DQuat, w_WO: DVec3) -> Result<Instant, PalmError> {
        let (palms, triple) = self.palms_at(t)?;
        Ok(Instant::new(self.body(), self.mass(), self.gravity(), (palms, triple), (t, R_WO, w_WO)))
    }
}

impl Instant {
    /// Contacts, velocities, accelerations and contact forces of a body on palms, at a time, orientation and angular
    /// velocity (rad/s, world axes), under `gravity` (m/s^2, world).
    ///
    /// With `v = J w - N^-1 p` and `a = J alpha + bias`, the contact forces do no work on `alpha` and drop out:
    /// `(I + m J' J) alpha = -w x I w - m J' (bias - g)`; then `f = N^-T m (a - g)`. The matrix is positive definite
    /// whatever the contacts, so nothing is divided but by `det N`, which the palms guard.
    #[must_use]
    pub fn new<S: SupportFunction + ?Sized>(
        body: &S,
        mass: &MassProperties,
        gravity: DVec3,
        (palms, triple): ([PalmState; 3], PalmTriple),
        (t, R_WO, w_WO): (f64, DQuat, DVec3),
    ) -> Self {
        let rotation = DMat3::from_quat(R_WO);
        let touch = ThreeContacts::new(body, rotation, triple);
        let rates = touch.rates(&palms, w_WO);
        let inertia_W = rotation * mass.inertia() * rotation.transpose();
        let (mass, jacobian, free_fall) = (mass.mass(), touch.jacobian, gravity);
        let generalised = inertia_W + jacobian.transpose() * jacobian * mass;
        let moment = -w_WO.cross(inertia_W * w_WO)
            - mass * (jacobian.transpose() * (rates.acceleration_bias - free_fall));
        let alpha_WO = generalised.inverse() * moment;
        let a_WCm = jacobian * alpha_WO + rates.acceleration_bias;
        let forces = triple.solve_transposed(mass * (a_WCm - free_fall)).to_array();
        let accelerations = Accelerations { alpha_WO, a_WCm, forces };
        Self { t, R_WO, w_WO, palms, touch, rates, accelerations }
    }
}
