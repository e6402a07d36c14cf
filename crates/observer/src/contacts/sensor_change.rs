//! What a constant of the sensors that is not what it was taken for makes of a contact.

use super::body::Body;
use super::changed::{ChangeBy, Felt};
use super::noise::ContactNoiseLevel;
use super::problem::Units;
use super::samples::Deviations;
use super::slopes::slopes;
use super::state::Motion;
use crate::faults::Constant;
use crate::random::Normal;
use glam::DVec3;
use object_dynamics::{ContactLog, LoggedPalm};

/// Seed of noise that is drawn to see what of the information it makes.
const SEED: u64 = 0xd31a;
/// Natural times on either side over which slopes of forces are taken.
const SMOOTH: f64 = 0.12;

/// A change of what a log says, by a constant of the sensors that is not what it was taken for.
pub(super) struct Change<'a> {
    pub(super) fault: Constant,
    /// Near which the change is small: forces that are late are taken from the samples nearest to when they were by it.
    pub(super) value: f64,
    pub(super) by: f64,
    /// Sine and versed sine of that, of a palm that is tilted.
    pub(super) turn: [f64; 2],
    pub(super) log: &'a ContactLog,
    /// Motion at all samples, positions from the record's origin.
    pub(super) motions: &'a [(Motion, Deviations)],
    pub(super) body: &'a Body,
    /// What the forces change by in a unit of time, N/s, by palm and sample; and what is taken for that from `value` on. Of contacts that are late
    /// what they move by in axes of their palms, m/s.
    pub(super) slopes: [&'a [Vec<DVec3>]; 2],
    /// Of contacts.
    pub(super) origin: DVec3,
}

impl Change<'_> {
    /// The palm whose contacts alone it changes, from 0.
    pub(super) fn palm(&self) -> Option<usize> {
        match self.fault {
            Constant::ForceGain { palm }
            | Constant::ForceBias { palm }
            | Constant::ContactOffset { palm, .. }
            | Constant::PalmTilt { palm, .. } => palm.checked_sub(1),
            _ => None,
        }
    }

    /// What a contact is different by then; none where it is as it was.
    pub(super) fn of(&self, contact: &Felt) -> Option<ChangeBy> {
        let (palm, k) = (&self.log.palms()[contact.palm], contact.sample);
        let (number, by) = (contact.palm + 1, self.by);
        let none = ChangeBy::default();
        let by = match self.fault {
            Constant::ForceGain { palm } if palm == number => ChangeBy { f: contact.f * by, ..none },
            Constant::ForceBias { palm } if palm == number => ChangeBy { f: contact.n * by, ..none },
            Constant::ForceDelay => ChangeBy { f: self.later(contact), ..none },
            Constant::ContactDelay => {
                let [own, along] = self.slopes.map(|slopes| slopes[contact.palm][k]);
                let moved = own * self.value + along * (by - self.value);
                ChangeBy { c: palm.motion(k).pose.R_WP * moved, ..none }
            }
            Constant::ContactOffset { palm: of, axis } if of == number => {
                ChangeBy { c: palm.motion(k).pose.R_WP * (DVec3::AXES[axis] * by), ..none }
            }
            Constant::PalmTilt { palm: of, axis } if of == number => {
                let pose = palm.motion(k).pose;
                let (about, [sine, versine]) = (pose.R_WP * DVec3::AXES[axis], self.turn);
                let turned = |v: DVec3| {
                    let across = about.cross(v);
                    across * sine + about.cross(across) * versine
                };
                let c = turned(contact.c - (pose.p_WP - self.origin));
                ChangeBy { c, n: turned(contact.n), f: turned(contact.f) }
            }
            Constant::Friction if contact.frictionless => {
                let motion = &self.motions[k].0;
                let w = self.body.turn(motion.q, motion.L).w;
                let slip = motion.v + w.cross(contact.c - motion.p) - contact.u;
                let against = -slip.reject_from_normalized(contact.n).normalize_or_zero();
                ChangeBy { f: against * (by * contact.f.dot(contact.n)), ..none }
            }
            _ => return None,
        };
        Some(by)
    }

    /// What the force is more that a palm tells later than at a contact. From whole samples, as far as there are: what is between two of them has
    /// less noise than each.
    fn later(&self, contact: &Felt) -> DVec3 {
        let k = contact.sample;
        let (palm, times) = (&self.log.palms()[contact.palm], self.log.times());
        let after = times.partition_point(|t| *t < times[k] + self.value).min(times.len() - 1);
        let before = after.saturating_sub(1);
        let off = |k: usize, of: usize| times[k] + self.value - times[of];
        let nearest = if off(k, before).abs() < off(k, after).abs() { before } else { after };
        let at = if force(palm, nearest).is_some() { nearest } else { k };
        let told = |k: usize| force(palm, k).unwrap_or_default();
        let [own, along] = self.slopes.map(|slopes| slopes[contact.palm][at]);
        let rest = times[k] + self.value - times[at];
        let more = told(at) - told(k) + own * rest + along * (self.by - self.value);
        if contact.frictionless { more.project_onto_normalized(contact.n) } else { more }
    }
}

