//! All that the palms can do with the body itself, from place to place, where no body drawn promises anything.
//!
//! A place is a normal at the upper contact, up to its sign: what is felt there is felt at the lower one as well. A stroke goes along a great circle
//! of places, until friction or a pad ends it. When every normal of a lattice was come near to, or lies beyond where strokes towards it
//! were stopped from wherever the body was, no stroke uncovers more, up to what hides between the nodes.

use crate::heading::Heading;
use crate::knowledge::Knowledge;
use crate::parallel::hold::{Stroke, Wall};
use crate::parallel::planner::{ParallelView, towards};
use crate::space::low_discrepancy;
use contact_kinematics::Direction;
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// What was aimed at.
#[derive(Clone, Debug, Default)]
pub(super) struct Walk {
    aim: Option<Aim>,
    /// Aims that strokes ended short of without meeting friction: at the edge of a pad. And the contacts there were when these were last tried anew.
    beyond: Vec<Direction>,
    tried: usize,
}

/// Where a stroke goes, and the walls there were before it.
#[derive(Clone, Copy, Debug)]
struct Aim {
    along: Direction,
    walls: usize,
}

/// Nodes: some 0.2 rad apart on half of the sphere.
const NODES: usize = 160;
/// A place nearer to a node than this, rad, was there.
const SEEN: f64 = 0.2;
/// Strokes into what was not seen are so long at most, rad.
const FARTHEST: f64 = 0.7;
/// Places farther apart than this, rad, are not gone between straight away.
const LINK: f64 = 0.4;
/// A stroke that ends nearer to its aim than this, rad, got there.
const THERE: f64 = 0.1;
/// Walls are felt within so many rad, and by strokes that lean by less than 25 degrees: there may be a way past them.
const WALL: [f64; 2] = [0.08, 0.9];
/// A way is looked at every so many rad.
const STEP: f64 = 0.05;

impl Walk {
    /// The next stroke towards what was not come near to; none where there is nothing left that could be got to.
    pub(super) fn next(&mut self, view: &ParallelView<'_>) -> Option<Stroke> {
        let here = view.hold.normals()[0];
        if let Some(aim) = self.aim.take()
            && aim.walls == view.walls.len()
            && angle(aim.along, here) > THERE
        {
            self.beyond.push(aim.along);
        }
        let felt = view.known.contacts().iter().map(|contact| contact.normal);
        // What is as good as here is no way to anywhere.
        let others = felt.filter(|place| angle(*place, here) > THERE);
        let places: Vec<Direction> = std::iter::once(here).chain(others).collect();
        let along = self.onwards(view, &places).or_else(|| {
            // Where the pads are by then is another matter.
            let touches = view.known.touches();
            let again = !self.beyond.is_empty() && touches > std::mem::replace(&mut self.tried, touches);
            self.beyond.retain(|_| !again);
            if again { self.onwards(view, &places) } else { None }
        })?;
        self.aim = Some(Aim { along, walls: view.walls.len() });
        towards(view.hold, along)
    }

    /// Where to go for what was not come near to.
    fn onwards(&self, view: &ParallelView<'_>, places: &[Direction]) -> Option<Direction> {
        let is_new = |node: &Direction| {
            places.iter().all(|place| angle(*place, *node) > SEEN)
                && self.beyond.iter().all(|beyond| angle(*beyond, *node) > THERE)
        };
        let nodes: Vec<Direction> = (0..NODES).map(low_discrepancy).filter(is_new).collect();
        self.nearest(view.walls, places, &nodes)
    }

    /// Where to go from the first place for the nearest node that a way leads to: there, or to the next place on the way.
    fn nearest(&self, walls: &[Wall], places: &[Direction], nodes: &[Direction]) -> Option<Direction> {
        let mut ways = vec![f64::INFINITY; places.len()];
        let mut first: Vec<Option<usize>> = vec![None; places.len()];
        let mut done = vec![false; places.len()];
        let mut best: Option<(f64, Direction)> = None;
        ways[0] = 0.0;
        loop {
            let open = (0..places.len()).filter(|k| !done[*k] && ways[*k].is_finite());
            let next = open.min_by(|a, b| ways[*a].total_cmp(&ways[*b]));
            // What is farther than the best already cannot be better.
            let Some(next) = next.filter(|k| best.is_none_or(|(way, _)| ways[*k] < way)) else {
                return best.map(|(_, along)| along);
            };
            done[next] = true;
            for node in nodes {
                let turn = angle(places[next], *node);
                let way = ways[next] + turn;
                let is_nearer = turn < FARTHEST && best.is_none_or(|(least, _)| way < least);
                if is_nearer && is_open(walls, places[next], *node) {
                    best = Some((way, first[next].map_or(*node, |k| places[k])));
                }
            }
            for to in 0..places.len() {
                let turn = angle(places[next], places[to]);
                if turn < LINK
                    && ways[next] + turn < ways[to]
                    && !self.beyond.contains(&places[to])
                    && is_open(walls, places[next], places[to])
                {
                    ways[to] = ways[next] + turn;
                    first[to] = first[next].or(Some(to));
                }
            }
        }
    }
}

/// Angle between two places, rad.
fn angle(a: Direction, b: Direction) -> f64 {
    let angle = a.angle_to(b);
    angle.min(std::f64::consts::PI - angle).clamp(0.0, FRAC_PI_2)
}

/// Whether no wall is known to stand on the way between two places.
fn is_open(walls: &[Wall], from: Direction, to: Direction) -> bool {
    let (a, b) = (from.get(), to.get() * from.get().dot(to.get()).signum());
    let across = b - a * a.dot(b);
    let (turn, Some(across)) = (angle(from, to), across.try_normalize()) else { return true };
    let parts = (turn / STEP).ceil().max(1.0);
    (0..parts as usize).all(|k| {
        let (sin, cos) = (turn * k as f64 / parts).sin_cos();
        let (place, onwards): (DVec3, DVec3) = (a * cos + across * sin, across * cos - a * sin);
        !walls.iter().any(|wall| wall.is_met(place, onwards, WALL))
    })
}
