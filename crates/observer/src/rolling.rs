//! Pose of a body that two parallel palms roll between them, from where it is touched and how the upper palm moves; no forces, mass or shape.
//!
//! The lower palm is the plane `z = 0` and stands still. Where neither contact slips and the pads keep the body from spinning about their normal (soft fingers),
//! a motion `dX` of the upper palm at the height `h` turns the body by `z x dX / h` about the lower contact: height and motion are those of the palm, and noise of contacts
//! enters by the centre of that turn alone. This is the paper's section 10 (motion relative to contacts that stick, without forces) for two contacts.
//! Between two readings the mean of both is taken, which is off by third order in the turn; a contact that jumps between them (the body goes over a face) is anywhere between
//! both places, which counts as noise.
//!
//! Nothing says that the body does spin. That a contact slips is told by the height, which must follow the turn by the span of the contacts.
//!
//! ```
//! use glam::{DVec2, DVec3};
//! use observer::rolling::{RollingNoise, RollingObserver, RollingReading};
//!
//! # fn main() -> Result<(), observer::rolling::RollingError> {
//! // A ball of 50 mm rolls by 0.4 rad: the upper palm goes twice as far as its centre.
//! let at = |turn: f64| RollingReading {
//!     upper: DVec3::new(0.05 * turn, 0.0, 0.05),
//!     contacts: [DVec2::new(-0.025 * turn, 0.0), DVec2::new(0.025 * turn, 0.0)],
//! };
//! let noise = RollingNoise { contact: 5e-5, palm: 1e-5, spin: 1e-3 };
//! let mut observer = RollingObserver::new(&at(0.0), noise)?;
//! for k in 1..=40 {
//!     observer.push(&at(0.01 * f64::from(k)))?;
//! }
//! let pose = observer.pose();
//! assert!((pose.R_WO * DVec3::Z - DVec3::new(0.4_f64.sin(), 0.0, 0.4_f64.cos())).length() < 1e-12);
//! assert!(pose.deviations().0 < 1e-3);
//! # Ok(())
//! # }
//! ```

mod covariance;
mod error;

pub use error::RollingError;

use crate::rigid::cross_matrix;
use covariance::{PoseCovariance, level, outer};
use glam::{DMat3, DQuat, DVec2, DVec3};

/// Standard deviations of what the palms sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingNoise {
    /// Of a contact along its palm, per axis, m.
    pub contact: f64,
    /// Of the place of the upper palm per axis, m.
    pub palm: f64,
    /// Of the turn about the line through both contacts that the pads let happen while the body rolls by 1 rad; it grows as the root of the turn. rad.
    pub spin: f64,
}

/// What is sensed at an instant; world axes, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RollingReading {
    /// The middle of the upper palm from that of the lower one.
    pub upper: DVec3,
    /// The contact on the upper and on the lower palm, from the middle of each.
    pub contacts: [DVec2; 2],
}

/// Largest turn between two readings, rad: the mean of two is off by a hundredth of it.
const APART: f64 = 0.3;
/// Deviations at which a contact slips: once in a million by chance, at one reading.
const SLIPS: f64 = 4.9;
/// Variance of a place that is anywhere between two, over the square of their distance.
const ANYWHERE: f64 = 1.0 / 12.0;

/// The pose of the body, whose axes are those of the world at the first reading, with its origin in the middle of the lower palm then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RolledPose {
    /// Turns axes of the body into those of the world.
    pub R_WO: DQuat,
    /// Origin of the body from the middle of the lower palm, world axes, m.
    pub p_WO: DVec3,
    /// Covariance of a small displacement of the pose that takes a point `x` of the body (body axes) to `x + theta x x + d`: of the turn, rad^2, ...
    pub rotation: DMat3,
    /// ... of the shift, m^2, ...
    pub translation: DMat3,
    /// ... and of both, `E[theta d']`, rad m.
    pub cross: DMat3,
    /// Points of the body that touch the upper and the lower palm, body axes, m. Outward normals are Z of the world and its opposite.
    pub contacts: [DVec3; 2],
    /// What sensors make of these, beside the pose: covariances, body axes, m^2.
    pub of_contacts: [DMat3; 2],
}

