//! Touch by touch as another implementation makes them: `tests/data/explore.json`.

use contact_kinematics::Direction;
use exploration::generators::{
    Outline, Solid, ellipse, ellipsoid, outline_sum, rounded_hull, superquadric, waves,
};
use exploration::{Goal, Heading, Knowledge, Motion, Planner, Step, Task, explore, planar, space};
use glam::{DQuat, DVec2, DVec3};
use serde_json::Value;

/// What is asked for; the other implementation says that it is right to 10 digits.
const TOLERANCE: f64 = 1e-9;

fn cases(dimension: u64) -> Vec<Value> {
    let text = include_str!("../data/explore.json");
    let all: Value = serde_json::from_str(text).unwrap();
    let is_it = |case: &&Value| case["dimension"] == dimension;
    let found: Vec<Value> = all["cases"].as_array().unwrap().iter().filter(is_it).cloned().collect();
    assert_eq!(found.len(), 3);
    found
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect()
}

fn axes2(value: &Value) -> DVec2 {
    DVec2::from_slice(&numbers(value))
}

fn outline_of(case: &Value) -> Outline {
    let p = &case["parameters"];
    match case["body"].as_str().unwrap() {
        "ellipse" => ellipse(axes2(&p["axes"]), p["angle"].as_f64().unwrap()),
        "sum of two ellipses" => {
            let angles = numbers(&p["angles"]);
            outline_sum((0..2).map(|k| ellipse(axes2(&p["axes"][k]), angles[k])).collect())
        }
        _ => {
            let (k, c, phase) = (numbers(&p["k"]), numbers(&p["c"]), numbers(&p["phase"]));
            waves((0..k.len()).map(|i| (k[i], c[i], phase[i])).collect())
        }
    }
}

fn solid_of(case: &Value) -> Solid {
    let p = &case["parameters"];
    let axes = || DVec3::from_slice(&numbers(&p["axes"]));
    let turn = || {
        let q = numbers(&p["quaternion_wxyz"]);
        DQuat::from_xyzw(q[1], q[2], q[3], q[0]).normalize()
    };
    match case["body"].as_str().unwrap() {
        "ellipsoid" => ellipsoid(axes(), turn()),
        name if name.starts_with("superquadric") => {
            superquadric(axes(), p["p"].as_f64().unwrap(), p["r"].as_f64().unwrap(), turn())
        }
        _ => {
            let points = p["points"].as_array().unwrap();
            let points = points.iter().map(|v| DVec3::from_slice(&numbers(v))).collect();
            rounded_hull(points, p["radius"].as_f64().unwrap())
        }
    }
}

/// Compares each step with the case; directions only where the choice was clear of a tie.
fn compare<K: Knowledge>(case: &Value, step: &Step<K>, known: &K) {
    let expected = &case["touches"][step.touch - 1];
    let at = format!("{} touch {}", case["body"], step.touch);
    let gap = known.measures().gap();
    assert!((gap - expected["gap"].as_f64().unwrap()).abs() < TOLERANCE, "{at}: {gap}");
    if let Some(lower) = expected["lower"].as_f64() {
        let measures = known.measures();
        assert!((measures.lower / lower - 1.0).abs() < TOLERANCE, "{at}: lower {}", measures.lower);
        let upper = expected["upper"].as_f64().unwrap();
        assert!((measures.upper / upper - 1.0).abs() < TOLERANCE, "{at}: upper {}", measures.upper);
    }
    let ties = case["body"] == "ellipse";
    if let Some(hausdorff) = expected["hausdorff"].as_f64().filter(|_| !ties) {
        assert!((known.hausdorff() - hausdorff).abs() < TOLERANCE, "{at}: {}", known.hausdorff());
    }
    if !ties {
        let u = numbers(&expected["u"]);
        let off: f64 = step.proposal.along.coordinates().iter().zip(u).map(|(a, b)| (a - b).powi(2)).sum();
        assert!(off.sqrt() < TOLERANCE, "{at}: {:?}", step.proposal.along);
    }
}

#[test]
fn the_largest_area_in_the_plane_is_touched_as_by_another_implementation() {
    for case in cases(2) {
        let count = case["touches"].as_array().unwrap().len();
        let mut finger = planar::SimulatedFinger::new(outline_of(&case), Motion::Plane);
        let mut planner = planar::AreaGreedy::new(planar::even_start(3, 0.1));
        let mut known = planar::PlanarKnowledge::exact();
        let task = Task::new(Goal::Gap(0.05), 100);
        let ended = explore(&mut known, &mut planner, &mut finger, &task, |step, known| {
            compare(&case, step, known);
        });
        assert!(ended.unwrap().is_reached());
        assert_eq!(known.touches(), count, "{}", case["body"]);
    }
}

#[test]
fn the_largest_distance_in_space_is_touched_as_by_another_implementation() {
    for case in cases(3) {
        let count = case["touches"].as_array().unwrap().len();
        let mut finger = space::SimulatedFinger::new(solid_of(&case), Motion::Plane);
        let mut planner = space::HausdorffGreedy::new(space::tetrahedron());
        let mut known = space::SpaceKnowledge::exact();
        let task = Task::new(Goal::Gap(0.2), 100);
        let ended = explore(&mut known, &mut planner, &mut finger, &task, |step, known| {
            compare(&case, step, known);
        });
        assert!(ended.unwrap().is_reached());
        assert_eq!(known.touches(), count, "{}", case["body"]);
    }
}

/// The path-aware planner with a share of 1 is the greedy one.
#[test]
fn a_share_of_one_is_greedy() {
    let case = &cases(3)[0];
    let directions = |planner: &mut dyn Planner<space::SpaceKnowledge>| -> Vec<Direction> {
        let mut finger = space::SimulatedFinger::new(solid_of(case), Motion::Plane);
        let mut known = space::SpaceKnowledge::exact();
        let mut made = Vec::new();
        let task = Task::new(Goal::Gap(0.3), 100);
        explore(&mut known, planner, &mut finger, &task, |step, _| made.push(step.proposal.along)).unwrap();
        made
    };
    let greedy = directions(&mut space::VolumeGreedy::new(space::tetrahedron()));
    let path = directions(&mut space::PathAware::new(space::tetrahedron()).with_share(1.0));
    assert!(greedy.len() > 20 && greedy == path);
}
