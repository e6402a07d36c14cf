//! The elbow of `../shared/data/elbow_tosses_link1.csv`, which is not part of this repository: a real box on a hinge, seen by
//! a tracker with gross errors, and often held up by its other half.

use super::body::Body;
use super::calibration::{conformal, moved, shortfall, volume};
use glam::DVec3;
use recon::shape_bounds::exact_hull::HalfSpace;
use recon::shape_bounds::poses::{BodyPose, CONFIDENCES, PoseBounds, half_space_above_plane};
use recon_io::parse_poses;
use shape_bounds::generators::Source;
use std::error::Error;
use std::fs::File;

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/data/elbow_tosses_link1.csv");
const SUBSETS: usize = 40;
const TOSSES: usize = 100;
/// Half sides of the box in m, to judge by.
const HALF: DVec3 = DVec3::new(0.05, 0.025, 0.025);

/// What became of one hundred of tosses.
struct Row {
    contained: [bool; 2],
    volumes: [f64; 2],
    /// What the tosses leave of space if no pose is seen too low.
    floor: f64,
    /// Margin over level that is enough.
    enough: f64,
    margin: f64,
    left_out: usize,
    propped: bool,
}

pub(crate) fn print() -> Result<(), Box<dyn Error>> {
    println!("\n## A real box with gross errors\n");
    let Ok(file) = File::open(PATH) else {
        println!("Skipped: the elbow's tosses are not beside this repository.");
        return Ok(());
    };
    let all = parse_poses(file)?;
    println!(
        "Link 1 of the elbow, {SUBSETS} random hundreds of its even-numbered tosses, which settle the factors of the rule for \
         propped bodies, and as many of its odd-numbered ones, which check it. Volumes over the box's: medians (largest). Floor: \
         the half-spaces of all poses, with those that see the box in the table lifted onto it: no rule that takes poses for \
         half-spaces can give less and be right.\n"
    );
    println!(
        "| tosses | contained 95 % | 99 % | volume 95 % | 99 % | floor | margin 95 %, mm | runs left out | propped | enough of 95 %, 99 % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (name, first) in [("even", 0), ("odd", 1)] {
        let half: Vec<&Vec<BodyPose>> = all.iter().skip(first).step_by(2).collect();
        let mut source = Source::new(first as u64 + 1);
        let subsets: Vec<Vec<Vec<BodyPose>>> = (0..SUBSETS).map(|_| hundred(&half, &mut source)).collect();
        let rows: Vec<Row> = super::in_parallel(&subsets, |runs| judge(runs).map_err(|e| e.to_string()))
            .into_iter()
            .collect::<Result<_, _>>()?;
        line(name, &rows);
    }
    Ok(())
}

fn hundred(of: &[&Vec<BodyPose>], source: &mut Source) -> Vec<Vec<BodyPose>> {
    let mut left = of.to_vec();
    while left.len() > TOSSES {
        let k = (source.between(0.0, left.len() as f64) as usize).min(left.len() - 1);
        left.swap_remove(k);
    }
    left.into_iter().cloned().collect()
}

fn judge(runs: &[Vec<BodyPose>]) -> Result<Row, Box<dyn Error>> {
    let corner =
        |i: u32| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 2.0 - DVec3::ONE;
    let body = Body::Points((0..8).map(|i| corner(i) * HALF).collect());
    let truth = body.volume();
    let [made, sure] = CONFIDENCES.map(|c| PoseBounds::above_plane(runs, 0.0, c));
    let (made, sure) = (made?, sure?);
    let lifted = |pose: &BodyPose| {
        let h = half_space_above_plane(pose, 0.0);
        moved(&h, shortfall(&body, &[h]).max(0.0))
    };
    let floor: Vec<HalfSpace> = runs.iter().flatten().map(lifted).collect();
    let bare: Vec<HalfSpace> = made.half_spaces.concat().iter().map(|h| moved(h, -made.margin)).collect();
    Ok(Row {
        contained: [&made, &sure].map(|m| shortfall(&body, m.upper.face_half_spaces()) <= 0.0),
        volumes: [&made, &sure].map(|m| m.upper.volume() / truth),
        floor: volume(&floor, 0.0) / truth,
        enough: shortfall(&body, &bare).max(0.0) / made.consistent_level,
        margin: made.margin,
        left_out: made.left_out.len(),
        propped: made.propped,
    })
}

fn line(name: &str, rows: &[Row]) {
    let contained = |c: usize| rows.iter().filter(|r| r.contained[c]).count();
    let spread = |value: &dyn Fn(&Row) -> f64| {
        let mut all: Vec<f64> = rows.iter().map(value).collect();
        all.sort_unstable_by(f64::total_cmp);
        format!("{:.2} ({:.2})", all[all.len() / 2], all[all.len() - 1])
    };
    println!(
        "| {name} | {} of {} | {} | {} | {} | {} | {} | {} | {} | {:.2}, {:.2} |",
        contained(0),
        rows.len(),
        contained(1),
        spread(&|r| r.volumes[0]),
        spread(&|r| r.volumes[1]),
        spread(&|r| r.floor),
        spread(&|r| 1e3 * r.margin),
        spread(&|r| r.left_out as f64),
        rows.iter().filter(|r| r.propped).count(),
        conformal(rows.iter().map(|r| r.enough), CONFIDENCES[0]),
        conformal(rows.iter().map(|r| r.enough), CONFIDENCES[1])
    );
}
