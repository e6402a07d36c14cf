//! What came of estimates in the plane over many runs.

use crate::rows::RowsError;
use cpu_time::ThreadTime;
use recon::object_dynamics::planar::{ContactLog, PlanarTruth};
use recon::observer::planar::{PlaneEstimate, PlaneOptions, estimate_plane};

/// Deviations beyond which an error that nothing warned of is silent.
pub(crate) const SILENT: f64 = 5.0;

/// Deviations from which on a constant that was taken as known is named: odds of two in a million.
const NAMED: f64 = 4.75;

/// Microseconds; none where there is an error, then the errors where it is relied on.
type Run = (f64, Option<Option<[f64; 5]>>);

/// Runs, those that are relied on, and how far these are off.
#[derive(Default)]
pub(crate) struct Tally {
    runs: usize,
    relied: usize,
    silent: usize,
    refused: usize,
    squares: f64,
    numbers: f64,
    places: Vec<f64>,
    /// What is wrong in its deviations, in silent runs.
    told: Vec<f64>,
    microseconds: f64,
    samples: f64,
}

impl Tally {
    /// Estimates the motion of a body of the size `length` (m), and counts what comes of it; `told` is what is wrong in the deviation that is stated of it.
    pub(crate) fn run(
        &mut self,
        log: &ContactLog,
        options: &PlaneOptions,
        length: f64,
        told: impl Fn(&PlaneEstimate) -> f64,
    ) -> Result<(), RowsError> {
        let run = crate::rows::row(|| -> Result<Run, RowsError> {
            let clock = ThreadTime::now();
            let made = estimate_plane(log, options);
            let microseconds = 1e6 * clock.elapsed().as_secs_f64();
            let reliable = |made: PlaneEstimate| {
                let truth = log.truth().unwrap_or_default();
                let told = told(&made);
                let errors = errors(&made, truth, length);
                made.reliability.is_reliable().then(|| [errors[0], errors[1], errors[2], errors[3], told])
            };
            Ok((microseconds, made.ok().map(reliable)))
        })?;
        let Some((microseconds, made)) = run else { return Ok(()) };
        self.microseconds += microseconds;
        self.samples += log.samples().len() as f64;
        self.runs += 1;
        self.refused += usize::from(made.is_none());
        if let Some([worst, squares, numbers, place, told]) = made.flatten() {
            self.squares += squares;
            self.numbers += numbers;
            self.relied += 1;
            if worst > SILENT {
                self.silent += 1;
                self.told.push(told);
            }
            self.places.push(place);
        }
        Ok(())
    }

    /// Cells of a row.
    pub(crate) fn told(&mut self) -> String {
        self.places.sort_by(f64::total_cmp);
        let place = self.places.get(self.places.len() / 2).map_or("-".to_owned(), |p| format!("{p:.1e}"));
        let mean =
            if self.numbers > 0.0 { format!("{:.2}", self.squares / self.numbers) } else { "-".to_owned() };
        let refused = if self.refused > 0 { format!(" ({} errors)", self.refused) } else { String::new() };
        self.told.sort_by(f64::total_cmp);
        // None states a deviation of what is no constant.
        let powers: Vec<String> =
            self.told.iter().map(|of| format!("{:.0}", 100.0 * below(of - NAMED))).collect();
        let told = match self.told.last() {
            Some(most) if *most > 0.0 => format!(" (power {} %)", powers.join(", ")),
            _ => String::new(),
        };
        format!(
            "{} | {}{refused} | {}{told} | {mean} | {place} | {:.0}",
            self.runs,
            self.relied,
            self.silent,
            self.microseconds / self.samples.max(1.0)
        )
    }
}

/// How probable it is that a standard normal number is below this one: by Simpson's rule, to 1e-6.
fn below(number: f64) -> f64 {
    const PARTS: u32 = 200;
    let step = number.clamp(-9.0, 9.0) / f64::from(PARTS);
    let density = |i: u32| (-0.5 * (f64::from(i) * step).powi(2)).exp();
    let weight = |i: u32| if i == 0 || i == PARTS { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) };
    let sum: f64 = (0..=PARTS).map(|i| weight(i) * density(i)).sum();
    0.5 + sum * step / 3.0 / std::f64::consts::TAU.sqrt()
}

/// The largest of the errors in their deviations, the sum of their squares, how many there are; and the largest of the place over the size.
pub(crate) fn errors(made: &PlaneEstimate, truth: &[PlanarTruth], length: f64) -> [f64; 4] {
    let [mut worst, mut squares, mut numbers, mut place] = [0.0_f64; 4];
    for (k, truth) in truth.iter().enumerate().filter(|(k, _)| made.relied_on[*k]) {
        let (state, of) = (&made.states[k], &made.deviations[k]);
        let p = state.p_WCm - truth.p_WCm;
        let (p_in, v_in) = (p / of.p_WCm, (state.v_WCm - truth.v_WCm) / of.v_WCm);
        let spin = (state.omega0 - truth.omega0) / of.omega0;
        for number in [p_in.x, p_in.y, v_in.x, v_in.y, spin] {
            worst = worst.max(number.abs());
            squares += number * number;
            numbers += 1.0;
        }
        place = place.max(p.length() / length);
    }
    [worst, squares, numbers, place]
}
