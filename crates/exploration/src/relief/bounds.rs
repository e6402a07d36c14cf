//! What is proven of a body that was touched on lines.

use super::cut::left_of_cube;
use super::felt::Relief;
use super::rays::{Ray, rays};
use contact_kinematics::Direction;
use glam::DVec3;
use shape_bounds::exact_hull::Hull;
use std::cmp::Ordering;
use std::collections::BinaryHeap;
use thiserror::Error;

/// Why nothing is bounded.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ReliefBoundsError {
    /// A side that is none, or too small.
    #[error("cubes of {side} m: their side must be finite and above {least} m")]
    Side {
        /// As given, m.
        side: f64,
        /// m.
        least: f64,
    },
    /// Nothing was touched.
    #[error("no line met the body within its reach: nothing bounds it from below")]
    Untouched,
}

/// Bounds on a body that was touched by a round finger on straight lines, of any shape: not convex, of several parts, with holes.
///
/// All that the finger swept is free: what is nearer to a ray of its centre than its radius, from the place where it stopped to where it came from, and to the whole line where it passed.
/// The body is within what is left of its reach, which is kept as cubes, smaller ones where the swept is near. What is left of the smallest ones is cut by a plane: the ball
/// about the ray's nearest place has all of the cube that is on this side of `sqrt(q^2 - l^2)` along the arm to the cube's middle, `l` the largest distance of a corner from that arm.
/// So the volume is larger than what is left by an error of second order in the side.
#[derive(Clone, Debug)]
pub struct ReliefBounds {
    points: Vec<DVec3>,
    /// What contacts may be off, m.
    margin: f64,
    swept: Swept,
    cells: Vec<Cell>,
    side: f64,
    volume: f64,
}

/// A cube of which not all is swept, with the rays that may be nearest to a place of it: none if it is not swept at all.
#[derive(Clone, Debug)]
struct Cell {
    middle: DVec3,
    half: f64,
    near: Vec<u32>,
}

#[derive(Clone, Debug)]
struct Swept {
    rays: Vec<Ray>,
    /// Of the finger less rounding, m.
    radius: f64,
    reach: f64,
}

/// Of distances to rays and of sums, relative to the reach.
const ROUNDING: f64 = 1e-9;
/// A side is at least so much of the reach.
const LEAST_SIDE: f64 = 1e-3;
/// Along a direction cubes are halved down to this share of the side, and so many of them at most: what is told then is larger, no less true.
const FINER: f64 = 1.0 / 256.0;
const MOST_HALVED: usize = 20_000;

impl Swept {
    /// What is left of a cell: nothing, all, or the rays that matter there.
    fn left(&self, Cell { middle, half, near }: Cell, all: bool) -> Option<Cell> {
        let round = half * 3f64.sqrt();
        // Outside of the reach: the cube's place nearest to the origin is.
        if (middle.abs() - DVec3::splat(half)).max(DVec3::ZERO).length() > self.reach {
            return None;
        }
        let known = if all { 0..self.rays.len() as u32 } else { 0..0 };
        let distances = near.into_iter().chain(known);
        let distances: Vec<(u32, f64)> = distances
            .map(|k| (k, self.rays[k as usize].distance(middle)))
            .filter(|(_, d)| *d < self.radius + round)
            .collect();
        let least = distances.iter().map(|(_, d)| *d).fold(f64::INFINITY, f64::min);
        // The distance to a ray changes by no more than the way: these are nearest nowhere in the cube.
        let near = distances.into_iter().filter(|(_, d)| *d <= least + 2.0 * round);
        let near: Vec<(u32, f64)> = near.collect();
        // The distance to a ray is a convex function: over a cube it is largest in a corner.
        let holds = |k: u32| corners(half).all(|c| self.rays[k as usize].distance(middle + c) < self.radius);
        if least + round < self.radius || near.iter().any(|(k, d)| *d < self.radius && holds(*k)) {
            return None;
        }
        Some(Cell { middle, half, near: near.into_iter().map(|(k, _)| k).collect() })
    }

    /// Volume of a small cube that is left, m^3: the least by one ray.
    fn volume(&self, cell: &Cell) -> f64 {
        let whole = (2.0 * cell.half).powi(3);
        let by = |k: &u32| {
            let arm = cell.middle - self.rays[*k as usize].nearest(cell.middle);
            let length = arm.length();
            // Without a direction, and where no part of the ball's cap is as wide as the cube, nothing is taken off.
            if length <= ROUNDING * self.reach {
                return whole;
            }
            let d = arm / length;
            let off = |c: DVec3| c.length_squared() - c.dot(d).powi(2);
            let room = self.radius.powi(2) - corners(cell.half).map(off).fold(0.0, f64::max);
            if room <= 0.0 { whole } else { left_of_cube(cell.half, d, room.sqrt() - length) }
        };
        cell.near.iter().map(by).fold(whole, f64::min)
    }
}

