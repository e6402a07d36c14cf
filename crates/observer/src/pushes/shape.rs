//! Outlines with few unknowns: polygons by their corners, smooth ones by the harmonics of their radius about a fixed point.

use super::fit::HARMONIC;
use glam::DVec2;
use object_dynamics::pushing::ClosedLine;

/// Most unknowns of a shape.
pub(super) const MOST: usize = 16;
/// Most corners of a polygon.
pub(super) const MOST_CORNERS: usize = MOST / 2;
/// Highest harmonic of a smooth outline.
pub(super) const HIGHEST: usize = (MOST - 1) / 2;
/// Corners of the line that stands for a smooth outline: of the harmonics above, it is off by less than 1e-3 of the radius.
const FINE: usize = 192;

/// An outline.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    Polygon(Vec<DVec2>),
    /// `r(phi) = c_0 + sum c_(2k-1) cos k phi + c_2k sin k phi` about a centre.
    Smooth {
        centre: DVec2,
        coefficients: Vec<f64>,
    },
}

impl Shape {
    pub(super) fn unknowns(&self) -> usize {
        match self {
            Self::Polygon(corners) => 2 * corners.len(),
            Self::Smooth { coefficients, .. } => coefficients.len(),
        }
    }

    /// What is known of an unknown beforehand, in sizes of the object: a corner is somewhere on it.
    pub(super) fn beforehand(&self, unknown: usize) -> f64 {
        match self {
            Self::Smooth { .. } if unknown > 0 => HARMONIC / unknown.div_ceil(2) as f64,
            _ => 1.0,
        }
    }

    pub(super) fn moved(&self, mut step: impl FnMut(usize) -> f64) -> Self {
        match self {
            Self::Polygon(corners) => Self::Polygon(
                corners
                    .iter()
                    .enumerate()
                    .map(|(k, p)| *p + DVec2::new(step(2 * k), step(2 * k + 1)))
                    .collect(),
            ),
            Self::Smooth { centre, coefficients } => Self::Smooth {
                centre: *centre,
                coefficients: coefficients.iter().enumerate().map(|(k, c)| c + step(k)).collect(),
            },
        }
    }

    /// The line; none where the corners do not go once around something counter-clockwise.
    pub(super) fn line(&self) -> Option<ClosedLine> {
        match self {
            Self::Polygon(corners) => {
                let line = ClosedLine::new(corners.clone()).ok()?;
                // Turned around, the corners would be other ones than the unknowns.
                (line.corners()[0] == corners[0] && is_simple(corners)).then_some(line)
            }
            Self::Smooth { centre, coefficients } => {
                let at = |j: usize| {
                    let direction = DVec2::from_angle(std::f64::consts::TAU * j as f64 / FINE as f64);
                    let r = radius(coefficients, direction);
                    (r > 0.0).then(|| *centre + direction * r)
                };
                ClosedLine::new((0..FINE).map(at).collect::<Option<Vec<_>>>()?).ok()
            }
        }
    }

    /// One in words.
    pub(super) fn name(&self) -> String {
        match self {
            Self::Polygon(corners) => format!("{} corners", corners.len()),
            Self::Smooth { coefficients, .. } => format!("smooth, {} harmonics", coefficients.len() / 2),
        }
    }
}

fn radius(coefficients: &[f64], direction: DVec2) -> f64 {
    let (mut sum, mut turned) = (coefficients[0], direction);
    for pair in coefficients[1..].chunks(2) {
        sum += pair[0] * turned.x + pair.get(1).map_or(0.0, |s| s * turned.y);
        turned = direction.rotate(turned);
    }
    sum
}

/// Whether no two edges of a polygon cross.
fn is_simple(corners: &[DVec2]) -> bool {
    let n = corners.len();
    let edge = |k: usize| (corners[k], corners[(k + 1) % n]);
    (0..n).all(|i| {
        (i + 2..n).all(|j| {
            (i == 0 && j == n - 1) || {
                let ((a, b), (c, d)) = (edge(i), edge(j));
                let side = |p: DVec2, q: DVec2, r: DVec2| (q - p).perp_dot(r - p) > 0.0;
                side(a, b, c) == side(a, b, d) || side(c, d, a) == side(c, d, b)
            }
        })
    })
}

/// A closed line with fewer corners: again and again without the corner that spans the smallest triangle with its neighbours.
pub(super) fn thinned(corners: &[DVec2], count: usize) -> Vec<DVec2> {
    let mut left = corners.to_vec();
    while left.len() > count.max(3) {
        let n = left.len();
        let spans = |k: usize| (left[(k + 1) % n] - left[k]).perp_dot(left[(k + n - 1) % n] - left[k]).abs();
        let Some(least) = (0..n).min_by(|&i, &j| spans(i).total_cmp(&spans(j))) else { break };
        left.remove(least);
    }
    left
}

/// All polygons with one corner less: without a corner, and without an edge whose neighbours meet not too far away.
pub(super) fn one_less(corners: &[DVec2], farthest: f64) -> Vec<Vec<DVec2>> {
    let n = corners.len();
    let mut all = Vec::new();
    for k in 0..n {
        let mut without = corners.to_vec();
        without.remove(k);
        all.push(without);
        let at = |j: usize| corners[(k + j) % n];
        let (before, after) = (at(n - 1), at(2));
        let (d, e) = (at(0) - before, at(1) - after);
        let along = (after - before).perp_dot(e) / d.perp_dot(e);
        let meet = before + d * along;
        if meet.is_finite() && meet.distance(at(0)) < farthest && meet.distance(at(1)) < farthest {
            let mut joined = corners.to_vec();
            joined[k] = meet;
            joined.remove((k + 1) % n);
            all.push(joined);
        }
    }
    all
}
