//! A finger that comes up to a surface which is computed.

use super::lines::{Line, ProbingFinger, Touch};
use super::surface::{ImplicitSurface, Level};
use super::view::View;
use crate::random::Source;
use glam::DVec3;
use nalgebra::{Matrix4, Vector4};
use thiserror::Error;

/// Why a simulated finger cannot go on.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum StuckFinger {
    /// A radius that is none, or so small that it falls between the points that the surface is known by.
    #[error(
        "the radius of the finger is {radius} m; it must be finite and above {least} m, what points of the surface are apart"
    )]
    Radius {
        /// As given, m.
        radius: f64,
        /// More than this, m.
        least: f64,
    },
    /// A surface of no points, or of some that are not finite.
    #[error("the surface has no points, or some that are not finite")]
    NoSurface,
    /// A point without a normal.
    #[error("the surface has no normal at ({}, {}, {})", .0.x, .0.y, .0.z)]
    NoNormal(DVec3),
}

/// A ball that comes down a line until it touches the surface first.
pub struct SimulatedFinger<S> {
    surface: S,
    radius: f64,
    points: Vec<DVec3>,
    /// What points of the surface are apart at most, about, m.
    gap: f64,
    view: Option<View>,
    /// Standard deviations of points per axis (m) and of normals about each tangent axis (rad).
    noise: [f64; 2],
    source: Source,
}

/// Points that contacts are looked for at first.
const POINTS: usize = 20_000;
/// Points apart over the size of the body, times the square root of their number: `sqrt(4 pi)` on a sphere, more where it is steep.
const APART: f64 = 6.0;
/// Steps of Newton's method at most, and those at which it has arrived, over the size.
const NEWTON: usize = 20;
const ARRIVED: f64 = 1e-13;
/// Search without derivatives: looks at most, and the last step over the first.
const LOOKS: usize = 3000;
const FINEST: f64 = 1e-9;
/// A line is missed that passes at more than this of the radius.
pub(super) const GRAZED: f64 = 1.0 - 1e-9;

impl<S: ImplicitSurface> SimulatedFinger<S> {
    /// A finger of `radius` m.
    ///
    /// # Errors
    /// [`StuckFinger`] for a radius that is none and for a surface without points.
    pub fn new(surface: S, radius: f64) -> Result<Self, StuckFinger> {
        let points = surface.points(POINTS);
        if points.is_empty() || points.iter().any(|x| !x.is_finite()) {
            return Err(StuckFinger::NoSurface);
        }
        let size = points.iter().map(|x| x.length()).fold(0.0, f64::max);
        let gap = APART * size / (points.len() as f64).sqrt();
        if !(radius > gap && radius.is_finite()) {
            return Err(StuckFinger::Radius { radius, least: gap });
        }
        Ok(Self { surface, radius, points, gap, view: None, noise: [0.0; 2], source: Source::new(0) })
    }

    /// With normal noise: standard deviations of a point per axis, in m, and of a normal about each tangent axis, in rad.
    #[must_use]
    pub fn with_noise(self, point: f64, normal: f64, seed: u64) -> Self {
        Self { noise: [point, normal], source: Source::new(seed), ..self }
    }

    /// Onto the surface along the gradient: a few steps of Newton's method, from nearby.
    fn onto(&self, mut x: DVec3) -> DVec3 {
        for _ in 0..3 {
            let Level { value, gradient, .. } = self.surface.at(x);
            let steep = gradient.length_squared();
            if steep <= 0.0 {
                break;
            }
            x -= gradient * (value / steep);
        }
        x
    }

    /// Height of the ball's centre over the plane through the origin when it touches `x`, coming down the line; `-inf` for what is beside its way.
    fn height(&self, line: &Line, x: DVec3) -> f64 {
        let a = line.along.get();
        let room = self.radius.powi(2) - line.off(x).length_squared();
        if room > 0.0 { x.dot(a) + room.sqrt() } else { f64::NEG_INFINITY }
    }

