use super::clean::{RANK_TOLERANCE, root_mean_square};
use super::correlation::whiteness;
use super::covariance::NoiseLevel;
use super::momentum::Row;
use super::track::Track;
use crate::faults::Suspect;
use crate::least_squares::Observability;
use glam::DVec3;
use nalgebra::SVector;
use std::fmt;

/// What an estimate rests on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence {
    /// Samples used.
    pub samples: usize,
    /// Time that they span, s.
    pub duration: f64,
    /// Root mean square of the contact residuals, m/s.
    pub residual_rms: f64,
    /// Root mean square that sensor noise would leave at the true motion, m/s.
    pub noise_explains: f64,
    /// Von Neumann's ratio of the residuals: about 1 for independent ones, near 0 for smooth ones (a misfit, or errors
    /// that last).
    pub whiteness: f64,
    /// Directions of the 12 unknowns that the data determine at all, in exact arithmetic.
    pub rank: usize,
    /// Largest over smallest singular value of the scaled Jacobian.
    pub condition: f64,
    /// Smallest eigenvalue of `J' J` in scaled unknowns, (m/s)^2.
    pub smallest_information: f64,
    /// The worst known combination of the unknowns.
    pub weakest: WeakDirection,
    /// Sensor noise that the covariance is computed from.
    pub noise: NoiseLevel,
    /// Linearisations in the last fit.
    pub iterations: usize,
}

impl Evidence {
    /// Of the residuals along a motion and of what the data say of its `P` unknowns, where the noise shifts nothing and no other
    /// motion is known.
    pub(super) fn new<const P: usize>(
        track: &Track,
        residuals: &[[f64; 3]],
        noise_explains: f64,
        observability: &Observability<P>,
        weakest: WeakDirection,
        noise: NoiseLevel,
        iterations: usize,
    ) -> Self {
        let eigenvalues = observability.eigenvalues;
        let (smallest, largest) = (eigenvalues[0], eigenvalues[P - 1]);
        Self {
            samples: track.len(),
            duration: track.duration(),
            residual_rms: root_mean_square(residuals),
            noise_explains,
            whiteness: whiteness(residuals),
            rank: eigenvalues.iter().filter(|&&v| v > RANK_TOLERANCE * largest).count(),
            condition: (largest / smallest.max(0.0)).sqrt(),
            smallest_information: smallest,
            weakest,
            noise,
            iterations,
        }
    }
}

/// A part of the state at the first sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Centre of mass.
    CentreOfMass,
    /// Velocity of the centre of mass.
    Velocity,
    /// Angular momentum, and with it the angular velocity.
    AngularMomentum,
    /// Orientation of the principal axes.
    Orientation,
    /// Mass.
    Mass,
    /// Inertia tensor.
    Inertia,
}

/// The combination of unknowns that the data determine worst, named by its largest part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeakDirection {
    /// What it is a change of.
    pub quantity: Quantity,
    /// Along or about which unit vector, world axes.
    pub axis: DVec3,
    /// Its standard deviation, in natural sizes (length of the scene, `sqrt(g length)`, radian).
    pub deviation: f64,
}

impl WeakDirection {
    /// Names a unit vector of the scaled unknowns.
    pub(super) fn new(direction: &Row, deviation: f64) -> Self {
        let block = |k: usize| DVec3::new(direction[3 * k], direction[3 * k + 1], direction[3 * k + 2]);
        let largest =
            (1..4).fold(0, |best, k| if block(k).length() > block(best).length() { k } else { best });
        let quantity = match largest {
            0 => Quantity::CentreOfMass,
            1 => Quantity::Velocity,
            2 => Quantity::AngularMomentum,
            _ => Quantity::Orientation,
        };
        Self { quantity, axis: block(largest).normalize_or_zero(), deviation }
    }

    /// Names a unit vector of the scaled unknowns of a body of which nothing is known.
    pub(super) fn of_body(direction: &SVector<f64, 16>, deviation: f64) -> Self {
        let inertia = direction.fixed_rows::<6>(10).norm();
        let block = |k: usize| DVec3::new(direction[3 * k], direction[3 * k + 1], direction[3 * k + 2]);
        let motion = (0..3).fold(0.0, |m: f64, k| m.max(block(k).length()));
        if motion < inertia.max(direction[9].abs()) {
            let quantity = if inertia > direction[9].abs() { Quantity::Inertia } else { Quantity::Mass };
            return Self { quantity, axis: DVec3::ZERO, deviation };
        }
        let row = Row::from_fn(|i, _| if i < 9 { direction[i] } else { 0.0 });
        Self::new(&row, deviation)
    }
}

impl fmt::Display for WeakDirection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (name, preposition) = match self.quantity {
            Quantity::CentreOfMass => ("centre of mass", "along"),
            Quantity::Velocity => ("velocity", "along"),
            Quantity::AngularMomentum => ("angular velocity", "about"),
            Quantity::Orientation => ("orientation", "about"),
            Quantity::Mass => ("mass", ""),
            Quantity::Inertia => ("inertia tensor", ""),
        };
        if self.axis == DVec3::ZERO {
            return f.write_str(name);
        }
        let DVec3 { x, y, z } = self.axis;
        write!(f, "{name} {preposition} ({x:.2}, {y:.2}, {z:.2})")
    }
}

