//! Certified gap over the way of a palm, planner by planner, in space and with friction.
//!
//! Usage: `parallel [EACH [FIRST [false]]]`: bodies of each family (10) and the first of their seeds. Prints docs/parallel.md; with `false` the count of
//! false certificates alone.

mod out_of_reach;

use recon::observer::rolling::RollingNoise;
use recon_benches::parallel::{LOOKAHEAD, PLANNERS, Rolling, Setting, runs};
use recon_benches::reaching::Bodies;
use recon_benches::reaching::statistics::{median_and_tail, quantile, ratio_of_medians};
use recon_benches::rows::is_part;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Seeds of the bodies: nothing was chosen on them. Those of tuning are 1000 to 1003, those of an earlier run 87000 to 87009.
const FIRST_SEED: u64 = 88_000;
/// Gaps of the tables.
const GAPS: [f64; 3] = [0.4, 0.3, 0.2];
/// Rubber on most things.
const SETTING: Setting = Setting { friction: 0.8, goal: 0.2, way: 40.0, noise: None };
/// Other frictions.
const FRICTIONS: [f64; 3] = [0.2, 0.4, 1.2];
/// Bodies of each family under noise, for horizons, and for frictions.
const FEW: u64 = 4;
const FINE: RollingNoise = RollingNoise { contact: 1e-3, palm: 1e-4, spin: 1e-3 };
const NOISY: Setting = Setting { goal: 0.3, noise: Some((FINE, CONTACTS)), ..SETTING };
/// Contacts that the confidence is shared among.
const CONTACTS: usize = 160;
/// Coarser sensors, and pads that let more spin.
const COARSER: [RollingNoise; 4] = [
    RollingNoise { spin: 0.0, ..FINE },
    RollingNoise { spin: 1e-2, ..FINE },
    RollingNoise { contact: 1e-2, ..FINE },
    RollingNoise { palm: 1e-3, ..FINE },
];

