//! Contact modes for the conditions of a second solution, from the probabilities that the first one left.

use super::mode_odds::EstimatedModes;
use super::samples::Deviations;
use super::verdict::UNEXPLAINED;
use crate::rigid::logarithm;
use glam::{DQuat, DVec3};
use object_dynamics::{BodyState, ContactMode, MOST_PALMS};

/// Probability with which a contact must stick to be taken to do so.
const SURE: f64 = 0.99;
/// The same to slide, where it was taken to stick.
const SLIDES: f64 = 0.5;

/// Modes in which a contact sticks where it does so with more than 0.99 for `time` on either side, s, and where it was taken to before and does not
/// more probably slide; elsewhere it slides.
///
/// A contact that slides and is said to stick is an error of its slip; one that sticks and is said to slide loses two conditions.
pub(super) fn surer(
    times: &[f64],
    modes: &[[ContactMode; MOST_PALMS]],
    found: &EstimatedModes,
    time: f64,
) -> Vec<[ContactMode; MOST_PALMS]> {
    let mut again = modes.to_vec();
    for palm in 0..MOST_PALMS {
        let open = |k: usize| modes[k][palm] != ContactMode::Off && found.odds[k][palm].stick <= SURE;
        let near = near(times, open, time);
        for (k, mode) in again.iter_mut().map(|modes| &mut modes[palm]).enumerate() {
            let kept = *mode == ContactMode::Stick && found.odds[k][palm].slide < SLIDES;
            *mode = match *mode {
                ContactMode::Off => ContactMode::Off,
                _ if kept || !near[k] => ContactMode::Stick,
                _ => ContactMode::Slide,
            };
        }
    }
    again
}

/// Samples at which a second solution, whose modes are surer, is away from the first by more than that one's deviations explain.
///
/// If both sets of modes are right it is within them, since it has all conditions of the first but a few and more (Hausman's test of
/// two estimates, one of which assumes more). Otherwise one of them has wrong ones, and it is not known which.
pub(super) fn apart(first: &[BodyState], deviations: &[Deviations], second: &[BodyState]) -> Vec<bool> {
    let turned = |of: &[BodyState], k: usize| of[k].R_WO * of[0].R_WO.inverse();
    let one = |k: usize| {
        let (a, b) = (&first[k], &second[k]);
        // Of the first sample it is none but for rounding, and so is its deviation.
        let turn = if k > 0 { turned(first, k) * turned(second, k).inverse() } else { DQuat::IDENTITY };
        let differences = [a.p_WCm - b.p_WCm, a.v_WCm - b.v_WCm, a.w_WO - b.w_WO, logarithm(turn)];
        let beyond = |(d, deviation): (DVec3, DVec3)| d.abs().cmpgt(deviation * UNEXPLAINED).any();
        differences.into_iter().zip(deviations[k]).any(beyond)
    };
    (0..first.len()).map(one).collect()
}

/// Whether a sample is within `time` of one that is `open`.
fn near(times: &[f64], open: impl Fn(usize) -> bool, time: f64) -> Vec<bool> {
    let (mut before, mut after) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut near = vec![false; times.len()];
    for (k, near) in near.iter_mut().enumerate() {
        if open(k) {
            before = times[k];
        }
        *near = times[k] - before <= time;
    }
    for (k, near) in near.iter_mut().enumerate().rev() {
        if open(k) {
            after = times[k];
        }
        *near |= after - times[k] <= time;
    }
    near
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact_modes::ContactOdds;
    use ContactMode::{Off, Slide, Stick};

    /// A quaternion's sign says nothing, nor do the first sample's axes.
    #[test]
    fn solutions_are_apart_where_any_number_is_beyond_what_the_first_may_be_off_by() {
        let at = |v: f64, turn: f64| BodyState {
            p_WCm: DVec3::ZERO,
            v_WCm: DVec3::X * v,
            R_WO: DQuat::from_rotation_y(turn),
            w_WO: DVec3::ZERO,
        };
        let first = [at(0.0, 0.2), at(0.0, 0.3), at(0.0, 0.3), at(0.0, 0.3)];
        let second = [at(0.04, 0.7), at(-0.05, 0.8), at(0.0, 0.8), at(0.0, 0.86)];
        let mut negated = second;
        negated[1..].iter_mut().for_each(|state| state.R_WO = -state.R_WO);
        let of = [0.01; 4].map(DVec3::splat);
        let deviations = [[of[0], of[1], of[2], DVec3::ZERO], of, of, of];
        for second in [second, negated] {
            assert_eq!(apart(&first, &deviations, &second), [false, true, false, true]);
        }
    }

    #[test]
    fn what_is_sure_for_long_enough_sticks_and_what_stuck_is_kept_unless_it_slides() {
        let odds = |stick: f64| ContactOdds { off: 0.0, slide: 1.0 - stick, stick };
        let sticks = [1.0, 1.0, 1.0, 0.9, 1.0, 0.7, 0.3, 1.0];
        let before = [Slide, Slide, Slide, Slide, Slide, Stick, Stick, Off];
        let times: Vec<f64> = (0..8).map(|k| 1e-3 * f64::from(k)).collect();
        let all = |own| [own, Off, Off, Off, Off];
        let odds = sticks.map(|of| [odds(of); MOST_PALMS]).to_vec();
        let found = EstimatedModes {
            odds,
            by_ratio: Vec::new(),
            frictions: [None; MOST_PALMS],
            one_friction: 1.0,
            doubts: Vec::new(),
        };
        let again = surer(&times, &before.map(all), &found, 1.5e-3);
        assert_eq!(again, [Stick, Stick, Slide, Slide, Slide, Stick, Slide, Off].map(all));
    }
}
