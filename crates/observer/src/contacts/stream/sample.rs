//! What a stream is told at a sample.

use super::estimate::StreamError;
use crate::contacts::options::ContactOptions;
use crate::contacts::record::{Contact, Wrench, add_noise, wrench};
use contact_kinematics::{PalmSurface, SurfacePose};
use glam::DVec3;
use nalgebra::Matrix6;
use object_dynamics::{MOST_PALMS, MeasuredMotion, Touch};

/// A palm of a stream: what does not change from sample to sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamPalm {
    /// Its shape.
    pub surface: PalmSurface,
    /// Coefficient of friction between it and the object, where it is known.
    pub friction: Option<f64>,
}

/// What a palm senses at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmSensed {
    /// Where it is.
    pub pose: SurfacePose,
    /// Velocity of its frame's origin, m/s, and its angular velocity, rad/s, world; from the poses where it is not measured.
    pub twist: Option<[DVec3; 2]>,
    /// Contact point in the world, m; none while the object does not touch it.
    pub contact: Option<DVec3>,
    /// Contact force on the object.
    pub force: ForceReading,
}

/// A contact force as it is measured, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ForceReading {
    /// Along the palm's normal, into the object: enough where there is no friction.
    Normal(f64),
    /// All of it, world axes.
    Three(DVec3),
}

/// A sample that was checked.
#[derive(Clone, Copy, Debug)]
pub(super) struct Raw {
    /// Counted from the stream's first one.
    pub(super) number: usize,
    pub(super) t: f64,
    /// As many as there are palms.
    pub(super) palms: [Option<PalmSensed>; MOST_PALMS],
}

/// Contacts of all palms at a sample.
pub(super) type Contacts = [Option<Contact>; MOST_PALMS];

/// Forces of all palms at a sample and their noise, with moments about the world's origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Felt {
    pub(super) number: usize,
    pub(super) t: f64,
    pub(super) wrench: Wrench,
    /// Covariance of the wrench's impulse over one second in which the noise does not change.
    pub(super) noise: Matrix6<f64>,
    pub(super) touching: [bool; MOST_PALMS],
}

impl ForceReading {
    fn value(&self) -> DVec3 {
        match self {
            Self::Normal(f) => DVec3::splat(*f),
            Self::Three(f) => *f,
        }
    }
}

impl PalmSensed {
    /// Refuses what is no number, which would spread from here to everything.
    pub(super) fn check(&self, palm: usize, t: f64) -> Result<(), StreamError> {
        let [v, w] = self.twist.unwrap_or_default();
        let q = self.pose.R_WP;
        let readings = [
            ("position", self.pose.p_WP),
            ("orientation", DVec3::splat(q.length_squared())),
            ("velocity", v),
            ("angular velocity", w),
            ("contact", self.contact.unwrap_or_default()),
            ("force", self.force.value()),
        ];
        let wrong = |(what, v): (&'static str, DVec3)| {
            v.to_array().into_iter().find(|c| !c.is_finite()).map(|value| (what, value))
        };
        match readings.into_iter().find_map(wrong) {
            Some((what, value)) => Err(StreamError::Reading { what, palm, t, value }),
            None => Ok(()),
        }
    }

    /// The contact, from the world's origin; none while there is none, or where the palm's surface has no normal.
    fn felt(&self, i: usize, palm: &StreamPalm, options: &ContactOptions) -> Option<Contact> {
        let (touch, _) = Touch::on(palm.surface, &self.pose.at_rest(), self.contact?)?;
        let force = match self.force {
            ForceReading::Normal(f) => f * touch.n.get(),
            ForceReading::Three(f) => f,
        };
        let [v_WP, w_WP] = self.twist.unwrap_or_default();
        let motion = MeasuredMotion { pose: self.pose, v_WP, w_WP };
        Some(Contact::new(
            i,
            palm.surface,
            &touch,
            &motion,
            (force, options.noise.force(force)),
            options.frictionless(palm.friction),
            options.planar,
        ))
    }
}

impl Raw {
    /// The contacts of all palms, from the world's origin, and what they make together.
    pub(super) fn felt(&self, palms: &[StreamPalm], options: &ContactOptions) -> (Contacts, Felt) {
        let mut felt = Felt {
            number: self.number,
            t: self.t,
            wrench: Wrench::default(),
            noise: Matrix6::zeros(),
            touching: [false; MOST_PALMS],
        };
        let mut contacts = [None; MOST_PALMS];
        for (i, (palm, sensed)) in palms.iter().zip(&self.palms).enumerate() {
            contacts[i] = sensed.as_ref().and_then(|sensed| sensed.felt(i, palm, options));
            if let Some(contact) = &contacts[i] {
                felt.wrench = felt.wrench + wrench([contact]);
                add_noise(&mut felt.noise, contact, options.noise.contact, 1.0);
                felt.touching[i] = true;
            }
        }
        (contacts, felt)
    }
}