    /// Where a function over the surface is largest near `x`: eight tangents, with steps halved where none is higher.
    fn climb(&self, mut x: DVec3, of: &dyn Fn(DVec3) -> f64) -> DVec3 {
        let (mut step, mut best, mut looks) = (0.5 * self.gap, of(x), 0);
        while step > FINEST * self.gap && looks < LOOKS {
            let Some(normal) = self.surface.at(x).normal() else { break };
            let (e, f) = normal.tangent_basis();
            let around = [e, e + f, f, f - e, -e, -e - f, -f, e - f].map(|d| self.onto(x + d * step));
            looks += around.len();
            let higher = around.into_iter().map(|y| (of(y), y)).max_by(|a, b| a.0.total_cmp(&b.0));
            match higher {
                Some((height, y)) if height > best => (best, x) = (height, y),
                _ => step *= 0.5,
            }
        }
        x
    }

    /// The place near `x` where the ball on the line touches: its centre is on the normal, `y + q n(y) = line + t a`, and `y` on the surface. None where the
    /// iteration does not end at one that is no lower, with the ball outside of it.
    fn touched(&self, line: &Line, x: DVec3) -> Option<DVec3> {
        let (a, q, size) = (line.along.get(), self.radius, x.length().max(self.radius));
        let first = self.height(line, x);
        let (mut y, mut t) = (x, first);
        for _ in 0..NEWTON {
            let level = self.surface.at(y);
            let (n, steep) = (level.normal()?.get(), level.gradient.length());
            let off = y + n * q - line.at - a * t;
            let bent = (level.hessian - outer_times(n, level.hessian)) * (q / steep);
            let rows = [0, 1, 2].map(|i| {
                let unit = f64::from(u8::from(i == 0));
                let [u, v] = [f64::from(u8::from(i == 1)), f64::from(u8::from(i == 2))];
                let row = bent.row(i);
                [row.x + unit, row.y + u, row.z + v, -a[i]]
            });
            let g = level.gradient;
            let last = [g.x, g.y, g.z, 0.0];
            let matrix = Matrix4::from_fn(|i, j| if i < 3 { rows[i][j] } else { last[j] });
            let step = matrix.lu().solve(&-Vector4::new(off.x, off.y, off.z, level.value))?;
            let move_ = DVec3::new(step[0], step[1], step[2]);
            if move_.is_nan() || move_.length() >= 2.0 * self.gap {
                return None;
            }
            (y, t) = (y + move_, t + step[3]);
            if move_.length() < ARRIVED * size {
                let outside = self.surface.at(y).curvatures()?[0] >= -(1.0 + 1e-6) / q;
                let near = y.distance(x) < 10.0 * self.gap;
                return (outside && near && t >= first - ARRIVED * size).then_some(y);
            }
        }
        None
    }

    /// The first contact, from places on the surface near which it may be.
    fn first(&self, line: &Line, starts: &[DVec3]) -> Option<(DVec3, f64)> {
        let of = |x: DVec3| self.height(line, x);
        let beside = |x: DVec3| -line.off(x).length();
        let contact = |x: &DVec3| {
            // Beside the way by the points that the surface is known by: perhaps in it between them.
            let x = if of(*x).is_finite() { *x } else { self.climb(*x, &beside) };
            (line.off(x).length() < GRAZED * self.radius).then(|| {
                let y = self.touched(line, x).unwrap_or_else(|| {
                    let y = self.climb(x, &of);
                    self.touched(line, y).unwrap_or(y)
                });
                (y, of(y))
            })
        };
        starts.iter().filter_map(contact).max_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// `n (n^T H)`.
fn outer_times(n: DVec3, h: glam::DMat3) -> glam::DMat3 {
    let row = h.transpose() * n;
    glam::DMat3::from_cols(n * row.x, n * row.y, n * row.z)
}

impl<S: ImplicitSurface> ProbingFinger for SimulatedFinger<S> {
    type Error = StuckFinger;

    fn radius(&self) -> f64 {
        self.radius
    }

    fn approach(&mut self, line: &Line) -> Result<Option<Touch>, StuckFinger> {
        if self.view.as_ref().is_none_or(|view| view.along() != line.along) {
            self.view = Some(View::of(&self.points, line.along, self.radius, self.gap));
        }
        let starts = self.view.as_ref().map(|view| view.starts(&self.points, line)).unwrap_or_default();
        let Some((point, _)) = self.first(line, &starts) else { return Ok(None) };
        let normal = self.surface.at(point).normal().ok_or(StuckFinger::NoNormal(point))?;
        let (point, normal) =
            self.source.reading(point, normal, self.noise).ok_or(StuckFinger::NoNormal(point))?;
        Ok(Some(Touch { line: *line, point, normal }))
    }
}
