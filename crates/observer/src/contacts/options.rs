//! What the estimate from contacts is told, and why it refuses.

use super::impulses::read;
use super::noise::ContactNoiseLevel;
use object_dynamics::{ContactLog, ContactMode, LoggedPalm, MOST_PALMS, MassProperties, SensedAxes};
use thiserror::Error;

/// Why there is no estimate.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactEstimateError {
    /// Nothing was touched.
    #[error("no palm was touched at any sample: there is nothing to estimate from")]
    NoContact,
    /// A palm lacks the force, and an impulse with its noise.
    #[error(
        "palm {palm} measures neither its force nor, with a stated noise, its impulse in three axes, and is not known to be frictionless: the \
         estimate from contacts needs all of one of them"
    )]
    NoForce {
        /// Number from 1.
        palm: usize,
    },
    /// As many modes as samples are needed.
    #[error("{found} sets of contact modes for {samples} samples: give one set a sample")]
    Modes {
        /// Sets given.
        found: usize,
        /// Samples of the log.
        samples: usize,
    },
    /// All contacts are on one palm, and the size of the body is not stated.
    #[error("one palm's contacts tell no size of the body: state one")]
    NoSize,
    /// A setting is no number, or not a possible one.
    #[error("{what} is {value}: it must be a finite number {must}")]
    Setting {
        /// Its name.
        what: &'static str,
        /// As it is.
        value: f64,
        /// What it must be.
        must: &'static str,
    },
    /// Fewer than two samples.
    #[error("the log has {samples} samples: a motion needs at least two")]
    Short {
        /// Samples of the log.
        samples: usize,
    },
    /// A motion at the first samples that leads nowhere.
    #[error(
        "the motion that is known at the first samples cannot be carried on to the others: it is another body's or another log's, or something happened that \
         the sensors did not tell; estimate the whole log from nothing"
    )]
    Lost,
    /// Numbers beyond all bounds.
    #[error(
        "no start leads to a motion that explains the log: its least squares leave all numbers or are singular; check units, frames and noise"
    )]
    Singular,
}

/// How [`estimate_contacts`](crate::contacts::estimate_contacts) works.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOptions {
    /// Noise of the sensors.
    pub noise: ContactNoiseLevel,
    /// Gravity, m/s^2, along -z of the world.
    pub gravity: f64,
    /// Coefficient of friction of the palms whose own the log does not state, if it is known. A palm without friction needs to measure its
    /// normal force alone.
    pub friction: Option<f64>,
    /// Mass and inertia of the body in axes of its own, where they are known; else they are estimated.
    pub body: Option<MassProperties>,
    /// Mean radius of the body, m, where it is known; else from contacts on two palms or more.
    pub size: Option<f64>,
    /// Whether to tell how far all poses together may be off, for bounds on the shape: a thousand motions are drawn for it.
    pub pose_errors: bool,
    /// Whether to tell covariances of the pose at all samples.
    pub pose_covariances: bool,
    /// Whether to test what is taken as known of the sensors, and to count in all deviations what of it may be wrong: without, they are those of
    /// sensors that are as stated.
    pub suspects: bool,
    /// Whether to tell how probable each contact mode is. For each palm that sticks somewhere a motion is solved for in which it need not, and modes
    /// that were not given are made anew from what is sure, for a second solution.
    pub mode_odds: bool,
    /// Whether the floor of the noise is a guess: where noise is not what conditions are off by, they count as good as what is left of them.
    pub guessed_floor: bool,
    /// Whether all motion is in the plane of the world's x and z: the object moves in it and turns about its normal.
    pub planar: bool,
}

impl ContactOptions {
    /// Of a body of which nothing is known, without joint errors of poses. `gravity` in m/s^2.
    #[must_use]
    pub fn new(noise: ContactNoiseLevel, gravity: f64) -> Self {
        Self {
            noise,
            gravity,
            friction: None,
            body: None,
            size: None,
            pose_errors: false,
            pose_covariances: false,
            suspects: false,
            mode_odds: false,
            guessed_floor: true,
            planar: false,
        }
    }

    /// Whether a palm of such a coefficient, where its own is known, is known to be without friction.
    pub(super) fn frictionless(&self, friction: Option<f64>) -> bool {
        friction.or(self.friction) == Some(0.0)
    }

    pub(super) fn check(&self) -> Result<(), ContactEstimateError> {
        let above =
            [("gravity", self.gravity), ("size", self.size.unwrap_or(1.0)), ("floor", self.noise.floor)];
        let not_below = [
            ("friction", self.friction.unwrap_or(0.0)),
            ("noise of contacts", self.noise.contact),
            ("fixed noise of forces", self.noise.force_fixed),
            ("noise of forces as a share", self.noise.force_share),
            ("fixed noise of impulses", self.noise.impulse.map_or(0.0, |noise| noise.fixed)),
            ("noise of impulses as a share", self.noise.impulse.map_or(0.0, |noise| noise.share)),
        ];
        let wrong = |must, possible: fn(f64) -> bool| {
            move |&(what, value): &(&'static str, f64)| {
                let refused = ContactEstimateError::Setting { what, value, must };
                (!value.is_finite() || !possible(value)).then_some(refused)
            }
        };
        let first = above.iter().find_map(wrong("above zero", |x| x > 0.0));
        first.or_else(|| not_below.iter().find_map(wrong("not below zero", |x| x >= 0.0))).map_or(Ok(()), Err)
    }
}

pub(super) fn check(
    log: &ContactLog,
    modes: Option<&[[ContactMode; MOST_PALMS]]>,
    options: &ContactOptions,
) -> Result<(), ContactEstimateError> {
    let samples = log.times().len();
    if samples < 2 {
        return Err(ContactEstimateError::Short { samples });
    }
    if let Some(modes) = modes.filter(|modes| modes.len() != samples) {
        return Err(ContactEstimateError::Modes { found: modes.len(), samples });
    }
    let felt = |palm: &LoggedPalm| match palm.force_axes() {
        Some(SensedAxes::Three) => true,
        Some(SensedAxes::Normal) if options.frictionless(palm.friction()) => true,
        _ => read(palm, &options.noise).is_some(),
    };
    let lacks = log.palms().iter().position(|palm| !felt(palm));
    lacks.map_or(Ok(()), |palm| Err(ContactEstimateError::NoForce { palm: palm + 1 }))
}
