use super::super::equations::Equations;
use super::super::first::First;
use super::super::problem::Beforehand;
use super::super::solve::{Solved, solve};
use super::super::state::parts;
use super::*;
use nalgebra::{SMatrix, Vector6};

/// A problem of a noisy log, of a body of which nothing is known or all but how its axes lie, and its solution.
fn solved<T>(known: bool, what: impl FnOnce(&Problem, &Solved<CONSTANTS>) -> T) -> T {
    let noise = noise(4e-5, 0.004);
    let log = noisy(&rubbed(0.4, 500.0, 0.1), &noise, 3);
    let options = options(noise);
    let mut record = Record::new(&log, &options).unwrap();
    record.set_modes(&modes(&log));
    let mut problem = search::problem(&record, &options, cold::units(&record, G, SIZE));
    let last = record.times.len() - 1;
    problem.nodes = (0..last).step_by(2).chain([last]).collect();
    let mut start = truth(&log, &problem);
    if known {
        let mass = MassProperties::uniform_ellipsoid(0.2, DVec3::new(0.05, 0.04, 0.03)).unwrap();
        start.body = problem.take_known(&mass, log.truth().unwrap()[0].R_WO);
    }
    let solved = solve::<CONSTANTS>(&problem, start, 200, 1e-6).unwrap();
    assert!(solved.settled);
    what(&problem, &solved)
}

/// A node on, with what all before it tell, the problem is the same one: it has the same solution and the same covariances.
#[test]
fn what_is_handed_on_stands_for_all_before() {
    for known in [false, true] {
        solved(known, |problem, solved| {
            for m in [10, 40, 80] {
                let (first, body) = First::at(problem, solved, m).unwrap();
                let last = problem.nodes.len() - 1;
                let part = problem.record.part(problem.nodes[m]..problem.nodes[last] + 1);
                let mut rest = problem.on(&part);
                (rest.first, rest.body) = (first, body);
                rest.nodes = problem.nodes[m..].iter().map(|k| k - problem.nodes[m]).collect();
                let at =
                    Unknowns { motions: solved.unknowns.motions[m..].to_vec(), body: solved.unknowns.body };
                let equations = rest.linearise::<CONSTANTS>(&at).unwrap();
                let unit = problem.natural_information();
                let (chain, mended) = equations.solver(&unit).unwrap();
                assert_eq!(mended, 0.0);
                // In deviations squared: of second order in how far apart what lies before and all of it are.
                let gradient = equations.gradient();
                let left = -gradient.dot(&chain.step(&gradient));
                assert!(left < 1e-2, "{known} {m}: {left} deviations squared beside");
                let [whole, rest] = [&solved.equations, &equations].map(|of| of.covariances(&unit).unwrap());
                let (whole_last, rest_last) = (whole.of_motion(last), rest.of_motion(last - m));
                for i in 0..MOTION {
                    let ratio = rest_last[(i, i)] / whole_last[(i, i)];
                    assert!(
                        (ratio - 1.0).abs() < 0.02,
                        "{known} {m}: variance {i} is {ratio} of the whole's"
                    );
                }
                for i in 0..CONSTANTS {
                    let ratio = rest.body[(i, i)] / whole.body[(i, i)];
                    assert!(
                        (ratio - 1.0).abs() < 0.02,
                        "{known} {m}: constant {i} is {ratio} of the whole's"
                    );
                }
            }
        });
    }
}

/// Far from what is known, where turns do not add.
#[test]
fn the_gradient_of_what_is_known_is_that_of_its_cost() {
    for known in [false, true] {
        solved(known, |problem, solved| {
            let handed_on = First::at(problem, solved, 40).unwrap();
            let by = Vector6::new(0.02, -0.03, 0.01, 0.2, -0.3, 0.1) * if known { 1.0 } else { 0.01 };
            let body = solved.unknowns.body.beside(1e-3, &by);
            let far = Tangent::from_fn(|i, _| if i < 9 { 1e-4 } else { 0.1 } * (i as f64 - 5.0));
            let motion = moved(&solved.unknowns.motions[40], &far);
            let gradient = told(problem, handed_on, &motion, &body);
            let cost = |motion: &Motion, body: &Body| {
                let (first, (of, information)) = handed_on;
                let d = body.from(&of);
                first.cost(motion, body, problem.record.origin) + (information * d).dot(&d)
            };
            let close = |slope: f64, expected: f64, all: f64| assert!((slope - expected).abs() < 1e-5 * all);
            let size = gradient.nodes[0].gradient.amax();
            for i in 0..MOTION {
                let h = 1e-7 * if i < 9 { 0.1 } else { 1.0 };
                let at = |h: f64| {
                    let step = Tangent::from_fn(|j, _| if i == j { h } else { 0.0 });
                    cost(&moved(&motion, &step), &body)
                };
                close((at(h) - at(-h)) / (4.0 * h), gradient.nodes[0].gradient[i], size);
            }
            for i in 0..CONSTANTS {
                let h = 1e-6;
                let at = |h: f64| {
                    let step = SVector::<f64, CONSTANTS>::from_fn(|j, _| if i == j { h } else { 0.0 });
                    cost(&motion, &body.beside(step[0], &step.fixed_rows::<6>(1).into_owned()))
                };
                close((at(h) - at(-h)) / (4.0 * h), gradient.body_gradient[i], gradient.body_gradient.amax());
            }
        });
    }
}

/// Numbers added; turned.
fn moved(motion: &Motion, step: &Tangent) -> Motion {
    let [p, v, L, turn] = parts(step);
    let q = (DQuat::from_scaled_axis(turn) * motion.q).normalize();
    Motion { p: motion.p + p, v: motion.v + v, L: motion.L + L, q }
}

/// Equations of one node that say what was handed on.
fn told(
    problem: &Problem,
    (first, (of, information)): (First, Beforehand),
    motion: &Motion,
    body: &Body,
) -> Equations<CONSTANTS> {
    let mut all = Equations::<CONSTANTS>::default();
    all.cleared(1);
    first.add(motion, body, problem.record.origin, &mut all);
    let slope: SMatrix<f64, CONSTANTS, CONSTANTS> = body.slope_from(&of);
    all.body_gradient += slope.transpose() * information * body.from(&of);
    all
}