type Compared = (&'static str, Vec<Rolling>);

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(10), |a| a.parse())?;
    let first: u64 = crate::words().nth(1).map_or(Ok(FIRST_SEED), |a| a.parse())?;
    let bodies = Bodies { first, each };
    if crate::words().nth(2).is_some_and(|word| word == "false") {
        let runs = runs(&PLANNERS[1], bodies, &NOISY)?;
        if !is_part() {
            false_certificates(&runs);
        }
        return Ok(());
    }
    let few = Bodies { each: each.min(FEW), ..bodies };
    let of_all = |bodies: Bodies, setting: &Setting| {
        let one = |p: &recon_benches::reaching::Named<_>| Ok((p.name, runs(p, bodies, setting)?));
        PLANNERS.iter().map(one).collect::<Result<Vec<Compared>, Failure>>()
    };
    let exact = of_all(bodies, &SETTING)?;
    let noisy = of_all(few, &NOISY)?;
    let coarser = COARSER
        .iter()
        .map(|noise| {
            let setting = Setting { noise: Some((*noise, CONTACTS)), ..NOISY };
            Ok((*noise, runs(&PLANNERS[1], few, &setting)?))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let ahead = LOOKAHEAD
        .iter()
        .map(|(horizon, drawn, p)| Ok(([*horizon, *drawn], runs(p, few, &SETTING)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let frictions = FRICTIONS
        .iter()
        .map(|friction| {
            Ok((*friction, runs(&PLANNERS[1], few, &Setting { friction: *friction, ..SETTING })?))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    let confined = out_of_reach::rows(few)?;
    if is_part() {
        return Ok(());
    }
    println!("{}", include_str!("intro.md").trim_end());
    println!("\nMade by `cargo xtask study parallel {each}`.\n\n## Exact contacts\n");
    ways(&exact, 0, "Way of the upper palm, in mean widths of the body,");
    ways(&exact, 1, "Turn of the body, rad,");
    ends(&exact);
    ratios(&exact);
    lookahead(&ahead);
    rubbed(&frictions);
    out_of_reach::table(few, &confined);
    under_noise(&noisy, &coarser);
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

fn count(runs: &[Rolling], which: impl Fn(&Rolling) -> bool) -> usize {
    runs.iter().filter(|r| which(r)).count()
}

fn to(runs: &[Rolling], gap: f64, what: usize) -> Vec<Option<f64>> {
    runs.iter().map(|r| r.to(gap).map(|way| way[what])).collect()
}

fn heads() -> String {
    GAPS.map(|g| format!("{:.0} %", 100.0 * g)).join(" | ")
}

fn ways(all: &[Compared], what: usize, title: &str) {
    println!(
        "{title} to a gap, median / 90 %:\n\n| planner | {} |\n|---|{}",
        heads(),
        "---|".repeat(GAPS.len())
    );
    for (name, runs) in all {
        println!("| {name} | {} |", GAPS.map(|g| median_and_tail(&to(runs, g, what), 1)).join(" | "));
    }
    println!();
}

/// Mean and longest time of a choice, ms.
fn choice(runs: &[Rolling]) -> [f64; 2] {
    let choices: usize = runs.iter().map(|r| r.strokes[0]).sum();
    let spent: f64 = runs.iter().map(|r| r.planning[0]).sum();
    [1e3 * spent / choices.max(1) as f64, 1e3 * runs.iter().map(|r| r.planning[1]).fold(0.0, f64::max)]
}

fn ends(all: &[Compared]) {
    println!("How runs to 20 % within {:.0} widths end:\n", SETTING.way);
    println!(
        "| planner | proven | way spent | no stroke found | of these proven by another planner | held nowhere | strokes a run | stopped by shear | by a pad's edge | contacts | ms a choice: mean, most | bodies between the bounds after every contact |"
    );
    println!("|{}", "---|".repeat(12));
    for (name, runs) in all {
        let short = |why: &str| count(runs, |r| r.short == Some(why));
        let mean =
            |of: &dyn Fn(&Rolling) -> usize| runs.iter().map(of).sum::<usize>() as f64 / runs.len() as f64;
        let [usual, most] = choice(runs);
        println!(
            "| {name} | {} | {} | {} | {} | {} | {:.1} | {:.1} | {:.1} | {:.0} | {usual:.0}, {most:.0} | {} of {} |",
            count(runs, |r| r.short.is_none()),
            short("budget"),
            short("not found"),
            contradicted(all, runs),
            short("not held"),
            mean(&|r| r.strokes[0]),
            mean(&|r| r.strokes[1]),
            mean(&|r| r.strokes[2]),
            mean(&|r| r.contacts),
            count(runs, |r| r.holds),
            runs.len()
        );
    }
    println!();
}

/// Runs whose planner found no stroke any more, on bodies on which another planner has proven the goal.
fn contradicted(all: &[Compared], runs: &[Rolling]) -> usize {
    let proven = |k: usize| all.iter().any(|(_, other)| other.get(k).is_some_and(|r| r.short.is_none()));
    runs.iter().enumerate().filter(|(k, r)| r.short == Some("not found") && proven(*k)).count()
}

fn ratios(all: &[Compared]) {
    let Some((_, sweep)) = all.iter().find(|(name, _)| *name == "fixed sweep") else { return };
    println!(
        "Way of the fixed sweep over that of a planner, ratio of medians (95 % bootstrap interval over bodies):\n"
    );
    println!("| planner | {} |\n|---|{}", heads(), "---|".repeat(GAPS.len()));
    for (name, runs) in all.iter().filter(|(name, _)| *name != "fixed sweep") {
        let one = |gap: f64| over(&to(sweep, gap, 0), &to(runs, gap, 0));
        println!("| {name} | {} |", GAPS.map(one).join(" | "));
    }
    println!();
}

/// Ratio of medians with its interval; none where one of them is not reached.
fn over(ways: &[Option<f64>], of: &[Option<f64>]) -> String {
    let (ratio, [low, high]) = ratio_of_medians(ways, of);
    let end = |v: f64| if v.is_finite() { format!("{v:.2}") } else { "-".to_owned() };
    if ratio.is_finite() && ratio > 0.0 {
        format!("{ratio:.2} ({} to {})", end(low), end(high))
    } else {
        "-".to_owned()
    }
}

/// Cost against benefit: ways over strokes ahead and bodies drawn, beside those of the cheapest.
fn lookahead(all: &[([usize; 2], Vec<Rolling>)]) {
    println!(
        "## Horizon and bodies drawn\n\nGap per way, exact contacts, some of the bodies. Way of the palm in widths, median / 90 %.\n"
    );
    println!(
        "| strokes ahead | bodies drawn | {} | of the cheapest, to 30 % | proven | ms a choice: mean, most |",
        heads()
    );
    println!("|{}", "---|".repeat(8));
    let Some((_, cheapest)) = all.first() else { return };
    for ([horizon, drawn], runs) in all {
        let ways = GAPS.map(|gap| median_and_tail(&to(runs, gap, 0), 1));
        let ratio = over(&to(runs, 0.3, 0), &to(cheapest, 0.3, 0));
        let [usual, most] = choice(runs);
        println!(
            "| {horizon} | {drawn} | {} | {ratio} | {} of {} | {usual:.0}, {most:.0} |",
            ways.join(" | "),
            count(runs, |r| r.short.is_none()),
            runs.len()
        );
    }
    println!();
}

fn rubbed(all: &[(f64, Vec<Rolling>)]) {
    println!("## Friction\n\nGap per way, 1 ahead, exact contacts, some of the bodies.\n");
    println!(
        "| coefficient | {} | proven | no stroke found | stopped by shear, a run |\n|{}",
        heads(),
        "---|".repeat(7)
    );
    for (friction, runs) in all {
        let stopped: usize = runs.iter().map(|r| r.strokes[1]).sum();
        println!(
            "| {friction} | {} | {} of {} | {} | {:.1} |",
            GAPS.map(|gap| median_and_tail(&to(runs, gap, 0), 1)).join(" | "),
            count(runs, |r| r.short.is_none()),
            runs.len(),
            count(runs, |r| r.short == Some("not found")),
            stopped as f64 / runs.len() as f64
        );
    }
    println!();
}

/// Noise in words, as shares of the mean width.
fn words(noise: &RollingNoise) -> String {
    let RollingNoise { contact, palm, spin } = noise;
    format!("{} %, {} %, {} mrad", 100.0 * contact, 100.0 * palm, 1e3 * spin)
}

fn under_noise(all: &[Compared], coarser: &[(RollingNoise, Vec<Rolling>)]) {
    println!(
        "## With the estimator in the loop\n\nStandard deviations of contacts along palms, of the place of the upper palm (both over the mean width), and of what the pads let spin in a turn by 1 rad; 95 % shared among {CONTACTS} contacts, to 30 %.\n"
    );
    println!(
        "| noise | planner | widths to 30 %, median / 90 % | proven | way spent | no stroke found | contacts | ms a choice: mean, most | body between the bounds after every contact |\n|{}",
        "---|".repeat(9)
    );
    let fine = all.iter().map(|(name, runs)| (FINE, *name, runs));
    let coarser = coarser.iter().map(|(noise, runs)| (*noise, PLANNERS[1].name, runs));
    for (noise, name, runs) in fine.chain(coarser) {
        let contacts: Vec<Option<f64>> = runs.iter().map(|r| Some(r.contacts as f64)).collect();
        let [usual, most] = choice(runs);
        println!(
            "| {} | {name} | {} | {} of {} | {} | {} | {:.0} | {usual:.0}, {most:.0} | {} of {} |",
            words(&noise),
            median_and_tail(&to(runs, 0.3, 0), 1),
            count(runs, |r| r.short.is_none()),
            runs.len(),
            count(runs, |r| r.short == Some("budget")),
            count(runs, |r| r.short == Some("not found")),
            quantile(&contacts, 0.5),
            count(runs, |r| r.holds),
            runs.len()
        );
    }
    println!();
}

/// How often bounds were false at some contact, and ended with a certificate.
fn false_certificates(runs: &[Rolling]) {
    let wrong = |r: &Rolling| !r.holds;
    let proven = count(runs, |r| r.short.is_none());
    println!(
        "{} runs, {proven} proven; bounds false at some contact in {}, {} of these proven; no body was held in {}.",
        runs.len(),
        count(runs, wrong),
        count(runs, |r| wrong(r) && r.short.is_none()),
        count(runs, |r| r.short == Some("not held"))
    );
}
