//! What a sample takes at the pace of a robot, with modes and without.

use super::super::contact_estimates::{Case, case};
use super::super::contact_logs::log::{Anything, Log};
use super::super::contact_modes_estimated::NOISE;
use super::{RATE, sensed};
use cpu_time::{ProcessTime, ThreadTime};
use recon::observer::contacts::ContactOptions;
use recon::observer::contacts::stream::{MotionStream, StreamOptions};
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

pub(super) fn main(folder: &Path, seed: u64, names: &[&str]) -> Anything<()> {
    println!("\n{}", include_str!("cost.md").trim_end());
    println!();
    println!(
        "| log | palms | modes | samples | own time: median us, 99 %, largest | wall: 99 % us, largest, over 1 ms | cores |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in names {
        let file = Log::read(folder, name)?;
        for mode_odds in [false, true] {
            println!("{}", row(&file, name, seed, mode_odds)?);
        }
    }
    Ok(())
}

fn row(file: &Log, name: &str, seed: u64, mode_odds: bool) -> Anything<String> {
    let Case { log, options, .. } = case(file, NOISE, f64::INFINITY, seed)?;
    let (palms, samples) = sensed(&log)?;
    let count = palms.len();
    let contacts = ContactOptions { mode_odds, suspects: true, ..options };
    let mut stream = MotionStream::new(palms, StreamOptions { contacts, sample_rate: RATE })?;
    let (started, used) = (Instant::now(), ProcessTime::now());
    let (mut own, mut wall) = (Vec::new(), Vec::new());
    for (k, sensed) in samples.iter().enumerate() {
        let due = Duration::from_secs_f64(log.times()[k]);
        if let Some(left) = due.checked_sub(started.elapsed()) {
            sleep(left);
        }
        let (thread, at) = (ThreadTime::now(), Instant::now());
        stream.push(log.times()[k], sensed)?;
        wall.push(1e6 * at.elapsed().as_secs_f64());
        own.push(1e6 * thread.elapsed().as_secs_f64());
    }
    let cores = used.elapsed().as_secs_f64() / started.elapsed().as_secs_f64();
    own.sort_by(f64::total_cmp);
    wall.sort_by(f64::total_cmp);
    let at = |all: &[f64], share: f64| all[((all.len() - 1) as f64 * share) as usize];
    let told = if mode_odds { "told" } else { "not told" };
    Ok(format!(
        "| {name} | {count} | {told} | {} | {:.1}, {:.0}, {:.0} | {:.0}, {:.0}, {} | {cores:.2} |",
        own.len(),
        at(&own, 0.5),
        at(&own, 0.99),
        at(&own, 1.0),
        at(&wall, 0.99),
        at(&wall, 1.0),
        wall.iter().filter(|us| **us > 1000.0).count(),
    ))
}
