//! What is read of a contact at a sample, its checks, and what it means in natural units.

use super::contact::Force;
use super::density::{Ratio, Slip};
use super::error::ContactModesError;
use super::foretold::Foretold;
use super::normal::log_density;
use super::options::ContactModesOptions;
use nalgebra::{Matrix2, Vector2};

/// Share of the force's deviation below which a normal force does not press.
const PRESSES: f64 = 1e-3;
/// Largest readings that are taken, in deviations, natural speeds or typical forces: squares of them must be finite.
const MOST: f64 = 1e9;

/// What is read of one contact at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ContactSeen {
    /// Nothing was read: modes go on as they are likely to.
    Missing,
    /// Palm and body are known not to touch: by the gap, by taxels, or by the log.
    Off,
    /// They are known to touch, and nothing else is read.
    Touches,
    /// It was read.
    Read(ContactReading),
}

/// The reading of a contact. Friction and slip are components along the same two axes across the palm's normal, at right angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactReading {
    /// Force along the palm's normal, on the body, N: pressing is positive. Where it does not press, the contact is off, unless
    /// it is known to touch.
    pub normal_force: f64,
    /// Force of the palm on the body across the normal, N.
    pub friction: Vector2<f64>,
    /// Standard deviation of each component of the force, N.
    pub force_deviation: f64,
    /// Where it is estimated.
    pub slip: Option<ContactSlip>,
    /// Whether it is known to touch, by the gap or by taxels.
    pub touches: bool,
}

/// An estimate of the slip of a contact: velocity of the body's material against the palm's.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSlip {
    /// m/s.
    pub velocity: Vector2<f64>,
    /// Its covariance, (m/s)^2, positive definite.
    pub covariance: Matrix2<f64>,
}

impl ContactSeen {
    /// Where it was read.
    pub(super) fn reading(&self) -> Option<&ContactReading> {
        match self {
            Self::Read(reading) => Some(reading),
            Self::Missing | Self::Off | Self::Touches => None,
        }
    }

    /// What the forces tell.
    pub(super) fn force(&self, options: &ContactModesOptions) -> Force {
        match self {
            Self::Missing => Force::Silent,
            Self::Off => Force::Off,
            Self::Touches => Force::Touches,
            Self::Read(reading) => reading.force(options),
        }
    }
}

/// Where a reading is, for errors.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) contact: usize,
    pub(super) sample: usize,
}

impl Place {
    pub(super) fn finite(self, what: &'static str, value: f64) -> Result<(), ContactModesError> {
        let Self { contact, sample } = self;
        if value.is_finite() {
            Ok(())
        } else {
            Err(ContactModesError::NotFinite { what, contact, sample, value })
        }
    }

    fn noise(self, what: &'static str, value: f64) -> Result<(), ContactModesError> {
        let Self { contact, sample } = self;
        self.finite(what, value)?;
        if value > 0.0 { Ok(()) } else { Err(ContactModesError::Noise { what, contact, sample, value }) }
    }

    pub(super) fn within(self, what: &'static str, value: f64, most: f64) -> Result<(), ContactModesError> {
        let Self { contact, sample } = self;
        if value <= most {
            Ok(())
        } else {
            Err(ContactModesError::Range { what, contact, sample, value, most })
        }
    }
}

impl ContactReading {
    pub(super) fn check(&self, at: Place, options: &ContactModesOptions) -> Result<(), ContactModesError> {
        at.finite("normal force", self.normal_force)?;
        self.friction.iter().try_for_each(|f| at.finite("friction", *f))?;
        at.noise("deviation of the force", self.force_deviation)?;
        let force = self.normal_force.hypot(self.friction.norm());
        at.within("force, in deviations", force / self.force_deviation, MOST)?;
        at.within("force, in typical forces", force / options.typical_force, MOST)?;
        at.within(
            "deviation of the force, in typical forces",
            self.force_deviation / options.typical_force,
            MOST,
        )?;
        let Some(slip) = &self.slip else { return Ok(()) };
        slip.velocity.iter().try_for_each(|v| at.finite("slip", *v))?;
        at.within("slip, in natural speeds", slip.velocity.norm() / options.natural_speed, MOST)?;
        slip.covariance.iter().try_for_each(|c| at.finite("covariance of the slip", *c))?;
        let variances = slip.covariance.diagonal();
        variances.iter().try_for_each(|v| at.noise("variance of the slip", *v))?;
        at.noise("determinant of the slip's covariance", slip.covariance.determinant())?;
        let widest = variances.max().sqrt() / options.natural_speed;
        at.within("deviation of the slip, in natural speeds", widest, MOST)
    }

    /// The ratio of friction to normal force, where it presses.
    pub(super) fn ratio(&self) -> Option<Ratio> {
        let normal = self.normal_force;
        if normal <= PRESSES * self.force_deviation {
            return None;
        }
        let size = self.friction.norm() / normal;
        Some(Ratio { size, deviation: self.force_deviation * (1.0 + size * size).sqrt() / normal })
    }

    /// What the forces tell.
    fn force(&self, options: &ContactModesOptions) -> Force {
        let normal = self.normal_force;
        let Some(ratio) = self.ratio() else {
            return if self.touches { Force::Touches } else { Force::Off };
        };
        let touching = -options.typical_force.ln() - normal / options.typical_force;
        let unloaded = options.unloaded_deviation;
        let off = if self.touches {
            f64::NEG_INFINITY
        } else {
            log_density(normal, unloaded.powi(2)) + ratio.log_off(unloaded / normal)
        };
        Force::Presses { ratio, touching, off, foretold: Foretold::default() }
    }

    /// The direction of friction, and its deviation, rad; some direction where there is no friction.
    pub(super) fn direction(&self) -> (Vector2<f64>, f64) {
        let size = self.friction.norm();
        let u = if size > 0.0 { self.friction / size } else { Vector2::x() };
        let ratio = size / self.normal_force.max(PRESSES * self.force_deviation);
        // sr / r = deviation (1 + r^2)^1/2 / |f_t|. Half a turn and more is no direction at all.
        let turn = self.force_deviation * (1.0 + ratio * ratio).sqrt() / size.max(f64::MIN_POSITIVE);
        (u, turn.min(std::f64::consts::PI))
    }
}

/// A slip in natural units, against and across the friction `u`.
pub(super) fn turned(
    velocity: &Vector2<f64>,
    covariance: &Matrix2<f64>,
    u: &Vector2<f64>,
    speed: f64,
) -> Slip {
    let v = Vector2::new(-u.y, u.x);
    let square = speed * speed;
    Slip {
        along: -velocity.dot(u) / speed,
        across: -velocity.dot(&v) / speed,
        variance_along: u.dot(&(covariance * u)) / square,
        variance_across: v.dot(&(covariance * v)) / square,
        covariance: u.dot(&(covariance * v)) / square,
    }
}
