//! Gap against radians of palm motion in the plane, and against the way of a palm in space, planner by planner.

use super::{Chart, Drawn};
use crate::diagram::{Axis, Method, WorkPrecision};
use crate::parallel;
use crate::reaching::Bodies;
use crate::reaching::statistics::quantile;
use crate::rolling::{Asked, LOOKAHEAD, PLANNERS, choice_ms, runs};
use crate::{Budget, Diagram};

pub(super) const CHART: Chart = Chart {
    name: "rolling",
    about: "gap between the bounds against palm motion, in the plane and in space",
    draw,
};

/// Bodies as in the study, and of a smoke test.
const BODIES: [Bodies; 2] = [Bodies { first: 86_000, each: 10 }, Bodies { first: 86_000, each: 1 }];
/// Radians of palm motion at most, as in the study.
const RADIANS: f64 = 40.0;
/// The last goal of each.
const LAST: [f64; 2] = [0.05, 0.4];
/// Bodies over which horizons are compared, and the gap.
const FEW: [Bodies; 2] = [Bodies { first: 86_000, each: 4 }, Bodies { first: 86_000, each: 1 }];
const AHEAD: [f64; 2] = [0.1, 0.4];
/// The same of parallel palms in space.
const SOLIDS: [Bodies; 2] = [Bodies { first: 88_000, each: 10 }, Bodies { first: 88_000, each: 1 }];
const LAST_OF_SOLIDS: [f64; 2] = [0.2, 0.6];

fn draw(budget: Budget) -> Drawn {
    let (bodies, last) = (budget.of(BODIES), budget.of(LAST));
    let mut methods = Vec::new();
    for planner in &PLANNERS {
        let all = runs(planner, bodies, &Asked { goal: last, radians: RADIANS, noise: None, room: None })?;
        methods.push(method(planner.name, last, |goal| all.iter().map(|run| run.to(goal)).collect()));
    }
    let (solids, closest) = (budget.of(SOLIDS), budget.of(LAST_OF_SOLIDS));
    let setting = parallel::Setting { friction: 0.8, goal: closest, way: 40.0, noise: None };
    let mut strokes = Vec::new();
    for planner in &parallel::PLANNERS {
        let all = parallel::runs(planner, solids, &setting)?;
        strokes.push(method(planner.name, closest, |goal| all.iter().map(|run| run.to(goal)).collect()));
    }
    let plane = Diagram::from(
        WorkPrecision::new("rolling-plane", "Palm motion to a gap in the plane")
            .subtitle("median of 50 bodies of five families, exact contacts, until the gap is below a value")
            .axes(Axis::linear("gap", "1"), Axis::linear("palm motion", "rad"))
            .methods(methods),
    );
    let space = Diagram::from(
        WorkPrecision::new("rolling-space", "Palm motion to a gap in space")
            .subtitle("median of 50 bodies of five families, friction 0.8, exact contacts, until the gap is below a value")
            .axes(Axis::linear("gap", "1"), Axis::linear("way of the palm", "mean widths"))
            .methods(strokes),
    );
    Ok(vec![plane, space, horizons(budget.of(FEW), budget.of(AHEAD))?])
}

/// What a longer look ahead and more bodies drawn cost, and bring.
fn horizons(bodies: Bodies, goal: f64) -> Result<Diagram, Box<dyn std::error::Error + Send + Sync>> {
    let asked = Asked { goal, radians: RADIANS, noise: None, room: None };
    let mut methods: Vec<Method> = Vec::new();
    for ahead in 1..=3 {
        let mut method = Method::new(format!("{ahead} ahead"));
        for (_, drawn, planner) in LOOKAHEAD.iter().filter(|(horizon, ..)| *horizon == ahead) {
            let all = runs(planner, bodies, &asked)?;
            let ways: Vec<Option<f64>> = all.iter().map(|run| run.to(goal).map(|way| way[0])).collect();
            let way = quantile(&ways, 0.5);
            if way.is_finite() {
                method = method.point(format!("{drawn} drawn"), way, choice_ms(&all));
            }
        }
        methods.push(method);
    }
    Ok(Diagram::from(
        WorkPrecision::new("rolling-horizon", "Looking ahead in the plane: cost against benefit")
            .subtitle(format!("median of some bodies of five families, exact contacts, to a gap of {:.0} %; points: bodies drawn", 100.0 * goal))
            .axes(Axis::linear("palm motion", "rad"), Axis::log("time of a choice", "ms"))
            .methods(methods),
    ))
}

/// `to` tells the ways of all runs to a gap; none of those that never got there.
fn method(name: &str, last: f64, to: impl Fn(f64) -> Vec<Option<[f64; 2]>>) -> Method {
    let goals = (0..=10).map(|k| 0.5 * (last / 0.5_f64).powf(f64::from(k) / 10.0));
    goals.fold(Method::new(name), |method, goal| {
        let ways: Vec<Option<f64>> = to(goal).into_iter().map(|way| way.map(|way| way[0])).collect();
        let median = quantile(&ways, 0.5);
        if median.is_finite() { method.point(format!("{goal:.3}"), goal, median) } else { method }
    })
}
