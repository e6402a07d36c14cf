//! Tables of touches and ways.

use super::{Failure, touches};
use exploration::Goal;
use exploration::generators::{Family, outline, solid};
use recon_benches::reaching::statistics::{mean, median_and_tail, ratio_of_medians};
use recon_benches::reaching::{Bodies, Trace, plane, space};
use recon_benches::rows::{is_part, rows_in_threads};

/// A planner and what it did.
pub(super) struct Compared {
    pub(super) name: &'static str,
    pub(super) traces: Vec<Trace>,
}

pub(super) fn number(value: f64) -> String {
    if value.is_finite() { format!("{value:.0}") } else { "not reached".to_owned() }
}

/// Touches to each goal and the way to the last one.
pub(super) fn touches_table(all: &[Compared], goals: &[f64]) {
    let heads: Vec<String> = goals.iter().map(|g| format!("{:.0} %", 100.0 * g)).collect();
    println!("| planner | {} | mean | rad to the last | not reached | ms a choice |", heads.join(" | "));
    println!("|---|{}---|---|---|---|", "---|".repeat(goals.len()));
    let last = goals.last().copied().unwrap_or(0.1);
    for Compared { name, traces } in all {
        let cells: Vec<String> = goals.iter().map(|g| median_and_tail(&touches(traces, *g), 0)).collect();
        let ways: Vec<Option<f64>> = traces.iter().map(|t| t.to(last).map(|(_, way)| way)).collect();
        let reached = touches(traces, last);
        let lost = reached.iter().filter(|t| t.is_none()).count();
        let average =
            if lost == 0 { format!("{:.1}", mean(&reached, f64::INFINITY)) } else { "-".to_owned() };
        let choices: usize = traces.iter().map(|t| t.progress.len()).sum();
        let time = 1e3 * traces.iter().map(|t| t.seconds).sum::<f64>() / choices.max(1) as f64;
        println!(
            "| {name} | {} | {average} | {} | {lost} | {time:.2} |",
            cells.join(" | "),
            median_and_tail(&ways, 1)
        );
    }
}

/// Median touches of each family.
pub(super) fn by_family(all: &[Compared], goal: f64) {
    let heads: Vec<&str> = Family::ALL.iter().map(|f| f.name()).collect();
    println!("Touches to {:.0} % by family, median / 90 %:\n", 100.0 * goal);
    println!("| planner | {} |\n|---|{}", heads.join(" | "), "---|".repeat(heads.len()));
    for Compared { name, traces } in all {
        let of = |family: &Family| {
            let own: Vec<Trace> = traces.iter().filter(|t| t.family == *family).cloned().collect();
            median_and_tail(&touches(&own, goal), 0)
        };
        let cells: Vec<String> = Family::ALL.iter().map(of).collect();
        println!("| {name} | {} |", cells.join(" | "));
    }
}

/// Ratios of medians to the first planner.
pub(super) fn ratios(all: &[Compared], goal: f64) {
    let Some((first, others)) = all.split_first().filter(|_| !is_part()) else { return };
    let under = touches(&first.traces, goal);
    println!(
        "\nTouches over those of {}, ratio of medians (95 % bootstrap interval over bodies):",
        first.name
    );
    for Compared { name, traces } in others {
        let (ratio, [low, high]) = ratio_of_medians(&touches(traces, goal), &under);
        println!("- {name} {ratio:.2} ({low:.2} to {high:.2})");
    }
    println!();
}

/// Goals in Hausdorff distance: shares of the mean width.
const PLANE_SHARE: f64 = 0.05;
const SPACE_SHARE: f64 = 0.08;

/// The goal in Hausdorff distance by its own score, and by others.
pub(super) fn distance_table(bodies: Bodies) -> Result<(), Failure> {
    println!("## A goal in Hausdorff distance\n");
    println!(
        "Distance of the bounds below {PLANE_SHARE} (plane) and {SPACE_SHARE} (space) of the mean width; touches median / 90 %, and \
         how many of the bodies are reached within 40 and 150 touches. The path-aware planner takes the score of its goal.\n"
    );
    println!("| planner | plane | reached | rad | space | reached | rad |\n|---|---|---|---|---|---|---|");
    let all: Vec<_> = bodies.all().collect();
    let wanted = ["path-aware", "area-greedy", "volume-greedy", "Hausdorff-greedy", "random"];
    let planners = plane::PLANNERS.iter().zip(&space::PLANNERS).filter(|(p, _)| wanted.contains(&p.name));
    for (flat, round) in planners {
        let in_plane = rows_in_threads(&all, |(family, seed)| -> Result<Trace, Failure> {
            let goal = PLANE_SHARE * plane::mean_width(&outline(*family, *seed));
            let trace = plane::run(flat.make, *family, *seed, Goal::Hausdorff(goal), 40)?;
            Ok(scaled(trace, goal))
        })?;
        let in_space = rows_in_threads(&all, |(family, seed)| -> Result<Trace, Failure> {
            let goal = SPACE_SHARE * space::mean_width(&solid(*family, *seed));
            let trace = space::run(round.make, *family, *seed, Goal::Hausdorff(goal), 150)?;
            Ok(scaled(trace, goal))
        })?;
        let cells = [&in_plane, &in_space].map(|traces| {
            let reached = touches(traces, 1.0);
            let ways: Vec<Option<f64>> = traces.iter().map(|t| t.to(1.0).map(|(_, way)| way)).collect();
            format!(
                "{} | {} of {} | {}",
                median_and_tail(&reached, 0),
                reached.iter().flatten().count(),
                reached.len(),
                median_and_tail(&ways, 1)
            )
        });
        let name = if flat.name == round.name { flat.name } else { "area-, volume-greedy" };
        println!("| {name} | {} |", cells.join(" | "));
    }
    println!();
    Ok(())
}

/// With the goal as the unit.
fn scaled(mut trace: Trace, goal: f64) -> Trace {
    trace.progress.iter_mut().for_each(|p| *p /= goal);
    trace
}
