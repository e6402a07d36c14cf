//! Time of one choice.

use super::Failure;
use exploration::generators::{Family, solid};
use exploration::space::{HausdorffGreedy, PathAware, SpaceKnowledge, VolumeGreedy, tetrahedron};
use exploration::{Goal, Heading, Knowledge, Limits, Planner, Situation, Source};
use recon::contact_kinematics::Direction;
use recon::shape_bounds::ContactSample;
use std::time::Instant;

const REPEATS: usize = 5;

/// A choice among many contacts on a sum of ellipsoids, and taking the last one of them; ms, median of a few.
pub(super) fn table() -> Result<(), Failure> {
    println!(
        "## Time\n\nOf one choice in space, and of taking a contact into both bounds, in ms (median of {REPEATS}):\n"
    );
    println!(
        "| contacts | path-aware | volume-greedy | Hausdorff-greedy | taking one |\n|---|---|---|---|---|"
    );
    for count in [100, 1000, 10_000] {
        crate::print_line(|| -> Result<String, Failure> {
            let mut known = SpaceKnowledge::exact();
            let body = solid(Family::Sum, super::FIRST_SEED);
            // In a random order, as an exploration has it: along a lattice, hulls are built from one side.
            let mut order = Direction::spread(count + REPEATS);
            let mut source = Source::new(1);
            for k in (1..order.len()).rev() {
                order.swap(k, (source.unit() * (k + 1) as f64) as usize);
            }
            let mut taking = Vec::new();
            for normal in order {
                let start = Instant::now();
                known.insert(ContactSample { point: body(normal), normal })?;
                taking.push(1e3 * start.elapsed().as_secs_f64());
            }
            let taking = taking.split_off(count);
            let (goal, limits) = (Goal::Gap(1e-9), Limits::default());
            let situation =
                Situation { known: &known, here: Some(Direction::X), goal: &goal, limits: &limits };
            let time = |planner: &mut dyn Planner<SpaceKnowledge>| -> Result<f64, Failure> {
                let mut all = Vec::new();
                for _ in 0..REPEATS {
                    let start = Instant::now();
                    planner.next(&situation)?;
                    all.push(1e3 * start.elapsed().as_secs_f64());
                }
                Ok(median(all))
            };
            let path = time(&mut PathAware::new(tetrahedron()))?;
            let volume = time(&mut VolumeGreedy::new(tetrahedron()))?;
            let distance = time(&mut HausdorffGreedy::new(tetrahedron()))?;
            Ok(format!("| {count} | {path:.2} | {volume:.2} | {distance:.2} | {:.2} |", median(taking)))
        })?;
    }
    Ok(())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
