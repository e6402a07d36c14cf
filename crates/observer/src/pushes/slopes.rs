//! How an outline changes with each of its unknowns, by differences.

use super::fit::UNKNOWNS;
use super::shape::Shape;
use glam::DVec2;
use nalgebra::SVector;
use object_dynamics::pushing::ClosedLine;

/// Step of the differences, in sizes of the object.
const STEP: f64 = 1e-5;

/// The lines to which steps of each unknown lead.
pub(super) struct Slopes {
    lines: Vec<Option<[ClosedLine; 2]>>,
}

impl Slopes {
    pub(super) fn new(shape: &Shape, size: f64) -> Self {
        let shifted = |j: usize, by: f64| shape.moved(|k| if k == j { by * size } else { 0.0 }).line();
        let pair = |j| Some([shifted(j, STEP)?, shifted(j, -STEP)?]);
        Self { lines: (0..shape.unknowns()).map(pair).collect() }
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

    /// How far its normal turns at a point next to it, rad for a change of each unknown by its size.
    pub(super) fn turn(&self, point: DVec2) -> SVector<f64, UNKNOWNS> {
        self.row(|above, below| below.nearest(point).normal.angle_to(above.nearest(point).normal))
    }
}
