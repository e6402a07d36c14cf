//! Motion, mass and inertia from the reference logs of any palms, from no guess, the contact modes being known.
//!
//! Arguments: the folder of the logs, seconds, seeds, scenes. Writes a Markdown table.

use super::contact_logs::log::{Anything, Log};
use glam::DMat3;
use recon::object_dynamics::{ChannelNoise, ContactLog, ContactMode, ContactNoise, MOST_PALMS};
use recon::observer::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use std::path::PathBuf;

const G: f64 = 9.81;
/// Contacts as a share of the size (twice the mean semi-axis), forces as a share of themselves.
const NOISES: [(f64, f64); 3] = [(0.0, 0.0), (0.001, 0.004), (0.005, 0.02)];
/// Floor of contact conditions over the natural speed: creep of the logs.
const FLOOR: f64 = 3e-5;
/// Size that is stated where one palm alone is touched, over the mean semi-axis.
const STATED_SIZE: f64 = 0.8;

/// A log that a robot would have, and what else is known.
struct Case {
    log: ContactLog,
    modes: Vec<[ContactMode; MOST_PALMS]>,
    options: ContactOptions,
    /// Mean semi-axis, m.
    length: f64,
}

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seconds: f64 = words.next().map_or(Ok(1.8), |s| s.parse())?;
    let seeds: u64 = words.next().map_or(Ok(3), |s| s.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = (1..=7).map(|k| format!("S{k}")).collect();
    }
    println!("# Motion, mass and inertia from contacts of any palms, from no guess");
    println!();
    println!(
        "The first {seconds} s of logs by another simulator (1 kHz, three axes of force), mass and inertia unknown, contact modes known (a contact sticks that slips by less than 2e-5 m/s). \
         Noise: contacts as a share of the size, forces of themselves. Errors are root mean squares over the run in natural units \
         (mean semi-axis, natural speed and rate); K is that of the inertia tensor, relative. Deviations are the estimate's own, in \
         the middle of the run."
    );
    println!();
    println!(
        "| log | noise | seed | linearisations | settled | chi-squared a condition | centre (its deviation) | velocity | rate | turn (rad) | mass (its deviation) | K | largest deviation of an inertia's logarithm | ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|---|");
    for name in names {
        let file = Log::read(&folder, &name)?;
        for noise in NOISES {
            for seed in 0..if noise.0 > 0.0 { seeds } else { 1 } {
                let row = row(&file, noise, seconds, seed)?;
                println!("| {name} | {} %, {} % | {seed} | {row} |", 100.0 * noise.0, 100.0 * noise.1);
            }
        }
    }
    Ok(())
}

fn case(file: &Log, (contact, share): (f64, f64), seconds: f64, seed: u64) -> Anything<Case> {
    let (log, modes) = file.contact_log(seconds)?;
    let length = file.semi_axes().element_sum() / 3.0;
    let contact = 2.0 * length * contact;
    let force = ChannelNoise { fixed: 0.0, share };
    let log = log.with_noise(&ContactNoise { contact, force, ..ContactNoise::default() }, seed)?;
    let floor = FLOOR * (G * length).sqrt();
    let noise = ContactNoiseLevel { contact, force_fixed: 0.0, force_share: share, floor };
    let size = (file.palm_count() == 1).then_some(STATED_SIZE * length);
    Ok(Case { log, modes, options: ContactOptions { noise, gravity: G, size }, length })
}

fn row(file: &Log, noise: (f64, f64), seconds: f64, seed: u64) -> Anything<String> {
    let Case { log, modes, options, length } = case(file, noise, seconds, seed)?;
    let started = std::time::Instant::now();
    let found = match estimate_contacts(&log, &modes, &options) {
        Ok(found) => found,
        Err(error) => return Ok(format!("{error} | | | | | | | | | |")),
    };
    let ms = started.elapsed().as_secs_f64() * 1e3;
    let [centre, velocity, rate, turn, mass, K] = errors(file, &found, length)?;
    let deviation = found.deviations[found.nodes.len() / 2][0].length() / length;
    let inertia = found.inertia_deviations.into_iter().fold(0.0, f64::max);
    Ok(format!(
        "{} | {} | {:.2} | {centre:.1e} ({deviation:.0e}) | {velocity:.1e} | {rate:.1e} | {turn:.1e} | {mass:.1e} ({:.0e}) | {K:.1e} | \
         {inertia:.0e} | {ms:.0}",
        found.iterations[1],
        if found.settled { "yes" } else { "no" },
        found.chi_squared / found.conditions as f64,
        found.mass_deviation,
    ))
}

/// Root mean squares of centre, velocity, rate and turn in natural units, and relative errors of mass and inertia.
fn errors(file: &Log, found: &ContactEstimate, length: f64) -> Anything<[f64; 6]> {
    let truth = file.bodies(found.nodes.last().map_or(0, |k| k + 1))?;
    let first = truth[0].R_WO;
    let mut sums = [0.0; 4];
    for (state, &k) in found.states.iter().zip(&found.nodes) {
        let turn = state.R_WO * (truth[k].R_WO * first.conjugate()).conjugate();
        sums[0] += (state.p_WCm - truth[k].p_WCm).length_squared() / (length * length);
        sums[1] += (state.v_WCm - truth[k].v_WCm).length_squared() / (G * length);
        sums[2] += (state.w_WO - truth[k].w_WO).length_squared() * length / G;
        sums[3] += turn.to_scaled_axis().length_squared();
    }
    let [centre, velocity, rate, turn] = sums.map(|sum| (sum / found.nodes.len() as f64).sqrt());
    let (mass, inertia) = file.mass();
    let R = DMat3::from_quat(first);
    let ratio = R * inertia * R.transpose() * found.inertia.inverse() - DMat3::IDENTITY;
    let K = (ratio.to_cols_array().iter().map(|x| x * x).sum::<f64>() / 3.0).sqrt();
    Ok([centre, velocity, rate, turn, (found.mass / mass - 1.0).abs(), K])
}
