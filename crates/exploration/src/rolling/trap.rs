//! A proof that no motion of the palms uncovers more: walls that the body cannot turn past.
//!
//! At the orientation `phi` between palms `P` the height of the centre of mass falls with `phi` where `d_1 sin P_2 + d_2 sin P_1 < 0`, and rises where it is above. With
//! the centre of mass known, each `d_i` is that of a point with the normal `theta_i`, and the bounds hold it within the triangle of its cell: the sign is the same
//! for all bodies between the bounds or it is not. A line `phi = w(P)` on which it is below zero for all palms of the workspace is a wall that none of these bodies gets
//! past from above, since it goes downhill and has no inertia; one on which it is above zero likewise from below. Between two walls contacts have normals
//! within two intervals, whatever the motion: the cells beside these stay as they are.

use super::belief::cells;
use super::gain::Cell;
use super::track::Track;
use super::workspace::Workspace;
use crate::knowledge::Knowledge;
use crate::planar::PlanarKnowledge;
use glam::DVec2;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// What no motion uncovers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Trap {
    /// Middles of the cells, rad, the largest first.
    pub(super) directions: Vec<f64>,
    /// The gap is at least this, whatever is done.
    pub(super) gap: f64,
}

/// Palms are looked at in patches of so many rad, and walls tried so far apart.
const PATCH: f64 = 0.04;
const WALL: f64 = 0.05;
/// Normals this near to what may be felt count as felt, rad: rests are known no better.
const MARGIN: f64 = 1e-6;

/// An interval.
type Range = [f64; 2];

/// What no motion uncovers of a body at rest as `track` says, if walls are found; none under noise, and where the bounds or the centre of mass are open.
pub(super) fn trapped(known: &PlanarKnowledge, track: &Track, workspace: &Workspace) -> Option<Trap> {
    let bounded = known.bounds().and_then(|bounds| bounds.upper().bounded()).is_some();
    if !bounded || known.confidence().is_some() || track.dynamics.is_some() {
        return None;
    }
    let centre = track.certain_centre()?;
    let cells = cells(known, workspace.size);
    let patches = patches(workspace);
    // Downhill is up in `phi` at the lower wall, down at the upper one.
    let wall = |sense: f64| {
        let at = |k: usize| track.phi + sense * WALL * k as f64;
        let holds = |phi: f64| {
            let slope = |patch: &[Range; 2]| slopes(&cells, centre, *patch, phi);
            patches.iter().map(slope).all(|[low, high]| if sense < 0.0 { high < 0.0 } else { low > 0.0 })
        };
        (1..=(PI / WALL) as usize).map(at).find(|phi| holds(*phi))
    };
    let (low, high) = (wall(-1.0)?, wall(1.0)?);
    let angles = |i: usize| {
        patches.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], p| [a.min(p[i][0]), b.max(p[i][1])])
    };
    let felt = [0, 1].map(|i| directions(i, angles(i), [low, high]));
    let mut left: Vec<&Cell> =
        cells.iter().filter(|cell| felt.iter().all(|felt| beside(cell, *felt))).collect();
    left.sort_by(|a, b| b.area.total_cmp(&a.area));
    let area: f64 = left.iter().map(|cell| cell.area).sum();
    let gap = area / known.measures().upper;
    Some(Trap { directions: left.iter().map(|cell| cell.middle()).collect(), gap })
}

/// Rectangles that cover all allowed angles of the palms.
fn patches(workspace: &Workspace) -> Vec<[Range; 2]> {
    let parts = |[low, high]: Range| {
        let count = ((high - low) / PATCH).ceil().max(1.0);
        (0..count as usize).map(move |k| {
            [low + (high - low) * k as f64 / count, low + (high - low) * (k + 1) as f64 / count]
        })
    };
    let all = parts(workspace.angles[0]).flat_map(|a| parts(workspace.angles[1]).map(move |b| [a, b]));
    let [narrow, wide] = workspace.wedge;
    all.filter(|[a, b]| b[1] - a[0] >= narrow && b[0] - a[1] <= wide).collect()
}

/// Normals in body axes at palm `i` (from 0) at angles `palm` with the body at `phi`, rad: `P_1 - phi - pi/2`, `P_2 - phi + pi/2`.
fn directions(i: usize, palm: Range, phi: Range) -> Range {
    let quarter = if i == 0 { -FRAC_PI_2 } else { FRAC_PI_2 };
    [palm[0] - phi[1] + quarter, palm[1] - phi[0] + quarter]
}

