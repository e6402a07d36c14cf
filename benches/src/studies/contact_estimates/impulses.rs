//! The same estimate from forces at samples and from measured impulses, of the reference logs.
//!
//! Arguments: the folder of the logs, seeds, logs. Writes a Markdown table.

use super::super::contact_logs::log::{Anything, Log};
use super::{BOUNDS, Case, FIRST_SEED, NOISES, case, errors};
use recon::object_dynamics::{ContactLog, ForceChannel};
use recon::observer::contacts::{ImpulseNoise, estimate_contacts};
use std::path::PathBuf;

/// Duration of the log with landings, s.
const LANDINGS: (&str, f64) = ("S8", 1.8);

/// What is read of a log.
#[derive(Clone, Copy)]
enum Reads {
    Forces,
    Both,
    Impulses,
}

/// Sums over runs.
#[derive(Default)]
struct Sums {
    runs: f64,
    reliable: f64,
    relied_on: f64,
    chi_squared: f64,
    squares: [f64; 6],
    /// Squared errors of velocities over their variances, a number.
    honest: f64,
    ms: f64,
}

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seeds: u64 = words.next().map_or(Ok(5), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    println!("# The estimate from contacts by measured impulses");
    println!();
    println!(
        "The logs, noises and units of [contact-estimates.md](contact-estimates.md), and S8 (landings) over 1.8 s, modes told from forces; seeds from \
         {FIRST_SEED} on. Read are forces at samples alone, both (impulses between samples, forces for everything else), or impulses alone. \
         The noise of an impulse over each interval is the same share of it as that of a force."
    );
    println!();
    println!(
        "| log | noise | read | reliable | relied on | chi-squared a condition | centre | velocity | rate | turn (rad) | mass | inertia | squared errors of velocity over variance | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    let logs = BOUNDS.iter().map(|bound| (bound.name, bound.seconds)).chain([LANDINGS]);
    for (name, seconds) in logs.filter(|(name, _)| names.is_empty() || names.iter().any(|n| n == name)) {
        let file = Log::read(&folder, name)?;
        for noise in &NOISES[1..] {
            for (reads, what) in
                [(Reads::Forces, "forces"), (Reads::Both, "both"), (Reads::Impulses, "impulses")]
            {
                let mut sums = Sums::default();
                for seed in 0..seeds {
                    sums.add(&file, case(&file, *noise, seconds, FIRST_SEED + seed)?, noise.1, reads)?;
                }
                let [contact, force] = [noise.0, noise.1].map(|share| 100.0 * share);
                println!("| {name} | {contact} %, {force} % | {what} | {} |", sums.row());
            }
        }
    }
    Ok(())
}

impl Sums {
    fn add(&mut self, file: &Log, case: Case, share: f64, reads: Reads) -> Anything<()> {
        let Case { mut log, mut options, length, .. } = case;
        if !matches!(reads, Reads::Forces) {
            options.noise.impulse = Some(ImpulseNoise { fixed: 0.0, share });
        }
        if matches!(reads, Reads::Impulses) {
            log = without_forces(&log)?;
        }
        let started = std::time::Instant::now();
        let found = estimate_contacts(&log, None, &options)?;
        self.ms += started.elapsed().as_secs_f64() * 1e3;
        let count = found.states.len() as f64;
        self.runs += 1.0;
        self.reliable += f64::from(found.reliability.is_reliable());
        self.relied_on += found.relied_on.iter().filter(|relied| **relied).count() as f64 / count;
        self.chi_squared += found.evidence.misfit;
        for (sum, error) in self.squares.iter_mut().zip(errors(file, &found, length)?) {
            *sum += error * error;
        }
        let truth = file.bodies(found.states.len())?;
        let ratios = found.states.iter().zip(&truth).zip(&found.deviations);
        let square = ratios.map(|((s, t), of)| ((s.v_WCm - t.v_WCm) / of[1]).length_squared()).sum::<f64>();
        self.honest += square / (3.0 * count);
        Ok(())
    }

    fn row(&self) -> String {
        let [centre, velocity, rate, mass, inertia, turn] = self.squares.map(|sum| (sum / self.runs).sqrt());
        let percent = |sum: f64| 100.0 * sum / self.runs;
        format!(
            "{:.0} of {:.0} | {:.0} % | {:.2} | {centre:.1e} | {velocity:.1e} | {rate:.1e} | {turn:.1e} | {mass:.1e} | {inertia:.1e} | {:.2} | {:.0}",
            self.reliable,
            self.runs,
            percent(self.relied_on),
            self.chi_squared / self.runs,
            self.honest / self.runs,
            self.ms / self.runs,
        )
    }
}

fn without_forces(log: &ContactLog) -> Anything<ContactLog> {
    let mut records = log.records();
    records.iter_mut().for_each(|record| record.force = ForceChannel::Missing);
    Ok(ContactLog::new(log.times().to_vec(), records, None)?)
}
