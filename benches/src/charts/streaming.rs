//! The motion sample by sample, by rate and quality of the sensors: error, availability, and the time that all but one push in a hundred stay below.

use super::{Chart, Drawn};
use crate::streaming::{Case, Paced, paced, some};
use crate::{Axis, Budget, Method, WorkPrecision};
use recon::observer::{StreamEstimate, StreamStage};

pub(super) const CHART: Chart =
    Chart { name: "streaming", about: "sample by sample, by rate and quality of the sensors", draw };

/// Noise of contacts as a share of the size, and of forces as one of what a palm carries, per cent.
const QUALITIES: [([f64; 2], &str); 3] = [
    ([0.01, 0.1], "0.01 % and 0.1 % noise"),
    ([0.1, 1.0], "0.1 % and 1 % noise"),
    ([1.0, 2.0], "1 % and 2 % noise"),
];
const RATES: [f64; 4] = [100.0, 200.0, 500.0, 1000.0];
/// m.
const SIZE: f64 = 0.3;
/// Seconds, and natural times.
const LONGEST: [f64; 2] = [6.0, 30.0];
const SEED: u64 = 61_000;

fn draw(_: Budget) -> Drawn {
    let mut methods = Vec::new();
    for (quality, name) in QUALITIES {
        let mut method = Method::new(name);
        for rate in RATES {
            for case in some(1, SEED, SIZE, rate, quality, LONGEST)? {
                let Paced { mut microseconds, estimates, .. } = paced(&case, false)?;
                microseconds.sort_by(f64::total_cmp);
                let slow = microseconds[(microseconds.len() - 1) * 99 / 100];
                let (error, share) = judged(&case, &estimates);
                method = method.point(format!("{rate} Hz, {:.0} %", 100.0 * share), error, slow);
            }
        }
        methods.push(method);
    }
    let chart = WorkPrecision::new("streaming", "Sample by sample: time against error")
        .subtitle(
            "body of 0.3 m, unknown, 30 natural times at its own pace; points: rate, samples with a motion",
        )
        .axes(Axis::log("mean error of the centre of mass", "m"), Axis::log("time of a push, 99 %", "us"))
        .methods(methods);
    Ok(vec![chart.into()])
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
