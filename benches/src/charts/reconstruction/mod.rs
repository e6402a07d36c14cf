//! Reconstruction: cost against error by window, rate and noise, in space and in the plane, beside the least error that is possible.

mod plane;
mod space;

pub(super) use plane::CHART as PLANE;
pub(super) use space::{BY_NOISE, BY_RATE, BY_WINDOW};

use crate::{Method, Outcome, Point};
use cpu_time::ProcessTime;

/// Draws of the noise at each setting, of a chart that is kept and of a smoke test: a root mean square of so many errors scatters by
/// 6 % where all three of their parts are alike, by 11 % where one alone counts, and may be that much below the bound.
const DRAWS: [u64; 2] = [40, 2];

/// A method under noise along its settings, and the least that is possible there.
struct Sweep {
    method: Method,
    least: Method,
    /// Of the next draw: settings whose draws are the same would all be off to one side.
    seed: u64,
}

impl Sweep {
    fn new(name: &str) -> Self {
        Self { method: Method::new(name), least: Method::least_of(name), seed: 1 }
    }

    /// Root mean square error over draws of the noise, and the median of their processor times; `run` gives the squared error of an estimate, m^2, none where it
    /// is not relied on, and `least` is the bound, m.
    fn at(&mut self, setting: String, draws: u64, least: Option<f64>, run: impl Fn(u64) -> Option<f64>) {
        let (mut squares, mut times) = (Vec::new(), Vec::new());
        for _ in 0..draws {
            let clock = ProcessTime::now();
            squares.extend(run(self.seed));
            self.seed += 1;
            times.push(1e3 * clock.elapsed().as_secs_f64());
        }
        times.sort_by(f64::total_cmp);
        let cost = times[times.len() / 2];
        let outcome = match squares.len() {
            0 => Outcome::Failed { reason: format!("none of {draws} is relied on") },
            count => {
                let error = (squares.iter().sum::<f64>() / count as f64).sqrt();
                Outcome::Measured { error, cost, least_cost: times.first().copied() }
            }
        };
        let of = match squares.len() as u64 {
            all if all == draws => setting.clone(),
            few => format!("{setting}, {few} of {draws}"),
        };
        if let (Some(least), Outcome::Measured { .. }) = (least, &outcome) {
            self.least = std::mem::replace(&mut self.least, Method::new("")).point(setting, least, cost);
        }
        self.method.push(Point { setting: of, outcome });
    }

    fn methods(self) -> [Method; 2] {
        [self.method, self.least]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_has_the_root_mean_square_of_what_is_relied_on_and_tells_how_much_is() {
        let mut sweep = Sweep::new("m");
        sweep.at("all".to_owned(), 2, Some(1.0), |seed| Some(if seed == 1 { 7.0 } else { 1.0 }));
        sweep.at("some".to_owned(), 2, None, |seed| (seed == 4).then_some(9.0));
        sweep.at("none".to_owned(), 2, Some(1.0), |_| None);
        let [method, least] = sweep.methods();
        let error = |k: usize| match method.points()[k].outcome {
            Outcome::Measured { error, .. } => error,
            Outcome::Failed { .. } => f64::NAN,
        };
        assert!(error(0) == 2.0 && error(1) == 3.0 && error(2).is_nan());
        let settings: Vec<&str> = method.points().iter().map(|point| point.setting.as_str()).collect();
        assert_eq!(settings, ["all", "some, 1 of 2", "none, 0 of 2"]);
        assert_eq!(least.points().len(), 1);
    }
}