fn corners(half: f64) -> impl Iterator<Item = DVec3> {
    let sign = move |k: u8, bit: u8| if k >> bit & 1 == 0 { -half } else { half };
    (0..8_u8).map(move |k| DVec3::new(sign(k, 0), sign(k, 1), sign(k, 2)))
}

impl Cell {
    fn halved(&self) -> impl Iterator<Item = Self> + '_ {
        let half = 0.5 * self.half;
        corners(half).map(move |c| Self { middle: self.middle + c, half, near: self.near.clone() })
    }
}

impl ReliefBounds {
    /// With cubes of `side` m at least.
    ///
    /// # Errors
    /// [`ReliefBoundsError`].
    pub fn of(relief: &Relief, side: f64) -> Result<Self, ReliefBoundsError> {
        let least = LEAST_SIDE * relief.reach;
        if !(side > least && side.is_finite()) {
            return Err(ReliefBoundsError::Side { side, least });
        }
        if relief.touches.is_empty() {
            return Err(ReliefBoundsError::Untouched);
        }
        let (reach, radius) = (relief.reach, relief.radius - ROUNDING * relief.reach);
        let swept = Swept { rays: rays(relief), radius, reach };
        let mut open: Vec<Cell> = swept
            .left(Cell { middle: DVec3::ZERO, half: reach, near: Vec::new() }, true)
            .into_iter()
            .collect();
        let (mut cells, mut volume) = (Vec::new(), 0.0);
        while let Some(cell) = open.pop() {
            if cell.near.is_empty() {
                volume += (2.0 * cell.half).powi(3);
                cells.push(cell);
            } else if 2.0 * cell.half <= side {
                let left = swept.volume(&cell);
                if left > 0.0 {
                    volume += left;
                    cells.push(cell);
                }
            } else {
                open.extend(cell.halved().filter_map(|part| swept.left(part, false)));
            }
        }
        let points = relief.touches.iter().map(|t| t.point).collect();
        let volume = volume * (1.0 + ROUNDING);
        Ok(Self { points, margin: relief.margins().point, swept, cells, side, volume })
    }

    /// The body's volume is no more than this, m^3.
    #[must_use]
    pub fn volume_at_most(&self) -> f64 {
        self.volume
    }

    /// Whether a point may be of the body: within the reach, and not swept.
    #[must_use]
    pub fn may_hold(&self, x: DVec3) -> bool {
        x.length() <= self.swept.reach && self.swept.rays.iter().all(|r| r.distance(x) >= self.swept.radius)
    }

    /// Bounds on the body's support function along a direction, m: the farthest contact, and the farthest place that is left.
    #[must_use]
    pub fn support(&self, along: Direction) -> (f64, f64) {
        let u = along.get();
        let low = self.points.iter().map(|x| x.dot(u)).fold(f64::NEG_INFINITY, f64::max) - self.margin;
        let far =
            |cell: &Cell| cell.half.mul_add(u.abs().element_sum(), cell.middle.dot(u)).min(self.swept.reach);
        // The body has a place that is no nearer than `low`: what is nearer is not looked at.
        let ranked = |cell: &Cell| Some(far(cell)).filter(|far| *far >= low);
        let ranked = |cell: &Cell| Some(Ranked { far: ranked(cell)?, cell: cell.clone() });
        let mut open: BinaryHeap<Ranked> = self.cells.iter().filter_map(ranked).collect();
        let mut halved = 0;
        // The farthest first: what is told is true whenever the looking ends.
        while let Some(Ranked { far: top, cell }) = open.pop() {
            halved += 1;
            if cell.near.is_empty() || 2.0 * cell.half <= FINER * self.side || halved > MOST_HALVED {
                return (low, top + ROUNDING * self.swept.reach);
            }
            let parts = cell.halved().filter_map(|part| self.swept.left(part, false));
            open.extend(parts.map(|cell| Ranked { far: far(&cell), cell }));
        }
        // All is swept: no body is there, and nothing contradicts that it is a point.
        (low, low)
    }

    /// The hull of the contacts, with exact signs; none where contacts may be off, or if they do not span space.
    #[must_use]
    pub fn hull(&self) -> Option<shape_bounds::exact_hull::SolidHull> {
        if self.margin > 0.0 {
            return None;
        }
        Hull::of(&self.points).ok()?.into_solid()
    }
}

/// A cell by how far it is along a direction.
struct Ranked {
    far: f64,
    cell: Cell,
}

impl PartialEq for Ranked {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Ranked {}

impl PartialOrd for Ranked {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Ranked {
    fn cmp(&self, other: &Self) -> Ordering {
        self.far.total_cmp(&other.far)
    }
}
