//! Certified gap over palm motion with the estimator in the loop: planners, false certificates, horizon against bodies drawn, friction.
//!
//! Usage: `rolling_sensed [BODIES [RUNS [FIRST [PART]]]]`: bodies of the comparisons (30), runs that false certificates are counted over (1000), the first
//! seed of both, and one of `planners`, `false`, `horizon` and `others` to be made alone. Prints docs/rolling-sensed.md.

use exploration::rolling::{InformationRate, LargestGap, PalmSweep, RandomTurns, RollPlanner};
use recon_benches::reaching::statistics::{interval, median_and_tail, quantile, ratio_of_medians};
use recon_benches::rolling_sensed::{End, Run, RunError, Setting, run};
use recon_benches::rows::RowsError;

type Failure = Box<dyn std::error::Error>;
/// How one is made from a seed.
type Make = fn(u64) -> Box<dyn RollPlanner>;

/// Seeds of the bodies: nothing was chosen on them. Those of tuning are 0 to 9 and 100 to 159.
const FIRST_SEED: u64 = 860_000;
const GAPS: [f64; 3] = [0.2, 0.1, 0.05];
/// Noise of the comparisons: 0.1 % of the size and of the weight, without friction.
const FINE: Setting = Setting { contact: 1e-3, force: 1e-3, friction: 0.0, gap: 0.05, motions: 25 };

const PLANNERS: [(&str, Make); 4] = [
    ("gap per radian, 2 ahead", |s| Box::new(InformationRate::new(s, 2).per_radian())),
    ("largest gap", |s| Box::new(LargestGap::new(s))),
    ("fixed sweep", |_| Box::new(PalmSweep::new())),
    ("random", |s| Box::new(RandomTurns::new(s))),
];

/// Horizon and bodies drawn.
const LOOKAHEAD: [(usize, usize); 7] = [(1, 1), (1, 4), (1, 12), (2, 4), (2, 12), (3, 4), (1, 32)];

/// What is kept of a run: radians and seconds to each gap, then how it ended, motions and doubts, milliseconds a choice, and whether the bounds held.
#[derive(Clone)]
struct Kept {
    to: [[f64; 2]; 3],
    end: usize,
    motions: usize,
    doubts: usize,
    choice: f64,
    holds: bool,
}

/// By the rest of the seed by three.
const KINDS: [&str; 3] = ["ellipses", "waves", "rounded polygons"];

const ENDS: [End; 6] = [End::Proven, End::Budget, End::NotFound, End::Lost, End::Stopped, End::Doubted];

type Row = ([[f64; 2]; 3], [usize; 3], f64, bool);

