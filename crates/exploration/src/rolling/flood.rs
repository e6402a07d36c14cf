//! Everything that the palms can do with a body, by a flood over their lattice: how to get to what no single motion reaches, and
//! what nothing reaches.

use super::balance::{Balance, settle_roughly};
use super::belief::Belief;
use super::drawn::{DrawnBody, cell_at};
use super::gain::removed;
use super::metric::between;
use super::palms::PREDICTED;
use super::planner::{RollProposal, View};
use super::predict::Course;
use super::workspace::{along, pair, radians};
use crate::planner::Reason;
use shape_bounds::exact_hull::planar::Direction;

/// A rest that can be got to.
struct Place {
    palms: [f64; 2],
    phi: f64,
    from: Option<usize>,
    /// Radians of palm motion up to here.
    way: f64,
    /// Directions felt on the last motion, rad.
    thetas: Vec<f64>,
}

/// Spacing of the lattice, rad, and the farthest neighbours that are tried.
const SPACING: f64 = 0.3;
const FARTHEST: f64 = 0.45;
/// Rests of the same palms closer than this, rad, are one.
const SAME: f64 = 0.1;

/// Places at most.
const MOST: usize = 600;
/// Bodies on which ways are looked for; all of them if there is none on these.
const ROUTED: usize = 4;
/// Of all places with this share of the largest gain the nearest is gone to.
const SHARE: f64 = 0.5;

/// Whether two orientations (rad) of a body between the same palms are one rest.
pub(super) fn is_same(phi: f64, other: f64) -> bool {
    between(phi, other) < SAME
}

/// All places that `body` can be brought to, nearest in motions first.
fn flood(view: &View<'_>, body: &DrawnBody, phi: f64) -> Vec<Place> {
    let lattice = view.workspace.lattice(SPACING);
    let start = Place { palms: view.track.palms, phi, from: None, way: 0.0, thetas: Vec::new() };
    let mut places = vec![start];
    let mut next = 0;
    while next < places.len() && places.len() < MOST {
        for to in &lattice {
            let (here, phi, way) = (places[next].palms, places[next].phi, places[next].way);
            let far = (to[0] - here[0]).abs().max((to[1] - here[1]).abs());
            if far > FARTHEST || far == 0.0 {
                continue;
            }
            let Some((phi, thetas)) = followed(view, body, here, *to, phi) else { continue };
            if !places.iter().any(|p| p.palms == *to && is_same(p.phi, phi)) {
                let way = way + radians(here, *to);
                places.push(Place { palms: *to, phi, from: Some(next), way, thetas });
            }
        }
        next += 1;
    }
    places
}

/// Where a body ends after a straight motion, and what is felt of it; none if it is lost.
fn followed(
    view: &View<'_>,
    body: &DrawnBody,
    from: [f64; 2],
    to: [f64; 2],
    mut phi: f64,
) -> Option<(f64, Vec<f64>)> {
    let mut thetas = Vec::new();
    for palms in along(from, to, PREDICTED) {
        let pair = pair(palms)?;
        phi = settle_roughly(body, &pair, phi)?.phi;
        let balance = Balance::at(body, &pair, phi);
        if balance.s.iter().any(|s| *s > view.workspace.length) {
            return None;
        }
        thetas.extend(balance.thetas);
    }
    Some((phi, thetas))
}

/// The way to the place with a gain worth it (`least`, m^2) that is nearest, on some of the bodies; none where there is none on any of
/// them.
pub(super) fn far_motion(view: &View<'_>, belief: &Belief, least: f64) -> Option<RollProposal> {
    let mut best: Option<RollProposal> = None;
    for (k, (body, (phi, _))) in belief.bodies.iter().zip(&belief.swings).enumerate() {
        if k >= ROUTED && best.is_some() {
            break;
        }
        let places = flood(view, body, *phi);
        let gains: Vec<f64> =
            places.iter().map(|p| removed(&belief.cells, belief.spacing, body, &p.thetas)).collect();
        let most = gains.iter().copied().fold(0.0, f64::max);
        if most < least {
            continue;
        }
        let worth = |k: &usize| gains[*k] >= (SHARE * most).max(least) && gains[*k] > 0.0;
        // The first one is where the palms are.
        let good = (1..places.len()).filter(worth);
        let Some(to) = good.min_by(|a, b| places[*a].way.total_cmp(&places[*b].way)) else { continue };
        let proposal = proposed(view, belief, legs(&places, to));
        let gain = |p: &RollProposal| p.expected.map_or(0.0, |e| e.gain);
        if best.as_ref().is_none_or(|b| gain(&proposal) > gain(b)) {
            best = Some(proposal);
        }
    }
    best
}

fn legs(places: &[Place], to: usize) -> Vec<[f64; 2]> {
    let back = std::iter::successors(Some(to), |k| places[*k].from);
    let mut legs: Vec<[f64; 2]> = back.map(|k| places[k].palms).collect();
    // The last one is where the palms are.
    legs.pop();
    legs.reverse();
    legs
}

fn proposed(view: &View<'_>, belief: &Belief, legs: Vec<[f64; 2]>) -> RollProposal {
    let start = Course::start(belief, view.track);
    let course = legs.iter().fold(start, |course, to| course.then(belief, view.workspace, *to));
    let expected = Some(course.prediction(belief, view.workspace));
    RollProposal { legs, expected, reason: Reason::Best }
}

/// Cells above this share of what is left are named.
const NAMED: f64 = 0.01;

/// Middles of the cells that on no body are reached, the largest first; the largest of all if each is reached by some.
pub(super) fn unreached(view: &View<'_>, belief: &Belief) -> Vec<Direction> {
    let mut reached = vec![false; belief.cells.len()];
    for (body, (phi, _)) in belief.bodies.iter().zip(&belief.swings) {
        for theta in flood(view, body, *phi).iter().flat_map(|p| &p.thetas) {
            let (cell, theta) = cell_at(&belief.cells, *theta);
            reached[cell] |= belief.cells[cell].takes(theta, belief.spacing);
        }
    }
    let least = NAMED * belief.between();
    let mut left: Vec<usize> = (0..reached.len()).filter(|k| belief.cells[*k].area > least).collect();
    if left.iter().any(|k| !reached[*k]) {
        left.retain(|k| !reached[*k]);
    }
    left.sort_by(|a, b| belief.cells[*b].area.total_cmp(&belief.cells[*a].area));
    left.iter().map(|k| Direction::from_angle(belief.cells[*k].middle())).collect()
}
