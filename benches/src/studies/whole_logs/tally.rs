//! What became of some runs.

use cpu_time::ProcessTime;
use glam::DVec3;
use recon::object_dynamics::BodyState;
use recon::observer::contacts::{ContactEstimate, ContactEstimateError};
use recon::observer::reliability::{Reason, Reliability};

/// Deviations from which on an error is one that was not told.
const BEYOND: f64 = 5.0;

/// Milliseconds; of an estimate, whether a constant is named where it is refused, and of its errors in their deviations the largest, the sum of
/// the squares and how many there are.
pub(super) type Run = (f64, Option<(Option<bool>, [f64; 3])>);

/// A run, whose log may lack some of the samples of the truth, of which there are so many a second.
pub(super) fn judged(
    run: impl Fn() -> Result<ContactEstimate, ContactEstimateError>,
    times: &[f64],
    (truth, rate): (&[BodyState], f64),
) -> Run {
    let clock = ProcessTime::now();
    let found = run();
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let Ok(found) = found else { return (milliseconds, None) };
    let (mut worst, mut squares, mut numbers) = (0.0_f64, 0.0, 0.0);
    let reliable = found.reliability.is_reliable();
    for (k, state) in found.states.iter().enumerate().filter(|(k, _)| found.relied_on[*k] || !reliable) {
        let place = ((times[k] - times[0]) * rate).round() as usize;
        let Some(at) = truth.get(place) else { continue };
        let [p, v, w, _] = found.deviations[k];
        let off = [(state.p_WCm - at.p_WCm) / p, (state.v_WCm - at.v_WCm) / v, (state.w_WO - at.w_WO) / w];
        worst = off.iter().map(|off: &DVec3| off.abs().max_element()).fold(worst, f64::max);
        squares += off.iter().map(|off| off.length_squared()).sum::<f64>();
        numbers += 9.0;
    }
    let named = match &found.reliability {
        Reliability::Unreliable(reasons) => {
            let constant = |reason: &Reason| matches!(reason, Reason::Fault(_) | Reason::OtherBody { .. });
            Some(reasons.iter().any(constant))
        }
        _ => None,
    };
    (milliseconds, Some((named, [worst, squares, numbers])))
}

#[derive(Default)]
pub(super) struct Tally {
    relied_on: usize,
    /// Relied on, and beyond.
    silent: usize,
    /// Refused, and a constant named.
    named: usize,
    refused: usize,
    /// Refused, and rightly so.
    rightly: usize,
    largest: f64,
    squares: f64,
    numbers: f64,
    milliseconds: Vec<f64>,
}

impl Tally {
    pub(super) fn take(&mut self, (milliseconds, judged): Run) {
        self.milliseconds.push(milliseconds);
        match judged {
            None => self.refused += 1,
            Some((Some(named), [worst, ..])) => {
                self.rightly += usize::from(worst > BEYOND);
                *(if named { &mut self.named } else { &mut self.refused }) += 1;
            }
            Some((None, [worst, squares, numbers])) => {
                self.relied_on += 1;
                self.silent += usize::from(worst > BEYOND);
                self.largest = self.largest.max(worst);
                self.squares += squares;
                self.numbers += numbers;
            }
        }
    }

    fn runs(&self) -> usize {
        self.milliseconds.len()
    }

    /// Of logs that are as stated.
    pub(super) fn row(&mut self) -> String {
        self.milliseconds.sort_by(f64::total_cmp);
        let place = |share: f64| ((self.runs() as f64 - 1.0) * share) as usize;
        let at = |share: f64| self.milliseconds.get(place(share)).copied().unwrap_or(f64::NAN);
        format!(
            "{} | {} | {:.2} | {} | {:.1} | {} of {} | {:.0} | {:.0}",
            self.runs(),
            self.relied_on,
            self.squares / self.numbers,
            self.silent,
            self.largest,
            self.rightly,
            self.runs() - self.relied_on,
            at(0.5),
            at(0.9)
        )
    }

    /// Of logs that are not.
    pub(super) fn faulty(&self) -> String {
        let right = self.relied_on - self.silent;
        let Self { named, refused, silent, largest, .. } = self;
        format!("{} | {right} | {named} | {refused} | {silent} | {largest:.1}", self.runs())
    }
}
