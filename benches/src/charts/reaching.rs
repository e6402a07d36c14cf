//! Gap against touches, planner by planner.

use super::{Chart, Drawn};
use crate::diagram::{Axis, Method, WorkPrecision};
use crate::reaching::statistics::quantile;
use crate::reaching::{Bodies, Trace, plane, space};
use crate::{Budget, Diagram};
use exploration::least_touches;

pub(super) const CHART: Chart =
    Chart { name: "reaching", about: "gap between the bounds against touches, planner by planner", draw };

/// Bodies as in the study, and of a smoke test with the last gap, in the plane and in space.
const BODIES: [Bodies; 2] = [Bodies { first: 79_000, each: 10 }, Bodies { first: 79_000, each: 1 }];
const LAST: [[f64; 2]; 2] = [[0.05, 0.15], [0.3, 0.4]];

fn draw(budget: Budget) -> Drawn {
    let (bodies, [in_plane, in_space]) = (budget.of(BODIES), budget.of(LAST));
    let mut flat = Vec::new();
    for planner in &plane::PLANNERS {
        flat.push(method(planner.name, &plane::runs(planner, bodies, in_plane, 200)?, in_plane));
    }
    flat.push(line(2, in_plane));
    let mut round = Vec::new();
    for planner in &space::PLANNERS {
        let most = if planner.name == "Gaussian process" { 100 } else { 400 };
        round.push(method(planner.name, &space::runs(planner, bodies, in_space, most)?, in_space));
    }
    round.push(line(3, in_space));
    let chart = |name: &str, title: &str, methods: Vec<Method>| {
        Diagram::from(
            WorkPrecision::new(name, title)
                .subtitle("median touches of 50 bodies of five families until the gap is below a value")
                .axes(Axis::linear("gap", "1"), Axis::linear("touches", "1"))
                .methods(methods),
        )
    };
    Ok(vec![
        chart("reaching-plane", "Touches to a gap in the plane", flat),
        chart("reaching-space", "Touches to a gap in space", round),
    ])
}

/// Goals from a half down to `last`.
fn goals(last: f64) -> impl Iterator<Item = f64> {
    (0..=10).map(move |k| 0.5 * (last / 0.5_f64).powf(f64::from(k) / 10.0))
}

fn method(name: &str, traces: &[Trace], last: f64) -> Method {
    goals(last).fold(Method::new(name), |method, goal| {
        let touches: Vec<Option<f64>> = traces.iter().map(|t| t.to(goal).map(|(n, _)| n as f64)).collect();
        let median = quantile(&touches, 0.5);
        if median.is_finite() { method.point(format!("{goal:.3}"), goal, median) } else { method }
    })
}

fn line(dimension: usize, last: f64) -> Method {
    let theory = Method::new("n* of ellipsoids (formula)");
    goals(last).fold(theory, |m, goal| m.point(format!("{goal:.3}"), goal, least_touches(dimension, goal)))
}
