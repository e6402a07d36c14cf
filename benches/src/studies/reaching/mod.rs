//! Touches and way that planners take, and what their certificates are worth.
//!
//! Usage: `reaching [EACH [RUNS]]`: bodies of each family (10) and runs under noise (1000). Prints docs/exploration.md.

mod cost;
mod lookahead;
mod noise;
mod polygons;
mod tables;

use exploration::least_touches;
use recon_benches::reaching::{Bodies, Trace, plane, space};
use tables::{Compared, by_family, distance_table, ratios, touches_table};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Seeds of the bodies: nothing was chosen on them. Those of tuning are 1000 to 1009, 2000 to 2029 and 5000 to 5029.
const FIRST_SEED: u64 = 79_000;

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(10), |a| a.parse())?;
    let noisy: u64 = crate::words().nth(1).map_or(Ok(1000), |a| a.parse())?;
    let bodies = Bodies { first: FIRST_SEED, each };
    println!("{}", include_str!("intro.md").trim_end());
    println!("\nMade by `cargo xtask study reaching {each} {noisy}`.\n");

    let plane = plane::PLANNERS
        .iter()
        .map(|p| Ok(Compared { name: p.name, traces: plane::runs(p, bodies, 0.1, 300)? }))
        .collect::<Result<Vec<_>, Failure>>()?;
    println!("## In the plane\n");
    touches_table(&plane, &[0.3, 0.2, 0.1]);
    least(2, &[0.3, 0.2, 0.1]);
    by_family(&plane, 0.1);
    ratios(&plane, 0.1);
    polygons::table()?;
    lookahead::table(bodies)?;

    let space = space::PLANNERS
        .iter()
        .map(|p| {
            // The process is slow, and where it stalls it does for long.
            let most = if p.name == "Gaussian process" { 120 } else { 400 };
            Ok(Compared { name: p.name, traces: space::runs(p, bodies, 0.2, most)? })
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    println!("## In space\n");
    touches_table(&space, &[0.3, 0.2]);
    least(3, &[0.3, 0.2]);
    by_family(&space, 0.2);
    ratios(&space, 0.2);
    distance_table(bodies)?;
    noise::tables(bodies, noisy)?;
    cost::table()?;
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

/// The line that none can cross.
fn least(dimension: usize, gaps: &[f64]) {
    let one = |gap: &f64| format!("{:.0} %: {:.1}", 100.0 * gap, least_touches(dimension, *gap));
    let all: Vec<String> = gaps.iter().map(one).collect();
    println!("\nn* of ellipsoids, below which no planner gets on them: {}.\n", all.join(", "));
}

/// Touches to a goal, run by run.
fn touches(traces: &[Trace], goal: f64) -> Vec<Option<f64>> {
    traces.iter().map(|t| t.to(goal).map(|(n, _)| n as f64)).collect()
}
