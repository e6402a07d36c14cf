//! Modes of a whole log: what comes after a sample counts as much as what came before it.
//!
//! Given the friction a contact is a chain, and forward and backward messages give its modes at every sample exactly. Frictions are
//! weighed by the evidence of the whole log, under two hypotheses that are weighed as well: that all contacts have one
//! friction, and that each has its own.

use super::classifier::ContactOdds;
use super::doubt::ContactModesDoubt;
use super::error::ContactModesError;
use super::friction::{ALIKE, Cell, LearnedFriction, guessed, learned, soften, together, values};
use super::options::ContactModesOptions;
use super::passage::{AtFriction, Pace, Passage};
use super::reading::{ContactSeen, Place};

/// Frictions whose probability is below this share of the most probable one's are left out of the modes.
const FAINT: f64 = 1e-4;
/// Frictions of a contact at most that modes are made for: of a contact that never slides neighbours count as one.
const MOST: usize = 24;

/// What a whole log tells of the modes of its contacts.
#[derive(Clone, Debug, PartialEq)]
pub struct WholeModes {
    /// For each contact its modes at each sample, given all samples.
    pub odds: Vec<Vec<ContactOdds>>,
    /// Of each contact, where it, or one of the same material, has slid for 10 ms with slips read and a probability of 0.99.
    pub frictions: Vec<Option<LearnedFriction>>,
    /// Probability that all contacts have one friction.
    pub one_friction: f64,
    /// What contradicts that readings are as stated, of each contact the clearest, as [`ContactModes::doubts`](super::ContactModes::doubts) has it.
    pub doubts: Vec<ContactModesDoubt>,
}

/// Tells the modes of contacts at all samples of a log from all of them, the friction unknown (from 0.02 to 2).
///
/// `times` are those of the samples, s; `seen` has for each contact what is read of it at each sample, slips with errors that are independent of
/// those of other contacts.
///
/// # Errors
/// Where there is no contact, time does not go on, numbers of samples differ, an option is not usable, or a reading is not a number, has
/// no noise or is beyond reason.
pub fn whole_modes(
    times: &[f64],
    seen: &[Vec<ContactSeen>],
    options: &ContactModesOptions,
) -> Result<WholeModes, ContactModesError> {
    check(times, seen, options)?;
    let pace = Pace::new(times, options);
    let frictions = values();
    let passages: Vec<Passage> = seen.iter().map(|seen| Passage::new(seen, &pace, options)).collect();
    let at: Vec<AtFriction> = frictions.iter().map(|friction| pace.at(*friction)).collect();
    let evidence: Vec<Vec<f64>> = passages.iter().map(|passage| passage.evidence(&pace, &at)).collect();
    drop(at);
    let (one_friction, weights) = weigh(&evidence);
    let (mut odds, mut guesses) = (Vec::new(), Vec::new());
    for (passage, weights) in passages.iter().zip(&weights) {
        let mut sums = vec![[0.0; 3]; times.len()];
        let few = fewer(&frictions, weights);
        let cells: Vec<Cell> =
            few.iter().map(|(friction, weight)| passage.add(&pace, *friction, *weight, &mut sums)).collect();
        let all: f64 = few.iter().map(|(_, weight)| weight).sum();
        guesses.push(guessed(few.iter().map(|(_, weight)| weight / all).zip(&cells)));
        odds.push(sums.into_iter().map(normal).collect::<Vec<_>>());
    }
    let slid: Vec<f64> = odds.iter().zip(seen).map(|(odds, seen)| pace.slid(odds, seen)).collect();
    let frictions: Vec<Option<LearnedFriction>> = if one_friction > 0.5 {
        let any = slid.iter().copied().fold(0.0, f64::max);
        vec![learned(together(guesses.into_iter()), any); seen.len()]
    } else {
        guesses.into_iter().zip(&slid).map(|(guess, slid)| learned(guess, *slid)).collect()
    };
    let doubts = seen.iter().enumerate().filter_map(|(contact, seen)| {
        let friction = frictions[contact].map(|learned| learned.coefficient);
        pace.left(&odds[contact], seen, friction, options).doubt(contact, options.slip_errors_last > 0.0)
    });
    let doubts = doubts.collect();
    Ok(WholeModes { odds, frictions, one_friction, doubts })
}

fn normal(sums: [f64; 3]) -> ContactOdds {
    let all: f64 = sums.iter().sum();
    let [off, slide, stick] = sums.map(|sum| sum / all);
    ContactOdds { off, slide, stick }
}

