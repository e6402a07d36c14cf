//! Closed loops under noise: touches, and certificates that were false.

use super::Failure;
use exploration::Spending;
use exploration::generators::Family;
use recon_benches::reaching::statistics::{interval, quantile};
use recon_benches::reaching::{Bodies, plane, space};
use recon_benches::rows::rows_in_threads;

/// Points off by this share of the mean width per axis, normals by twice as many rad.
const LEVEL: f64 = 1e-3;
/// Touches that the confidence is shared among.
const BUDGETS: [usize; 2] = [30, 120];

/// Touches, whether the body lies between the bounds, and whether the gap that is stated bounds that of exact contacts.
type Run = (Option<f64>, bool, bool);

type Work = fn(&(Family, u64, u64, Spending)) -> Result<Run, exploration::ExploreError>;

fn in_plane(
    (family, seed, noise, spending): &(Family, u64, u64, Spending),
) -> Result<Run, exploration::ExploreError> {
    let c = plane::certified_run(*family, *seed, *noise, LEVEL, 0.1, *spending)?;
    Ok((c.touches.map(|n| n as f64), c.holds, c.bounds_gap))
}

fn in_space(
    (family, seed, noise, spending): &(Family, u64, u64, Spending),
) -> Result<Run, exploration::ExploreError> {
    let c = space::certified_run(*family, *seed, *noise, LEVEL, 0.2, *spending)?;
    Ok((c.touches.map(|n| n as f64), c.holds, c.bounds_gap))
}

/// All bodies, each as often as makes `runs` in all.
pub(super) fn tables(bodies: Bodies, runs: u64) -> Result<(), Failure> {
    println!("## Under noise\n");
    println!(
        "Points off by {:.1} % of the mean width per axis, normals by {:.0} mrad (standard deviations), path-aware planner on the \
         bounds that hold at 95 %, for all touches that may be made together: an equal share for each of the budget, or 6 a / (pi k)^2 \
         for touch k. False: runs in which the body is not between the bounds at the end, whatever they state, with the exact 95 % \
         interval of their probability. Below: runs whose stated gap is below that of exact contacts at the same places. A run that \
         ends without a proof is none that was false.\n",
        100.0 * LEVEL,
        2e3 * LEVEL
    );
    println!(
        "| | goal | spending | runs | touches | smooth bodies | not proven | false | below |\n|---|---|---|---|---|---|---|---|---|"
    );
    let all: Vec<_> = bodies.all().collect();
    let times = runs.div_ceil(all.len() as u64);
    let rows: [(&str, &str, Work, usize); 2] =
        [("plane", "10 %", in_plane, BUDGETS[0]), ("space", "20 %", in_space, BUDGETS[1])];
    for (name, goal, work, budget) in rows {
        for (spending, words, times) in [
            (Spending::Budget(budget), format!("budget of {budget}"), times),
            (Spending::Unlimited, "unlimited".to_owned(), times.div_ceil(5)),
        ] {
            let items: Vec<_> = (0..times)
                .flat_map(|k| all.iter().map(move |(f, s)| (*f, *s, 1_000_000 * (k + 1) + *s, spending)))
                .collect();
            let done = rows_in_threads(&items, |item| -> Result<Run, Failure> { Ok(work(item)?) })?;
            let touches: Vec<Option<f64>> = done.iter().map(|(touches, ..)| *touches).collect();
            let smooth: Vec<Option<f64>> =
                items.iter().zip(&done).filter(|(i, _)| i.0.is_smooth()).map(|(_, run)| run.0).collect();
            let wrong = done.iter().filter(|(_, holds, _)| !holds).count();
            let [low, high] = interval(wrong, done.len()).map(|p| 100.0 * p);
            println!(
                "| {name} | {goal} | {words} | {} | {} / {} | {} / {} | {} | {wrong} ({low:.2} to {high:.2} %) | {} |",
                done.len(),
                super::tables::number(quantile(&touches, 0.5)),
                super::tables::number(quantile(&touches, 0.9)),
                super::tables::number(quantile(&smooth, 0.5)),
                super::tables::number(quantile(&smooth, 0.9)),
                touches.iter().filter(|t| t.is_none()).count(),
                done.iter().filter(|(.., bounds_gap)| !bounds_gap).count()
            );
        }
    }
    println!();
    Ok(())
}