impl RolledPose {
    /// Outward normals at the upper and the lower contact, body axes.
    #[must_use]
    pub fn normals(&self) -> [DVec3; 2] {
        let up = self.R_WO.inverse() * DVec3::Z;
        [up, -up]
    }

    /// Deviations of the turn (rad) and of the shift (m), over all axes together.
    #[must_use]
    pub fn deviations(&self) -> (f64, f64) {
        let root = |m: DMat3| (m.x_axis.x + m.y_axis.y + m.z_axis.z).max(0.0).sqrt();
        (root(self.rotation), root(self.translation))
    }
}

/// Follows a body from reading to reading.
#[derive(Clone, Debug)]
pub struct RollingObserver {
    noise: RollingNoise,
    last: RollingReading,
    index: usize,
    R_WO: DQuat,
    p_WO: DVec3,
    covariance: PoseCovariance,
    /// The latest turn, and how far contacts moved with it: the lower one, and the span from it to the upper one.
    turn: DVec3,
    moved: [DVec2; 2],
    height: Height,
}

/// What the height tells of slip.
#[derive(Clone, Copy, Debug, Default)]
struct Height {
    first: f64,
    /// By how much it rises with the turns so far.
    risen: f64,
    /// Variance of that by the noise of contacts, m^2, but for the latest turn.
    variance: f64,
}

impl RollingObserver {
    /// From the first reading on.
    ///
    /// # Errors
    /// [`RollingError::Noise`], [`RollingError::NotFinite`], [`RollingError::Height`].
    pub fn new(first: &RollingReading, noise: RollingNoise) -> Result<Self, RollingError> {
        let RollingNoise { contact, palm, spin } = noise;
        for (what, value) in
            [("noise of contacts, m,", contact), ("noise of the palm, m,", palm), ("spin, rad,", spin)]
        {
            if !(value.is_finite() && value >= 0.0) {
                return Err(RollingError::Noise { what, value });
            }
        }
        check(first, 0)?;
        // What the place of the palm is off at first stays in all turns.
        let turn = level((palm / first.upper.z).powi(2));
        let arm = -first.contacts[1].extend(0.0);
        Ok(Self {
            noise,
            last: *first,
            index: 0,
            R_WO: DQuat::IDENTITY,
            p_WO: DVec3::ZERO,
            covariance: PoseCovariance::NONE.with_turn(turn, arm),
            turn: DVec3::ZERO,
            moved: [DVec2::ZERO; 2],
            height: Height { first: first.upper.z, ..Height::default() },
        })
    }

    /// Takes the next reading.
    ///
    /// # Errors
    /// [`RollingError`]; the pose stays the one before.
    pub fn push(&mut self, reading: &RollingReading) -> Result<(), RollingError> {
        let index = self.index + 1;
        check(reading, index)?;
        let (before, now) = (&self.last, reading);
        let moved = now.upper - before.upper;
        let inverse = 0.5 * (before.upper.z.recip() + now.upper.z.recip());
        let turn = DVec3::new(-moved.y, moved.x, 0.0) * inverse;
        let angle = turn.length();
        if angle > APART {
            return Err(RollingError::Apart { index, turn: angle, most: APART });
        }
        // How far contacts went: the lower one, and the span of both; and what of that is beyond how they went before.
        let span = span(now);
        let gone = [now.contacts[1] - before.contacts[1], (span - self::span(before)).truncate()];
        let jumps = self.jumps(gone, angle);
        let height = self.risen(reading, turn, jumps[1], index)?;
        // About the mean of the lower contacts.
        let centre = (0.5 * (before.contacts[1] + now.contacts[1])).extend(0.0);
        let by = DQuat::from_scaled_axis(turn);
        let arm = by * (self.p_WO - centre);
        let RollingNoise { contact, palm, spin } = self.noise;
        let along = span.normalize_or_zero();
        // Heights, and places of the palm that are turns at one height and others at the next.
        let of_height = outer(turn) * (palm * inverse).powi(2);
        let of_place = level((palm * inverse * moved.z * inverse).powi(2));
        let of_spin = outer(along) * (spin * spin * angle);
        let about = DMat3::from_quat(by);
        let mut covariance = self.covariance.turned(about).with_turn(of_height + of_place + of_spin, arm);
        // Each contact is in the mean of two turns.
        let weight = cross_matrix(0.5 * (self.turn + turn));
        let of_centre = level(contact * contact);
        covariance.translation += weight * of_centre * weight.transpose();
        let within = cross_matrix(turn) * outer(jumps[0].extend(0.0)) * cross_matrix(turn).transpose();
        covariance.translation += within * ANYWHERE;

        self.moved = gone;
        (self.index, self.last, self.turn, self.height) = (index, *now, turn, height);
        self.R_WO = (by * self.R_WO).normalize();
        self.p_WO = centre + arm;
        self.covariance = covariance;
        Ok(())
    }

