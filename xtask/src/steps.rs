//! A list of named steps: which of them run, and the table at the end.

use std::time::{Duration, Instant};

use crate::cargo::holding;

/// What a step that did not fail has to say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Passed,
    /// Nothing is wrong, but something is to be looked at, one a line.
    Warned(String),
    /// It could not do its work here, and why.
    Skipped(String),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum When {
    /// In its turn.
    InTurn,
    /// From its turn on, beside the steps after it: for what keeps one core busy at most. Its output is shown at the end.
    Beside,
    /// In its turn, and only when it is asked for.
    AskedFor,
}

/// A named step.
#[derive(Clone, Copy)]
pub(crate) struct Step {
    pub(crate) name: &'static str,
    pub(crate) about: &'static str,
    pub(crate) when: When,
    /// The error holds one complaint a line.
    pub(crate) run: fn() -> Result<Outcome, String>,
}

/// Which steps are asked for.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Choice {
    pub(crate) list: bool,
    only: Vec<String>,
    skip: Vec<String>,
    with: Vec<String>,
}

impl Choice {
    pub(crate) fn parse(mut words: impl Iterator<Item = String>, steps: &[Step]) -> Result<Self, String> {
        let mut choice = Self::default();
        while let Some(word) = words.next() {
            let names = match word.as_str() {
                "--list" => {
                    choice.list = true;
                    continue;
                }
                "--only" => &mut choice.only,
                "--skip" => &mut choice.skip,
                "--with" => &mut choice.with,
                other => return Err(format!("unknown option {other}")),
            };
            let name = words.next().ok_or_else(|| format!("{word} needs the name of a step"))?;
            if !steps.iter().any(|step| step.name == name) {
                let known: Vec<_> = steps.iter().map(|step| step.name).collect();
                return Err(format!("no step is called {name}; there are: {}", known.join(", ")));
            }
            names.push(name);
        }
        Ok(choice)
    }

    fn takes(&self, step: &Step) -> bool {
        let named = |names: &[String]| names.iter().any(|name| name == step.name);
        let asked = if self.only.is_empty() { step.when != When::AskedFor } else { named(&self.only) };
        (asked || named(&self.with)) && !named(&self.skip)
    }
}

/// What a step came to.
pub(crate) struct Report {
    name: &'static str,
    took: Duration,
    result: Result<Outcome, String>,
}

/// Runs the chosen steps; one that fails does not keep the others from running.
pub(crate) fn run(steps: &[Step], choice: &Choice) -> Vec<Report> {
    let mut reports = Vec::new();
    std::thread::scope(|scope| {
        let mut beside = Vec::new();
        for step in steps.iter().filter(|step| choice.takes(step)) {
            if step.when == When::Beside {
                println!("\n=== {}: begins, beside the steps after it", step.name);
                beside.push((step, scope.spawn(|| holding(|| Report::of(step)))));
            } else {
                println!("\n=== {}: {}", step.name, step.about);
                reports.push(Report::of(step));
                println!("{}", reports[reports.len() - 1].line());
            }
        }
        for (step, running) in beside {
            let (report, held) = running.join().unwrap_or_else(|_| (Report::broken_off(step), String::new()));
            println!("\n=== {}: {}\n{held}{}", step.name, step.about, report.line());
            reports.push(report);
        }
    });
    reports
}

impl Report {
    fn of(step: &Step) -> Self {
        let start = Instant::now();
        Self { name: step.name, result: (step.run)(), took: start.elapsed() }
    }

    fn broken_off(step: &Step) -> Self {
        Self { name: step.name, result: Err("it panicked".to_owned()), took: Duration::ZERO }
    }

    pub(crate) fn failed(&self) -> bool {
        self.result.is_err()
    }

    fn skipped(&self) -> bool {
        matches!(self.result, Ok(Outcome::Skipped(_)))
    }

    fn line(&self) -> String {
        let took = self.took.as_secs_f64();
        match &self.result {
            Ok(Outcome::Passed) => format!("{:<12} {took:>7.1} s  pass", self.name),
            Ok(Outcome::Warned(what)) => {
                format!(
                    "{:<12} {took:>7.1} s  pass, look at\n    {}",
                    self.name,
                    what.trim().replace('\n', "\n    ")
                )
            }
            Ok(Outcome::Skipped(why)) => format!("{:<12} {took:>7.1} s  skipped: {why}", self.name),
            Err(complaints) => {
                format!(
                    "{:<12} {took:>7.1} s  FAIL\n    {}",
                    self.name,
                    complaints.trim().replace('\n', "\n    ")
                )
            }
        }
    }
}

/// The table at the end, with the time that all took.
pub(crate) fn table(reports: &[Report], took: Duration) -> String {
    let mut lines: Vec<_> = reports.iter().map(Report::line).collect();
    let count = |what: fn(&Report) -> bool| reports.iter().filter(|report| what(report)).count();
    let (failed, skipped) = (count(Report::failed), count(Report::skipped));
    let words = match (failed, skipped) {
        (0, 0) => "pass".to_owned(),
        (0, _) => format!("pass, {skipped} skipped"),
        _ => format!("{failed} FAILED, {skipped} skipped"),
    };
    lines.push(format!("{:<12} {:>7.1} s  {words}", "all", took.as_secs_f64()));
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEPS: [Step; 4] = [
        Step { name: "bad", about: "", when: When::Beside, run: || Err("one\ntwo".to_owned()) },
        Step { name: "good", about: "", when: When::InTurn, run: || Ok(Outcome::Passed) },
        Step {
            name: "odd",
            about: "",
            when: When::InTurn,
            run: || Ok(Outcome::Warned("1 was 2\n3 was 4".to_owned())),
        },
        Step {
            name: "extra",
            about: "",
            when: When::AskedFor,
            run: || Ok(Outcome::Skipped("not here".to_owned())),
        },
    ];

    fn names(options: &str) -> Vec<&'static str> {
        let words = options.split_whitespace().map(str::to_owned);
        let choice = Choice::parse(words, &STEPS).expect("the options are good");
        run(&STEPS, &choice).iter().map(|report| report.name).collect()
    }

    #[test]
    fn a_failure_does_not_hide_the_steps_after_it() {
        let reports = run(&STEPS, &Choice::default());
        assert_eq!(reports.iter().map(Report::failed).collect::<Vec<_>>(), [false, false, true]);
        let table = table(&reports, Duration::ZERO);
        assert!(table.contains("    one\n    two") && table.ends_with("1 FAILED, 0 skipped"), "{table}");
        assert!(table.contains("pass, look at\n    1 was 2\n    3 was 4"), "{table}");
    }

    #[test]
    fn optional_steps_run_only_when_asked_for() {
        assert_eq!(names(""), ["good", "odd", "bad"]);
        assert_eq!(names("--with extra"), ["good", "odd", "extra", "bad"]);
        assert_eq!(names("--only extra"), ["extra"]);
        assert_eq!(names("--skip bad"), ["good", "odd"]);
    }

    #[test]
    fn a_step_that_does_not_exist_is_named() {
        let words = ["--only", "god"].map(str::to_owned).into_iter();
        let complaint = Choice::parse(words, &STEPS).expect_err("there is no such step");
        assert!(complaint.contains("god") && complaint.contains("good"), "{complaint}");
    }
}