/// Of a palm that is touched, N.
fn force(palm: &LoggedPalm, k: usize) -> Option<DVec3> {
    palm.touch(k).and_then(|_| palm.force(k)).map(|force| force.vector)
}

/// What the forces change by in a unit of time, N/s, by palm and sample.
pub(super) fn slopes_of_forces(log: &ContactLog, units: &Units) -> Vec<Vec<DVec3>> {
    slopes_of(log, units, force)
}

/// What contacts move by in a unit of time in axes of their palms, m/s, by palm and sample: of the samples on both sides at least.
pub(super) fn slopes_of_contacts(log: &ContactLog, units: &Units) -> Vec<Vec<DVec3>> {
    let place = |palm: &LoggedPalm, k: usize| {
        let pose = palm.motion(k).pose;
        palm.touch(k).map(|touch| pose.R_WP.conjugate() * (touch.p_WC - pose.p_WP))
    };
    slopes_within(log, reach_of_contacts(log, units), place)
}

/// The same of noise that is drawn in place of the contacts, of so large a `deviation`, m, along the palms.
pub(super) fn slopes_of_contact_noise(log: &ContactLog, units: &Units, deviation: f64) -> Vec<Vec<DVec3>> {
    let mut random = Normal::seeded(SEED);
    let drawn = |palm: &LoggedPalm, k: usize| {
        let drawn = DVec3::new(random.draw(), random.draw(), 0.0);
        palm.touch(k).map(|_| drawn * deviation)
    };
    slopes_within(log, reach_of_contacts(log, units), drawn)
}

/// Over which slopes of contacts are taken on either side, s.
fn reach_of_contacts(log: &ContactLog, units: &Units) -> f64 {
    let interval = log.duration() / (log.times().len() - 1).max(1) as f64;
    (SMOOTH * units.time()).max(1.5 * interval)
}

/// The same of noise that is drawn in place of the forces.
pub(super) fn slopes_of_noise(log: &ContactLog, units: &Units, noise: &ContactNoiseLevel) -> Vec<Vec<DVec3>> {
    let mut random = Normal::seeded(SEED);
    slopes_of(log, units, |palm, k| {
        let drawn = DVec3::new(random.draw(), random.draw(), random.draw());
        force(palm, k).map(|force| drawn * noise.force(force))
    })
}

/// Of `value` at each: of the line through those around, as far as the palm is touched. The noise of two neighbours would be taken for slope.
fn slopes_of(
    log: &ContactLog,
    units: &Units,
    value: impl FnMut(&LoggedPalm, usize) -> Option<DVec3>,
) -> Vec<Vec<DVec3>> {
    slopes_within(log, SMOOTH * units.time(), value)
}

/// The same of those at most `reach` away, s.
fn slopes_within(
    log: &ContactLog,
    reach: f64,
    mut value: impl FnMut(&LoggedPalm, usize) -> Option<DVec3>,
) -> Vec<Vec<DVec3>> {
    let of = |palm| {
        let values: Vec<Option<DVec3>> = (0..log.times().len()).map(|k| value(palm, k)).collect();
        slopes(log.times(), &values, reach)
    };
    log.palms().iter().map(of).collect()
}
