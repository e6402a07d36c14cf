//! Probabilities of contact modes after an estimate: from forces, and slips of the estimated motion.

use super::noise::ContactNoiseLevel;
use super::problem::Units;
use super::record::{Contact, Record};
use super::slips::Known;
use crate::contact_modes::{
    ContactModesDoubt, ContactModesOptions, ContactOdds, ContactReading, ContactSeen, ContactSlip,
    LearnedFriction, whole_modes,
};
use nalgebra::Vector2;
use object_dynamics::{ContactMode, MOST_PALMS};

/// Natural times for which errors of slips last.
const LASTING: f64 = 0.5;
/// Least deviation of a force as a share of it.
const LEAST_FORCE: f64 = 3e-3;
/// Probability from which on a mode is sure.
const SURE: f64 = 0.99;

/// Probabilities of contact modes of an estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct EstimatedModes {
    /// At each sample, of each palm, given all samples; off where it touches nothing.
    pub odds: Vec<[ContactOdds; MOST_PALMS]>,
    /// Modes that the first solution took: those that were given, or those by the ratio of friction to normal force alone.
    pub by_ratio: Vec<[ContactMode; MOST_PALMS]>,
    /// Coefficients of friction, where a palm has slid, or one of the same friction.
    pub frictions: [Option<LearnedFriction>; MOST_PALMS],
    /// Probability that all palms with friction have one coefficient.
    pub one_friction: f64,
    /// What contradicts that readings are as stated, of each palm the clearest: its modes can be sure and wrong.
    pub doubts: Vec<ContactModesDoubt>,
}

const OFF: ContactOdds = ContactOdds { off: 1.0, slide: 0.0, stick: 0.0 };
const SLIDES: ContactOdds = ContactOdds { off: 0.0, slide: 1.0, stick: 0.0 };

impl EstimatedModes {
    /// Samples at which some palm touches in a mode that is less sure than 0.99.
    #[must_use]
    pub fn unsure(&self) -> usize {
        let open = |odds: &ContactOdds| odds.off.max(odds.slide).max(odds.stick) < SURE;
        self.odds.iter().filter(|all| all.iter().any(open)).count()
    }

    /// The most probable mode of each palm at each sample.
    #[must_use]
    pub fn most_probable(&self) -> Vec<[ContactMode; MOST_PALMS]> {
        let most = |of: &ContactOdds| match of {
            of if of.off >= of.slide.max(of.stick) => ContactMode::Off,
            of if of.stick > of.slide => ContactMode::Stick,
            _ => ContactMode::Slide,
        };
        self.odds.iter().map(|all| std::array::from_fn(|i| most(&all[i]))).collect()
    }
}

/// None where no palm has friction, or what is read is beyond reason.
pub(super) fn mode_odds(known: &Known, noise: &ContactNoiseLevel, units: &Units) -> Option<EstimatedModes> {
    let record = known.log;
    let mut odds = vec![[OFF; MOST_PALMS]; record.times.len()];
    let (mut palms, mut seen) = (Vec::new(), Vec::new());
    for palm in 0..MOST_PALMS {
        let contacts = || {
            record
                .contacts
                .iter()
                .enumerate()
                .filter_map(move |(k, all)| Some((k, all.iter().find(|c| c.palm == palm)?)))
        };
        if contacts().all(|(_, contact)| contact.frictionless) {
            contacts().for_each(|(k, _)| odds[k][palm] = SLIDES);
            continue;
        }
        let slips = known.slips(palm);
        let mut own = vec![ContactSeen::Off; record.times.len()];
        contacts().for_each(|(k, contact)| {
            own[k] = ContactSeen::Read(reading(contact, slips[k], (units.speed, record.deviation)))
        });
        palms.push(palm);
        seen.push(own);
    }
    if palms.is_empty() {
        return None;
    }
    let options = mode_options(noise, units, typical(record));
    let found = whole_modes(&record.times, &seen, &options).ok()?;
    let doubts =
        found.doubts.iter().map(|of| ContactModesDoubt { contact: palms[of.contact], ..*of }).collect();
    let mut frictions = [None; MOST_PALMS];
    for ((palm, own), friction) in palms.into_iter().zip(&found.odds).zip(&found.frictions) {
        frictions[palm] = *friction;
        odds.iter_mut().zip(own).for_each(|(all, own)| all[palm] = *own);
    }
    let by_ratio = known.modes.to_vec();
    Some(EstimatedModes { odds, by_ratio, frictions, one_friction: found.one_friction, doubts })
}

/// The same where there is no motion along y: that there is no slip along it says nothing.
fn along_plane(slip: ContactSlip, contact: &Contact, speed: f64) -> ContactSlip {
    let across = Vector2::from(contact.tangents().map(|tangent| speed * tangent.y));
    ContactSlip { covariance: slip.covariance + across * across.transpose(), ..slip }
}

/// What is read of a contact with its slip; `speed` is the natural one, m/s, and `place` the deviation of a contact, m: the force is taken apart by the
/// normal there, which on a curved palm is off with it.
pub(super) fn reading(
    contact: &Contact,
    slip: Option<ContactSlip>,
    (speed, place): (f64, f64),
) -> ContactReading {
    let [a, b] = contact.tangents();
    let slip = slip.map(|slip| if contact.planar { along_plane(slip, contact, speed) } else { slip });
    ContactReading {
        normal_force: contact.f.dot(contact.n),
        friction: Vector2::new(contact.f.dot(a), contact.f.dot(b)),
        force_deviation: contact
            .f_deviation
            .hypot(contact.turning(place) * contact.f.length())
            .max(LEAST_FORCE * contact.f.length())
            .max(f64::MIN_POSITIVE.sqrt()),
        slip,
        touches: true,
    }
}

/// Of contacts whose mean force is `typical`, N.
pub(super) fn mode_options(noise: &ContactNoiseLevel, units: &Units, typical: f64) -> ContactModesOptions {
    let unloaded = noise.force_fixed.max(1e-9).max(1e-6 * typical);
    let options = ContactModesOptions::new(units.speed, unloaded, typical);
    ContactModesOptions { slip_errors_last: LASTING * units.time(), ..options }
}

/// Mean force of all contacts, N.
pub(super) fn typical(record: &Record) -> f64 {
    let forces = || record.contacts.iter().flatten().map(|contact| contact.f.length());
    (forces().sum::<f64>() / forces().count().max(1) as f64).max(1e-9)
}
