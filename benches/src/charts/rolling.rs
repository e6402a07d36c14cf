//! Gap against radians of palm motion, planner by planner.

use super::{Chart, Drawn};
use crate::Budget;
use crate::diagram::{Axis, Method, Outcome, Point, WorkPrecision};
use crate::reaching::Bodies;
use crate::reaching::statistics::quantile;
use crate::rolling::{LOOKAHEAD, PLANNERS, Rolling, runs};

pub(super) const CHART: Chart =
    Chart { name: "rolling", about: "gap between the bounds against radians of palm motion", draw };

/// Bodies as in the study.
const BODIES: Bodies = Bodies { first: 84_000, each: 10 };
/// Radians of palm motion at most, as in the study.
const RADIANS: f64 = 40.0;
/// The last goal.
const LAST: f64 = 0.05;

fn draw(_: Budget) -> Drawn {
    let mut methods = Vec::new();
    for planner in &PLANNERS {
        methods.push(method(planner.name, &runs(planner, BODIES, LAST, RADIANS, None)?));
    }
    let planners = WorkPrecision::new("rolling-plane", "Palm motion to a gap in the plane")
        .subtitle("median of 50 bodies of five families, exact contacts, until the gap is below a value")
        .axes(Axis::linear("gap", "1"), Axis::linear("palm motion", "rad"))
        .methods(methods);
    Ok(vec![planners.into(), lookahead()?.into()])
}

/// Palm motion to ten per cent against the time of a choice.
fn lookahead() -> Result<WorkPrecision, Box<dyn std::error::Error + Send + Sync>> {
    let mut methods: Vec<Method> = Vec::new();
    for (horizon, drawn, roller) in &LOOKAHEAD {
        let all = runs(roller, BODIES, LAST, RADIANS, None)?;
        let ways: Vec<Option<f64>> = all.iter().map(|run| run.to(0.1).map(|way| way[0])).collect();
        let motions: usize = all.iter().map(|run| run.motions).sum();
        let choice = 1e3 * all.iter().map(|run| run.planning).sum::<f64>() / motions.max(1) as f64;
        let name = format!("{horizon} ahead");
        if methods.last().is_none_or(|last| last.name() != name) {
            methods.push(Method::new(name));
        }
        if let Some(method) = methods.last_mut() {
            let outcome = Outcome::Measured { error: quantile(&ways, 0.5), cost: choice, least_cost: None };
            method.push(Point { setting: format!("{drawn} bodies"), outcome });
        }
    }
    Ok(WorkPrecision::new("rolling-lookahead", "Horizon and bodies drawn: cost against benefit")
        .subtitle(
            "gap per radian, median of 50 bodies, to a gap of 10 %; each point a number of bodies drawn",
        )
        .axes(Axis::linear("palm motion", "rad"), Axis::log("time of a choice", "ms"))
        .methods(methods))
}

fn method(name: &str, all: &[Rolling]) -> Method {
    let goals = (0..=10).map(|k| 0.5 * (LAST / 0.5_f64).powf(f64::from(k) / 10.0));
    goals.fold(Method::new(name), |method, goal| {
        let ways: Vec<Option<f64>> = all.iter().map(|run| run.to(goal).map(|way| way[0])).collect();
        let median = quantile(&ways, 0.5);
        if median.is_finite() { method.point(format!("{goal:.3}"), goal, median) } else { method }
    })
}
