//! At the pace of a robot: how long a sample takes while the other thread solves, and how much of a core that takes.

use super::scene::{Case, some};
use super::tally::quantile;
use super::{Failure, QUALITIES, SEED};
use cpu_time::ProcessTime;
use recon::observer::PlaneReadings;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Sizes, m.
const SIZES: [f64; 3] = [0.03, 0.3, 3.0];
const RATE: f64 = 1000.0;
/// Longest log, s.
const LONGEST: f64 = 10.0;

pub(super) fn main() -> Result<(), Failure> {
    println!(
        "\n## At the pace of a robot\n\nOne scene of each size at 1 kHz, contacts off by 0.1 % and forces by 1 %; each sample is pushed when its time has come. Wall"
    );
    println!(
        "time of a push, which waits where the other thread is not done when its window is due; processor time of both threads together.\n"
    );
    println!("| size m | body | samples | median us | 99 % us | largest us | over 1 ms | cores |");
    println!("|---|---|---|---|---|---|---|---|");
    for size in SIZES {
        for (name, known) in [("known", true), ("unknown", false)] {
            for case in some(1, SEED, size, RATE, QUALITIES[2], [LONGEST, f64::INFINITY])? {
                let (mut microseconds, cores) = paced(&case, known)?;
                microseconds.sort_by(f64::total_cmp);
                let slow = microseconds.iter().filter(|&&us| us > 1000.0).count();
                println!(
                    "| {size} | {name} | {} | {:.1} | {:.0} | {:.0} | {slow} | {cores:.2} |",
                    microseconds.len(),
                    quantile(&microseconds, 0.5),
                    quantile(&microseconds, 0.99),
                    quantile(&microseconds, 1.0)
                );
            }
        }
    }
    Ok(())
}

fn paced(case: &Case, known: bool) -> Result<(Vec<f64>, f64), Failure> {
    let mut stream = case.stream(known)?;
    let mut readings = PlaneReadings::new(None);
    let mut microseconds = Vec::with_capacity(case.samples.len());
    let (clock, processor) = (Instant::now(), ProcessTime::now());
    for sample in &case.samples {
        let due = Duration::from_secs_f64((sample.t - case.start()).max(0.0));
        if let Some(early) = due.checked_sub(clock.elapsed()) {
            sleep(early);
        }
        let begun = Instant::now();
        if let Some((t, sensed)) = readings.push(sample)? {
            stream.push(t, &sensed)?;
            microseconds.push(1e6 * begun.elapsed().as_secs_f64());
        }
    }
    Ok((microseconds, processor.elapsed().as_secs_f64() / clock.elapsed().as_secs_f64()))
}
