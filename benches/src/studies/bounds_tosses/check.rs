//! The tight rule: how often it holds, and what its volume is made of.

use super::calibration::{shortfall, volume};
use super::sets::{Set, Tosses};
use recon::shape_bounds::exact_hull::HalfSpace;
use recon::shape_bounds::poses::{CONFIDENCES, PoseBounds, PoseError, PoseRule};
use std::error::Error;

/// Tosses in a cut of a set.
const CUTS: [usize; 2] = [25, 50];

/// What became of one set.
pub(crate) struct Row {
    family: &'static str,
    tracker: u32,
    /// Whether upper and lower bound hold, for each confidence.
    holds: [[bool; 2]; 2],
    /// Volumes over the true one: exact half-spaces; the smallest common margin that contains the body, on top of the
    /// kinks; upper and lower bound at the first confidence.
    volumes: [f64; 4],
    margin: f64,
    /// Of the cuts into fewer tosses: those that were bounded, and whose bounds both hold.
    cuts: [[usize; 2]; CUTS.len()],
}

pub(crate) fn check(set: &Set, tosses: &Tosses) -> Result<Row, Box<dyn Error>> {
    let body = &tosses.body;
    let [made, sure] = CONFIDENCES.map(|c| PoseBounds::by_rule(&tosses.runs, 0.0, c, &PoseRule::tight()));
    let (made, sure) = (made?, sure?);
    let half_spaces: Vec<HalfSpace> = made.half_spaces.concat();
    let lower = made.lower.as_ref().and_then(|l| l.solid());
    let volumes = [
        volume(&tosses.exact, 0.0),
        volume(&half_spaces, shortfall(body, &half_spaces)),
        made.upper.volume(),
        lower.map_or(0.0, |solid| solid.volume()),
    ];
    let cut = |count: usize| {
        let mut found = [0, 0];
        for runs in tosses.runs.chunks_exact(count) {
            match PoseBounds::by_rule(runs, 0.0, CONFIDENCES[0], &PoseRule::tight()) {
                Ok(made) => {
                    found[0] += 1;
                    found[1] += usize::from(holds(tosses, &made) == [true, true]);
                }
                Err(PoseError::Open { .. } | PoseError::TooFewTouching { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(found)
    };
    Ok(Row {
        family: set.family,
        tracker: set.tracker,
        holds: [holds(tosses, &made), holds(tosses, &sure)],
        volumes: volumes.map(|v| v / body.volume()),
        margin: made.margin,
        cuts: [cut(CUTS[0])?, cut(CUTS[1])?],
    })
}

fn holds(tosses: &Tosses, made: &PoseBounds) -> [bool; 2] {
    let upper = shortfall(&tosses.body, made.upper.face_half_spaces()) <= 0.0;
    let lower = made.lower.as_ref().and_then(|l| l.solid());
    [upper, lower.is_none_or(|solid| tosses.body.holds(solid.vertices()))]
}

pub(crate) fn print(rows: &[Row]) {
    println!("## The tight rule\n");
    println!(
        "Sets in which the body lies in the upper bound, and in which it holds the lower one. Volumes over the true one, \
         medians: the half-spaces of the true poses (what the tosses touch at all), those of the tracked poses with the \
         smallest common margin that contains the body (what the tracker's errors cost whatever the rule), and the \
         bounds at 95 %.\n"
    );
    println!(
        "| body | tracker | sets | upper 95 % | lower 95 % | upper 99 % | lower 99 % | exact poses | least margin | upper | lower | margin, mm |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut groups: Vec<(&str, u32)> = rows.iter().map(|r| (r.family, r.tracker)).collect();
    groups.dedup();
    for (family, tracker) in groups {
        let own: Vec<&Row> = rows.iter().filter(|r| r.family == family && r.tracker == tracker).collect();
        let count = |c: usize, side: usize| own.iter().filter(|r| r.holds[c][side]).count();
        let of = |value: &dyn Fn(&Row) -> f64| median(own.iter().map(|r| value(r)).collect());
        println!(
            "| {family} | x{tracker} | {} | {} | {} | {} | {} | {:.3} | {:.3} | {:.3} | {:.3} | {:.2} |",
            own.len(),
            count(0, 0),
            count(0, 1),
            count(1, 0),
            count(1, 1),
            of(&|r| r.volumes[0]),
            of(&|r| r.volumes[1]),
            of(&|r| r.volumes[2]),
            of(&|r| r.volumes[3]),
            of(&|r| 1e3 * r.margin)
        );
    }
    println!("\nFewer tosses: the same sets cut into smaller ones, at 95 %.\n");
    println!("| tosses | tracker | bounded | both bounds hold |");
    println!("|---|---|---|---|");
    for (k, tosses) in CUTS.iter().enumerate() {
        for tracker in [1, super::sets::WORSE] {
            let own = rows.iter().filter(|r| r.tracker == tracker);
            let [bounded, hold] = own.fold([0, 0], |sum, r| [sum[0] + r.cuts[k][0], sum[1] + r.cuts[k][1]]);
            println!("| {tosses} | x{tracker} | {bounded} | {hold} |");
        }
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
