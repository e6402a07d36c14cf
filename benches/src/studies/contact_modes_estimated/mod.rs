//! Probabilities of contact modes after an estimate from the reference logs: friction unknown, slips the estimate's own.
//!
//! Arguments: the folder of the logs, the first seed, seeds, scenes. Writes a Markdown table.

pub(super) mod tally;

use super::contact_estimates::{Case, case};
use super::contact_logs::log::{Anything, Log};
use recon::object_dynamics::{ContactMode, MOST_PALMS};
use recon::observer::contacts::{ContactEstimate, ContactOptions, estimate_contacts};
use std::path::{Path, PathBuf};
use tally::{Run, reliability, row};

pub(super) const SCENES: [&str; 6] = ["S2", "S3", "S4", "S6", "S7", "S8"];
/// Contacts as a share of the mean semi-axis, forces as a share of themselves.
pub(super) const NOISE: (f64, f64) = (0.005, 0.02);
/// Seeds from here on; constants were set on those below 20.
const FIRST_SEED: u64 = 501;
/// Time about a switch of a contact in which its samples do not count, s.
const SWITCH: f64 = 5e-3;

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let first: u64 = words.next().map_or(Ok(FIRST_SEED), |s| s.parse())?;
    let seeds: u64 = words.next().map_or(Ok(5), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    let asked: Vec<&str> =
        SCENES.into_iter().filter(|name| names.is_empty() || names.iter().any(|n| n == name)).collect();
    let jobs: Vec<(&str, u64)> =
        asked.iter().flat_map(|name| (first..first + seeds).map(move |seed| (*name, seed))).collect();
    let runs = on_two_cores(&jobs, |name, seed| run(&folder, name, seed))?;
    print!("{}", include_str!("about.md"));
    println!("Seeds {first} to {}.\n", first + seeds - 1);
    println!("{}", tally::HEAD);
    for name in asked {
        let own: Vec<&Run> = runs.iter().filter(|run| run.name == name).collect();
        println!("{}", row(name, &own));
    }
    println!("\n{}", include_str!("reliability.md").trim_end());
    println!();
    print!("{}", reliability(&runs.iter().collect::<Vec<_>>()));
    Ok(())
}

/// What comes of each job.
pub(super) fn on_two_cores<T: Send>(
    jobs: &[(&str, u64)],
    run: impl Fn(&str, u64) -> Anything<T> + Sync,
) -> Anything<Vec<T>> {
    let every = |offset: usize| -> Result<Vec<T>, String> {
        jobs.iter()
            .skip(offset)
            .step_by(2)
            .map(|(name, seed)| run(name, *seed).map_err(|error| format!("{name}, seed {seed}: {error}")))
            .collect()
    };
    let (one, two) = std::thread::scope(|scope| {
        let other = scope.spawn(|| every(1));
        let own = every(0);
        (own, other.join())
    });
    let mut all = one?;
    all.extend(two.map_err(|_| "a thread was lost")??);
    Ok(all)
}

/// What the log says is true at its samples.
pub(super) struct Truth {
    times: Vec<f64>,
    /// Of each palm at each sample.
    pub(super) modes: Vec<Vec<ContactMode>>,
    /// Whether a switch of that contact is near.
    pub(super) near: Vec<Vec<bool>>,
}

fn run(folder: &Path, name: &str, seed: u64) -> Anything<Run> {
    let file = Log::read(folder, name)?;
    let Case { log, options, .. } = case(&file, NOISE, f64::INFINITY, seed)?;
    let truth = Truth::new(&file, log.times())?;
    let found = estimate_contacts(&log, None, &ContactOptions { mode_odds: true, ..options })?;
    truth.judge(name, &file, &found)
}

impl Truth {
    pub(super) fn new(file: &Log, times: &[f64]) -> Anything<Self> {
        let (mut modes, mut near) = (Vec::new(), Vec::new());
        for i in 1..=file.palm_count() {
            let column = file.column(&format!("mode_{i}"))?;
            let own: Vec<ContactMode> = column.iter().map(|mode| ContactMode::ALL[*mode as usize]).collect();
            let switches: Vec<f64> = (1..own.len())
                .filter(|&k| own[k] != own[k - 1])
                .map(|k| 0.5 * (times[k] + times[k - 1]))
                .collect();
            let close = |t: &f64| switches.iter().any(|switch| (t - switch).abs() < SWITCH);
            near.push(times.iter().map(close).collect());
            modes.push(own);
        }
        Ok(Self { times: times.to_vec(), modes, near })
    }

    fn judge(&self, name: &str, file: &Log, found: &ContactEstimate) -> Anything<Run> {
        let odds = found.mode_odds.as_ref().ok_or("no probabilities of modes")?;
        let mut run = Run::new(name, found.evidence.settled && found.reliability.is_reliable());
        for i in 0..file.palm_count().min(MOST_PALMS) {
            for k in 0..self.times.len() {
                let truth = self.modes[i][k];
                if truth != ContactMode::Off {
                    let of = &odds.odds[k][i];
                    run.add(truth, odds.by_ratio[k][i], [of.off, of.slide, of.stick], self.near[i][k]);
                }
            }
            if let Some(learned) = odds.frictions[i] {
                run.friction(learned.coefficient, learned.deviation, file.friction(i + 1));
            }
        }
        Ok(run)
    }
}
