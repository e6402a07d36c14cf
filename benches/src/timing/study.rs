//! A study: methods at their settings, each with its error, all timed side by side in one run.

use super::{Budget, SideBySide};
use crate::{Method, Outcome, Point};

struct Case<'a> {
    method: String,
    setting: String,
    /// Error of the one run that was looked at, or why there is none.
    error: Result<f64, String>,
    job: Box<dyn FnMut() + 'a>,
}

/// Collects cases, then times them and hands back one curve per method.
#[derive(Default)]
pub struct Study<'a> {
    cases: Vec<Case<'a>>,
}

impl<'a> Study<'a> {
    /// No cases yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a case that always answers. It is run once here, and its error taken from that answer; timing calls
    /// the same closure again.
    pub fn case<T>(
        &mut self,
        method: impl Into<String>,
        setting: impl Into<String>,
        mut run: impl FnMut() -> T + 'a,
        error: impl FnOnce(&T) -> f64,
    ) -> &mut Self {
        let run = move || Ok::<T, std::convert::Infallible>(run());
        self.fallible_case(method, setting, run, error)
    }

    /// Adds a case that may give up; one that does is not timed and becomes a failed point with its own words.
    pub fn fallible_case<T, E: std::fmt::Display>(
        &mut self,
        method: impl Into<String>,
        setting: impl Into<String>,
        mut run: impl FnMut() -> Result<T, E> + 'a,
        error: impl FnOnce(&T) -> f64,
    ) -> &mut Self {
        let error = run().map(|answer| error(&answer)).map_err(|reason| reason.to_string());
        let job = Box::new(move || {
            std::hint::black_box(run().is_ok());
        });
        self.cases.push(Case { method: method.into(), setting: setting.into(), error, job });
        self
    }

    /// Times all cases that answered, in turns, and gives the methods in the order of their first case. The cost is
    /// in milliseconds per unit of `work`: seconds of simulated time for a simulation, 1 for a whole run.
    #[must_use]
    pub fn measure(self, budget: Budget, work: f64) -> Vec<Method> {
        let mut jobs = SideBySide::new();
        let mut labels = Vec::new();
        for Case { method, setting, error, job } in self.cases {
            if error.is_ok() {
                jobs.job(job);
            }
            labels.push((method, setting, error));
        }
        let mut timings = jobs.run(budget).into_iter();
        let mut methods: Vec<Method> = Vec::new();
        for (name, setting, error) in labels {
            let outcome = match error {
                Err(reason) => Outcome::Failed { reason },
                // One timing was taken for each case that answered, so one is there.
                Ok(error) => {
                    timings.next().map_or(Outcome::Failed { reason: "not timed".to_owned() }, |timing| {
                        let (cost, least_cost) = (timing.ms_per(work), Some(timing.least_ms_per(work)));
                        Outcome::Measured { error, cost, least_cost }
                    })
                }
            };
            add_point(&mut methods, name, Point { setting, outcome });
        }
        methods
    }
}

fn add_point(methods: &mut Vec<Method>, name: String, point: Point) {
    match methods.iter_mut().find(|method| method.name() == name) {
        Some(method) => method.push(point),
        None => methods.push(Method::new(name).with(point)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_are_grouped_by_method_and_failures_keep_their_words() {
        let mut study = Study::new();
        study
            .case("a", "1", || 3.0, |answer| answer - 2.0)
            .fallible_case("b", "1", || Err::<f64, _>("too stiff"), |_| 0.0)
            .case("a", "2", || 2.5, |answer| answer - 2.0);
        let methods = study.measure(Budget::quick(), 1.0);
        assert_eq!(methods.iter().map(Method::name).collect::<Vec<_>>(), ["a", "b"]);
        let error = |point: &Point| match point.outcome {
            Outcome::Measured { error, cost, .. } if cost > 0.0 => error,
            _ => f64::NAN,
        };
        assert_eq!(methods[0].points().iter().map(error).collect::<Vec<_>>(), [1.0, 0.5]);
        assert_eq!(methods[1].points()[0].outcome, Outcome::Failed { reason: "too stiff".to_owned() });
    }
}
