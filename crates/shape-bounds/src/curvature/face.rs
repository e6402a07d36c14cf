//! Faces of an intersection of equal balls, and what another ball leaves of them.

use super::circle::{Circle, Cut};
use glam::DVec3;

/// An edge of a face: an arc of the circle in which the face's sphere meets that of ball `other`, from `start` to the
/// start of the next arc, with the face on its left as seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub(super) other: u32,
    pub(super) start: DVec3,
}

/// What a ball does to a face.
pub(super) enum Clipped {
    /// The face stays as it is.
    Kept,
    /// Nothing of the face is left.
    Gone,
    /// The face keeps these arcs; the new ones run from the first point to the second. A ball may cut off both ends of a
    /// long face, so there may be several.
    Cut { arcs: Vec<Arc>, news: Vec<(DVec3, DVec3)> },
    /// Rounding has made half of an edge.
    Inconsistent,
}

/// The arc `(k, other)` from `start` to `end` cut by ball `p`. The circle is that of the pair in order of the indices, so
/// that both faces at an edge get the same points to the last bit.
pub(super) fn cut_arc(centres: &[DVec3], rho: f64, k: u32, arc: Arc, end: DVec3, p: u32) -> Cut {
    let at = |i: u32| centres[i as usize];
    let centre = at(p);
    let outside = |y: DVec3| y.distance_squared(centre) > rho * rho;
    let (a, b, from, to) = if k < arc.other {
        (at(k), at(arc.other), arc.start, end)
    } else {
        (at(arc.other), at(k), end, arc.start)
    };
    if !outside(from) && !outside(to) && surely_kept(a, b, from, to, centre) {
        return Cut::Kept;
    }
    let cut = Circle::between(a, b, rho).cut(from, to, centre, outside);
    if k < arc.other { cut } else { cut.reversed() }
}

/// A cheap test for most arcs with both ends in the ball: unless its centre is in the ball whose diameter is that between
/// the arc's centres, at least half of the circle is outside, which an arc of less than half a circle cannot pass.
fn surely_kept(a: DVec3, b: DVec3, from: DVec3, to: DVec3, centre: DVec3) -> bool {
    let half = (b - a) / 2.0;
    let middle = a + half;
    middle.distance_squared(centre) >= half.length_squared()
        && half.dot((from - middle).cross(to - from)) > 0.0
}

/// Clips face `k` with ball `p`; `touched` is called with the neighbour across each edge of which something is cut off.
pub(super) fn clip(
    centres: &[DVec3],
    rho: f64,
    k: u32,
    arcs: &[Arc],
    p: u32,
    mut touched: impl FnMut(u32),
) -> Clipped {
    let mut kept: Vec<Arc> = Vec::with_capacity(arcs.len() + 2);
    let (mut leaves, mut enters) = (Vec::new(), Vec::new());
    // Whether the first crossing met comes in, so that the last one that goes out belongs to it.
    let mut begins_outside = false;
    let mut any_cut = false;
    for (i, arc) in arcs.iter().enumerate() {
        let end = arcs[(i + 1) % arcs.len()].start;
        let cut = cut_arc(centres, rho, k, *arc, end, p);
        if cut != Cut::Kept {
            any_cut = true;
            touched(arc.other);
        }
        let (first, second) = match cut {
            Cut::Kept | Cut::Gone => (None, None),
            Cut::Leaves(at) => (Some((false, at)), None),
            Cut::Enters(at) => (Some((true, at)), None),
            Cut::Interrupted(out, back) => (Some((false, out)), Some((true, back))),
            Cut::Visits(enter, out) => (Some((true, enter)), Some((false, out))),
        };
        if matches!(cut, Cut::Kept | Cut::Leaves(_) | Cut::Interrupted(..)) {
            kept.push(*arc);
        }
        for (enters_here, at) in [first, second].into_iter().flatten() {
            if enters_here {
                begins_outside |= leaves.is_empty() && enters.is_empty();
                kept.push(Arc { start: at, ..*arc });
                enters.push(at);
            } else {
                kept.push(Arc { other: p, start: at });
                leaves.push(at);
            }
        }
    }
    if !any_cut {
        Clipped::Kept
    } else if leaves.len() != enters.len() {
        Clipped::Inconsistent
    } else if leaves.is_empty() {
        // Cut, yet never crossed: all arcs are gone.
        if kept.is_empty() { Clipped::Gone } else { Clipped::Inconsistent }
    } else {
        enters.rotate_left(usize::from(begins_outside));
        Clipped::Cut { arcs: kept, news: leaves.into_iter().zip(enters).collect() }
    }
}