/// Probability that all contacts have one friction, and the weights of the frictions for each contact, which sum to one.
///
/// Of one friction all evidences multiply, and one prior counts; of one for each contact each has a prior of its own.
fn weigh(evidence: &[Vec<f64>]) -> (f64, Vec<Vec<f64>>) {
    let count = evidence[0].len();
    let sums: Vec<f64> = (0..count).map(|k| evidence.iter().map(|logs| logs[k]).sum()).collect();
    let soft = |mut logs: Vec<f64>| (soften(&mut logs), logs);
    let (together, shared) = soft(sums);
    let apart: Vec<(f64, Vec<f64>)> = evidence.iter().map(|logs| soft(logs.clone())).collect();
    // Each mean over the grid is the evidence of a hypothesis with a prior that is even over it.
    let even = (count as f64).ln();
    let odds = (ALIKE / (1.0 - ALIKE)).ln() + (together - even)
        - apart.iter().map(|(log, _)| log - even).sum::<f64>();
    let one = if evidence.len() > 1 { 1.0 / (1.0 + (-odds).exp()) } else { 1.0 };
    let mixed = |(_, own): &(f64, Vec<f64>)| {
        own.iter().zip(&shared).map(|(own, shared)| one * shared + (1.0 - one) * own).collect()
    };
    (one, apart.iter().map(mixed).collect())
}

/// The frictions that count, with their weights; neighbours are taken together where they are many.
fn fewer(frictions: &[f64], weights: &[f64]) -> Vec<(f64, f64)> {
    let most = weights.iter().copied().fold(0.0, f64::max);
    let counts: Vec<(f64, f64)> = frictions
        .iter()
        .zip(weights)
        .filter(|(_, weight)| **weight > FAINT * most)
        .map(|(friction, weight)| (*friction, *weight))
        .collect();
    counts
        .chunks(counts.len().div_ceil(MOST))
        .map(|group| {
            let sum: f64 = group.iter().map(|(_, weight)| weight).sum();
            (group.iter().map(|(friction, weight)| friction * weight).sum::<f64>() / sum, sum)
        })
        .collect()
}

