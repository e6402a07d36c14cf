//! What tells that modes no longer hold: quantities that are positive while they do.

use super::field::{Evaluated, Stretch};
use super::packed::Units;
use super::result::ContactEventKind as Kind;
use crate::ContactMode;
use crate::contacts::MOST_PALMS;

/// A guard below this share of what it was when the step began has the step searched.
const SUSPICIOUS: f64 = 0.3;

/// Two guards a contact, dimensionless; infinite where there is none.
pub(super) type Guards = [[f64; 2]; MOST_PALMS];

impl Stretch {
    /// Which events the two guards of contact `i` stand for.
    pub(super) fn kinds(&self, i: usize) -> [Kind; 2] {
        match self.modes[i] {
            ContactMode::Off => [Kind::Touches; 2],
            ContactMode::Slide => [Kind::Lifts, Kind::SlipEnds],
            ContactMode::Stick => [Kind::Lifts, Kind::ConeLeft],
        }
    }

    pub(super) fn guards(&self, now: &Evaluated, units: &Units) -> Guards {
        let mut guards = [[f64::INFINITY; 2]; MOST_PALMS];
        let weight = units.work / units.length;
        for (i, contact) in now.problem.contacts().iter().enumerate() {
            let force = now.reaction.map_or(glam::DVec3::NAN, |reaction| reaction.forces[i]);
            let normal = contact.n.dot(force);
            match self.modes[i] {
                ContactMode::Off => {
                    // A gap that opens is no contact, however small it is.
                    let closing = now.touch.rates[i].gap_rate < 0.0;
                    let gap = now.touch.contacts[i].gap / units.length;
                    guards[i][0] = if closing { gap } else { gap.max(f64::MIN_POSITIVE) };
                }
                ContactMode::Slide => {
                    guards[i][0] = normal / weight;
                    if contact.friction > 0.0 {
                        guards[i][1] = now.touch.rates[i].slip.dot(self.towards[i]) / units.speed;
                    }
                }
                ContactMode::Stick => {
                    let tangential = contact.in_tangent(force).length();
                    guards[i] = [normal / weight, (contact.friction * normal - tangential) / weight];
                }
            }
        }
        guards
    }
}

/// Whether a guard has come so near to zero inside of a step that the step must be searched.
pub(super) fn suspicious(now: &Guards, at_start: &Guards) -> bool {
    let pairs = now.iter().flatten().zip(at_start.iter().flatten());
    pairs.into_iter().any(|(now, start)| now.is_finite() && (*now <= 0.0 || *now < SUSPICIOUS * start))
}
