//! Gaps of open contacts inside of a step: none may close and open again unseen.
//!
//! In flight nothing limits a step but the body's own motion: palms may come and go within it, and so may the body's corners. Steps are kept
//! so short that gap and rate at both ends tell what lies between.

use super::field::{Evaluated, Stretch};
use super::packed::Units;
use crate::ContactMode;
use crate::contacts::{ContactScene, MOST_PALMS};
use contact_kinematics::{PalmSurface, SupportFunction};

/// Angle by which body and palms together may turn within a step while a contact is open, rad. The cubic through both ends is then wrong by
/// less than 2e-4 of what the gap swings by, on an eighth of the step by less than 1e-7.
const TURN: f64 = 0.5;

/// Gap, m, and its rate, m/s, of each open contact.
pub(super) type Gaps = [Option<[f64; 2]>; MOST_PALMS];

impl Stretch {
    pub(super) fn gaps(&self, now: &Evaluated) -> Gaps {
        let mut gaps: Gaps = [None; MOST_PALMS];
        for (i, (contact, rates)) in now.touch.contacts.iter().zip(&now.touch.rates).enumerate() {
            gaps[i] = (self.modes[i] == ContactMode::Off).then_some([contact.gap, rates.gap_rate]);
        }
        gaps
    }

    /// The longest step that is taken while a contact is open, s.
    pub(super) fn longest_step<S: SupportFunction>(
        &self,
        scene: &ContactScene<S>,
        now: &Evaluated,
        units: &Units,
    ) -> f64 {
        let body = &now.state.body;
        let mut quickest: f64 = 0.0;
        for (i, palm) in scene.palms().iter().enumerate() {
            if self.modes[i] != ContactMode::Off {
                continue;
            }
            let state = &now.touch.palms[i];
            // Past what is round directions change without a turn: by the way over the distance of the centres at least.
            let past = match palm.surface {
                PalmSurface::Plane => 0.0,
                _ => (body.v_WCm - state.v_WP).length() / (0.5 * units.length),
            };
            quickest = quickest.max(palm.drive.quickness(now.state.t) + state.w_WP.length() + past);
        }
        let quickest = quickest + body.w_WO.length();
        if quickest > 0.0 && self.modes.contains(&ContactMode::Off) { TURN / quickest } else { f64::INFINITY }
    }
}

/// Whether a gap that is open at both ends of `h` seconds may have closed between.
pub(super) fn any_dips(before: &Gaps, after: &Gaps, h: f64) -> bool {
    before.iter().zip(after).any(|(before, after)| match (before, after) {
        (Some(before), Some(after)) => dips(*before, *after, h),
        _ => false,
    })
}

/// Whether the cubic through gaps and rates at both ends falls to zero between, or to half of what it is there.
pub(super) fn dips([a, va]: [f64; 2], [b, vb]: [f64; 2], h: f64) -> bool {
    if va >= 0.0 || vb <= 0.0 {
        return false;
    }
    let (c1, c2, c3) = (va * h, 3.0 * (b - a) - (2.0 * va + vb) * h, 2.0 * (a - b) + (va + vb) * h);
    // Where its rate passes through zero upwards; there is one, since it does between both ends.
    let root = c2 + (c2 * c2 - 3.0 * c1 * c3).max(0.0).sqrt();
    let s = if root > 0.0 { (-c1 / root).clamp(0.0, 1.0) } else { 0.5 };
    a + s * (c1 + s * (c2 + s * c3)) <= 0.5 * a.min(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_that_falls_below_zero_between_is_seen() {
        let gap = |t: f64, least: f64| [least + (t - 0.3) * (t - 0.3), 2.0 * (t - 0.3)];
        assert!(dips(gap(0.0, -1e-3), gap(1.0, -1e-3), 1.0));
        assert!(!dips(gap(0.0, 0.1), gap(1.0, 0.1), 1.0), "more than half of the lower end");
        assert!(!dips(gap(0.4, -1e-3), gap(1.0, -1e-3), 0.6), "it opens all along");
        let whole = |t: f64| [0.1 + (7.0 * t).cos(), -7.0 * (7.0 * t).sin()];
        assert!(dips(whole(0.2), whole(0.7), 0.5));
    }
}
