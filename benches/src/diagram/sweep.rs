//! Failure sweeps: a parameter moves towards the place where methods fail, and each point shows what the method
//! said about itself there.

use super::csv::{number, row};
use super::drawing::{Curve, Drawing, LegendItem, Rule};
use super::style::{Marker, Style};
use super::{Axis, files::check_name};
use crate::{ChartError, machine_line};

/// What became of one run, by its error and by what it said about itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Within the tolerance, and no warning.
    Right,
    /// A warning or a typed error came with it, whatever its error is.
    ReportedAsUnreliable,
    /// Outside of the tolerance (or not a number), and nothing said so.
    WrongWithoutWarning,
}

impl Verdict {
    /// All of them, in the order of the legend.
    pub const ALL: [Self; 3] = [Self::Right, Self::ReportedAsUnreliable, Self::WrongWithoutWarning];

    /// The words in legend and CSV.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::ReportedAsUnreliable => "reported as unreliable",
            Self::WrongWithoutWarning => "wrong without a warning",
        }
    }
}

/// One run at one value of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Judged {
    /// Value of the swept parameter.
    pub parameter: f64,
    /// Error against the truth; `None` where the method gave no estimate.
    pub error: Option<f64>,
    /// The warning or typed error of the method, in its own words.
    pub warning: Option<String>,
}

impl Judged {
    /// The verdict under a tolerance: a missing or NaN error without a warning is wrong without a warning.
    #[must_use]
    pub fn verdict(&self, tolerance: f64) -> Verdict {
        match (self.error, &self.warning) {
            (_, Some(_)) => Verdict::ReportedAsUnreliable,
            (Some(error), None) if error <= tolerance => Verdict::Right,
            (_, None) => Verdict::WrongWithoutWarning,
        }
    }
}

/// A method (or scene) that is swept; its own marker where there are several.
#[derive(Clone, Debug, PartialEq)]
pub struct Subject {
    name: String,
    runs: Vec<Judged>,
}

impl Subject {
    /// A subject without runs.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self { name: name.into(), runs: Vec::new() }
    }

    /// Adds a run that gave an estimate and no warning.
    #[must_use]
    pub fn estimate(self, parameter: f64, error: f64) -> Self {
        self.run(Judged { parameter, error: Some(error), warning: None })
    }

    /// Adds a run that gave an estimate and warned of it.
    #[must_use]
    pub fn warned(self, parameter: f64, error: f64, warning: impl Into<String>) -> Self {
        self.run(Judged { parameter, error: Some(error), warning: Some(warning.into()) })
    }

    /// Adds a run that ended in a typed error instead of an estimate.
    #[must_use]
    pub fn refused(self, parameter: f64, reason: impl Into<String>) -> Self {
        self.run(Judged { parameter, error: None, warning: Some(reason.into()) })
    }

    /// Adds a run.
    #[must_use]
    pub fn run(mut self, run: Judged) -> Self {
        self.runs.push(run);
        self
    }
}

/// A chart of error against a swept parameter with verdicts.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    pub(super) name: String,
    title: String,
    subtitle: String,
    parameter: Axis,
    error: Axis,
    tolerance: f64,
    subjects: Vec<Subject>,
}

impl Sweep {
    /// An empty sweep; `name` is the stem of its files, `tolerance` (in the unit of the error) parts right from wrong.
    #[must_use]
    pub fn new(name: impl Into<String>, title: impl Into<String>, tolerance: f64) -> Self {
        Self {
            name: name.into(),
            title: title.into(),
            subtitle: String::new(),
            parameter: Axis::linear("parameter", "1"),
            error: Axis::log("error", "1"),
            tolerance,
            subjects: Vec::new(),
        }
    }

    /// One line under the title.
    #[must_use]
    pub fn subtitle(mut self, subtitle: impl Into<String>) -> Self {
        self.subtitle = subtitle.into();
        self
    }

    /// The axes: parameter to the right, error upwards.
    #[must_use]
    pub fn axes(mut self, parameter: Axis, error: Axis) -> Self {
        self.parameter = parameter;
        self.error = error;
        self
    }

    /// Adds a subject.
    #[must_use]
    pub fn subject(mut self, subject: Subject) -> Self {
        self.subjects.push(subject);
        self
    }

    /// The runs that were wrong without a warning, with the name of their subject. Of these there must be none.
    pub fn wrong_without_warning(&self) -> impl Iterator<Item = (&str, &Judged)> {
        self.subjects.iter().flat_map(|subject| {
            let wrong = |run: &&Judged| run.verdict(self.tolerance) == Verdict::WrongWithoutWarning;
            subject.runs.iter().filter(wrong).map(|run| (subject.name.as_str(), run))
        })
    }

