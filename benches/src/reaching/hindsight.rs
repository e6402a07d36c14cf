//! What could be had by looking ahead at touches in the plane: the best pattern of all, by who knows the body, and the shortest way through touches that were made.

use super::Bodies;
use crate::rows::{Cells, rows_in_threads};
use exploration::generators::{Family, Outline, outline};
use exploration::planar::{PathAware, PlanarKnowledge, SimulatedFinger, turned_start};
use exploration::{ExploreError, Goal, Heading, Motion, Task, explore};
use glam::DVec2;
use recon::shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::TAU;

/// Directions that a pattern is made of.
const DIRECTIONS: usize = 120;
/// Touches of a pattern at most.
const MOST: usize = 24;

/// A cell between two touches: areas of what is between the bounds there and of the upper one's sector about the origin, m^2.
type Cell = [f64; 2];

/// The least number of touches in some of 120 directions after which the gap is no more than `gap`: that of who knows the body. None above 24.
///
/// Cells add up: with areas `A` between the bounds and `U` of the upper one the gap is below `t` where the sum of `A - t U` over the cells is below zero, and the
/// cheapest round of `n` cells is a shortest way of `n` steps.
#[must_use]
pub fn fewest(body: &Outline, gap: f64) -> Option<usize> {
    let lattice = Direction::spread(DIRECTIONS);
    let points: Vec<DVec2> = lattice.iter().map(|u| body(*u)).collect();
    let half = DIRECTIONS / 2;
    // From each direction to those within half a turn.
    let cost = |i: usize, step: usize| {
        let k = (i + step) % DIRECTIONS;
        cell([points[i], points[k]], [lattice[i].get(), lattice[k].get()]).map(|[a, u]| a - gap * u)
    };
    let costs: Vec<Vec<f64>> = (0..DIRECTIONS)
        .map(|i| (1..half).map(|step| cost(i, step).unwrap_or(f64::INFINITY)).collect())
        .collect();
    let reached = |n: usize| (0..DIRECTIONS).any(|start| round(&costs, start, n) <= 0.0);
    (3..=MOST).find(|n| reached(*n))
}

/// The cheapest round of `n` cells from `start` on.
fn round(costs: &[Vec<f64>], start: usize, n: usize) -> f64 {
    let mut cheapest = vec![f64::INFINITY; DIRECTIONS + 1];
    cheapest[0] = 0.0;
    for _ in 0..n {
        let mut next = vec![f64::INFINITY; DIRECTIONS + 1];
        for (at, cost) in cheapest.iter().enumerate().filter(|(_, cost)| cost.is_finite()) {
            let steps = costs[(start + at) % DIRECTIONS].iter().zip(at + 1..=DIRECTIONS);
            steps.for_each(|(own, to)| next[to] = next[to].min(cost + own));
        }
        cheapest = next;
    }
    cheapest[DIRECTIONS]
}

/// Between touches at two points with these normals, counter-clockwise. None where their lines do not meet on that side.
fn cell([a, b]: [DVec2; 2], [n, m]: [DVec2; 2]) -> Option<Cell> {
    let turn = n.perp_dot(m);
    if turn <= 1e-9 {
        return None;
    }
    let corner = DVec2::new(m.y * n.dot(a) - n.y * m.dot(b), n.x * m.dot(b) - m.x * n.dot(a)) / turn;
    Some([0.5 * (corner - a).perp_dot(b - a).abs(), 0.5 * (a.perp_dot(corner) + corner.perp_dot(b))])
}

/// On one body: the family's number, the fewest touches to 30, 20 and 10 % in hindsight and by the path-aware planner, the way of that to the last, rad, and the
/// shortest one through the same touches.
#[derive(Clone, Debug)]
pub struct Hindsight {
    /// Of the body.
    pub family: Family,
    /// To each gap.
    pub fewest: [Option<usize>; 3],
    /// By the planner.
    pub made: [Option<usize>; 3],
    /// Of the planner and the least through its touches, rad.
    pub way: [f64; 2],
}

/// Gaps that touches are counted to.
pub const GAPS: [f64; 3] = [0.3, 0.2, 0.1];

/// On all bodies (of a part of a study: of some), in two threads.
///
/// # Errors
/// The first error of a run.
pub fn hindsight(bodies: Bodies) -> Result<Vec<Hindsight>, Box<dyn std::error::Error + Send + Sync>> {
    let all: Vec<_> = bodies.all().collect();
    rows_in_threads(&all, |(family, seed)| Ok(one(*family, *seed)?))
}

impl Cells for Hindsight {
    fn write(&self, to: &mut Vec<String>) {
        self.family.write(to);
        let counts = [self.fewest, self.made].map(|counts| counts.map(|n| n.unwrap_or(usize::MAX)));
        (counts, self.way).write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let family = Family::read(from)?;
        let (counts, way): ([[usize; 3]; 2], _) = Cells::read(from)?;
        let [fewest, made] = counts.map(|of| of.map(|n| (n < usize::MAX).then_some(n)));
        Some(Self { family, fewest, made, way })
    }
}

fn one(family: Family, seed: u64) -> Result<Hindsight, ExploreError> {
    let body = outline(family, seed);
    let mut finger = SimulatedFinger::new(outline(family, seed), Motion::Plane);
    let (mut known, mut planner) = (PlanarKnowledge::exact(), PathAware::new(turned_start(5, seed)));
    let (mut made, mut way, mut angles) = ([None; 3], 0.0, Vec::new());
    explore(&mut known, &mut planner, &mut finger, &Task::new(Goal::Gap(GAPS[2]), 300), |step, _| {
        way += step.turned;
        angles.push(step.proposal.along.angle().rem_euclid(TAU));
        for (gap, made) in GAPS.iter().zip(&mut made) {
            if step.progress <= *gap && made.is_none() {
                *made = Some(step.touch);
            }
        }
    })?;
    Ok(Hindsight { family, fewest: GAPS.map(|gap| fewest(&body, gap)), made, way: [way, once_round(angles)] })
}

/// The shortest way through directions, rad: round but for the widest space between two.
fn once_round(mut angles: Vec<f64>) -> f64 {
    angles.sort_by(f64::total_cmp);
    let next = angles.iter().cycle().skip(1);
    let spaces = angles.iter().zip(next).map(|(a, b)| (b - a).rem_euclid(TAU));
    TAU - spaces.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a disc the gap after `n` even touches is `sin^2(pi / n)`: 6, 7 and 10 touches.
    #[test]
    fn the_fewest_touches_of_a_disc_are_known() {
        let disc: Outline = Box::new(|u: Direction| u.get() * 2.0 + DVec2::new(0.3, -0.1));
        assert_eq!(GAPS.map(|gap| fewest(&disc, gap)), [Some(6), Some(7), Some(10)]);
        // Six even ones are among the directions; a hair below what they leave takes one more.
        let exact = (std::f64::consts::PI / 6.0).sin().powi(2);
        assert_eq!([1e-9, -1e-9].map(|more| fewest(&disc, exact + more)), [Some(6), Some(7)]);
    }

    #[test]
    fn the_shortest_way_leaves_the_widest_space_out() {
        assert!((once_round(vec![3.0, 0.0, 1.0, 2.0]) - 3.0).abs() < 1e-15);
        assert!((once_round(vec![0.1, TAU - 0.1, 0.5]) - 0.6).abs() < 1e-12);
    }
}
