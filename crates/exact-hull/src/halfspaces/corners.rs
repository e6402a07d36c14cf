//! The corners of an intersection of half-spaces, one for each facet of the hull of duals.

use super::vertex::{common_point, polar_corner};
use crate::HalfSpace;
use crate::hull::{SolidHull, SupportWalk};
use glam::DVec3;

/// Facets whose data are fetched together, so that memory is waited for once.
const BATCH: usize = 16;

/// The corner of each facet of the dual, and whether all are well determined by their planes.
///
/// The planes of the duals are those of the half-spaces but for rounding, and the combinatorics of the dual hull is
/// exact for them: their corners are consistent to rounding, but where planes are nearly parallel they may slide far along
/// them. The corner computed from the half-spaces as given is exact in that direction too, where it is a corner at all:
/// where rounding of the duals has joined planes that are not quite neighbours it protrudes over the plane across an edge.
/// That edge is then flipped. Where the planes determine it badly, those across the edges may do no better, and it is held
/// against the plane that it is the farthest beyond of all.
pub(super) fn corners(
    dual: &mut SolidHull,
    half_spaces: &[HalfSpace],
    interior: DVec3,
    tolerance: f64,
) -> (Vec<DVec3>, bool) {
    let triangles = dual.triangles();
    let mut sure = true;
    let mut corners = Vec::with_capacity(triangles.len());
    let mut doubtful = Vec::new();
    let mut across: Vec<[HalfSpace; 3]> = Vec::with_capacity(BATCH);
    for first in (0..triangles.len()).step_by(BATCH) {
        let batch = first..(first + BATCH).min(triangles.len());
        across.clear();
        across.extend(batch.clone().map(|f| neighbours_across(dual, f).map(|v| half_spaces[v as usize])));
        for (f, across) in batch.zip(&across) {
            let planes = triangles[f].map(|v| &half_spaces[v as usize]);
            let within = |corner: DVec3| across.iter().all(|h| h.excess(corner) <= tolerance);
            let found = common_point(planes, tolerance);
            sure &= found.is_some_and(|(_, sure)| sure);
            let corner = found
                .filter(|(corner, sure)| {
                    within(*corner)
                        && (*sure || beyond_all(dual, half_spaces, f, *corner, interior) <= tolerance)
                })
                .map(|(corner, _)| corner);
            if corner.is_none() {
                doubtful.push(f);
            }
            corners.push(corner.unwrap_or(DVec3::NAN));
        }
    }
    // A flip before may have settled it.
    doubtful
        .retain(|&f| corners[f].is_nan() && !flip(dual, half_spaces, &mut corners, f, interior, tolerance));
    settle(dual, half_spaces, &mut corners, doubtful, interior, tolerance);
    (corners, sure)
}

/// Gives corners to the facets that are left: slivers, whose three planes have a line in common but for rounding, as planes along
/// a sharp edge do. Where along the line their corner is, rounding decides; those of the facets beside it, which share two of
/// the planes, are on it. The one that is the least off its own planes and beyond any other is taken, or that of the rounded
/// duals if it is better, from the surest facet to the next.
fn settle(
    dual: &SolidHull,
    half_spaces: &[HalfSpace],
    corners: &mut [DVec3],
    mut left: Vec<usize>,
    interior: DVec3,
    tolerance: f64,
) {
    let height = |f: usize, corner: DVec3| {
        let own = dual.triangles()[f].map(|v| half_spaces[v as usize].excess(corner).abs());
        own.into_iter().fold(beyond_all(dual, half_spaces, f, corner, interior), f64::max)
    };
    let best = |f: usize, corners: &[DVec3]| {
        let beside = dual.neighbours()[f].map(|g| corners[g as usize]);
        let polar = interior + polar_corner(dual.corners(f));
        let all = beside.into_iter().chain([polar]).filter(|corner| corner.is_finite());
        all.map(|corner| (height(f, corner), corner)).min_by(|a, b| a.0.total_cmp(&b.0))
    };
    // What no pass settles any more takes the best there is.
    let mut allowed = tolerance;
    while !left.is_empty() {
        let before = left.len();
        left.retain(|&f| match best(f, corners).filter(|(off, _)| *off <= allowed) {
            Some((_, corner)) => {
                corners[f] = corner;
                false
            }
            None => true,
        });
        if left.len() == before {
            if allowed == f64::INFINITY {
                break;
            }
            allowed = f64::INFINITY;
        }
    }
}

/// Flips the edge over which the corner of facet `f` protrudes, if that gives two corners that do not.
fn flip(
    dual: &mut SolidHull,
    half_spaces: &[HalfSpace],
    corners: &mut [DVec3],
    f: usize,
    interior: DVec3,
    tolerance: f64,
) -> bool {
    let planes = dual.triangles()[f].map(|v| &half_spaces[v as usize]);
    let Some((corner, _)) = common_point(planes, tolerance) else { return false };
    let across = neighbours_across(dual, f).map(|v| half_spaces[v as usize].excess(corner));
    let edge = (1..3).fold(0, |worst, edge| if across[edge] > across[worst] { edge } else { worst });
    let g = dual.neighbours()[f][edge] as usize;
    if !dual.flip(f as u32, edge) {
        return false;
    }
    let new = [f, g].map(|facet| consistent(dual, half_spaces, facet, interior, tolerance));
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

/// The corner of a facet, if it lies on its own planes and within all others.
fn consistent(
    dual: &SolidHull,
    half_spaces: &[HalfSpace],
    facet: usize,
    interior: DVec3,
    tolerance: f64,
) -> Option<DVec3> {
    let planes = dual.triangles()[facet].map(|v| &half_spaces[v as usize]);
    let (corner, _) = common_point(planes, tolerance)?;
    let across = neighbours_across(dual, facet).map(|v| half_spaces[v as usize].excess(corner));
    let within = across.into_iter().all(|excess| excess <= tolerance)
        && beyond_all(dual, half_spaces, facet, corner, interior) <= tolerance;
    within.then_some(corner)
}

/// How far a corner of a facet is beyond the plane that it is the farthest beyond of all, in m: that whose dual is the farthest along
/// the corner's direction.
#[cold]
fn beyond_all(
    dual: &SolidHull,
    half_spaces: &[HalfSpace],
    facet: usize,
    corner: DVec3,
    interior: DVec3,
) -> f64 {
    let mut walk = SupportWalk::new(dual);
    walk.start_at(dual.triangles()[facet][0]);
    half_spaces[walk.farthest_corner(corner - interior)].excess(corner)
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
