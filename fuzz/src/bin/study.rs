//! Every target on inputs made of its seeds: `study [INPUTS]`, 1,000,000 by default, shared among the targets.
//!
//! Prints a page of Markdown; ends with an error if an input broke a promise, which is then left in `artifacts`.

use exact_hull::generators::Source;
use recon_fuzz::{TARGETS, Target, inputs};
use std::error::Error;
use std::panic::catch_unwind;
use std::path::Path;
use std::time::{Duration, Instant};

struct Tally {
    accepted: usize,
    broken: usize,
    slowest: Duration,
    time: Duration,
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words.iter().any(|word| word.starts_with("--")) {
        return Err("fuzz_targets is not made in parts: it is done within minutes".into());
    }
    let all: usize = words.first().map_or(Ok(1_000_000), |count| count.parse())?;
    let each = all.div_ceil(TARGETS.len());
    // Those that are caught are counted.
    std::panic::set_hook(Box::new(|_| {}));
    println!("# Fuzzing\n");
    println!(
        "`cargo xtask study fuzz_targets`: {} inputs made of the committed seeds (bytes changed, cut, doubled and joined, words that parsers\n\
         stumble over; one in twenty is random bytes), by a fixed seed. An input is broken where a target panics: by itself, by overflow, by an\n\
         assertion of the library, or because what it returned does not keep its promise (hulls are judged by exact signs).\n",
        each * TARGETS.len()
    );
    println!(
        "| target | seeds (accepted) | inputs | accepted | refused by name | broken | slowest, ms | all, s |\n|---|---|---|---|---|---|---|---|"
    );
    let mut broken = 0;
    for (which, target) in TARGETS.iter().enumerate() {
        let seeds = inputs::seeds(target.name)?;
        let tally = run(target, &seeds, each, which as u64)?;
        broken += tally.broken;
        let refused = each - tally.accepted - tally.broken;
        println!(
            "| {} | {} ({}) | {each} | {} | {refused} | {} | {:.1} | {:.1} |",
            target.name,
            seeds.len(),
            seeds.iter().filter(|seed| (target.run)(seed)).count(),
            tally.accepted,
            tally.broken,
            1e3 * tally.slowest.as_secs_f64(),
            tally.time.as_secs_f64()
        );
    }
    if broken > 0 {
        Err(format!("{broken} inputs broke a promise: see fuzz/artifacts").into())
    } else {
        Ok(())
    }
}

fn run(target: &Target, seeds: &[Vec<u8>], count: usize, which: u64) -> Result<Tally, Box<dyn Error>> {
    let mut s = Source::new(0xF0_22 + which);
    let mut tally = Tally { accepted: 0, broken: 0, slowest: Duration::ZERO, time: Duration::ZERO };
    for _ in 0..count {
        let input = inputs::made(seeds, &mut s);
        let start = Instant::now();
        let outcome = catch_unwind(|| (target.run)(&input));
        let time = start.elapsed();
        tally.slowest = tally.slowest.max(time);
        tally.time += time;
        match outcome {
            Ok(accepted) => tally.accepted += usize::from(accepted),
            Err(_) => {
                let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("artifacts").join(target.name);
                std::fs::create_dir_all(&folder)?;
                std::fs::write(folder.join(format!("broken-{}", tally.broken)), &input)?;
                tally.broken += 1;
            }
        }
    }
    Ok(tally)
}
