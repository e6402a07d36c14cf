//! Cost against error: one curve per method, one point per setting.

use super::csv::{number, row};
use super::drawing::{Curve, Drawing, LegendItem, Note, Star};
use super::style::Style;
use super::{Axis, files::check_name};
use crate::{ChartError, machine_line};

/// What one setting of a method came to.
#[derive(Clone, Debug, PartialEq)]
pub enum Outcome {
    /// It ran: its error and cost, in the units of the axes.
    Measured {
        /// Error against the reference.
        error: f64,
        /// Cost (a median, where it was timed).
        cost: f64,
        /// Least cost over the repeats, where it was timed.
        least_cost: Option<f64>,
    },
    /// It gave up; the reason goes to the CSV, and nothing is drawn.
    Failed {
        /// The method's own words.
        reason: String,
    },
}

/// One setting of a method.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The setting as a reader knows it, e.g. `1e-10` for a tolerance.
    pub setting: String,
    /// What it came to.
    pub outcome: Outcome,
}

/// A curve: a method at its settings, in the order they were added.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    name: String,
    recorded: Option<String>,
    points: Vec<Point>,
}

impl Method {
    /// A method measured in this run.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), recorded: None, points: Vec::new() }
    }

    /// A method whose figures come from elsewhere, and where from; drawn dashed and marked in the legend.
    #[must_use]
    pub fn recorded(name: impl Into<String>, source: impl Into<String>) -> Self {
        Self { name: name.into(), recorded: Some(source.into()), points: Vec::new() }
    }

    /// Adds a setting with its error and cost.
    #[must_use]
    pub fn point(self, setting: impl Into<String>, error: f64, cost: f64) -> Self {
        self.with(Point {
            setting: setting.into(),
            outcome: Outcome::Measured { error, cost, least_cost: None },
        })
    }

    /// Adds a setting.
    #[must_use]
    pub fn with(mut self, point: Point) -> Self {
        self.push(point);
        self
    }

    /// Adds a setting in place.
    pub fn push(&mut self, point: Point) {
        self.points.push(point);
    }

    /// The name in the legend.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    fn legend(&self) -> String {
        let suffix = if self.recorded.is_some() { " (recorded elsewhere)" } else { "" };
        format!("{}{suffix}", self.name)
    }

    /// The settings.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }
}

/// A place on the chart that a method is meant to reach: error and cost at most these.
#[derive(Clone, Debug, PartialEq)]
pub struct Goal {
    /// What it stands for.
    pub label: String,
    /// Error at most.
    pub error: f64,
    /// Cost at most.
    pub cost: f64,
}

/// A chart of cost against error.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkPrecision {
    pub(super) name: String,
    title: String,
    subtitle: String,
    error: Axis,
    cost: Axis,
    methods: Vec<Method>,
    goals: Vec<Goal>,
}

