//! The motion sample by sample, by rate and quality of the sensors: error, availability, and the time that all but one push in a hundred stay below.

use super::{Chart, Drawn};
use crate::streaming::{Case, Paced, paced, some};
use crate::{Axis, Budget, Method, Outcome, Point, WorkPrecision, load};
use recon::observer::contacts::stream::{StreamEstimate, StreamStage};

pub(super) const CHART: Chart =
    Chart { name: "streaming", about: "sample by sample, by rate and quality of the sensors", draw };

/// Noise of contacts as a share of the size, and of forces as one of what a palm carries, per cent.
const QUALITIES: [([f64; 2], &str); 3] = [
    ([0.01, 0.1], "0.01 % and 0.1 % noise"),
    ([0.1, 1.0], "0.1 % and 1 % noise"),
    ([1.0, 2.0], "1 % and 2 % noise"),
];
/// Rates, Hz, natural times at most and bodies, of a chart that is kept and of a smoke test.
const RATES: [&[f64]; 2] = [&[100.0, 200.0, 500.0, 1000.0], &[200.0]];
const NATURAL: [f64; 2] = [30.0, 15.2];
const BODIES: [usize; 2] = [2, 1];
/// m.
const SIZE: f64 = 0.3;
/// s.
const LONGEST: f64 = 6.0;
const SEED: u64 = 61_000;

fn draw(budget: Budget) -> Drawn {
    let mut all: [Vec<Method>; 3] = Default::default();
    for (quality, name) in QUALITIES {
        let mut methods = [0; 3].map(|_| Method::new(name));
        for rate in budget.of(RATES) {
            let cases = some(budget.of(BODIES), SEED, SIZE, *rate, quality, [LONGEST, budget.of(NATURAL)])?;
            for (method, value) in methods.iter_mut().zip(sensed(&cases)?) {
                let outcome = Outcome::Measured { error: *rate, cost: value, least_cost: None };
                method.push(Point { setting: format!("{rate}"), outcome });
            }
        }
        all.iter_mut().zip(methods).for_each(|(all, method)| all.push(method));
    }
    let [errors, shares, times] = all;
    let chart = |name: &str, title: &str, axis: Axis, methods: Vec<Method>| {
        WorkPrecision::new(name, title)
            .subtitle(format!("sample by sample, two unknown bodies of 0.3 m, 30 natural times at their own pace; curves: noise of contacts and forces{}", load()))
            .axes(Axis::log("rate of the sensors", "Hz"), axis)
            .methods(methods)
            .into()
    };
    Ok(vec![
        chart(
            "streaming-error",
            "Stream: error by rate",
            Axis::log("mean error of the centre of mass", "m"),
            errors,
        ),
        chart(
            "streaming-availability",
            "Stream: availability by rate",
            Axis::linear("samples with a motion after the first", "%"),
            shares,
        ),
        chart(
            "streaming-time",
            "Stream: time of a sample by rate",
            Axis::log("99 in 100 samples take at most", "us"),
            times,
        ),
    ])
}

/// Root mean square error of the centre, m, per cent of the samples that have a motion after the first one that has, and microseconds that all but one sample in a
/// hundred stay below, over bodies.
fn sensed(cases: &[Case]) -> Result<[f64; 3], Box<dyn std::error::Error + Send + Sync>> {
    let (mut times, mut squares, mut share) = (Vec::new(), 0.0, 0.0);
    for case in cases {
        let Paced { microseconds, estimates, .. } = paced(case, false).map_err(|error| error.to_string())?;
        times.extend(microseconds);
        let (error, of) = judged(case, &estimates);
        (squares, share) = (squares + error * error, share + of);
    }
    times.sort_by(f64::total_cmp);
    let count = cases.len() as f64;
    let slow = times.get(times.len().saturating_sub(1) * 99 / 100).copied().unwrap_or(f64::NAN);
    Ok([(squares / count).sqrt(), 100.0 * share / count, slow])
}

/// Root mean square error of the centre where a motion is stated, m, and the share of samples where one is after the first.
fn judged(case: &Case, estimates: &[(usize, StreamEstimate)]) -> (f64, f64) {
    let stated = |estimate: &StreamEstimate| estimate.stage == StreamStage::Tracking;
    let first = estimates.iter().position(|(_, estimate)| stated(estimate)).unwrap_or(estimates.len());
    let after = &estimates[first..];
    let squares: Vec<f64> = after
        .iter()
        .filter(|(_, estimate)| stated(estimate))
        .filter_map(|(k, estimate)| {
            Some(estimate.motion?.state.p_WCm.distance_squared(case.truth.get(*k)?.touch.p_WCm))
        })
        .collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    (mean.sqrt(), squares.len() as f64 / after.len().max(1) as f64)
}