/// Whether to believe an estimate.
#[derive(Clone, Debug, PartialEq)]
pub enum Reliability {
    /// Its covariance tells how far.
    Reliable,
    /// It may be wrong by more than its numbers say.
    Unreliable(Vec<Reason>),
}

/// Why not to believe an estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reason {
    /// The fit did not settle.
    NotConverged {
        /// Linearisations used.
        iterations: usize,
    },
    /// The data leave a direction open.
    Unobservable {
        /// Which.
        direction: WeakDirection,
    },
    /// Contacts and forces had to be corrected by more than their noise.
    Inconsistent {
        /// Chi-squared over its degrees of freedom; about 1 when all is as stated.
        misfit: f64,
    },
    /// Something that was taken as known of the sensors is not so.
    Fault(Suspect),
    /// Mass and moments of inertia that were stated contradict those that the log has without them.
    OtherBody {
        /// What the mass of the log is of the stated one.
        mass: f64,
        /// How many of its deviations that is off.
        deviations: f64,
        /// Squared departure of mass and moments in their covariance, four degrees of freedom.
        squares: f64,
    },
    /// The body hardly turns: where its centre of mass is, and its inertia, follow from how the spin changes.
    Still {
        /// Largest change of the angular velocity from its mean, in its deviations.
        deviations: f64,
    },
    /// Without the stated mass and inertia the search leads to no motion, so that nothing confirms the one that was found with them.
    Unconfirmed,
    /// Contacts and forces hardly change beyond noise: rest, slow rocking, or a disc.
    Unchanging {
        /// Largest spread of the contacts of a palm, in natural lengths, noise taken out.
        contacts: f64,
        /// Largest spread of the whole force, in weights, noise taken out.
        forces: f64,
    },
    /// Another motion explains the log as well.
    Ambiguous {
        /// How far it is from this one, in deviations of the velocities or positions.
        apart: f64,
    },
    /// The log is noisy and short beside the time in which the body falls its own length.
    TooShort {
        /// Length of the log, s.
        duration: f64,
        /// Length that is needed, s.
        needed: f64,
    },
    /// The log is noisy, and the estimate one for exact logs.
    Noisy {
        /// Standard deviation of a contact coordinate, m.
        contact: f64,
    },
    /// The motion found leaves more than noise.
    Misfit {
        /// Root mean square of the contact residuals, m/s.
        residual: f64,
        /// What noise explains, m/s.
        explained: f64,
    },
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotConverged { iterations } => {
                write!(f, "the fit did not settle in {iterations} iterations")
            }
            Self::Unobservable { direction } => write!(
                f,
                "the log does not determine the {direction}: standard deviation {:.2e} of its natural size",
                direction.deviation
            ),
            Self::Fault(suspect) => write!(
                f,
                "the data speak for a wrong constant of the sensors, most of all for this one: {suspect}"
            ),
            Self::OtherBody { mass, deviations, squares } => write!(
                f,
                "the stated mass and inertia are not those of this object: without them the mass comes out {mass:.4} times as large, which is \
                 {deviations:.1} deviations off, and mass and moments together depart by {squares:.0} where chance makes 4: state others, or \
                 none"
            ),
            Self::Inconsistent { misfit } => write!(
                f,
                "contacts and forces had to be corrected by {:.2} times their noise: a wrong motion, a wrong constant of \
                 body or sensors (a force gain, say), or more noise than was stated",
                misfit.sqrt()
            ),
            Self::Still { deviations } => write!(
                f,
                "the body hardly turns: its angular velocity changes by {deviations:.1} of its deviations at most, and where its centre of mass is \
                 follows from such changes"
            ),
            Self::Unchanging { contacts, forces } => write!(
                f,
                "the readings hardly change beyond their noise (contacts by {contacts:.3} of the body's size, the whole force by {forces:.3} of \
                 the weight): at rest, rocking slowly, or round, a body shows no motion"
            ),
            Self::Ambiguous { apart } => write!(
                f,
                "another motion explains the log as well, {apart:.0} deviations away: the readings change too little to tell which"
            ),
            Self::Unconfirmed => write!(
                f,
                "without the stated mass and inertia the search leads to no motion that explains the log, so that nothing confirms this one"
            ),
            Self::TooShort { duration, needed } => write!(
                f,
                "{duration:.2} s of noisy data are too short for a body of this size: at least {needed:.2} s are needed"
            ),
            Self::Noisy { contact } => write!(
                f,
                "contacts are noisy by {contact:.1e} m, and the momentum form is for exact logs: estimate from contacts of any palms"
            ),
            Self::Misfit { residual, explained } if !explained.is_finite() => write!(
                f,
                "the motion found leaves {residual:.2e} m/s of the contact condition, beyond what any noise explains: \
                 check units, frames, mass and inertia"
            ),
            Self::Misfit { residual, explained } => write!(
                f,
                "the motion found leaves {residual:.2e} m/s of the contact condition where sensor noise explains \
                 {explained:.2e}: a wrong motion, a wrong mass or inertia, or sensor errors that last"
            ),
        }
    }
}

impl Reliability {
    /// One more reason.
    pub(crate) fn add(&mut self, reason: Reason) {
        match self {
            Self::Reliable => *self = Self::Unreliable(vec![reason]),
            Self::Unreliable(reasons) => reasons.push(reason),
        }
    }

    /// Whether the estimate may be believed to within its covariance.
    #[must_use]
    pub fn is_reliable(&self) -> bool {
        *self == Self::Reliable
    }
}
