//! Motion, mass and inertia from the reference logs of any palms, from no guess, the contact modes known or not.
//!
//! Arguments: the folder of the logs, seeds, scenes. Writes a Markdown table.

pub(crate) mod impulses;
mod mixed;
pub(crate) mod random;

use super::contact_logs::log::{Anything, Log};
use glam::DMat3;
use recon::object_dynamics::{ChannelNoise, ContactLog, ContactMode, ContactNoise, MOST_PALMS};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use std::path::PathBuf;

const G: f64 = 9.81;
/// Contacts as a share of the mean semi-axis, forces as a share of themselves.
const NOISES: [(f64, f64); 3] = [(0.0, 0.0), (0.001, 0.004), (0.005, 0.02)];
/// Seeds from here on; windows, modes and damping were set on those below 20.
const FIRST_SEED: u64 = 100;
/// Floor of contact conditions over the natural speed: creep of the logs.
const FLOOR: f64 = 3e-5;
/// Size that is stated where one palm alone is touched, over the mean semi-axis.
const STATED_SIZE: f64 = 0.8;

/// What a log of some seconds can tell at most with contacts of 0.5 % and forces of 2 %: deviations of centre, velocity, rate,
/// mass and inertia.
struct Bound {
    name: &'static str,
    seconds: f64,
    deviations: [f64; 5],
}

const BOUNDS: [Bound; 7] = [
    Bound { name: "S1", seconds: 2.9, deviations: [0.0065, 0.0023, 0.016, 7e-4, 0.28] },
    Bound { name: "S2", seconds: 1.8, deviations: [0.0049, 0.0026, 0.010, 7e-4, 0.088] },
    Bound { name: "S3", seconds: 1.8, deviations: [0.024, 0.0068, 0.013, 2.3e-3, 0.63] },
    Bound { name: "S4", seconds: 1.8, deviations: [0.014, 0.0017, 0.0023, 1.4e-3, 0.43] },
    Bound { name: "S5", seconds: 1.8, deviations: [0.045, 0.0064, 0.30, 7e-3, 3.4] },
    Bound { name: "S6", seconds: 1.6, deviations: [0.024, 0.0053, 0.086, 7.5e-4, 1.8] },
    Bound { name: "S7", seconds: 1.8, deviations: [0.021, 0.015, 0.050, 2.1e-3, 0.35] },
];

/// A log that a robot would have, and what else is known.
pub(super) struct Case {
    pub(super) log: ContactLog,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    pub(super) options: ContactOptions,
    /// Mean semi-axis, m.
    length: f64,
}

/// Sums over the runs of one log and noise.
#[derive(Default)]
struct Sums {
    runs: f64,
    failed: usize,
    settled: f64,
    linearisations: f64,
    chi_squared: f64,
    /// Squares of the errors of centre, velocity, rate, mass, inertia, turn.
    squares: [f64; 6],
    /// Squares of the stated deviations of centre and mass, and the greatest of an inertia's logarithm.
    stated: [f64; 3],
    ms: f64,
}

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seeds: u64 = words.next().map_or(Ok(20), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    println!("# Motion, mass and inertia from contacts of any palms, from no guess");
    println!();
    println!(
        "The first 1.8 s (S1 2.9 s, S6 1.6 s) of logs by another simulator (1 kHz, three axes of force), mass and inertia unknown, contact modes known \
         (a contact sticks that slips by less than 2e-5 m/s) or estimated from the ratio of friction to normal force. Noise: contacts as a share of the mean semi-axis, forces of themselves. \
         Errors are root mean squares over run and seeds in natural units (mean semi-axis, natural speed and rate), mass and inertia relative; \
         in brackets, at the largest noise, as a multiple of the least possible deviation; stated: the estimate's own deviations, in the middle of the run."
    );
    println!();
    println!(
        "| log | noise | modes | runs, failed | settled | linearisations | chi-squared a condition | centre | velocity | rate | turn (rad) | mass | inertia | stated: centre, mass, logarithm of a second moment's root | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for bound in BOUNDS.iter().filter(|b| names.is_empty() || names.iter().any(|name| name == b.name)) {
        let file = Log::read(&folder, bound.name)?;
        for noise in NOISES {
            for known in [true, false] {
                let mut sums = Sums::default();
                for seed in 0..if noise.0 > 0.0 { seeds } else { 1 } {
                    sums.add(&file, noise, bound.seconds, FIRST_SEED + seed, known)?;
                }
                let least = (noise == NOISES[2]).then_some(&bound.deviations);
                let modes = if known { "known" } else { "estimated" };
                let [contact, force] = [noise.0, noise.1].map(|share| 100.0 * share);
                println!("| {} | {contact} %, {force} % | {modes} | {} |", bound.name, sums.row(least));
            }
        }
    }
    Ok(())
}

