//! What is drawn, in places on the axes, and with no word of the library that draws it.

use super::style::Style;
use super::{Axis, ChartError};

pub(super) type Place = (f64, f64);

/// Points with their tooltips, joined by a line where the style has a width.
#[derive(Debug)]
pub(super) struct Curve {
    pub(super) points: Vec<(Place, String)>,
    pub(super) style: Style,
    pub(super) dashed: bool,
}

/// A short text at a point.
#[derive(Debug)]
pub(super) struct Note {
    pub(super) at: Place,
    pub(super) text: String,
}

/// A goal.
#[derive(Debug)]
pub(super) struct Star {
    pub(super) at: Place,
    pub(super) label: String,
}

#[derive(Debug)]
pub(super) struct LegendItem {
    pub(super) label: String,
    pub(super) style: Style,
    /// Shown as a dashed line in place of a point.
    pub(super) dashed: bool,
}

/// A diagram before it is rendered.
#[derive(Debug)]
pub(super) struct Drawing {
    pub(super) title: String,
    pub(super) subtitle: String,
    pub(super) foot: String,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) curves: Vec<Curve>,
    pub(super) notes: Vec<Note>,
    pub(super) stars: Vec<Star>,
    /// Groups of entries under a heading; one group without a heading where there is one only.
    pub(super) legend: Vec<(&'static str, Vec<LegendItem>)>,
    /// Points that have no place at all; their number is written under the title.
    pub(super) left_out: usize,
}

impl Drawing {
    pub(super) fn new(title: &str, subtitle: &str, x: &Axis, y: &Axis) -> Self {
        Self {
            title: title.to_owned(),
            subtitle: subtitle.to_owned(),
            foot: String::new(),
            x: x.clone(),
            y: y.clone(),
            curves: Vec::new(),
            notes: Vec::new(),
            stars: Vec::new(),
            legend: Vec::new(),
            left_out: 0,
        }
    }

    /// An error unless there is at least one point.
    pub(super) fn require_points(&self, chart: &str) -> Result<(), ChartError> {
        if self.curves.iter().all(|curve| curve.points.is_empty()) {
            return Err(ChartError::NothingToDraw { chart: chart.to_owned(), left_out: self.left_out });
        }
        Ok(())
    }

    /// All places that must be inside the frame, as (x, y).
    pub(super) fn extent(&self) -> (Vec<f64>, Vec<f64>) {
        let points = || self.curves.iter().flat_map(|curve| curve.points.iter().map(|(at, _)| *at));
        let places = || points().chain(self.stars.iter().map(|star| star.at));
        places().unzip()
    }
}
