//! How an outline changes with each of its unknowns, by differences.

use super::face::Face;
use super::fit::UNKNOWNS;
use super::shape::Shape;
use glam::DVec2;
use nalgebra::SVector;
use object_dynamics::pushing::{ClosedLine, Nearest};

/// Step of the differences, in sizes of the object.
const STEP: f64 = 1e-5;

/// The lines to which steps of each unknown lead.
pub(super) struct Slopes {
    lines: Vec<Option<[ClosedLine; 2]>>,
    has_corners: bool,
}

impl Slopes {
    pub(super) fn new(shape: &Shape, size: f64) -> Self {
        let shifted = |j: usize, by: f64| shape.moved(|k| if k == j { by * size } else { 0.0 }).line();
        let pair = |j| Some([shifted(j, STEP)?, shifted(j, -STEP)?]);
        let has_corners = matches!(shape, Shape::Polygon(_));
        Self { lines: (0..shape.unknowns()).map(pair).collect(), has_corners }
    }

    fn row(&self, of: impl Fn(&ClosedLine, &ClosedLine) -> f64) -> SVector<f64, UNKNOWNS> {
        SVector::from_fn(|k, _| match self.lines.get(k) {
            Some(Some([above, below])) => of(above, below) / (2.0 * STEP),
            _ => 0.0,
        })
    }

    /// How far the outline moves outward at a point of it, m for a change of each unknown by its size.
    pub(super) fn outward(&self, point: DVec2) -> SVector<f64, UNKNOWNS> {
        self.row(|above, below| below.nearest(point).distance - above.nearest(point).distance)
    }

    /// How far the normal of an edge turns at a point of the outline, rad for a change of each unknown by its size.
    pub(super) fn turn(&self, at: &Nearest) -> SVector<f64, UNKNOWNS> {
        let normal = |line: &ClosedLine| Face { line, has_corners: self.has_corners }.normal(at);
        self.row(|above, below| normal(below).angle_to(normal(above)))
    }
}
