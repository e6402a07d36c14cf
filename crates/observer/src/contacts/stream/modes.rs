//! How probable contact modes are at the newest sample.
//!
//! A contact that the window took to stick has no slip in a motion that rests on that: its slip is asked of the motion in which it need not.

use super::front::Front;
use super::sample::{Contacts, StreamPalm};
use crate::contact_modes::{
    ContactFriction, ContactModes, ContactModesDoubt, ContactOdds, ContactSeen, LearnedFriction,
};
use crate::contacts::mode_odds::{mode_options, reading};
use crate::contacts::options::ContactOptions;
use crate::contacts::problem::Units;
use crate::contacts::record::Contact;
use crate::contacts::slips::{Moving, slip};
use nalgebra::Matrix3;
use object_dynamics::{ContactMode, MOST_PALMS};

/// Contact modes at a sample, from all samples up to it; off where a palm touches nothing, and of palms that there are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamModes {
    /// How probable they are, of each palm.
    pub odds: [ContactOdds; MOST_PALMS],
    /// The modes to act on: each changes only where another one is more probable than 0.75.
    pub decided: [ContactMode; MOST_PALMS],
    /// What contradicts that a palm's readings are as stated: its modes can be sure and wrong.
    pub doubts: [Option<ContactModesDoubt>; MOST_PALMS],
    /// Coefficients of friction that were not stated, where a palm has slid, or one of the same friction.
    pub frictions: [Option<LearnedFriction>; MOST_PALMS],
}

const OFF: ContactOdds = ContactOdds { off: 1.0, slide: 0.0, stick: 0.0 };
const SLIDES: ContactOdds = ContactOdds { off: 0.0, slide: 1.0, stick: 0.0 };

/// What tells them.
#[derive(Debug)]
pub(super) struct Modes {
    /// Of palms with friction, in their order.
    told: ContactModes,
    palms: Vec<usize>,
    seen: Vec<ContactSeen>,
    options: ContactOptions,
    /// m/s.
    speed: f64,
    /// Time of the sample before, or from one to the next while there is none, s.
    before: Result<f64, f64>,
}

impl Modes {
    /// Of contacts whose mean force is `typical`, N, at so many samples a second. None where a stated friction is none that has modes.
    pub(super) fn new(
        palms: &[StreamPalm],
        options: &ContactOptions,
        (units, typical, sample_rate): (&Units, f64, f64),
    ) -> Option<Box<Self>> {
        let friction = |palm: &StreamPalm| palm.friction.or(options.friction);
        let rough = palms.iter().enumerate().filter(|(_, palm)| !options.frictionless(palm.friction));
        let (palms, frictions): (Vec<usize>, Vec<ContactFriction>) = rough
            .map(|(i, palm)| {
                (i, friction(palm).map_or(ContactFriction::Alike { material: 0 }, ContactFriction::Known))
            })
            .unzip();
        let told = mode_options(&options.noise, units, typical);
        let told = ContactModes::every(1.0 / sample_rate, &frictions, told).ok()?;
        let seen = vec![ContactSeen::Off; palms.len()];
        let (speed, before) = (units.speed, Err(1.0 / sample_rate));
        Some(Box::new(Self { told, palms, seen, options: *options, speed, before }))
    }

    /// At the time `t`, s, with the motion that a palm's slip is asked of.
    pub(super) fn take<'a>(
        &mut self,
        t: f64,
        contacts: &Contacts,
        motion: impl Fn(usize) -> Option<&'a Front>,
    ) -> StreamModes {
        for (i, (palm, seen)) in self.palms.iter().zip(&mut self.seen).enumerate() {
            let Some(contact) = &contacts[*palm] else {
                *seen = ContactSeen::Off;
                continue;
            };
            let slip = motion(*palm).and_then(|front| slip(contact, &front.moving(), &self.options.noise));
            // Of a friction that nobody knows forces alone take any ratio that stays the same for sliding.
            *seen = match slip.is_some() || self.told.friction_told(i).is_some() {
                true => ContactSeen::Read(reading(contact, slip, (self.speed, self.options.noise.contact))),
                false => ContactSeen::Touches,
            };
        }
        let dt = self.before.map_or_else(|dt| dt, |before| t - before);
        self.before = Ok(t);
        // What is beyond reason is missing: modes go on as they are likely to.
        if self.told.push(dt, &self.seen).is_err() {
            self.seen.fill(ContactSeen::Missing);
            let _ = self.told.push(dt, &self.seen);
        }
        self.all(contacts)
    }

    fn all(&self, contacts: &Contacts) -> StreamModes {
        let touched = |contact: &Option<Contact>| if contact.is_some() { SLIDES } else { OFF };
        let mut all = StreamModes {
            odds: contacts.each_ref().map(touched),
            decided: contacts
                .each_ref()
                .map(|c| if c.is_some() { ContactMode::Slide } else { ContactMode::Off }),
            doubts: [None; MOST_PALMS],
            frictions: [None; MOST_PALMS],
        };
        for (i, palm) in self.palms.iter().enumerate() {
            all.odds[*palm] = self.told.odds(i).unwrap_or(OFF);
            all.decided[*palm] = self.told.label(i).unwrap_or(ContactMode::Off);
            all.frictions[*palm] = self.told.friction(i);
        }
        for doubt in self.told.doubts() {
            let contact = self.palms[doubt.contact];
            all.doubts[contact] = Some(ContactModesDoubt { contact, ..doubt });
        }
        all
    }
}

impl Front {
    /// For slips.
    fn moving(&self) -> Moving {
        let motion = self.motion();
        let state = motion.state;
        Moving {
            p_WCm: state.p_WCm,
            v_WCm: state.v_WCm,
            w_WO: state.w_WO,
            covariance: motion.covariance,
            beside: Matrix3::zeros(),
        }
    }
}
