//! Polygons, which touches can know exactly.

use super::Failure;
use exploration::generators::polygon;
use exploration::planar::{AreaGreedy, PathAware, PlanarKnowledge, SimulatedFinger, turned_start};
use exploration::{Goal, Knowledge, Motion, Planner, Task, explore};

const EACH: u64 = 10;

/// Touches to exactness of polygons of 3 to 9 corners.
pub(super) fn table() -> Result<(), Failure> {
    println!(
        "Polygons of m corners, {EACH} of each, until the gap is below 1e-9: who does not know the normals must touch each corner, then each edge.\n"
    );
    println!("| m | area-greedy: least, most | path-aware: least, most | 2m + 1 |\n|---|---|---|---|");
    for corners in 3..10 {
        let greedy = counts(corners, |seed| Box::new(AreaGreedy::new(turned_start(3, seed))))?;
        let path = counts(corners, |seed| Box::new(PathAware::new(turned_start(3, seed))))?;
        println!("| {corners} | {greedy} | {path} | {} |", 2 * corners + 1);
    }
    println!();
    Ok(())
}

/// The least and the most touches of a planner.
fn counts(corners: usize, make: fn(u64) -> Box<dyn Planner<PlanarKnowledge>>) -> Result<String, Failure> {
    let mut counts = Vec::new();
    for seed in 0..EACH {
        let (body, _) = polygon(corners, super::FIRST_SEED + seed);
        let mut known = PlanarKnowledge::exact();
        let mut finger = SimulatedFinger::new(body, Motion::Plane);
        let task = Task::new(Goal::Gap(1e-9), 100);
        let ended = explore(&mut known, &mut *make(seed), &mut finger, &task, |_, _| ())?;
        if !ended.is_reached() {
            return Ok("not reached".to_owned());
        }
        counts.push(known.touches());
    }
    let (least, most) = (counts.iter().min(), counts.iter().max());
    Ok(format!("{}, {}", least.unwrap_or(&0), most.unwrap_or(&0)))
}
