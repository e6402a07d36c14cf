//! What the torque of a palm's motor says of the contact.

use super::palm::Touch;
use super::{ContactLog, ContactLogError as Error};
use crate::PalmTorque;
use contact_kinematics::Direction;
use glam::DVec3;

/// The hinge that a motor turns a palm about, fixed in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmHinge {
    /// A point of its axis, world, m.
    pub pivot: DVec3,
    /// Direction of its axis, world. Torque and rate count about it.
    pub axis: Direction,
    /// The palm's moment of inertia about it, kg m^2, above zero.
    pub inertia: f64,
}

impl From<&PalmTorque> for PalmHinge {
    fn from(motor: &PalmTorque) -> Self {
        Self { pivot: motor.pivot, axis: motor.axis, inertia: motor.inertia }
    }
}

impl PalmHinge {
    /// Moment about the hinge of the palm's force on the object, N m: the motor's torque (N m) less what the palm's own
    /// angular acceleration (rad/s^2) takes (paper, (29)).
    #[must_use]
    pub fn contact_moment(&self, torque: f64, acceleration: f64) -> f64 {
        torque - self.inertia * acceleration
    }

    /// Moment of a unit force along the palm's normal at the contact, m. Friction has a moment of its own unless the axis
    /// lies in the tangent plane of the contact, as that of a flat palm through its hinge does.
    #[must_use]
    pub fn lever(&self, touch: &Touch) -> f64 {
        self.axis.get().dot((touch.p_WC - self.pivot).cross(touch.n.get()))
    }
}

impl ContactLog {
    /// Normal forces that the torque of palm `i` (from 0) tells, N: its moment about the hinge, less what turns the palm
    /// itself, over the lever of the contact. None while the object does not touch the palm, or touches it on the axis.
    ///
    /// The angular acceleration is that of a parabola through three neighbouring samples of the rate: its error falls with the
    /// square of the time between them, and is large where the rate has a bend, as at a change of modes. What
    /// [`PalmHinge::lever`] says of friction holds here.
    ///
    /// # Errors
    /// [`ContactLogError`](Error) where the palm has no torque or no hinge, or lacks a torque at a sample with contact.
    pub fn forces_of_torque(&self, i: usize) -> Result<Vec<Option<f64>>, Error> {
        let none = |what, mend| Error::NoMotor { palm: i + 1, what, mend };
        let palm = self.palms.get(i).ok_or(Error::PalmCount { found: i + 1 })?;
        let hinge =
            palm.hinge().ok_or(none("hinge", "give pivot, axis and inertia of its motor in the scene"))?;
        if !palm.has_torque() {
            return Err(none("torque", "measure it, or use forces"));
        }
        let rate = |k: usize| palm.motion(k).w_WP.dot(hinge.axis.get());
        let force = |k: usize| {
            let Some(touch) = palm.touch(k) else { return Ok(None) };
            let (sample, time) = (k, self.times[k]);
            let missing = Error::Missing { what: "torque", palm: i + 1, sample, time };
            let moment = hinge.contact_moment(palm.torque(k).ok_or(missing)?, slope(&self.times, k, rate));
            let force = moment / hinge.lever(&touch);
            Ok(force.is_finite().then_some(force))
        };
        (0..self.times.len()).map(force).collect()
    }
}

/// Slope at sample `k` of the parabola through it and its neighbours, at an end through the three samples there.
pub(super) fn slope(times: &[f64], k: usize, value: impl Fn(usize) -> f64) -> f64 {
    let chord = |a: usize, b: usize| (value(b) - value(a)) / (times[b] - times[a]);
    let last = times.len() - 1;
    if last == 1 {
        return chord(0, 1);
    }
    let middle = k.clamp(1, last - 1);
    let [before, after] = [chord(middle - 1, middle), chord(middle, middle + 1)];
    let bend = (after - before) / (times[middle + 1] - times[middle - 1]);
    // Newton's form: the slope halfway along the first chord, and on from there.
    before + bend * (2.0 * times[k] - times[middle - 1] - times[middle])
}
