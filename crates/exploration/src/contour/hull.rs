//! What is proven of the hull of a body that was followed.

use super::margins::Margins;
use super::trace::{Touch, TraceEnd, Traced};
use crate::heading::Heading;
use glam::DVec2;
use shape_bounds::exact_hull::planar::{Direction, HalfPlane, Hull, Intersection};
use std::f64::consts::FRAC_PI_2;

/// Bounds on the hull of a body that was followed once round by a round finger.
///
/// The lower one is the hull of the contacts. The body grown by the finger's disc of radius `q` is what the centre's path goes round, past its start, so that the
/// body's support function is the path's less `q`. A body grown by a disc bulges nowhere more sharply than the disc: where the path is highest along a direction its
/// tangent is across it, and a way `d` back it is lower by `q (1 - cos(d / q))` at most. Over the way `L` between two touches it is therefore higher than both by
/// `q (1 - cos(L / 2 q))` at most, some `L^2 / 8 q`, whatever it does in between, jumps and all.
///
/// Where touches are off by [`Margins`], contacts are moved inwards by that of the point, and centres along the direction outwards by it and by what the disc's
/// point along the normal can be off.
#[derive(Clone, Copy)]
pub struct HullBounds<'a> {
    traced: &'a Traced,
    margins: Margins,
    /// What the path is higher by than the touches at most, m.
    bulge: f64,
}

/// Directions along which the upper bound is cut off: a disc's is larger than what is known of it by 1e-5 then.
const DIRECTIONS: usize = 720;
/// Of the sums of support functions, in units of the last place of the largest term.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

impl<'a> HullBounds<'a> {
    /// None of what was not followed to its end.
    #[must_use]
    pub fn of(traced: &'a Traced, margins: Margins) -> Option<Self> {
        let longest = traced.ways.iter().copied().fold(0.0, f64::max);
        let bulge = bulge(longest, traced.radius);
        (traced.end == TraceEnd::Closed).then_some(Self { traced, margins, bulge })
    }

    /// Support functions of both along a direction, m: that of the body is between them.
    #[must_use]
    pub fn support(&self, along: Direction) -> (f64, f64) {
        let most =
            |of: &dyn Fn(&Touch) -> f64| self.traced.touches.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let Margins { point, normal } = self.margins;
        let (u, q) = (along.get(), self.traced.radius);
        let lower = most(&|t| t.point.dot(u)) - point;
        let centre =
            |t: &Touch| q.mul_add((t.normal.angle_to(along) - normal).max(0.0).cos(), t.point.dot(u));
        let upper = most(&centre) + point + self.bulge;
        (lower, upper - q + ROUNDING * (upper.abs() + q))
    }

    /// Corners of the lower bound, counter-clockwise; none where margins leave nothing.
    #[must_use]
    pub fn lower(&self) -> Vec<DVec2> {
        let points: Vec<DVec2> = self.traced.touches.iter().map(|t| t.point).collect();
        let Some(hull) = Hull::of(&points).ok().and_then(|hull| hull.polygon().map(|p| p.shape().clone()))
        else {
            return Vec::new();
        };
        if self.margins.point == 0.0 {
            return hull.vertices().to_vec();
        }
        // What a disc of the margin can be moved about in within the hull as measured is within the true one.
        let inwards = |(a, b): (DVec2, DVec2)| {
            let normal = Direction::new(-(b - a).perp()).ok()?;
            Some(HalfPlane { point: a, normal, margin: -self.margins.point })
        };
        corners(&hull.edges().filter_map(inwards).collect::<Vec<_>>())
    }

    /// Corners of a polygon around the upper bound, counter-clockwise.
    #[must_use]
    pub fn upper(&self) -> Vec<DVec2> {
        let cut = |normal: Direction| {
            let (_, height) = self.support(normal);
            HalfPlane { point: normal.get() * height, normal, margin: 0.0 }
        };
        corners(&Direction::spread(DIRECTIONS).into_iter().map(cut).collect::<Vec<_>>())
    }
}

/// Corners of an intersection; none of one that is empty or open.
fn corners(half_planes: &[HalfPlane]) -> Vec<DVec2> {
    let of = Intersection::of(half_planes).ok();
    of.and_then(|of| of.bounded().map(|region| region.shape().vertices().to_vec())).unwrap_or_default()
}

/// What a path of length `way` that bulges no more sharply than a disc of radius `q` is higher by than both of its ends at most, m.
fn bulge(way: f64, q: f64) -> f64 {
    let half = 0.5 * way;
    let turned = (half / q).min(FRAC_PI_2);
    // Beyond a quarter turn it can go straight up.
    2.0 * q * (0.5 * turned).sin().powi(2) + (half - q * FRAC_PI_2).max(0.0)
}
