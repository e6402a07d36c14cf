//! The least model that serves, on scenes drawn by a seed: whether the wanted accuracy is reached, and what that costs beside the cheapest found by
//! trying all.
//!
//! Usage: `least_model [SCENES] [SEED]` (100 by default: half of them simulated, half of them logs to estimate from). Of some seeds there is no scene: these are left out, and counted.

mod estimates;
mod logs;
mod motions;
mod picture;
mod scenes;

use crate::rows::{Cells, is_part, row};

type Failure = Box<dyn std::error::Error>;

/// Seed of the scenes, on which nothing was set.
const SEED: u64 = 77_000;

/// What came of a scene.
pub(crate) struct Outcome {
    kind: String,
    wanted: f64,
    /// Error against the truth, and what was stated of it.
    error: f64,
    stated: f64,
    is_reached: bool,
    /// Processor time of what was chosen, of all that led to it and of the cheapest that was found to reach the accuracy, ms.
    chosen: f64,
    all: f64,
    cheapest: f64,
    /// What was chosen, and what was the cheapest.
    what: [String; 2],
}

impl Cells for Outcome {
    fn write(&self, to: &mut Vec<String>) {
        self.kind.write(to);
        [self.wanted, self.error, self.stated].write(to);
        self.is_reached.write(to);
        [self.chosen, self.all, self.cheapest].write(to);
        self.what.write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let kind = String::read(from)?;
        let [wanted, error, stated] = <[f64; 3]>::read(from)?;
        let is_reached = bool::read(from)?;
        let [chosen, all, cheapest] = <[f64; 3]>::read(from)?;
        Some(Self {
            kind,
            wanted,
            error,
            stated,
            is_reached,
            chosen,
            all,
            cheapest,
            what: <[String; 2]>::read(from)?,
        })
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    let words: Vec<String> = crate::words().collect();
    let count: usize = words.first().map_or(Ok(100), |word| word.parse())?;
    let seed: u64 = words.get(1).map_or(Ok(SEED), |word| word.parse())?;
    let motions = some(count / 2, seed, motions::one)?;
    let estimates = some(count - count / 2, seed, estimates::one)?;
    if is_part() {
        return Ok(());
    }
    println!("# The least model that serves\n");
    println!("{}", include_str!("about.md"));
    for (name, all, asked) in
        [("Simulations", &motions, count / 2), ("Estimates", &estimates, count - count / 2)]
    {
        println!("\n## {name}\n\n{} of the {asked} seeds from {seed} on.\n", all.len());
        table(all);
    }
    picture::write(&motions, &estimates)?;
    println!(
        "\n![Cost beside the cheapest](charts/least-model.svg)\n\nMade by `cargo xtask study least_model {count} {seed}`."
    );
    Ok(())
}

/// What came of those of so many seeds of which there is a scene.
fn some(
    count: usize,
    seed: u64,
    one: impl Fn(usize, u64) -> Result<Option<Outcome>, Failure>,
) -> Result<Vec<Outcome>, Failure> {
    let mut all = Vec::with_capacity(count);
    for k in 0..count {
        let made = row(|| {
            let made = one(k, seed + k as u64)?;
            made.iter().for_each(progress);
            Ok::<_, Failure>(made)
        })?;
        all.extend(made.flatten());
    }
    Ok(all)
}

/// Says how far it is.
fn progress(of: &Outcome) {
    eprintln!(
        "{}: {:.1e} wanted, {:.1e} off, {:.2} of the cheapest ({} beside {})",
        of.kind,
        of.wanted,
        of.error,
        of.chosen / of.cheapest,
        of.what[0],
        of.what[1]
    );
}

fn table(all: &[Outcome]) {
    println!(
        "| scenes | runs | reached | said so | wrong in silence | cost over the cheapest: median | 90 % | largest | within twice | with all trials: median | 90 % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    let mut kinds: Vec<&str> = all.iter().map(|of| of.kind.as_str()).collect();
    kinds.sort_unstable();
    kinds.dedup();
    for kind in kinds {
        line(kind, &all.iter().filter(|of| of.kind == kind).collect::<Vec<_>>());
    }
    line("all", &all.iter().collect::<Vec<_>>());
    let missed: Vec<&Outcome> =
        all.iter().filter(|of| of.error > of.wanted || of.chosen > 2.0 * of.cheapest).collect();
    if !missed.is_empty() {
        println!("\nNot reached, or dearer than twice the cheapest:\n");
    }
    for of in missed {
        println!(
            "- {}: {:.1e} wanted, {:.1e} stated, {:.1e} off; {} in {:.2} ms, cheapest {} in {:.2} ms",
            of.kind, of.wanted, of.stated, of.error, of.what[0], of.chosen, of.what[1], of.cheapest
        );
    }
}

fn line(name: &str, all: &[&Outcome]) {
    let count = |is: &dyn Fn(&Outcome) -> bool| all.iter().filter(|of| is(of)).count();
    let share = |mut ratios: Vec<f64>, p: f64| {
        ratios.sort_by(f64::total_cmp);
        ratios.get(((ratios.len() as f64 - 1.0) * p) as usize).copied().unwrap_or(f64::NAN)
    };
    let own = || {
        all.iter().filter(|of| of.cheapest.is_finite()).map(|of| of.chosen / of.cheapest).collect::<Vec<_>>()
    };
    let whole =
        || all.iter().filter(|of| of.cheapest.is_finite()).map(|of| of.all / of.cheapest).collect::<Vec<_>>();
    println!(
        "| {name} | {} | {} | {} | {} | {:.2} | {:.2} | {:.2} | {} | {:.2} | {:.2} |",
        all.len(),
        count(&|of| of.error <= of.wanted),
        count(&|of| of.is_reached),
        count(&|of| of.is_reached && of.error > of.wanted),
        share(own(), 0.5),
        share(own(), 0.9),
        share(own(), 1.0),
        count(&|of| of.chosen <= 2.0 * of.cheapest),
        share(whole(), 0.5),
        share(whole(), 0.9),
    );
}
