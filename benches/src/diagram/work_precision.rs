//! Cost against error: one curve per method, one point per setting.

use super::csv::{number, row};
use super::drawing::{Curve, Drawing, LegendItem, Note, Star};
use super::style::Style;
use super::{Axis, files::check_name};
use crate::{ChartError, machine_line};

/// How the lines that no estimate crosses are called.
const LEAST: &str = "least possible (Cramér-Rao)";

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

/// What a curve is of.
#[derive(Clone, Debug, PartialEq)]
enum Origin {
    /// Measured in this run.
    Here,
    /// Figures from elsewhere, and where from.
    Recorded(String),
    /// No method: the least error that is possible, of the method of this name.
    LeastOf(String),
}

/// A curve: a method at its settings, in the order they were added.
#[derive(Clone, Debug, PartialEq)]
pub struct Method {
    name: String,
    origin: Origin,
    points: Vec<Point>,
    joined: bool,
}

impl Method {
    /// A method measured in this run.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), origin: Origin::Here, points: Vec::new(), joined: true }
    }

    /// A method whose figures come from elsewhere, and where from; drawn dashed and marked in the legend.
    #[must_use]
    pub fn recorded(name: impl Into<String>, source: impl Into<String>) -> Self {
        Self { name: name.into(), origin: Origin::Recorded(source.into()), points: Vec::new(), joined: true }
    }

    /// The line that no curve of a method crosses: the least error that what it is given allows at each of its settings. Drawn dashed in the method's colour,
    /// without points, and named once for all of them.
    #[must_use]
    pub fn least_of(method: impl Into<String>) -> Self {
        let method = method.into();
        let name = format!("{LEAST}, {method}");
        Self { name, origin: Origin::LeastOf(method), points: Vec::new(), joined: true }
    }

    /// Points that have nothing to do with each other: no line joins them, and the table alone tells their settings.
    #[must_use]
    pub fn apart(self) -> Self {
        Self { joined: false, ..self }
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

    fn is_least(&self) -> bool {
        matches!(self.origin, Origin::LeastOf(_))
    }

    /// The method whose look it has.
    fn look(&self) -> &str {
        match &self.origin {
            Origin::LeastOf(method) => method,
            _ => &self.name,
        }
    }

    fn legend(&self) -> String {
        let suffix = if matches!(self.origin, Origin::Recorded(_)) { " (recorded elsewhere)" } else { "" };
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
            let origin = match &method.origin {
                Origin::Recorded(source) => source,
                _ => &here,
            };
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
        let of_methods = self.methods.iter().filter(|method| !method.is_least());
        let styles = Style::of_methods(of_methods.clone().map(Method::name));
        let styled: Vec<(&str, Style)> = of_methods.map(Method::name).zip(styles).collect();
        for method in &self.methods {
            let style = styled.iter().find(|(name, _)| *name == method.look()).map(|(_, style)| *style);
            let style = style.unwrap_or_else(Style::goal);
            let style = if method.is_least() { style.without_marker() } else { style };
            self.draw_method(&mut drawing, method, style);
            if !method.is_least() {
                legend.push(LegendItem { label: method.legend(), style, dashed: false });
            }
        }
        if self.methods.iter().any(Method::is_least) {
            let style = Style::goal().without_marker();
            legend.push(LegendItem { label: format!("{LEAST}, each"), style, dashed: true });
        }
        drawing.legend.push(("", legend));
        for goal in &self.goals {
            match self.place(goal.error, goal.cost) {
                Some(at) => drawing.stars.push(Star { at, label: goal.label.clone() }),
                None => drawing.left_out += 1,
            }
        }
        if self.methods.iter().any(|method| method.origin == Origin::Here) {
            drawing.foot = machine_line();
        }
        drawing.require_points(&self.name)?;
        Ok(drawing)
    }

    fn draw_method(&self, drawing: &mut Drawing, method: &Method, style: Style) {
        let style = if method.joined { style } else { Style { line_width: 0.0, ..style } };
        let mut curve = Curve { points: Vec::new(), style, dashed: method.origin != Origin::Here };
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
            if method.joined && !method.is_least() && !is_on_the_axis(setting, error) {
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
    fn the_least_possible_has_the_colour_of_its_method_no_points_and_one_name_for_all() {
        let two = [Method::new("a").point("1", 2.0, 1.0), Method::new("b").point("1", 3.0, 1.0)];
        let least = ["a", "b"].map(|of| Method::least_of(of).point("1", 1.0, 1.0));
        let drawing = WorkPrecision::new("c", "").methods(two).methods(least).drawing().unwrap();
        for k in 0..2 {
            let [own, least] = [k, k + 2].map(|i| &drawing.curves[i]);
            assert_eq!(own.style.colour, least.style.colour);
            assert!(least.dashed && !own.dashed && least.style.marker != own.style.marker);
        }
        assert_eq!(drawing.legend[0].1.len(), 3);
        assert_eq!(drawing.notes.len(), 2);
    }

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