fn check(
    times: &[f64],
    seen: &[Vec<ContactSeen>],
    options: &ContactModesOptions,
) -> Result<(), ContactModesError> {
    options.check()?;
    if seen.is_empty() {
        return Err(ContactModesError::NoContact);
    }
    for (k, pair) in times.windows(2).enumerate() {
        let value = pair[1] - pair[0];
        if !(value > 0.0 && value < super::classifier::LONGEST) {
            return Err(ContactModesError::TimeStep { sample: k + 1, value });
        }
    }
    for (contact, seen) in seen.iter().enumerate() {
        if seen.len() != times.len() {
            let (found, samples) = (seen.len(), times.len());
            return Err(ContactModesError::Samples { contact, found, samples });
        }
        for (sample, seen) in seen.iter().enumerate() {
            if let ContactSeen::Read(reading) = seen {
                reading.check(Place { contact, sample }, options)?;
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::{ContactFriction, ContactModes, ContactReading, ContactSlip};
    use super::*;
    use crate::random::Normal;
    use nalgebra::{Matrix2, Vector2};

    const DT: f64 = 1e-3;
    const SLIP: f64 = 2e-3;

    fn options() -> ContactModesOptions {
        ContactModesOptions::new(0.6, 0.01, 1.0)
    }

    fn times(count: usize) -> Vec<f64> {
        (0..count).map(|k| 2.0 + DT * k as f64).collect()
    }

    /// 1 N along the normal with noise of 2 %, slips with white noise of 2 mm/s.
    fn read(ratio: f64, slip: f64, normal: &mut Normal) -> ContactSeen {
        let mut draw = || normal.draw();
        let noise = Vector2::new(draw(), draw()) * 0.02;
        let velocity = Vector2::new(-slip + SLIP * draw(), SLIP * draw());
        ContactSeen::Read(ContactReading {
            normal_force: 1.0 + 0.02 * draw(),
            friction: Vector2::new(ratio, 0.0) + noise,
            force_deviation: 0.02,
            slip: Some(ContactSlip { velocity, covariance: Matrix2::identity() * (SLIP * SLIP) }),
            touches: true,
        })
    }

    /// Sticks with a ratio that grows up to the friction, and slides from the middle on.
    fn begins_to_slide(friction: f64, count: usize, seed: u64) -> Vec<ContactSeen> {
        let mut normal = Normal::seeded(seed);
        let half = count as f64 / 2.0;
        let at = |k: usize| {
            let after = k as f64 - half;
            if after < 0.0 {
                (friction * (0.4 + 0.6 * k as f64 / half), 0.0)
            } else {
                (friction, 1e-3 * after)
            }
        };
        (0..count).map(at).map(|(ratio, slip)| read(ratio, slip, &mut normal)).collect()
    }

    #[test]
    fn frictions_are_learned_and_told_to_be_one_or_several() {
        for (frictions, one) in [([0.3, 0.3], true), ([0.3, 0.6], false)] {
            let seen = [begins_to_slide(frictions[0], 240, 1), begins_to_slide(frictions[1], 240, 2)];
            let found = whole_modes(&times(240), &seen, &options()).unwrap();
            assert_eq!(found.one_friction > 0.9, one, "{}", found.one_friction);
            assert_eq!(found.one_friction < 0.1, !one, "{}", found.one_friction);
            for i in 0..2 {
                let learned = found.frictions[i].unwrap();
                // A step of the grid, 1.6 %, beside what the noise leaves.
                assert!((learned.coefficient - frictions[i]).abs() < 0.016 * frictions[i], "{learned:?}");
                let sticks = |k: usize| found.odds[i][k].stick > 0.5;
                let right = (0..240).filter(|k| (110..130).contains(k) || sticks(*k) == (*k < 120)).count();
                assert!(right >= 232, "{right}");
            }
        }
    }

    /// Where a contact sticks far within its cone, its ratio says that the friction is above and no more: bins and walks are the same for all
    /// frictions. Those of shares of the friction spoke for low ones by 60 and more.
    #[test]
    fn a_slow_ratio_does_not_speak_for_a_low_friction() {
        let mut normal = Normal::seeded(3);
        let at = |k: usize| 0.2 + 0.02 * (0.01 * k as f64).sin();
        let seen: Vec<ContactSeen> = (0..600).map(|k| read(at(k), 0.0, &mut normal)).collect();
        let lasting = ContactModesOptions { slip_errors_last: 0.05, ..options() };
        let pace = Pace::new(&times(600), &lasting);
        let logs = Passage::new(&seen, &pace, &options())
            .evidence(&pace, &[0.35, 0.5, 0.8, 1.2].map(|friction| pace.at(friction)));
        // The disc that ratios are drawn from at first, and at jumps, grows by the square of the friction.
        let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        assert!(logs.iter().all(|log| most - log < 12.0), "{logs:?}");
        let alone = whole_modes(&times(600), &[seen], &lasting).unwrap();
        assert_eq!(alone.frictions, [None], "nothing slid");
        assert!(alone.odds[0].iter().filter(|odds| odds.stick > 0.9).count() > 590);
    }

    /// Of `[ratio, slip]` at each of so many samples, with forces and slips as noisy as said.
    fn noisy(count: usize, [force, slip]: [f64; 2], of: impl Fn(usize) -> [f64; 2]) -> Vec<ContactSeen> {
        let mut normal = Normal::seeded(5);
        let mut draw = || normal.draw();
        let read = |k: usize| {
            let [ratio, along] = of(k);
            let velocity = Vector2::new(slip * draw() - along, slip * draw());
            let covariance = Matrix2::identity() * (slip * slip);
            ContactSeen::Read(ContactReading {
                normal_force: 1.0 + force * draw(),
                friction: Vector2::new(ratio + force * draw(), force * draw()),
                force_deviation: force,
                slip: Some(ContactSlip { velocity, covariance }),
                touches: true,
            })
        };
        (0..count).map(read).collect()
    }

    /// A ratio that stays the same is no friction, however well it is read: of a whole log the most probable mode is the true one, in a stream none is sure and
    /// wrong, and no friction is told.
    #[test]
    fn what_rests_does_not_slide_and_tells_no_friction() {
        for noise in [[0.02, 2e-3], [0.02, 2e-4], [1e-3, 2e-3], [1e-3, 2e-4]] {
            for slip_errors_last in [0.0, 0.03] {
                let seen = noisy(800, noise, |_| [0.2, 0.0]);
                let options = ContactModesOptions { slip_errors_last, ..options() };
                let found = whole_modes(&times(800), std::slice::from_ref(&seen), &options).unwrap();
                let slides = found.odds[0].iter().map(|odds| odds.slide).fold(0.0, f64::max);
                assert!(slides < 0.5, "{noise:?} {slip_errors_last} {slides}");
                assert_eq!(found.frictions, [None], "{noise:?}");
                let material = 0;
                let mut modes = ContactModes::new(&[ContactFriction::Unknown { material }], options).unwrap();
                for seen in seen {
                    modes.push(DT, &[seen]).unwrap();
                    let slides = modes.odds(0).unwrap().slide;
                    assert!(slides < 0.99, "{noise:?} {slip_errors_last} {slides}");
                }
                assert_eq!(modes.friction(0), None);
            }
        }
    }

    /// Slips of 5 mm/s for long, as palms that move slowly have it: that is no walk of a body on its own.
    #[test]
    fn what_slides_slowly_for_long_slides_and_tells_its_friction() {
        let slides = |k: usize| (300..900).contains(&k);
        let of = |k: usize| if slides(k) { [0.3, 5e-3] } else { [0.2, 0.0] };
        let seen = noisy(1200, [0.02, 2e-3], of);
        let options = ContactModesOptions { slip_errors_last: 0.01, ..options() };
        let found = whole_modes(&times(1200), &[seen], &options).unwrap();
        let right = (0..1200).filter(|k| (found.odds[0][*k].slide > 0.5) == slides(*k)).count();
        assert!(right > 1180, "{right}");
        let friction = found.frictions[0].unwrap();
        assert!((friction.coefficient - 0.3).abs() < 3.0 * friction.deviation, "{friction:?}");
    }

    /// What comes later moves what was, by less the longer ago it is; at the end there is nothing later.
    #[test]
    fn what_comes_later_counts() {
        let seen = begins_to_slide(0.3, 120, 4);
        let modes = |count: usize| {
            let pace = Pace::new(&times(count), &options());
            let mut sums = vec![[0.0; 3]; count];
            Passage::new(&seen[..count], &pace, &options()).add(&pace, 0.3, 1.0, &mut sums);
            sums
        };
        let (whole, until) = (modes(120), modes(63));
        assert!(whole.iter().all(|modes| (modes.iter().sum::<f64>() - 1.0).abs() < 1e-12));
        let moved = |k: usize| (whole[k][1] - until[k][1]).abs();
        // Slips have come to 2 mm/s, a deviation, when the shorter log ends: the longer one knows better.
        assert!(moved(62) > 1e-3 && moved(10) < 0.1 * moved(62), "{} {}", moved(62), moved(10));
    }

    #[test]
    fn a_contact_that_is_off_is_off_and_outliers_leave_numbers() {
        let mut seen = begins_to_slide(0.3, 200, 5);
        seen[40..60].fill(ContactSeen::Off);
        seen[100] = ContactSeen::Missing;
        if let ContactSeen::Read(reading) = &mut seen[150] {
            reading.slip = Some(ContactSlip {
                velocity: Vector2::new(1e5, -1e5),
                covariance: Matrix2::identity() * 1e-9,
            });
        }
        let found = whole_modes(&times(200), &[seen], &options()).unwrap();
        assert!(found.odds[0][40..60].iter().all(|odds| odds.off == 1.0));
        let sum = |odds: &ContactOdds| odds.off + odds.slide + odds.stick;
        assert!(found.odds[0].iter().all(|odds| (sum(odds) - 1.0).abs() < 1e-9));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let seen = begins_to_slide(0.3, 10, 6);
        let refused = |times: &[f64], seen: &[Vec<ContactSeen>], slip_errors_last| {
            let options = ContactModesOptions { slip_errors_last, ..options() };
            whole_modes(times, seen, &options).unwrap_err().to_string()
        };
        assert!(refused(&times(10), &[], 0.0).contains("no contact"));
        assert!(
            refused(&times(9), std::slice::from_ref(&seen), 0.0)
                .contains("contact 0 has 10 sample(s), and there are 9 times")
        );
        assert!(
            refused(&times(10), std::slice::from_ref(&seen), -1.0).contains("errors of slips last is -1")
        );
        let mut back = times(10);
        back[4] = back[3];
        assert!(refused(&back, std::slice::from_ref(&seen), 0.0).contains("before sample 4 is 0"));
        let mut wrong = seen;
        if let ContactSeen::Read(reading) = &mut wrong[7] {
            reading.normal_force = f64::NAN;
        }
        assert!(refused(&times(10), &[wrong], 0.0).contains("normal force of contact 0 at sample 7 is NaN"));
    }
}