#[derive(Debug, thiserror::Error)]
enum Why {
    #[error(transparent)]
    Rows(#[from] RowsError),
    #[error(transparent)]
    Run(#[from] RunError),
}

fn kept(make: &dyn Fn(u64) -> Box<dyn RollPlanner>, seed: u64, of: Setting) -> Result<Option<Kept>, Why> {
    let row = crate::rows::row(|| -> Result<Row, Why> {
        let run: Run = run(make, seed, of)?;
        let to = GAPS.map(|gap| run.to(gap).unwrap_or([f64::INFINITY; 2]));
        let end = ENDS.iter().position(|end| *end == run.end).unwrap_or(ENDS.len());
        Ok((to, [end, run.motions, run.doubts], 1e3 * run.planning / run.motions.max(1) as f64, run.holds))
    })?;
    Ok(row.map(|(to, [end, motions, doubts], choice, holds)| Kept {
        to,
        end,
        motions,
        doubts,
        choice,
        holds,
    }))
}

fn all(
    make: &dyn Fn(u64) -> Box<dyn RollPlanner>,
    seeds: std::ops::Range<u64>,
    of: Setting,
) -> Result<Vec<Kept>, Why> {
    seeds.filter_map(|seed| kept(make, seed, of).transpose()).collect()
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let bodies: u64 = words.next().map_or(Ok(30), |a| a.parse())?;
    let runs: u64 = words.next().map_or(Ok(1000), |a| a.parse())?;
    let first: u64 = words.next().map_or(Ok(FIRST_SEED), |a| a.parse())?;
    let part = words.next();
    let asked = |name: &str| part.as_deref().is_none_or(|part| part == name);
    println!("{}\n", include_str!("intro.md").trim_end());
    let of_part = part.as_ref().map(|part| format!(" {part}")).unwrap_or_default();
    println!("Made by `cargo xtask study rolling_sensed {bodies} {runs} {first}{of_part}`.\n");
    let seeds = first..first + bodies;
    if asked("planners") {
        compare(&seeds)?;
    }
    if asked("false") {
        false_certificates(first + 1000, runs)?;
    }
    if asked("horizon") {
        lookahead(&seeds)?;
    }
    if asked("coarser") {
        others(&seeds, "Coarser sensors", &[(1e-3, 1e-2, 0.0, 25), (1e-2, 1e-2, 0.0, 25)])?;
    }
    if asked("friction") {
        others(&seeds, "Friction", &[(1e-3, 1e-3, 0.2, 12)])?;
    }
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

fn compare(seeds: &std::ops::Range<u64>) -> Result<(), Why> {
    let compared = PLANNERS
        .iter()
        .map(|(name, make)| Ok((*name, all(make, seeds.clone(), FINE)?)))
        .collect::<Result<Vec<_>, Why>>()?;
    planners(&compared);
    Ok(())
}

fn way(runs: &[Kept], gap: usize, what: usize) -> Vec<Option<f64>> {
    runs.iter().map(|r| Some(r.to[gap][what]).filter(|w| w.is_finite())).collect()
}

fn ended(runs: &[Kept], end: End) -> usize {
    runs.iter().filter(|r| ENDS.get(r.end) == Some(&end)).count()
}

/// Median and 90 % to each gap, how the runs ended, and in how many the bounds held at every look.
fn row(name: &str, runs: &[Kept], what: usize) -> String {
    let ways: Vec<String> = (0..GAPS.len()).map(|gap| median_and_tail(&way(runs, gap, what), 1)).collect();
    let ends: Vec<String> = ENDS.iter().map(|end| ended(runs, *end).to_string()).collect();
    let holds = runs.iter().filter(|r| r.holds).count();
    let mean = |sum: usize| sum as f64 / runs.len().max(1) as f64;
    format!(
        "| {name} | {} | {} | {:.1} | {:.1} | {holds} of {} |",
        ways.join(" | "),
        ends.join(" | "),
        mean(runs.iter().map(|r| r.motions).sum()),
        mean(runs.iter().map(|r| r.doubts).sum()),
        runs.len()
    )
}

const HEADS: &str = "20 % | 10 % | 5 % | proven | budget | no motion found | lost | no motion of rigid bodies | not relied on | motions a run | doubts a run | body between the bounds of every look |";
const LINE: &str = "|---|---|---|---|---|---|---|---|---|---|---|---|---|";

fn planners(all: &[(&str, Vec<Kept>)]) {
    for (what, title) in [(0, "Radians of palm motion"), (1, "Seconds")] {
        println!("{title} to a certified gap, median / 90 %:\n\n| planner | {HEADS}\n{LINE}");
        for (name, runs) in all {
            println!("{}", row(name, runs, what));
        }
        println!();
    }
    let Some((_, sweep)) = all.iter().find(|(name, _)| *name == "fixed sweep") else { return };
    println!(
        "Radians of the fixed sweep over those of a planner, ratio of medians (95 % bootstrap interval over bodies):\n"
    );
    println!("| planner | 20 % | 10 % | 5 % |\n|---|---|---|---|");
    for (name, runs) in all.iter().filter(|(name, _)| *name != "fixed sweep") {
        let one = |gap: usize| {
            let (ratio, [low, high]) = ratio_of_medians(&way(sweep, gap, 0), &way(runs, gap, 0));
            if ratio.is_finite() { format!("{ratio:.2} ({low:.2} to {high:.2})") } else { "-".to_owned() }
        };
        println!("| {name} | {} |", [0, 1, 2].map(one).join(" | "));
    }
    println!();
}

fn false_certificates(first: u64, count: u64) -> Result<(), Why> {
    // Of runs that are proven hardly one takes more motions, and those that are not take long.
    let of = Setting { gap: 0.1, motions: 12, ..FINE };
    let make = |s: u64| -> Box<dyn RollPlanner> { Box::new(InformationRate::new(s, 1).per_radian()) };
    let runs = all(&make, first..first + count, of)?;
    let wrong = runs.iter().filter(|r| !r.holds).count();
    let [low, high] = interval(wrong, runs.len()).map(|p| 100.0 * p);
    println!("## False certificates\n\n| bodies, to 10 % | {HEADS}\n{LINE}");
    for (k, kind) in KINDS.iter().enumerate() {
        let of = |(seed, run): (u64, &Kept)| (seed % 3 == k as u64).then(|| run.clone());
        let of: Vec<Kept> = (first..).zip(&runs).filter_map(of).collect();
        println!("{}", row(kind, &of, 0));
    }
    println!("{}\n", row("all", &runs, 0));
    let proven = ended(&runs, End::Proven);
    let bad = runs.iter().filter(|r| !r.holds && ENDS.get(r.end) == Some(&End::Proven)).count();
    let [least, most] = interval(bad, proven).map(|p| 100.0 * p);
    println!(
        "Gap per radian, one motion ahead, at most 12 motions. At 95 % bounds were false at some look in {wrong} of {} runs ({low:.2} to {high:.2} %, exact 95 % interval), {bad} of which ended with a certificate, of {proven} \
         that did ({least:.2} to {most:.2} %).\n",
        runs.len()
    );
    Ok(())
}

fn lookahead(seeds: &std::ops::Range<u64>) -> Result<(), Why> {
    println!(
        "## Horizon and bodies drawn\n\n| motions ahead | bodies drawn | rad to 20 %, median / 90 % | to 10 % | to 5 % | not proven | ms a choice |\n|---|---|---|---|---|---|---|"
    );
    for (horizon, bodies) in LOOKAHEAD {
        let make = move |s: u64| -> Box<dyn RollPlanner> {
            Box::new(InformationRate::new(s, horizon).per_radian().with_bodies(bodies))
        };
        let runs = all(&make, seeds.clone(), FINE)?;
        let ways: Vec<String> = (0..GAPS.len()).map(|gap| median_and_tail(&way(&runs, gap, 0), 1)).collect();
        let choice: Vec<Option<f64>> = runs.iter().map(|r| Some(r.choice)).collect();
        println!(
            "| {horizon} | {bodies} | {} | {} | {:.0} |",
            ways.join(" | "),
            runs.len() - ended(&runs, End::Proven),
            quantile(&choice, 0.5)
        );
    }
    println!();
    Ok(())
}

/// Noise of contacts and forces, friction, and motions at most.
type Other = (f64, f64, f64, usize);

fn others(seeds: &std::ops::Range<u64>, title: &str, of: &[Other]) -> Result<(), Why> {
    println!(
        "## {title}\n\nGap per radian, 1 ahead, radians of palm motion.\n\n| noise of contacts, forces; friction; motions at most | {HEADS}\n{LINE}"
    );
    let make = |s: u64| -> Box<dyn RollPlanner> { Box::new(InformationRate::new(s, 1).per_radian()) };
    for &(contact, force, friction, motions) in of {
        let of = Setting { contact, force, friction, motions, ..FINE };
        let name = format!("{} %, {} %; {friction}; {motions}", 100.0 * contact, 100.0 * force);
        println!("{}", row(&name, &all(&make, seeds.clone(), of)?, 0));
    }
    println!();
    Ok(())
}
