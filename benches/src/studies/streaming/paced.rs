//! At the pace of a robot: how long a sample takes while the other thread solves, and how much of a core that takes.

use super::tally::quantile;
use super::{Failure, QUALITIES, SEED};
use recon_benches::streaming::{Paced, paced, some};

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
                crate::print_line(|| -> Result<String, Failure> {
                    let Paced { mut microseconds, cores, .. } = paced(&case, known)?;
                    microseconds.sort_by(f64::total_cmp);
                    let slow = microseconds.iter().filter(|&&us| us > 1000.0).count();
                    Ok(format!(
                        "| {size} | {name} | {} | {:.1} | {:.0} | {:.0} | {slow} | {cores:.2} |",
                        microseconds.len(),
                        quantile(&microseconds, 0.5),
                        quantile(&microseconds, 0.99),
                        quantile(&microseconds, 1.0)
                    ))
                })?;
            }
        }
    }
    Ok(())
}
