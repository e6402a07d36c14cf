//! A finger on an outline that is computed.

use super::outline::SmoothOutline;
use super::trace::{ContourFinger, Touch};
use crate::random::Source;
use glam::DVec2;
use shape_bounds::exact_hull::planar::{Direction, DirectionError};
use std::f64::consts::TAU;
use thiserror::Error;

/// Why a simulated finger cannot go on.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StuckFinger {
    /// A radius that is none.
    #[error("the radius of the finger is {0} m; it must be positive and finite")]
    Radius(f64),
    /// The outline has a point without a tangent.
    #[error("the outline has no tangent at the parameter {t}: {source}")]
    NoTangent {
        /// Where.
        t: f64,
        /// Why.
        source: DirectionError,
    },
    /// Nothing on the other side where the finger is stopped.
    #[error(
        "the finger is stopped at the parameter {t} and touches nothing else; sample the outline more densely"
    )]
    Stopped {
        /// Where.
        t: f64,
    },
}

/// Keeps in touch with an outline from outside.
pub struct SimulatedFinger<O> {
    outline: O,
    radius: f64,
    /// Parameter of the contact.
    t: f64,
    table: Vec<DVec2>,
    /// Of so many of these in a row the middle, and how far they are from it.
    blocks: Vec<(DVec2, f64)>,
    size: f64,
    /// Standard deviations of points per axis (m) and of normals (rad).
    noise: [f64; 2],
    source: Source,
}

/// Points by which it is looked whether the disc is free.
const POINTS: usize = 2048;
/// Points that are looked at together.
const BLOCK: usize = 32;
/// The contact moves by this share of a turn of the parameter at most between two looks.
const STEP: f64 = TAU / 4096.0;
/// A disc that is entered by less than this share of the size is free.
const FREE: f64 = 1e-9;
/// Halvings of the place where both sides are touched, and steps of Newton's method on the other side.
const HALVINGS: usize = 50;
const NEWTON: usize = 30;
/// Times that a step is made shorter.
const CORRECTIONS: usize = 8;
/// Points nearer to the contact than this (parameter) are the contact itself, unless the finger is larger than the hollow.
const OWN: f64 = 8.0 * TAU / POINTS as f64;

impl<O: SmoothOutline> SimulatedFinger<O> {
    /// A finger of `radius` m, at the point of the outline that is farthest along world x: every finger gets there.
    ///
    /// # Errors
    /// [`StuckFinger::Radius`].
    pub fn new(outline: O, radius: f64) -> Result<Self, StuckFinger> {
        if !(radius > 0.0 && radius.is_finite()) {
            return Err(StuckFinger::Radius(radius));
        }
        let place = |k: usize| TAU * k as f64 / POINTS as f64;
        let table: Vec<DVec2> = (0..POINTS).map(|k| outline.at(place(k)).point).collect();
        let farthest = (0..POINTS).max_by(|a, b| table[*a].x.total_cmp(&table[*b].x)).unwrap_or(0);
        let size = table.iter().map(|p| p.length()).fold(0.0, f64::max);
        let block = |points: &[DVec2]| {
            let middle = points[points.len() / 2];
            (middle, points.iter().map(|p| p.distance(middle)).fold(0.0, f64::max))
        };
        let blocks = table.chunks(BLOCK).map(block).collect();
        let (t, source) = (place(farthest), Source::new(0));
        Ok(Self { outline, radius, t, table, blocks, size, noise: [0.0; 2], source })
    }

    /// With normal noise: standard deviations of a point per axis, in m, and of a normal, in rad.
    #[must_use]
    pub fn with_noise(self, point: f64, normal: f64, seed: u64) -> Self {
        Self { noise: [point, normal], source: Source::new(seed), ..self }
    }

    fn centre(&self, t: f64) -> DVec2 {
        let at = self.outline.at(t);
        at.point + at.normal() * self.radius
    }

    /// Way of the centre while the contact moves from one parameter to another, m: of its path and not of the chord, since the room that a bound leaves for
    /// it is what the path is longer by. By Gauss's rule of three points.
    fn way(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let speed = |x: f64| {
            let at = self.outline.at(half.mul_add(x, middle));
            at.first.length() * (1.0 + self.radius * at.curvature()).abs()
        };
        let x = 0.6_f64.sqrt();
        half.abs() * (5.0 * (speed(-x) + speed(x)) + 8.0 * speed(0.0)) / 9.0
    }

