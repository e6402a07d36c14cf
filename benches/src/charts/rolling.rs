//! Gap against radians of palm motion, planner by planner.

use super::{Chart, Drawn};
use crate::diagram::{Axis, Method, WorkPrecision};
use crate::reaching::Bodies;
use crate::reaching::statistics::quantile;
use crate::rolling::{PLANNERS, Rolling, runs};
use crate::{Budget, Diagram};

pub(super) const CHART: Chart =
    Chart { name: "rolling", about: "gap between the bounds against radians of palm motion", draw };

/// Bodies as in the study, and of a smoke test.
const BODIES: [Bodies; 2] = [Bodies { first: 84_000, each: 10 }, Bodies { first: 84_000, each: 1 }];
/// Radians of palm motion at most, as in the study.
const RADIANS: f64 = 40.0;
/// The last goal of each.
const LAST: [f64; 2] = [0.05, 0.4];

fn draw(budget: Budget) -> Drawn {
    let (bodies, last) = (budget.of(BODIES), budget.of(LAST));
    let mut methods = Vec::new();
    for planner in &PLANNERS {
        methods.push(method(planner.name, &runs(planner, bodies, last, RADIANS, None)?, last));
    }
    Ok(vec![Diagram::from(
        WorkPrecision::new("rolling-plane", "Palm motion to a gap in the plane")
            .subtitle("median of 50 bodies of five families, exact contacts, until the gap is below a value")
            .axes(Axis::linear("gap", "1"), Axis::linear("palm motion", "rad"))
            .methods(methods),
    )])
}

fn method(name: &str, all: &[Rolling], last: f64) -> Method {
    let goals = (0..=10).map(|k| 0.5 * (last / 0.5_f64).powf(f64::from(k) / 10.0));
    goals.fold(Method::new(name), |method, goal| {
        let ways: Vec<Option<f64>> = all.iter().map(|run| run.to(goal).map(|way| way[0])).collect();
        let median = quantile(&ways, 0.5);
        if median.is_finite() { method.point(format!("{goal:.3}"), goal, median) } else { method }
    })
}
