//! The motion sample by sample: over many scenes, sizes and qualities of sensors, whether it is found, kept and as good as it says;
//! what gaps cost; and at the pace of a robot, the time of a sample.
//!
//! Usage: `streaming [SCENES SEED [WHAT]]`: with these two tables alone, of so many scenes a size and of the two worse qualities, and of what is not as
//! stated; with a word of what is not as stated in its rows alone.

mod paced;
mod tally;

use recon::observer::contacts::stream::{PlaneReadings, StreamError, StreamEstimate};
use recon_benches::fault::FAULTS;
use recon_benches::streaming::{Case, some};
use tally::Tally;

pub(crate) type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Noise of contacts as a share of the size, and of forces as one of what a palm carries, in per cent.
const QUALITIES: [[f64; 2]; 4] = [[1e-6, 1e-5], [0.01, 0.1], [0.1, 1.0], [1.0, 2.0]];
/// Sizes, m, with samples a second: so many that a natural time has some tens of them.
const SIZES: [(f64, f64); 3] = [(0.03, 1000.0), (0.3, 500.0), (3.0, 200.0)];
/// Scenes of each size, and the first of their seeds.
const SCENES: usize = 20;
const SEED: u64 = 52_000;
/// Length of the logs: in s, and in natural times, whichever is shorter.
const LONGEST: [f64; 2] = [30.0, 80.0];
/// Lengths of gaps, ms, and scenes that have one.
const GAPS: [f64; 3] = [20.0, 60.0, 200.0];
const WITH_GAPS: usize = 10;

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = std::env::args().skip(2);
    let given = words.next().zip(words.next());
    if let Some((scenes, seed)) = &given {
        let what = words.next();
        if what.is_none() {
            table(scenes.parse()?, seed.parse()?, &QUALITIES[2..])?;
        }
        return faulty(scenes.parse()?, seed.parse()?, &what.unwrap_or_default());
    }
    println!("# Streaming\n\nMade by `cargo xtask study streaming`.\n");
    println!(
        "Ellipsoids with axes of up to 1 : 2.5 and moments up to 15 % off those of a uniform one, on three palms that swing, with spins of up"
    );
    println!(
        "to half a radian in a natural time (the root of size over gravity); {SCENES} scenes of each size, up to {} s or {} natural times",
        LONGEST[0], LONGEST[1]
    );
    println!(
        "or up to the loss of contact; from no guess. Times are natural ones. Available: share of the samples after the first motion at"
    );
    println!(
        "which one is stated. Lost: how often one is not any more. NEES / 9: squared errors of position, velocity and angular velocity over"
    );
    println!(
        "their covariance, one where that is true. Beyond 5: share of scenes with a stated number more than 5 deviations off. Moments: how far"
    );
    println!("the worst of three principal moments is off at the last stated sample, in the median.\n");
    table(SCENES, SEED, &QUALITIES)?;
    gaps()?;
    faulty(WITH_GAPS, SEED, "")?;
    paced::main()
}

/// What is not as stated and has this word in its name, over streams that are long enough for it to add up.
fn faulty(scenes: usize, seed: u64, word: &str) -> Result<(), Failure> {
    println!(
        "\n## What is not as stated\n\nThe scenes of 0.3 m with contacts off by 0.1 % and forces by 1 %; of a body that is not known, or whose constants are wrong.\n"
    );
    println!(
        "| what | found | after: median, largest | available: mean, least | lost | NEES / 9: mean, largest | beyond 5 | moments % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for fault in FAULTS.iter().filter(|fault| fault.name().contains(word)) {
        crate::print_line(|| -> Result<String, Failure> {
            let mut tally = Tally::default();
            for case in some(scenes, seed, 0.3, 500.0, QUALITIES[2], LONGEST)? {
                let case = case.with(fault)?;
                tally.take(&case, &followed(&case, fault.of_body(), |_| true)?, f64::NEG_INFINITY);
            }
            Ok(format!("| {} |{}", fault.name(), tally.row()))
        })?;
    }
    Ok(())
}

fn table(scenes: usize, seed: u64, qualities: &[[f64; 2]]) -> Result<(), Failure> {
    println!(
        "| size m | contacts %, forces % | body | found | after: median, largest | available: mean, least | lost | NEES / 9: mean, largest | beyond 5 | moments % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (size, rate) in SIZES {
        for &quality in qualities {
            for (name, known) in [("known", true), ("unknown", false)] {
                crate::print_line(|| -> Result<String, Failure> {
                    let mut tally = Tally::default();
                    for case in some(scenes, seed, size, rate, quality, LONGEST)? {
                        tally.take(&case, &followed(&case, known, |_| true)?, f64::NEG_INFINITY);
                    }
                    Ok(format!("| {size} | {}, {} | {name} |{}", quality[0], quality[1], tally.row()))
                })?;
            }
        }
    }
    Ok(())
}

fn gaps() -> Result<(), Failure> {
    println!(
        "\n## Gaps\n\nThe scenes of 0.3 m with contacts off by 0.1 % and forces by 1 %, the samples of some time after 25 natural ones left out:"
    );
    println!(
        "availability and errors after the gap; and how long after its end, in natural times, the motion is stated again.\n"
    );
    println!(
        "| gap ms | body | stated again after: median, largest | available: mean, least | lost | NEES / 9: mean, largest | beyond 5 | moments % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for gap in GAPS {
        for (name, known) in [("known", true), ("unknown", false)] {
            crate::print_line(|| -> Result<String, Failure> {
                let mut tally = Tally::default();
                for case in some(WITH_GAPS, SEED, 0.3, 500.0, QUALITIES[2], LONGEST)? {
                    let from = case.start() + 25.0 * case.natural;
                    let to = from + gap / 1000.0;
                    let estimates = followed(&case, known, |t| !(from..to).contains(&t))?;
                    tally.take(&case, &estimates, to);
                }
                Ok(format!("| {gap} | {name} |{}", tally.after_gap()))
            })?;
        }
    }
    Ok(())
}

/// Estimates with the numbers of their samples, of those that are `kept` by their times.
fn followed(
    case: &Case,
    known: bool,
    kept: impl Fn(f64) -> bool,
) -> Result<Vec<(usize, StreamEstimate)>, Failure> {
    let mut stream = case.stream(known)?;
    let mut readings = PlaneReadings::new(None);
    let mut estimates = Vec::with_capacity(case.samples.len());
    let mut before = 0;
    for (k, sample) in case.samples.iter().enumerate().filter(|(_, sample)| kept(sample.t)) {
        if let Some((t, sensed)) = readings.push(sample)? {
            // A sample that a palm's readings stand still in is refused, and left out.
            match stream.push(t, &sensed) {
                Ok(estimate) => estimates.push((before, estimate)),
                Err(StreamError::Stuck { .. }) => {}
                Err(error) => return Err(error.into()),
            }
        }
        before = k;
    }
    Ok(estimates)
}