    /// The parameter of the outline's point nearest to `c` that is not the contact at `t`, to within the table.
    fn nearest_other(&self, c: DVec2, t: f64) -> Option<(f64, f64)> {
        let apart = |k: usize| {
            let turn = (TAU * k as f64 / POINTS as f64 - t).rem_euclid(TAU);
            turn.min(TAU - turn)
        };
        let (mut nearest, mut least) = (None, f64::INFINITY);
        for (block, (middle, reach)) in self.blocks.iter().enumerate() {
            // None of a block is nearer than this.
            if middle.distance(c) - reach > least {
                continue;
            }
            let points = self.table.iter().enumerate().skip(BLOCK * block).take(BLOCK);
            for (k, point) in points.filter(|(k, _)| apart(*k) > OWN) {
                let distance = point.distance(c);
                if distance < least {
                    (nearest, least) = (Some(k), distance);
                }
            }
        }
        let k = nearest?;
        let mut s = TAU * k as f64 / POINTS as f64;
        // Stationary: (x - c) . x' = 0.
        for _ in 0..NEWTON {
            let at = self.outline.at(s);
            let arm = at.point - c;
            let slope = at.first.length_squared() + arm.dot(at.second);
            let step = arm.dot(at.first) / slope;
            // Where the distance is hardly bent, or bent the other way, downhill by what the table is apart.
            let most = TAU / POINTS as f64;
            let step = if slope > 0.0 { step.clamp(-most, most) } else { most.copysign(arm.dot(at.first)) };
            s -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        Some((s, self.outline.at(s).point.distance(c)))
    }

    /// How far the disc at the contact `t` is from being entered on another side, m.
    fn room(&self, t: f64) -> f64 {
        self.nearest_other(self.centre(t), t).map_or(f64::INFINITY, |(_, d)| d - self.radius)
    }

    /// Where the finger is stopped between `free` and `stopped`, and the touch on the other side.
    fn jumped(&self, mut free: f64, mut stopped: f64) -> Result<(f64, f64), StuckFinger> {
        for _ in 0..HALVINGS {
            let middle = 0.5 * (free + stopped);
            if self.room(middle) < -FREE * self.size { stopped = middle } else { free = middle }
        }
        let other = self.nearest_other(self.centre(free), free);
        let near = |d: f64| (d - self.radius).abs() < 1e-6 * self.size;
        other.filter(|(_, d)| near(*d)).map(|(s, _)| (free, s)).ok_or(StuckFinger::Stopped { t: free })
    }

    fn touch(&mut self) -> Result<Touch, StuckFinger> {
        let at = self.outline.at(self.t);
        let exact =
            Direction::new(at.normal()).map_err(|source| StuckFinger::NoTangent { t: self.t, source })?;
        let [point, normal] = self.noise;
        let off = DVec2::new(self.source.normal(), self.source.normal()) * point;
        let normal = Direction::from_angle(exact.angle() + normal * self.source.normal());
        Ok(Touch { point: at.point + off, normal })
    }
}

impl<O: SmoothOutline> ContourFinger for SimulatedFinger<O> {
    type Error = StuckFinger;

    fn radius(&self) -> f64 {
        self.radius
    }

    fn advance(&mut self, length: f64) -> Result<Touch, StuckFinger> {
        let (mut left, sense) = (length.abs(), length.signum());
        while left > 0.0 {
            // The contact moves so that the centre does not overshoot: |dc / dt| = |x'| |1 + q k|.
            let at = self.outline.at(self.t);
            let speed = at.first.length() * (1.0 + self.radius * at.curvature()).max(1e-6);
            let mut next = self.t + sense * (left / speed).min(STEP);
            // No farther than asked for: what is proven of the path rests on its length.
            for _ in 0..CORRECTIONS {
                let moved = self.way(self.t, next);
                if moved <= left {
                    break;
                }
                next = self.t + (next - self.t) * (left / moved) * (1.0 - 1e-12);
            }
            if self.room(next) < -FREE * self.size {
                let (stop, other) = self.jumped(self.t, next)?;
                left -= self.way(self.t, stop);
                // On by next to nothing, off the place where both sides are touched.
                self.t = other + sense * 1e-9;
                continue;
            }
            left -= self.way(self.t, next).max(1e-12 * self.size);
            self.t = next;
        }
        self.touch()
    }
}