    /// What contacts moved beyond how they moved before.
    fn jumps(&self, moved: [DVec2; 2], angle: f64) -> [DVec2; 2] {
        let before = self.turn.length();
        // Neither of a body that stood.
        let share = if before > 0.0 { (angle / before).min(1.0) } else { 1.0 };
        [0, 1].map(|i| moved[i] - self.moved[i] * share)
    }

    /// How the height rises with a turn: by its moment about the lower contact, `turn x span`.
    fn risen(
        &self,
        reading: &RollingReading,
        turn: DVec3,
        jump: DVec2,
        index: usize,
    ) -> Result<Height, RollingError> {
        let mean = 0.5 * (span(&self.last) + span(reading));
        let within = turn.truncate().perp_dot(jump).powi(2) * ANYWHERE;
        let weight = 0.5 * (self.turn + turn);
        // The span has the noise of two contacts.
        let of_contacts = 2.0 * weight.length_squared() * self.noise.contact.powi(2);
        let height = Height {
            risen: self.height.risen + turn.truncate().perp_dot(mean.truncate()),
            variance: self.height.variance + of_contacts + within,
            ..self.height
        };
        let lean = mean.truncate().length() / reading.upper.z;
        // Places of the palm at both ends, and the last contact with its half of a turn.
        let of_palm = 2.0 * self.noise.palm.powi(2) * (1.0 + lean * lean);
        let ended = 0.5 * turn.length_squared() * self.noise.contact.powi(2);
        // Of exact readings the sums alone are off, by a millionth of the height.
        let sums = (1e-6 * reading.upper.z).powi(2);
        let deviation = (height.variance + of_palm + ended + sums).sqrt();
        let by = reading.upper.z - height.first - height.risen;
        if by.abs() > SLIPS * deviation {
            return Err(RollingError::Slipped { index, by, deviations: by.abs() / deviation });
        }
        Ok(height)
    }

    /// Where the body is.
    #[must_use]
    pub fn pose(&self) -> RolledPose {
        let RollingNoise { contact, palm, .. } = self.noise;
        let RollingReading { upper, contacts } = self.last;
        let lower = contacts[1].extend(0.0);
        let places = [upper + contacts[0].extend(0.0), lower];
        // Where the palm is now is in the latest turn.
        let end = level((palm / upper.z).powi(2));
        let back = self.R_WO.inverse();
        let in_body = DMat3::from_quat(back);
        let PoseCovariance { rotation, translation, cross } =
            self.covariance.with_turn(end, self.p_WO - lower).turned(in_body);
        let along = contact * contact;
        let upper = level(along + palm * palm) + outer(DVec3::Z * palm);
        let of_contacts = [upper, level(along)].map(|m| in_body * m * in_body.transpose());
        let contacts = places.map(|place| back * (place - self.p_WO));
        RolledPose { R_WO: self.R_WO, p_WO: self.p_WO, rotation, translation, cross, contacts, of_contacts }
    }
}

fn check(reading: &RollingReading, index: usize) -> Result<(), RollingError> {
    let RollingReading { upper, contacts } = reading;
    if !(upper.is_finite() && contacts.iter().all(|c| c.is_finite())) {
        return Err(RollingError::NotFinite { index });
    }
    if upper.z <= 0.0 {
        return Err(RollingError::Height { index, height: upper.z });
    }
    Ok(())
}

/// From the lower contact to the upper one.
fn span(reading: &RollingReading) -> DVec3 {
    let [upper, lower] = reading.contacts;
    reading.upper + (upper - lower).extend(0.0)
}

#[cfg(test)]
mod tests;
