//! Certified gap over radians of palm motion and over seconds, planner by planner.
//!
//! Usage: `rolling [EACH [FIRST]]`: bodies of each family (10) and the first of their seeds. Prints docs/rolling.md.

mod confined;

use recon_benches::reaching::Bodies;
use recon_benches::reaching::statistics::{median_and_tail, quantile, ratio_of_medians};
use recon_benches::rolling::{Asked, LOOKAHEAD, Noisy, PLANNERS, Rolling, choice_ms, runs};
use recon_benches::rows::is_part;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Seeds of the bodies: nothing was chosen on them. Those of tuning are 1000 to 1005, those of earlier runs 83000 to 85009.
const FIRST_SEED: u64 = 86_000;
/// Gaps of the tables.
const GAPS: [f64; 4] = [0.3, 0.2, 0.1, 0.05];
/// Radians of palm motion at most.
const RADIANS: f64 = 40.0;
/// Bodies of each family under noise, and for horizons.
const NOISY: u64 = 4;

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(10), |a| a.parse())?;
    let first: u64 = crate::words().nth(1).map_or(Ok(FIRST_SEED), |a| a.parse())?;
    let bodies = Bodies { first, each };
    println!("{}", include_str!("intro.md").trim_end());
    println!("\nMade by `cargo xtask study rolling {each}`.\n");
    let asked = Asked { goal: 0.05, radians: RADIANS, noise: None, room: None };
    let exact = PLANNERS
        .iter()
        .map(|p| Ok((p.name, runs(p, bodies, &asked)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let few = Bodies { each: each.min(NOISY), ..bodies };
    let under_noise = Asked { goal: 0.15, noise: Some(Noisy { level: 1e-3, budget: 60 }), ..asked };
    let noisy = PLANNERS
        .iter()
        .map(|p| Ok((p.name, runs(p, few, &under_noise)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let ahead = LOOKAHEAD
        .iter()
        .map(|(horizon, drawn, p)| Ok(([*horizon, *drawn], runs(p, few, &asked)?)))
        .collect::<Result<Vec<_>, Failure>>()?;
    let confined = confined::rows(bodies)?;
    if is_part() {
        return Ok(());
    }
    println!("## Exact contacts\n");
    ways(&exact, 0, "Radians of palm motion");
    ways(&exact, 1, "Seconds");
    ends(&exact);
    ratios(&exact);
    lookahead(&ahead);
    println!(
        "## Under noise\n\nPoints off by 0.1 % of the mean width per axis, normals by 2 mrad (standard deviations), 95 % shared among 60 contacts, to 15 %.\n"
    );
    println!(
        "| planner | rad to 15 %, median / 90 % | reached | contacts | body between the bounds after every reading |\n|---|---|---|---|---|"
    );
    for (name, runs) in &noisy {
        let contacts: Vec<Option<f64>> = runs.iter().map(|r| Some(r.contacts as f64)).collect();
        let (reached, holds) = (count(runs, |r| r.short.is_none()), count(runs, |r| r.holds));
        let all = runs.len();
        println!(
            "| {name} | {} | {reached} of {all} | {:.0} | {holds} of {all} |",
            median_and_tail(&to(runs, 0.15, 0), 1),
            quantile(&contacts, 0.5)
        );
    }
    println!();
    confined::table(&confined);
    println!("\n{}", include_str!("outro.md").trim_end());
    Ok(())
}

/// Cost against benefit of "gap per radian": radians to a gap over motions ahead and bodies drawn, beside those of the cheapest.
fn lookahead(all: &[([usize; 2], Vec<Rolling>)]) {
    println!(
        "## Horizon and bodies drawn\n\n![time of a choice against palm motion](charts/rolling-horizon.svg)\n\nThe chart is of runs to 10 %, the table of runs to 5 %. Gap per radian, exact contacts, on four of the bodies of each family. Radians of palm motion to a gap, median / 90 %, and how many times those of one ahead on one body (ratio of medians, 95 % bootstrap interval over bodies).\n"
    );
    println!(
        "| motions ahead | bodies drawn | 20 % | 10 % | 5 % | of the cheapest, to 10 % | proven | motions a run | ms a choice |\n|---|---|---|---|---|---|---|---|---|"
    );
    let Some((_, cheapest)) = all.first() else { return };
    for ([horizon, drawn], runs) in all {
        let ways = [0.2, 0.1, 0.05].map(|gap| median_and_tail(&to(runs, gap, 0), 1));
        let (ratio, [low, high]) = ratio_of_medians(&to(runs, 0.1, 0), &to(cheapest, 0.1, 0));
        let motions: usize = runs.iter().map(|r| r.motions).sum();
        println!(
            "| {horizon} | {drawn} | {} | {ratio:.2} ({low:.2} to {high:.2}) | {} | {:.1} | {:.1} |",
            ways.join(" | "),
            count(runs, |r| r.short.is_none()),
            motions as f64 / runs.len() as f64,
            choice_ms(runs)
        );
    }
    println!();
}

type Compared = (&'static str, Vec<Rolling>);

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

fn ends(all: &[Compared]) {
    println!("How runs to 5 % within {RADIANS:.0} rad end:\n");
    println!(
        "| planner | proven | radians spent | no motion found | of these proven by another planner | lost | falls a run | motions a run | ms a choice | bodies between the bounds after every reading |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (name, runs) in all {
        let short = |why: &str| count(runs, |r| r.short == Some(why));
        let mean = |sum: usize| sum as f64 / runs.len() as f64;
        let motions: usize = runs.iter().map(|r| r.motions).sum();
        println!(
            "| {name} | {} | {} | {} | {} | {} | {:.1} | {:.1} | {:.1} | {} of {} |",
            count(runs, |r| r.short.is_none()),
            short("budget"),
            short("not found"),
            contradicted(all, runs),
            short("lost"),
            mean(runs.iter().map(|r| r.falls).sum()),
            mean(motions),
            choice_ms(runs),
            count(runs, |r| r.holds),
            runs.len()
        );
    }
    println!();
}

/// Runs whose planner found no motion any more, on bodies on which another planner has proven the goal.
fn contradicted(all: &[Compared], runs: &[Rolling]) -> usize {
    let proven = |k: usize| all.iter().any(|(_, other)| other.get(k).is_some_and(|r| r.short.is_none()));
    runs.iter().enumerate().filter(|(k, r)| r.short == Some("not found") && proven(*k)).count()
}

fn ratios(all: &[Compared]) {
    let Some((_, sweep)) = all.iter().find(|(name, _)| *name == "fixed sweep") else { return };
    println!(
        "Radians of the fixed sweep over those of a planner, ratio of medians (95 % bootstrap interval over bodies):\n"
    );
    println!("| planner | {} |\n|---|{}", heads(), "---|".repeat(GAPS.len()));
    for (name, runs) in all.iter().filter(|(name, _)| *name != "fixed sweep") {
        let one = |gap: f64| {
            let (ratio, [low, high]) = ratio_of_medians(&to(sweep, gap, 0), &to(runs, gap, 0));
            if ratio.is_finite() { format!("{ratio:.2} ({low:.2} to {high:.2})") } else { "-".to_owned() }
        };
        println!("| {name} | {} |", GAPS.map(one).join(" | "));
    }
    println!();
}