/// The slope of the height times `sin phi_2` for all bodies and all palms of a patch, at `phi`.
fn slopes(cells: &[Cell], centre: DVec2, patch: [Range; 2], phi: f64) -> Range {
    let lever = |i: usize| levers(cells, centre, directions(i, patch[i], [phi, phi]));
    let (one, two) = (product(lever(0), sines(patch[1])), product(lever(1), sines(patch[0])));
    [one[0] + two[0], one[1] + two[1]]
}

/// `x . t` with `t = (sin theta, -cos theta)` for all points about `centre` that a body between the bounds may have with a normal of the range.
fn levers(cells: &[Cell], centre: DVec2, thetas: Range) -> Range {
    let mut all = [f64::INFINITY, f64::NEG_INFINITY];
    for cell in cells {
        // The part of the range in the cell, in full turns.
        let turn = ((thetas[1] - cell.from) / TAU).floor() * TAU;
        for turn in [turn, turn - TAU] {
            let [low, high] = [(thetas[0] - turn).max(cell.from), (thetas[1] - turn).min(cell.to)];
            if low > high {
                continue;
            }
            for corner in [cell.points[0], cell.points[1], cell.corner] {
                let [a, b] = swept(corner - centre, [low, high]);
                all = [all[0].min(a), all[1].max(b)];
            }
        }
    }
    all
}

/// Range of `x . t` with `t = (sin theta, -cos theta)`.
fn swept(x: DVec2, [low, high]: Range) -> Range {
    let at = |theta: f64| x.x * theta.sin() - x.y * theta.cos();
    let (mut least, mut most) = (at(low).min(at(high)), at(low).max(at(high)));
    // t is along x where theta is its angle and a quarter turn more; against it half a turn from there.
    let along = x.to_angle() + FRAC_PI_2;
    let within = |theta: f64| low + (theta - low).rem_euclid(TAU) <= high;
    if within(along) {
        most = x.length();
    }
    if within(along + PI) {
        least = -x.length();
    }
    [least, most]
}

/// Range of the sine over angles in (0, pi).
fn sines([low, high]: Range) -> Range {
    let (a, b) = (low.sin(), high.sin());
    [a.min(b), if (low..=high).contains(&FRAC_PI_2) { 1.0 } else { a.max(b) }]
}

fn product(a: Range, b: Range) -> Range {
    let all = [a[0] * b[0], a[0] * b[1], a[1] * b[0], a[1] * b[1]];
    all.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
}

/// Whether no normal of the range is in the cell.
fn beside(cell: &Cell, felt: Range) -> bool {
    let (low, high) = (felt[0] - MARGIN, felt[1] + MARGIN);
    // From the end of the cell on a range that is no longer than what is beside it does not come back to it.
    let after = (low - cell.to).rem_euclid(TAU);
    after + (high - low) < TAU - (cell.to - cell.from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_hold_what_is_in_them_and_are_met() {
        let mut source = crate::random::Source::new(1);
        for _ in 0..200 {
            let x = DVec2::new(source.between(-1.0, 1.0), source.between(-1.0, 1.0));
            let low = source.between(-7.0, 7.0);
            let range = [low, low + source.between(0.0, 3.0)];
            let [least, most] = swept(x, range);
            let values: Vec<f64> = (0..=2000)
                .map(|k| range[0] + (range[1] - range[0]) * f64::from(k) / 2000.0)
                .map(|theta| x.x * theta.sin() - x.y * theta.cos())
                .collect();
            let (a, b) =
                values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
            assert!(least <= a + 1e-12 && a < least + 1e-5 && b <= most + 1e-12 && b > most - 1e-5);
        }
    }

    #[test]
    fn a_range_is_beside_a_cell_or_not() {
        let cell = Cell {
            from: 1.0,
            to: 1.5,
            points: [DVec2::ZERO; 2],
            corner: DVec2::ZERO,
            real: [true; 2],
            area: 1.0,
        };
        for turn in [-TAU, 0.0, TAU] {
            assert!(beside(&cell, [1.6 + turn, 7.2 + turn]) && beside(&cell, [0.2 + turn, 0.9 + turn]));
            assert!(!beside(&cell, [1.4 + turn, 1.45 + turn]) && !beside(&cell, [0.9 + turn, 1.6 + turn]));
            assert!(!beside(&cell, [1.6 + turn, 7.3 + turn]) && !beside(&cell, [1.2 + turn, 3.0 + turn]));
        }
    }
}