impl Sums {
    fn add(&mut self, file: &Log, noise: (f64, f64), seconds: f64, seed: u64, known: bool) -> Anything<()> {
        let Case { log, modes, options, length } = case(file, noise, seconds, seed)?;
        let started = std::time::Instant::now();
        let Ok(found) = estimate_contacts(&log, known.then_some(&modes[..]), &options) else {
            self.failed += 1;
            return Ok(());
        };
        self.ms += started.elapsed().as_secs_f64() * 1e3;
        self.runs += 1.0;
        self.settled += f64::from(found.evidence.settled);
        self.linearisations += found.evidence.iterations[1] as f64;
        self.chi_squared += found.evidence.misfit;
        for (sum, error) in self.squares.iter_mut().zip(errors(file, &found, length)?) {
            *sum += error * error;
        }
        let inertia = found.inertia_deviations.into_iter().fold(0.0, f64::max);
        let centre = found.deviations[found.states.len() / 2][0].length() / length;
        for (sum, deviation) in self.stated.iter_mut().zip([centre, found.mass_deviation, inertia]) {
            *sum += deviation * deviation;
        }
        Ok(())
    }

    fn row(&self, least: Option<&[f64; 5]>) -> String {
        let rms = |square: f64| (square / self.runs).sqrt();
        let cell = |i: usize| {
            let error = rms(self.squares[i]);
            least.map_or(format!("{error:.1e}"), |least| format!("{error:.1e} ({:.2})", error / least[i]))
        };
        let [centre, mass, inertia] = self.stated.map(rms);
        format!(
            "{}, {} | {:.0} % | {:.0} | {:.2} | {} | {} | {} | {:.1e} | {} | {} | {centre:.0e}, {mass:.0e}, {inertia:.0e} | {:.0}",
            self.runs as usize + self.failed,
            self.failed,
            100.0 * self.settled / self.runs,
            self.linearisations / self.runs,
            self.chi_squared / self.runs,
            cell(0),
            cell(1),
            cell(2),
            rms(self.squares[5]),
            cell(3),
            cell(4),
            self.ms / self.runs,
        )
    }
}

pub(super) fn case(file: &Log, (contact, share): (f64, f64), seconds: f64, seed: u64) -> Anything<Case> {
    let (log, modes) = file.contact_log(seconds)?;
    let length = file.semi_axes().element_sum() / 3.0;
    let contact = length * contact;
    let force = ChannelNoise { fixed: 0.0, share };
    let noise = ContactNoise { contact, force, impulse: force, ..ContactNoise::default() };
    let log = log.with_noise(&noise, seed)?;
    let floor = FLOOR * (G * length).sqrt();
    let noise = ContactNoiseLevel { contact, force_fixed: 0.0, force_share: share, impulse: None, floor };
    let size = (file.palm_count() == 1).then_some(STATED_SIZE * length);
    Ok(Case { log, modes, options: ContactOptions { size, ..ContactOptions::new(noise, G) }, length })
}

/// Root mean squares of centre, velocity and rate in natural units, relative errors of mass and inertia, turn.
fn errors(file: &Log, found: &ContactEstimate, length: f64) -> Anything<[f64; 6]> {
    let truth = file.bodies(found.states.len())?;
    let first = truth[0].R_WO;
    let mut sums = [0.0; 4];
    for (k, state) in found.states.iter().enumerate() {
        let turn = state.R_WO * (truth[k].R_WO * first.conjugate()).conjugate();
        sums[0] += (state.p_WCm - truth[k].p_WCm).length_squared() / (length * length);
        sums[1] += (state.v_WCm - truth[k].v_WCm).length_squared() / (G * length);
        sums[2] += (state.w_WO - truth[k].w_WO).length_squared() * length / G;
        sums[3] += turn.to_scaled_axis().length_squared();
    }
    let [centre, velocity, rate, turn] = sums.map(|sum| (sum / found.states.len() as f64).sqrt());
    let (mass, inertia) = file.mass();
    let R = DMat3::from_quat(first);
    let ratio = R * inertia * R.transpose() * found.inertia.inverse() - DMat3::IDENTITY;
    let K = (ratio.to_cols_array().iter().map(|x| x * x).sum::<f64>() / 3.0).sqrt();
    Ok([centre, velocity, rate, found.mass / mass - 1.0, K, turn])
}
