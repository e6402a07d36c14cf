//! The corners of an intersection of half-spaces, one for each facet of the hull of duals.

use super::vertex::{common_point, polar_corner};
use crate::hull::SolidHull;
use crate::sample::HalfSpace;
use glam::DVec3;

/// Facets whose data are fetched together, so that memory is waited for once.
const BATCH: usize = 16;

/// The corner of each facet of the dual.
///
/// The planes of the duals are those of the half-spaces but for rounding, and the combinatorics of the dual hull is
/// exact for them: their corners are consistent to rounding, but where planes are nearly parallel they may slide far along
/// them. The corner computed from the half-spaces as given is exact in that direction too, where it is a corner at all:
/// where rounding of the duals has joined planes that are not quite neighbours it protrudes over the plane across an edge.
/// That edge is then flipped.
pub(super) fn corners(
    dual: &mut SolidHull,
    half_spaces: &[HalfSpace],
    interior: DVec3,
    tolerance: f64,
) -> Vec<DVec3> {
    let triangles = dual.triangles();
    let mut corners = Vec::with_capacity(triangles.len());
    let mut doubtful = Vec::new();
    let mut across: Vec<[HalfSpace; 3]> = Vec::with_capacity(BATCH);
    for first in (0..triangles.len()).step_by(BATCH) {
        let batch = first..(first + BATCH).min(triangles.len());
        across.clear();
        across.extend(batch.clone().map(|f| neighbours_across(dual, f).map(|v| half_spaces[v as usize])));
        for (f, across) in batch.zip(&across) {
            let planes = triangles[f].map(|v| &half_spaces[v as usize]);
            let corner = common_point(planes, tolerance)
                .filter(|corner| across.iter().all(|h| h.excess(*corner) <= tolerance));
            if corner.is_none() {
                doubtful.push(f);
            }
            corners.push(corner.unwrap_or(DVec3::NAN));
        }
    }
    for f in doubtful {
        // A flip before may have settled it.
        if corners[f].is_nan() && !flip(dual, half_spaces, &mut corners, f, tolerance) {
            corners[f] = interior + polar_corner(dual.corners(f));
        }
    }
    corners
}

/// Flips the edge over which the corner of facet `f` protrudes, if that gives two corners that do not.
fn flip(
    dual: &mut SolidHull,
    half_spaces: &[HalfSpace],
    corners: &mut [DVec3],
    f: usize,
    tolerance: f64,
) -> bool {
    let planes = dual.triangles()[f].map(|v| &half_spaces[v as usize]);
    let Some(corner) = common_point(planes, tolerance) else { return false };
    let across = neighbours_across(dual, f).map(|v| half_spaces[v as usize].excess(corner));
    let edge = (1..3).fold(0, |worst, edge| if across[edge] > across[worst] { edge } else { worst });
    let g = dual.neighbours()[f][edge] as usize;
    if !dual.flip(f as u32, edge) {
        return false;
    }
    let new = [f, g].map(|facet| consistent(dual, half_spaces, facet, tolerance));
    if let [Some(at_f), Some(at_g)] = new {
        (corners[f], corners[g]) = (at_f, at_g);
        return true;
    }
    // Each flip turns the pair by a quarter; four of them restore it.
    (0..3).for_each(|_| {
        dual.flip(f as u32, 1);
    });
    false
}

/// The corner of a facet, if it lies on its own planes and within those across its edges.
fn consistent(dual: &SolidHull, half_spaces: &[HalfSpace], facet: usize, tolerance: f64) -> Option<DVec3> {
    let planes = dual.triangles()[facet].map(|v| &half_spaces[v as usize]);
    let across = neighbours_across(dual, facet).map(|v| &half_spaces[v as usize]);
    common_point(planes, tolerance).filter(|corner| across.iter().all(|h| h.excess(*corner) <= tolerance))
}

/// The third corners of the facets across the edges of a facet.
#[inline]
fn neighbours_across(dual: &SolidHull, facet: usize) -> [u32; 3] {
    let t = dual.triangles()[facet];
    let neighbours = dual.neighbours()[facet];
    [0, 1, 2].map(|edge| {
        let [a, b, c] = dual.triangles()[neighbours[edge] as usize];
        a ^ b ^ c ^ t[edge] ^ t[(edge + 1) % 3]
    })
}
