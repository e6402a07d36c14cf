//! What tells that modes no longer hold: quantities that are positive while they do.

use super::field::{Evaluated, Stretch};
use super::packed::Units;
use super::result::ContactEventKind as Kind;
use crate::ContactMode;
use crate::contacts::{FULFILLED, MOST_PALMS};

/// A guard below this share of what it was when the step began has the step searched.
const SUSPICIOUS: f64 = 0.3;

/// Over-constrained sticking holds as long as the palms let it and some forces are in their cones: a guard that jumps.
const HOLDS: f64 = 1e-3;
/// Forces within this share of the weight are on the edge of their cone.
const SLACK: f64 = 1e-7;

/// A contact that has begun to slide is no longer driven when it is braked by this share of the natural acceleration.
const DRIVEN: f64 = 1e-5;

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
                        guards[i][1] = self.slip_guard(i, now, units);
                    }
                }
                ContactMode::Stick if now.reaction.is_some_and(|reaction| !reaction.unique) => {
                    let tangential = contact.in_tangent(force).length();
                    let held =
                        tangential - contact.friction * normal <= SLACK * weight && normal >= -SLACK * weight;
                    let agree = 1.0 - now.reaction.map_or(f64::NAN, |reaction| reaction.unmet) / FULFILLED;
                    guards[i][1] = HOLDS * if held { agree } else { -1.0 };
                }
                ContactMode::Stick => {
                    let tangential = contact.in_tangent(force).length();
                    guards[i] = [normal / weight, (contact.friction * normal - tangential) / weight];
                }
            }
        }
        guards
    }

    /// The slip along its direction when the step began; of a contact that has just begun to slide, what drives it.
    fn slip_guard(&self, i: usize, now: &Evaluated, units: &Units) -> f64 {
        let slip = now.touch.rates[i].slip;
        match &now.reaction {
            Some(reaction) if self.begins(i, &now.problem, slip, units) => {
                let rate = now.problem.contacts()[i].in_tangent(now.problem.slip_rate(i, reaction));
                DRIVEN + now.directions[i].dot(rate) / (units.speed * units.rate)
            }
            _ => slip.dot(self.towards[i]) / units.speed,
        }
    }
}

/// Whether a guard has come so near to zero inside of a step that the step must be searched.
pub(super) fn suspicious(now: &Guards, at_start: &Guards) -> bool {
    let pairs = now.iter().flatten().zip(at_start.iter().flatten());
    pairs.into_iter().any(|(now, start)| now.is_finite() && (*now <= 0.0 || *now < SUSPICIOUS * start))
}
