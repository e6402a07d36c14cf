//! What is between the bounds, cell by cell, and what contacts take of it.

use super::balance::RollingBody;
use super::drawn::cell_at;
use glam::DVec2;

/// What is not known between two neighbouring contacts: a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    /// Direction of the first normal, rad.
    pub(super) from: f64,
    /// Direction of the second, rad, not below the first.
    pub(super) to: f64,
    /// Both contacts, m.
    pub(super) points: [DVec2; 2],
    /// Where their tangents meet, m.
    pub(super) corner: DVec2,
    /// Whether a contact is at either end: else a guess is, and all beside it is new.
    pub(super) real: [bool; 2],
    /// Area in m^2.
    pub(super) area: f64,
}

impl Cell {
    /// The direction in its middle, rad.
    pub(super) fn middle(&self) -> f64 {
        0.5 * (self.from + self.to)
    }

    /// Whether a contact at `theta` (rad) is taken: not beside one that there is, within `spacing` rad.
    pub(super) fn takes(&self, theta: f64, spacing: f64) -> bool {
        let beside = |i: usize, off: f64| self.real[i] && off < spacing;
        !beside(0, theta - self.from) && !beside(1, self.to - theta)
    }
}

/// Area (m^2) between the chord of two contacts and the corner of their tangents.
fn triangle((p, a): (DVec2, f64), (q, b): (DVec2, f64)) -> f64 {
    let (along, n) = (DVec2::from_angle(a).perp(), DVec2::from_angle(b));
    let facing = n.dot(along);
    // Tangents that are one line, but for rounding, enclose nothing.
    if facing.abs() < 1e-12 {
        return 0.0;
    }
    let chord = q - p;
    (0.5 * n.dot(chord) / facing * along.perp_dot(chord)).max(0.0)
}

/// Area (m^2) that contacts of `body` at the directions `thetas` (rad) take of what is between the bounds.
pub(super) fn removed<B: RollingBody>(cells: &[Cell], spacing: f64, body: &B, thetas: &[f64]) -> f64 {
    let all = thetas.iter().map(|theta| cell_at(cells, *theta));
    let taken = |at: &(usize, f64)| cells.get(at.0).is_some_and(|cell| cell.takes(at.1, spacing));
    let mut touched: Vec<(usize, f64)> = all.filter(taken).collect();
    touched.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut sum = 0.0;
    for run in touched.chunk_by(|a, b| a.0 == b.0) {
        let Some(cell) = run.first().and_then(|(index, _)| cells.get(*index)) else { continue };
        let mut last = (cell.points[0], cell.from);
        let mut left = 0.0;
        for (_, theta) in run {
            let next = (body.farthest(*theta), *theta);
            left += triangle(last, next);
            last = next;
        }
        left += triangle(last, (cell.points[1], cell.to));
        sum += (cell.area - left).max(0.0);
    }
    sum
}
