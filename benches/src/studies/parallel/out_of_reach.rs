//! Whether it is said where nothing that the palms can do uncovers more, and there alone.

use super::{Failure, SETTING};
use recon::contact_kinematics::Direction;
use recon_benches::parallel::reachable::Reachable;
use recon_benches::parallel::{PLANNERS, Rolling, Setting, runs};
use recon_benches::reaching::Bodies;
use recon_benches::reaching::told::{Told, cells, heads};

const FRICTIONS: [f64; 4] = [0.2, 0.4, 0.8, 1.2];
/// "Gap per way, 1 ahead" and "largest gap".
const COMPARED: [usize; 2] = [1, 3];
/// Palms stop at this share of what friction holds.
const SHARE: f64 = 0.9;
/// A direction that lies no farther than this, rad, from one that can be felt could have been felt: contacts are not taken nearer than so to each other.
const SPACING: f64 = 0.2;

/// Runs of a planner under a friction.
type Rows = (f64, &'static str, Vec<Rolling>);

/// Runs of each planner under each friction.
pub(super) fn rows(bodies: Bodies) -> Result<Vec<Rows>, Failure> {
    let mut all = Vec::new();
    for friction in FRICTIONS {
        for planner in COMPARED.map(|k| &PLANNERS[k]) {
            all.push((friction, planner.name, runs(planner, bodies, &Setting { friction, ..SETTING })?));
        }
    }
    Ok(all)
}

/// What became of them.
pub(super) fn table(bodies: Bodies, all: &[Rows]) {
    println!(
        "## Where no stroke can uncover more\n\nThe same bodies to 20 %. What can be felt at all was found with the true body: all normals of a lattice of 0.055 rad that friction holds at and that a way through such normals leads to, between pads without an end. \
         Where all of these contacts together leave a gap above 20 % no stroke reaches the goal. Bodies that are held nowhere are left out.\n"
    );
    println!("| friction | planner | {} |", heads("widths of way"));
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let bodies: Vec<_> = bodies.all().collect();
    for (friction, name, runs) in all {
        let told = bodies.iter().zip(runs).filter_map(|(body, run)| {
            let direction = |v: &[f64; 3]| Direction::new((*v).into()).ok();
            let can = Reachable::of(*body, direction(&run.up?)?, SHARE * friction);
            let beyond =
                run.named.iter().filter_map(direction).filter(|d| can.distance(*d) > SPACING).count();
            let way = run.steps.last().map(|step| step[0]);
            Some(Told { short: run.short, way, least: can.gap, named: [run.named.len(), beyond] })
        });
        let told: Vec<Told> = told.collect();
        println!("| {friction} | {name} | {} |", cells(&told, SETTING.goal, "not found"));
    }
    println!();
}
