//! The outline that touches tell, with what is left open of it.

use super::arcs::Arcs;
use super::choose::OutlineCandidate;
use super::fit::{Fitted, UNKNOWNS, information};
use super::shape::Shape;
use super::slopes::Slopes;
use super::touches::Touch;
use glam::DVec2;
use nalgebra::{Cholesky, Matrix2, SMatrix};
use object_dynamics::pushing::ClosedLine;

/// Points of the outline at which its deviation is told.
const POINTS: usize = 360;

/// What covariances are widened by, of deviations 1.3: how far the outlines of simulated pushes were off beyond what touches by themselves
/// state (`docs/pushes.md`).
const WIDER: f64 = 1.69;

/// A corner of a polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlineCorner {
    /// In the object's frame, m.
    pub point: DVec2,
    /// Covariance, m^2.
    pub covariance: Matrix2<f64>,
    /// Way along the outline to the nearest touch, clockwise and counter-clockwise, m.
    pub to_touch: [f64; 2],
}

impl OutlineCorner {
    /// Root of the sum of both variances, m.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.covariance.trace().sqrt()
    }
}

/// A point of the outline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutlinePoint {
    /// In the object's frame, m.
    pub point: DVec2,
    /// Unit vector out of the object.
    pub normal: DVec2,
    /// Standard deviation of the outline along it, m.
    pub deviation: f64,
    /// Way along the outline to the nearest stretch that the finger touched, m; 0 on one.
    pub to_touch: f64,
}

/// The outline of an object.
#[derive(Clone, Debug, PartialEq)]
pub struct PushedOutline {
    /// As a closed line, object's frame.
    pub line: ClosedLine,
    /// Corners of a polygon; none of a smooth outline.
    pub corners: Vec<OutlineCorner>,
    /// Points all around, counter-clockwise, at equal distances.
    pub points: Vec<OutlinePoint>,
    /// What it is, such as `3 corners`.
    pub name: String,
    /// All outlines that were tried, by evidence.
    pub candidates: Vec<OutlineCandidate>,
}

/// Covariance of the scaled unknowns.
pub(super) fn covariance(
    fitted: &Fitted,
    touches: &[[Touch; 2]],
    radius: f64,
    size: f64,
) -> SMatrix<f64, UNKNOWNS, UNKNOWNS> {
    let inverse = information(fitted, touches, radius, size).and_then(Cholesky::new).map(|c| c.inverse());
    // Where nothing is told, all is open: by the size of the object.
    inverse.unwrap_or_else(SMatrix::identity) * WIDER
}

/// Ways to a touch, as a share of the way around, beyond which a stretch of the outline is inferred.
const INFERRED: f64 = 0.05;

impl PushedOutline {
    /// Where a push tells most: in the middle of the longest stretch that no finger felt, where its face and its corners are inferred from those beside
    /// them; of one that was felt all around where it is least known. None of an outline without points.
    #[must_use]
    pub fn next_push(&self) -> Option<&OutlinePoint> {
        let around: f64 = self.line.edges().map(|(a, b)| a.distance(b)).sum();
        let most = |of: fn(&OutlinePoint) -> f64| self.points.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
        most(|p| p.to_touch).filter(|p| p.to_touch > INFERRED * around).or_else(|| most(|p| p.deviation))
    }

    pub(super) fn new(
        fitted: &Fitted,
        candidates: Vec<OutlineCandidate>,
        (touches, times): (&[[Touch; 2]], [f64; 2]),
        covariance: &SMatrix<f64, UNKNOWNS, UNKNOWNS>,
        size: f64,
    ) -> Self {
        let line = fitted.line.clone();
        let arcs = Arcs::new(&line);
        let spans: Vec<[f64; 2]> = touches
            .iter()
            .map(|pair| [0, 1].map(|i| arcs.of(&line, pair[i].centre - pair[i].velocity * times[i])))
            .collect();
        let slopes = Slopes::new(&fitted.point.shape, size);
        let point = |j: usize| {
            let along = arcs.length() * j as f64 / POINTS as f64;
            let (point, normal) = arcs.at(&line, along);
            let row = slopes.outward(point);
            let deviation = row.dot(&(covariance * row)).max(0.0).sqrt();
            OutlinePoint { point, normal, deviation, to_touch: arcs.to_spans(along, &spans) }
        };
        let points = (0..POINTS).map(point).collect();
        let corners = match &fitted.point.shape {
            Shape::Polygon(corners) => {
                let one = |(k, point): (usize, &DVec2)| OutlineCorner {
                    point: *point,
                    covariance: covariance.fixed_view::<2, 2>(2 * k, 2 * k) * size.powi(2),
                    to_touch: arcs.to_ends(arcs.before[k], &spans),
                };
                corners.iter().enumerate().map(one).collect()
            }
            Shape::Smooth { .. } => Vec::new(),
        };
        Self { line, corners, points, name: fitted.point.shape.name(), candidates }
    }
}
