//! Outlines in the plane, true to scale.

use super::csv::{number, row};
use super::drawing::{Curve, Drawing, LegendItem, Place};
use super::style::{Marker, Style};
use super::{Axis, files::check_name};
use crate::ChartError;

/// Width over height of the diagram's frame beside a legend.
const FRAME: f64 = 1.72;

/// How an outline is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stroke {
    /// A closed line.
    Line,
    /// A closed line in ink: what the others are compared with.
    Ink,
    /// Points without a line.
    Points,
}

/// One outline: its label, its points in order, and how it is drawn.
#[derive(Clone, Debug, PartialEq)]
struct Outline {
    label: String,
    points: Vec<Place>,
    stroke: Stroke,
}

/// Outlines in the plane with one scale for both axes, in m.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlines {
    pub(super) name: String,
    title: String,
    subtitle: String,
    outlines: Vec<Outline>,
}

impl Outlines {
    /// An empty diagram; `name` is the stem of its files.
    #[must_use]
    pub fn new(name: impl Into<String>, title: impl Into<String>, subtitle: impl Into<String>) -> Self {
        Self { name: name.into(), title: title.into(), subtitle: subtitle.into(), outlines: Vec::new() }
    }

    /// Adds an outline, in order around it.
    #[must_use]
    pub fn outline(mut self, label: impl Into<String>, points: Vec<(f64, f64)>, stroke: Stroke) -> Self {
        self.outlines.push(Outline { label: label.into(), points, stroke });
        self
    }

    /// The figures as CSV: outline, x, y.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut text = row(["outline", "x [m]", "y [m]"]);
        for Outline { label, points, .. } in &self.outlines {
            for (x, y) in points {
                text += &row([label, &number(*x), &number(*y)]);
            }
        }
        text
    }

    pub(super) fn drawing(&self) -> Result<Drawing, ChartError> {
        check_name(&self.name)?;
        let axis = |name| Axis::linear(name, "m");
        let mut drawing = Drawing::new(&self.title, &self.subtitle, &axis("x"), &axis("y"));
        let mut legend = Vec::new();
        let styles = Style::of_methods(self.outlines.iter().map(|outline| outline.label.as_str()));
        for (Outline { label, points, stroke }, style) in self.outlines.iter().zip(styles) {
            let dots = *stroke == Stroke::Points;
            let style = match stroke {
                Stroke::Line => Style { marker: Marker::None, ..style },
                Stroke::Ink => Style { marker: Marker::None, ..Style { line_width: 2.4, ..Style::goal() } },
                Stroke::Points => Style { line_width: 0.0, marker: Marker::Circle, ..style },
            };
            let close = points.first().filter(|_| !dots);
            let places = points.iter().chain(close).map(|at| (*at, label.clone())).collect();
            drawing.curves.push(Curve { points: places, style, dashed: false });
            legend.push(LegendItem { label: label.clone(), style, dashed: false });
        }
        drawing.require_points(&self.name)?;
        drawing.curves.push(even_scale(&drawing));
        drawing.legend = vec![("", legend)];
        Ok(drawing)
    }
}

/// Two corners that are not drawn but widen the shorter axis until both have one scale.
fn even_scale(drawing: &Drawing) -> Curve {
    let (xs, ys) = drawing.extent();
    let span =
        |v: &[f64]| v.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    let ((left, right), (low, high)) = (span(&xs), span(&ys));
    let height = (high - low).max((right - left) / FRAME);
    let (x, y) = (0.5 * (left + right), 0.5 * (low + high));
    let corner = |side: f64| ((x + side * 0.5 * height * FRAME, y + side * 0.5 * height), String::new());
    let style = Style { line_width: 0.0, marker: Marker::None, ..Style::goal() };
    Curve { points: vec![corner(-1.0), corner(1.0)], style, dashed: false }
}
