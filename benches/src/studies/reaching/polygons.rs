//! Polygons, which touches can know exactly.

use super::Failure;
use exploration::generators::polygon;
use exploration::planar::{AreaGreedy, PlanarKnowledge, SimulatedFinger, turned_start};
use exploration::{Goal, Knowledge, Motion, Task, explore};

const EACH: u64 = 10;

/// Touches to exactness of polygons of 3 to 9 corners.
pub(super) fn table() -> Result<(), Failure> {
    println!(
        "Polygons of m corners, {EACH} of each, until the gap is below 1e-9: who does not know the normals must touch each corner, then each edge.\n"
    );
    println!("| m | least | most | 2m + 1 |\n|---|---|---|---|");
    for corners in 3..10 {
        let mut counts = Vec::new();
        for seed in 0..EACH {
            let (body, _) = polygon(corners, super::FIRST_SEED + seed);
            let mut known = PlanarKnowledge::exact();
            let mut planner = AreaGreedy::new(turned_start(3, seed));
            let mut finger = SimulatedFinger::new(body, Motion::Plane);
            let task = Task::new(Goal::Gap(1e-9), 100);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ())?;
            counts.push(if ended.is_reached() { known.touches() } else { usize::MAX });
        }
        let (least, most) = (counts.iter().min().copied(), counts.iter().max().copied());
        println!("| {corners} | {} | {} | {} |", least.unwrap_or(0), most.unwrap_or(0), 2 * corners + 1);
    }
    println!();
    Ok(())
}
