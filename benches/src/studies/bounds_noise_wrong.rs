//! Bounds of contacts whose noise is not what is stated or assumed: how often they hold, and what is said about it.
//!
//! Usage: `bounds_noise_wrong [RUNS [FIRST_SEED]]` (90 runs a row from seed 80000 by default). Writes the page to standard
//! output.

use recon_benches::noisy_contacts::{Case, Course, Levels, Tally, TrueNoise, WrongContacts};
use std::ops::Range;

const CONFIDENCE: f64 = 0.95;
const COUNTS: [usize; 3] = [300, 600, 1000];
/// Stated and estimated levels, each with all numbers of contacts.
const COLUMNS: usize = 2 * COUNTS.len();

type Failure = Box<dyn std::error::Error>;
type Row = (&'static str, TrueNoise);
type Tallies = (Row, [Tally; COLUMNS]);

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let runs: u64 = words.next().map_or(Ok(90), |a| a.parse())?;
    let first: u64 = words.next().map_or(Ok(80_000), |a| a.parse())?;
    let seeds = first..first + runs;
    let tallies = rows().into_iter().map(|row| Ok((row, tally(row.1, seeds.clone())?)));
    let tallies = tallies.collect::<Result<Vec<Tallies>, Failure>>()?;
    println!("# Bounds of contacts whose noise is not as stated or assumed\n");
    println!(
        "Made by `cargo xtask study bounds_noise_wrong {runs} {first}`: {runs} runs a row, seeds {first} to {}. A third each \
         ellipsoids, eggs and rounded boxes, stated noise of 1e-4, 1e-3, 1e-2 of the size and in rad, three curves, 95 %. Levels \
         are stated or estimated; numbers of contacts are those of all curves together.",
        seeds.end.saturating_sub(1)
    );
    table("Both bounds hold, of those with bounds (the others are refused)", &tallies, |t| {
        format!("{} of {}", t.hold, t.bounded)
    });
    table("Wrong contacts that are found, % (of how many)", &tallies, |t| match t.wrong {
        0 => String::new(),
        wrong => format!("{:.0} ({wrong})", 100.0 * t.found as f64 / wrong as f64),
    });
    table("Right contacts taken for wrong, a run with bounds", &tallies, |t| match t.bounded {
        0 => String::new(),
        bounded => format!("{:.1}", t.taken as f64 / bounded as f64),
    });
    table(
        "Runs with bounds and a warning that noise is not as stated, or not tested (misses without one)",
        &tallies,
        |t| format!("{} ({})", t.warned, t.silent),
    );
    Ok(())
}

fn rows() -> Vec<Row> {
    let changing = |course| TrueNoise { course, correlation: 0.0, wrong: None };
    let right = changing(Course::Constant(1.0));
    let wrong = |share, pairs| TrueNoise { wrong: Some(WrongContacts { share, pairs }), ..right };
    vec![
        ("as stated", right),
        ("twice", changing(Course::Constant(2.0))),
        ("changes smoothly by 1 : 3", changing(Course::Smooth(3.0))),
        ("smoothly by 1 : 5", changing(Course::Smooth(5.0))),
        ("steps by 1 : 3", changing(Course::Step(3.0))),
        ("steps by 1 : 5", changing(Course::Step(5.0))),
        ("in proportion to a force, 1 to 4", changing(Course::Force(4.0))),
        ("four times over an eighth of a curve", changing(Course::Burst(4.0))),
        ("correlation 0.95", TrueNoise { correlation: 0.95, ..right }),
        ("1 % off by 5 to 40 deviations", wrong(0.01, false)),
        ("2 %", wrong(0.02, false)),
        ("5 %", wrong(0.05, false)),
        ("2 %, in pairs alike", wrong(0.02, true)),
        ("5 %, in pairs alike", wrong(0.05, true)),
    ]
}

fn tally(noise: TrueNoise, seeds: Range<u64>) -> Result<[Tally; COLUMNS], Failure> {
    let mut tallies = [Tally::default(); COLUMNS];
    for (column, count) in COUNTS.into_iter().enumerate() {
        for seed in seeds.clone() {
            let run = crate::rows::row(|| -> Result<[[usize; 7]; 2], Failure> {
                let case = Case::of_seed(noise, count, seed)?;
                let of = |levels| Tally::of(&case, levels, CONFIDENCE).counts().map(|count| *count);
                Ok([of(Levels::Stated), of(Levels::Estimated)])
            })?;
            for (k, run) in run.into_iter().flatten().enumerate() {
                let sums = tallies[column + k * COUNTS.len()].counts();
                sums.into_iter().zip(run).for_each(|(sum, count)| *sum += count);
            }
        }
    }
    Ok(tallies)
}

fn table(title: &str, tallies: &[Tallies], cell: fn(&Tally) -> String) {
    println!("\n## {title}\n");
    println!("| noise | stated, 300 | 600 | 1000 contacts | estimated, 300 | 600 | 1000 |");
    println!("|---|---|---|---|---|---|---|");
    for ((name, _), row) in tallies {
        let cells: Vec<String> = row.iter().map(cell).collect();
        println!("| {name} | {} |", cells.join(" | "));
    }
}
