//! Probabilities of contact modes after an estimate from reference logs, friction unknown, slips the estimate's own.
//!
//! Arguments: the folder of the logs, first seed, seeds, scenes. Writes a Markdown table.

use super::contact_logs::log::{Anything, Log};
use recon::object_dynamics::{ChannelNoise, ContactMode, ContactNoise};
use recon::observer::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use std::path::PathBuf;

const G: f64 = 9.81;
const SCENES: [&str; 6] = ["S2", "S3", "S4", "S6", "S7", "S8"];
const FLOOR: f64 = 3e-5;
const STATED_SIZE: f64 = 0.8;
/// Time about a switch that does not count, s.
const SWITCH: f64 = 5e-3;

#[derive(Default)]
struct Sums {
    samples: f64,
    right: f64,
    labels_right: f64,
    confident: f64,
    wrong: f64,
    brier: f64,
}

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let first: u64 = words.next().map_or(Ok(101), |s| s.parse())?;
    let seeds: u64 = words.next().map_or(Ok(20), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    for name in SCENES.iter().filter(|name| names.is_empty() || names.iter().any(|n| n == *name)) {
        let file = Log::read(&folder, name)?;
        for seed in first..first + seeds {
            let started = std::time::Instant::now();
            let (truth, found) = estimated(&file, (0.005, 0.02), seed)?;
            let ms = started.elapsed().as_secs_f64() * 1e3;
            let Some(modes) = &found.mode_odds else {
                println!("{name} {seed} none, {:?}", found.reliability);
                continue;
            };
            let e = super::contact_estimates::errors(&file, &found, file.semi_axes().element_sum() / 3.0)?;
            println!(
                "   errors centre {:.1e} v {:.1e} w {:.1e} mass {:.1e} inertia {:.1e} turn {:.1e}",
                e[0], e[1], e[2], e[3], e[4], e[5]
            );
            let mut all = Sums::default();
            for i in 0..file.palm_count() {
                let mut s = Sums::default();
                for k in 0..truth.times.len() {
                    if truth.near[i][k] || truth.modes[i][k] == 0 {
                        continue;
                    }
                    s.add(truth.modes[i][k], found.modes[k][i], &modes.odds[k][i]);
                    all.add(truth.modes[i][k], found.modes[k][i], &modes.odds[k][i]);
                }
                println!(
                    "   palm {i} {} {:?}",
                    s.row(),
                    modes.frictions[i].map(|f| (f.coefficient, f.deviation))
                );
            }
            println!(
                "{name} {seed} {} one {:.3} unsure {} {ms:.0} ms misfit {:.2} settled {} reliable {}",
                all.row(),
                modes.one_friction,
                modes.unsure(),
                found.evidence.misfit,
                found.evidence.settled,
                found.reliability.is_reliable()
            );
        }
    }
    Ok(())
}

impl Sums {
    fn add(&mut self, truth: u8, label: ContactMode, odds: &recon::observer::ContactOdds) {
        let p = [odds.off, odds.slide, odds.stick];
        let t = usize::from(truth);
        let best = (0..3).max_by(|a, b| p[*a].total_cmp(&p[*b])).unwrap_or(0);
        let label = match label {
            ContactMode::Off => 0,
            ContactMode::Slide => 1,
            ContactMode::Stick => 2,
        };
        self.samples += 1.0;
        self.right += f64::from(best == t);
        self.labels_right += f64::from(label == t);
        self.confident += f64::from(p[best] > 0.99);
        self.wrong += f64::from(p[best] > 0.99 && best != t);
        self.brier += (0..3).map(|m| (p[m] - f64::from(u8::from(m == t))).powi(2)).sum::<f64>() / 2.0;
    }
    fn row(&self) -> String {
        let n = self.samples.max(1.0);
        format!(
            "n {n:5} right {:.4} labels {:.4} confident {:.3} wrong {:.4} brier {:.4}",
            self.right / n,
            self.labels_right / n,
            self.confident / n,
            self.wrong / n,
            self.brier / n
        )
    }
}

struct Truth {
    times: Vec<f64>,
    /// Of each palm at each sample: 0 off, 1 slides, 2 sticks.
    modes: Vec<Vec<u8>>,
    near: Vec<Vec<bool>>,
}

fn estimated(file: &Log, (contact, share): (f64, f64), seed: u64) -> Anything<(Truth, ContactEstimate)> {
    let (log, _) = file.contact_log(f64::INFINITY)?;
    let times = log.times().to_vec();
    let length = file.semi_axes().element_sum() / 3.0;
    let contact = length * contact;
    let force = ChannelNoise { fixed: 0.0, share };
    let noise = ContactNoise { contact, force, impulse: force, ..ContactNoise::default() };
    let log = log.with_noise(&noise, seed)?;
    let floor = FLOOR * (G * length).sqrt();
    let impulse =
        std::env::var("IMPULSE").is_ok().then_some(recon::observer::ImpulseNoise { fixed: 0.0, share });
    let noise = ContactNoiseLevel { contact, force_fixed: 0.0, force_share: share, impulse, floor };
    let size = (file.palm_count() == 1).then_some(STATED_SIZE * length);
    let options = ContactOptions { size, mode_odds: true, ..ContactOptions::new(noise, G) };
    let found = estimate_contacts(&log, None, &options)?;
    let mut modes = Vec::new();
    let mut near = Vec::new();
    for i in 1..=file.palm_count() {
        let own: Vec<u8> = file.column(&format!("mode_{i}"))?.iter().map(|m| *m as u8).collect();
        let switches: Vec<f64> = (1..own.len())
            .filter(|&k| own[k] != own[k - 1])
            .map(|k| 0.5 * (times[k] + times[k - 1]))
            .collect();
        near.push(times.iter().map(|t| switches.iter().any(|s| (t - s).abs() < SWITCH)).collect());
        modes.push(own);
    }
    Ok((Truth { times, modes, near }, found))
}