impl WorkPrecision {
    /// An empty chart; `name` is the stem of its files (lower case, digits, hyphens).
    #[must_use]
    pub fn new(name: impl Into<String>, title: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            title: title.into(),
            subtitle: String::new(),
            error: Axis::log("error", "1"),
            cost: Axis::log("cost", "ms per simulated second"),
            methods: Vec::new(),
            goals: Vec::new(),
        }
    }

    /// One line under the title: scene, reference, what varies along a curve.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// The axes: error to the right, cost upwards.
    #[must_use]
    pub fn axes(mut self, error: Axis, cost: Axis) -> Self {
        self.error = error;
        self.cost = cost;
        self
    }

    /// Adds a curve.
    #[must_use]
    pub fn method(mut self, method: Method) -> Self {
        self.methods.push(method);
        self
    }

    /// Adds curves.
    #[must_use]
    pub fn methods(mut self, methods: impl IntoIterator<Item = Method>) -> Self {
        self.methods.extend(methods);
        self
    }

    /// Adds a goal, drawn as a star that curves are meant to pass below and to the left of.
    #[must_use]
    pub fn goal(mut self, label: impl Into<String>, error: f64, cost: f64) -> Self {
        self.goals.push(Goal { label: label.into(), error, cost });
        self
    }

    /// The figures as CSV: method, setting, error, cost, least cost, failure, and where they come from.
    #[must_use]
    pub fn csv(&self) -> String {
        let (error, cost) = (self.error.label(), self.cost.label());
        let least = format!("least {cost}");
        let mut text = row(["method", "setting", &error, &cost, &least, "failure", "origin"]);
        let here = machine_line();
        for method in &self.methods {
            let origin = method.recorded.as_ref().unwrap_or(&here);
            for Point { setting, outcome } in &method.points {
                let (error, cost, least, failure) = match outcome {
                    Outcome::Measured { error, cost, least_cost } => {
                        (number(*error), number(*cost), least_cost.map_or_else(String::new, number), "")
                    }
                    Outcome::Failed { reason } => {
                        (String::new(), String::new(), String::new(), reason.as_str())
                    }
                };
                text += &row([&method.name, setting, &error, &cost, &least, failure, origin]);
            }
        }
        text
    }

    pub(super) fn drawing(&self) -> Result<Drawing, ChartError> {
        check_name(&self.name)?;
        let mut drawing = Drawing::new(&self.title, &self.subtitle, &self.error, &self.cost);
        let mut legend = Vec::new();
        let styles = Style::of_methods(self.methods.iter().map(Method::name));
        for (method, style) in self.methods.iter().zip(styles) {
            self.draw_method(&mut drawing, method, style);
            legend.push(LegendItem { label: method.legend(), style });
        }
        drawing.legend.push(("", legend));
        for goal in &self.goals {
            match self.place(goal.error, goal.cost) {
                Some(at) => drawing.stars.push(Star { at, label: goal.label.clone() }),
                None => drawing.left_out += 1,
            }
        }
        if self.methods.iter().any(|method| method.recorded.is_none()) {
            drawing.foot = machine_line();
        }
        drawing.require_points(&self.name)?;
        Ok(drawing)
    }

    fn draw_method(&self, drawing: &mut Drawing, method: &Method, style: Style) {
        let mut curve = Curve { points: Vec::new(), style, dashed: method.recorded.is_some() };
        let mut notes = Vec::new();
        for Point { setting, outcome } in &method.points {
            let Outcome::Measured { error, cost, .. } = *outcome else {
                drawing.left_out += 1;
                continue;
            };
            let Some(at) = self.place(error, cost) else {
                drawing.left_out += 1;
                continue;
            };
            let tooltip = format!("{}, {setting}: error {error:.2e}, cost {cost:.3e}", method.name);
            curve.points.push((at, tooltip));
            if !is_on_the_axis(setting, error) {
                notes.push(Note { at, text: setting.clone() });
            }
        }
        drawing.notes.extend(ends(notes));
        drawing.curves.push(curve);
    }

    fn place(&self, error: f64, cost: f64) -> Option<(f64, f64)> {
        Some((self.error.place(error)?, self.cost.place(cost)?))
    }
}

/// Whether a setting is the error itself, as printed: the axis has it, and a note would only lie over those of other curves.
fn is_on_the_axis(setting: &str, error: f64) -> bool {
    setting.parse().is_ok_and(|value: f64| (value - error).abs() <= 0.01 * error.abs())
}

/// The notes of the dearest and the cheapest point of a curve: a label at every point would bury the curves.
fn ends(mut notes: Vec<Note>) -> impl Iterator<Item = Note> {
    notes.sort_by(|a, b| b.at.1.total_cmp(&a.at.1));
    let cheapest = if notes.len() > 1 { notes.pop() } else { None };
    notes.into_iter().take(1).chain(cheapest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_axis_tells_is_not_noted() {
        let noted = |setting: &str, error: f64| {
            let method = Method::new("m").point(setting, error, 1.0);
            let chart = WorkPrecision::new("c", "").method(method);
            chart.drawing().unwrap().notes.len()
        };
        assert_eq!((noted("0.063", 0.06295), noted("1e-6", 0.063), noted("2 ms", 2.0)), (0, 1, 1));
    }
}