    /// The figures as CSV: subject, parameter, error, tolerance, verdict, warning, and where they come from.
    #[must_use]
    pub fn csv(&self) -> String {
        let (parameter, error) = (self.parameter.label(), self.error.label());
        let mut text = row(["subject", &parameter, &error, "tolerance", "verdict", "warning", "origin"]);
        let (tolerance, here) = (number(self.tolerance), machine_line());
        for subject in &self.subjects {
            for run in &subject.runs {
                let error = run.error.map_or_else(String::new, number);
                let verdict = run.verdict(self.tolerance).words();
                let warning = run.warning.as_deref().unwrap_or_default();
                let parameter = number(run.parameter);
                text += &row([&subject.name, &parameter, &error, &tolerance, verdict, warning, &here]);
            }
        }
        text
    }

    pub(super) fn drawing(&self) -> Result<Drawing, ChartError> {
        check_name(&self.name)?;
        let mut drawing = Drawing::new(&self.title, &self.subtitle, &self.parameter, &self.error);
        if let Some(at) = self.error.place(self.tolerance) {
            drawing.rules.push(Rule { at, label: format!("tolerance {}", number(self.tolerance)) });
        }
        for (index, subject) in self.subjects.iter().enumerate() {
            self.draw_subject(&mut drawing, subject, Marker::of_subject(index));
        }
        drawing.legend = self.legend();
        drawing.require_points(&self.name)?;
        Ok(drawing)
    }

    /// The verdicts, below the subjects where there are several.
    fn legend(&self) -> Vec<(&'static str, Vec<LegendItem>)> {
        let subject = |(index, subject): (usize, &Subject)| LegendItem {
            label: subject.name.clone(),
            style: Style::neutral(Marker::of_subject(index)),
        };
        let verdict = |verdict: Verdict| LegendItem {
            label: verdict.words().to_owned(),
            style: Style::of_verdict(verdict, Marker::Circle),
        };
        let verdicts = Verdict::ALL.map(verdict).into();
        if self.subjects.len() > 1 {
            let subjects = self.subjects.iter().enumerate().map(subject).collect();
            vec![("Markers", subjects), ("Colours", verdicts)]
        } else {
            vec![("", verdicts)]
        }
    }

    fn draw_subject(&self, drawing: &mut Drawing, subject: &Subject, marker: Marker) {
        let mut thread = Curve { points: Vec::new(), style: Style::thread(), dashed: false };
        let mut by_verdict = Verdict::ALL.map(|verdict| Curve {
            points: Vec::new(),
            style: Style::of_verdict(verdict, marker),
            dashed: false,
        });
        for run in &subject.runs {
            let verdict = run.verdict(self.tolerance);
            let error = run.error.map_or_else(|| "no estimate".to_owned(), |e| format!("error {e:.2e}"));
            let said = run.warning.as_deref().unwrap_or("no warning");
            let tooltip =
                format!("{}, {}: {error}, {}, {said}", subject.name, run.parameter, verdict.words());
            let Some(x) = self.parameter.place(run.parameter) else {
                drawing.left_out += 1;
                continue;
            };
            let curve = &mut by_verdict[verdict as usize];
            match run.error.and_then(|error| self.error.place(error)) {
                Some(y) => {
                    thread.points.push(((x, y), String::new()));
                    curve.points.push(((x, y), tooltip));
                }
                None => drawing.off_scale.push((x, curve.style, tooltip)),
            }
        }
        drawing.curves.push(thread);
        drawing.curves.extend(by_verdict);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn verdict(error: Option<f64>, warning: Option<&str>) -> Verdict {
        Judged { parameter: 1.0, error, warning: warning.map(str::to_owned) }.verdict(1e-3)
    }

    #[test]
    fn silence_is_right_only_within_the_tolerance() {
        assert_eq!(verdict(Some(1e-3), None), Verdict::Right);
        assert_eq!(verdict(Some(1.1e-3), None), Verdict::WrongWithoutWarning);
        assert_eq!(verdict(Some(f64::NAN), None), Verdict::WrongWithoutWarning);
        assert_eq!(verdict(None, None), Verdict::WrongWithoutWarning);
    }

    #[test]
    fn a_warning_counts_as_reported_whatever_the_error() {
        for error in [None, Some(1e-9), Some(1.0), Some(f64::NAN)] {
            assert_eq!(verdict(error, Some("rank 2 of 3")), Verdict::ReportedAsUnreliable);
        }
    }

    #[test]
    fn the_wrong_runs_are_named() {
        let subject =
            Subject::new("method").estimate(1.0, 1e-9).estimate(2.0, 1.0).refused(3.0, "parallel palms");
        let sweep = Sweep::new("s", "", 1e-3).subject(subject);
        let wrong: Vec<_> = sweep.wrong_without_warning().map(|(name, run)| (name, run.parameter)).collect();
        assert_eq!(wrong, [("method", 2.0)]);
    }
}
