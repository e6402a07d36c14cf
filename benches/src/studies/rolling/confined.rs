//! Palms that can turn by little: whether it is said where nothing that they can do uncovers more, and there alone.

use super::{Failure, RADIANS};
use recon_benches::reaching::Bodies;
use recon_benches::reaching::told::{Told, cells, heads};
use recon_benches::rolling::reachable::Reachable;
use recon_benches::rolling::{Asked, PLANNERS, Roller, Rolling, run};
use recon_benches::rows::rows_in_threads;

/// How far each palm may be from where it starts, rad.
const ROOMS: [f64; 4] = [0.05, 0.15, 0.3, 0.6];
/// The gap asked for.
const GOAL: f64 = 0.1;
/// Planners that look at what is expected.
const LOOKING: usize = 4;
/// A direction that lies no farther than this, rad, from one that can be felt could have been felt: contacts are not taken nearer than so to each other.
const SPACING: f64 = 0.1;

/// A run, the least gap that can be reached on its body, and how many of the directions named cannot be felt.
type Row = (Rolling, f64, usize);

/// The room, the planner, and its runs.
type Rows = (f64, &'static str, Vec<Row>);

/// Runs of each planner with each room.
pub(super) fn rows(bodies: Bodies) -> Result<Vec<Rows>, Failure> {
    let all: Vec<_> = bodies.all().collect();
    let mut tables = Vec::new();
    for room in ROOMS {
        let asked = Asked { goal: GOAL, radians: RADIANS, noise: None, room: Some(room) };
        for Roller { name, make } in &PLANNERS[..LOOKING] {
            let row = |body: &_| -> Result<Row, Failure> {
                let made = run(*make, *body, &asked)?;
                let can = Reachable::of(*body, &asked);
                let beyond = made.named.iter().filter(|theta| can.distance(**theta) > SPACING).count();
                Ok((made, can.gap, beyond))
            };
            tables.push((room, *name, rows_in_threads(&all, row)?));
        }
    }
    Ok(tables)
}

/// What became of them.
pub(super) fn table(all: &[Rows]) {
    println!("{}\n", include_str!("confined.md").trim_end());
    println!("| rad to each side | planner | {} |", heads("radians"));
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (room, name, rows) in all {
        let told = rows.iter().map(|(run, least, beyond)| {
            let (way, named) = (run.steps.last().map(|step| step[0]), [run.named.len(), *beyond]);
            Told { short: run.short, way, least: *least, named }
        });
        println!("| {room} | {name} | {} |", cells(&told.collect::<Vec<_>>(), GOAL, "not found"));
    }
}
