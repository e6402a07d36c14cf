//! Estimates beside the truth of simulated pushes. What is told is held to its own stated deviations.

use super::*;
use glam::DVec2;
use object_dynamics::pushing::{
    ClosedLine, PushDisturbances, PushLog, PushMode, PushScene, SimulatedPushes, simulate_pushes,
};

fn scene(outline: Vec<DVec2>) -> PushScene {
    PushScene {
        outline: ClosedLine::new(outline).unwrap(),
        finger_radius: 3e-3,
        friction: 0.45,
        length: 0.035,
        sliding_force: 3.0,
        compliance: 6e-5,
    }
}

fn rectangle() -> PushScene {
    let corners = [[-0.06, -0.04], [0.06, -0.04], [0.06, 0.04], [-0.06, 0.04]];
    scene(corners.map(DVec2::from).to_vec())
}

fn made(scene: &PushScene, count: u32, noise: PushDisturbances) -> SimulatedPushes {
    simulate_pushes(scene, &noise, count, 41).unwrap()
}

#[test]
fn a_rectangle_is_told_with_friction_and_modes_to_within_what_is_stated() {
    let scene = rectangle();
    let truth = made(&scene, 30, PushDisturbances::default());
    let told = estimate_pushes(&truth.log, scene.finger_radius).unwrap();
    assert_eq!(told.outline.corners.len(), 4, "{:?}", told.outline.candidates);
    let friction = told.friction.unwrap();
    // Three deviations: once in 370.
    assert!((friction.value - 0.45).abs() < 3.0 * friction.deviation, "{friction:?}");
    assert!(friction.deviation < 0.05, "{friction:?}");
    for corner in &told.outline.corners {
        let off = scene.outline.corners().iter().map(|c| c.distance(corner.point));
        assert!(off.fold(f64::INFINITY, f64::min) < 4.0 * corner.deviation(), "{corner:?}");
    }
    let (mut right, mut all) = (0, 0);
    for (push, steps) in told.pushes.iter().zip(&truth.truth) {
        for instant in &push.instants {
            let k = (instant.t * 101.0).round() as usize;
            if steps[k].mode != PushMode::Rest {
                right += usize::from(instant.mode() == steps[k].mode);
                all += 1;
            }
        }
    }
    assert!(right as f64 > 0.9 * f64::from(all), "{right} of {all}");
}

#[test]
fn an_ellipse_is_told_as_smooth() {
    let at = |k: u32| DVec2::from_angle(f64::from(k) * std::f64::consts::TAU / 360.0);
    let scene = scene((0..360).map(|k| at(k) * DVec2::new(0.06, 0.04)).collect());
    let told = estimate_pushes(&made(&scene, 30, PushDisturbances::default()).log, 3e-3).unwrap();
    assert!(told.outline.corners.is_empty(), "{}", told.outline.name);
    let off = told
        .outline
        .points
        .iter()
        .filter(|p| p.to_touch == 0.0)
        .map(|p| (scene.outline.nearest(p.point).distance / p.deviation).abs());
    // The deviation stands for all points of a stretch together: four of it at the worst one.
    assert!(off.fold(0.0, f64::max) < 4.0);
}

#[test]
fn a_clock_that_is_ahead_is_told_and_does_not_move_the_outline() {
    let scene = rectangle();
    let noise = PushDisturbances { finger_ahead: 0.3, ..PushDisturbances::default() };
    let told = estimate_pushes(&made(&scene, 30, noise).log, 3e-3).unwrap();
    let [(start, start_deviation), (end, end_deviation)] = told.clocks;
    assert!((start - 0.3).abs() < 3.0 * start_deviation, "{start} +- {start_deviation}");
    assert!((end - 0.3).abs() < 3.0 * end_deviation, "{end} +- {end_deviation}");
}

#[test]
fn what_tells_nothing_is_refused() {
    let scene = rectangle();
    let log = made(&scene, 8, PushDisturbances::default()).log;
    for value in [0.0, -1.0, f64::NAN, 0.2] {
        assert!(matches!(estimate_pushes(&log, value), Err(PushesError::Radius { .. })), "{value}");
    }
    let few = PushLog::new(log.pushes()[..5].to_vec()).unwrap();
    let error = estimate_pushes(&few, 3e-3).unwrap_err();
    assert!(matches!(error, PushesError::TooFew { touched: 5, pushes: 5, first: None }), "{error}");
    // Forces of nothing but noise, and a finger that is there from the start.
    let mut pushes = log.pushes().to_vec();
    let quiet: Vec<DVec2> = pushes[2].samples[..40].iter().map(|s| s.force).collect();
    pushes[2].samples.iter_mut().enumerate().for_each(|(k, s)| s.force = quiet[k % 40]);
    pushes[4].samples.drain(..450);
    let told = estimate_pushes(&PushLog::new(pushes).unwrap(), 3e-3).unwrap();
    assert_eq!(told.untouched, [(2, NoTouch::NoForce), (4, NoTouch::FromTheStart)]);
}

/// A push whose first pose is wrong by 6 mm is one that is wrong, wherever it stands: it does not make a corner of the object.
#[test]
fn one_push_that_is_wrong_makes_no_corner() {
    let log = made(&rectangle(), 30, PushDisturbances::default()).log;
    for wrong in [3, 11, 19, 26] {
        let mut pushes = log.pushes().to_vec();
        let push = &mut pushes[wrong];
        let way = push.samples[push.samples.len() - 1].finger - push.samples[0].finger;
        push.before.p_WO += way.normalize() * 6e-3;
        let told = estimate_pushes(&PushLog::new(pushes).unwrap(), 3e-3).unwrap();
        assert_eq!(told.outline.corners.len(), 4, "{wrong}");
    }
}

/// Of few pushes an outline of as many unknowns leaves nothing; what is told is held to how far it may be off all the same.
#[test]
fn few_pushes_do_not_tell_an_outline_to_hundredths_of_a_millimetre() {
    let scene = rectangle();
    let log = made(&scene, 40, PushDisturbances::default()).log;
    for pushes in log.pushes().chunks(10) {
        let told = estimate_pushes(&PushLog::new(pushes.to_vec()).unwrap(), 3e-3).unwrap();
        let touched = told.outline.points.iter().filter(|p| p.to_touch == 0.0);
        let off = touched.map(|p| (scene.outline.nearest(p.point).distance / p.deviation).abs());
        let most = off.fold(0.0, f64::max);
        assert!(most < 5.0, "{most} deviations off as {}", told.outline.name);
    }
}

/// Whatever a clock begins at, times are since the push began.
#[test]
fn times_count_from_the_beginning_of_each_push() {
    let log = made(&rectangle(), 12, PushDisturbances::default()).log;
    let mut pushes = log.pushes().to_vec();
    // In steps that such a clock can tell exactly.
    pushes.iter_mut().flat_map(|push| &mut push.samples).for_each(|s| s.t = (s.t * 4096.0).round() / 4096.0);
    let own = estimate_pushes(&PushLog::new(pushes.clone()).unwrap(), 3e-3).unwrap();
    pushes.iter_mut().flat_map(|push| &mut push.samples).for_each(|s| s.t += 1.7e9);
    let told = estimate_pushes(&PushLog::new(pushes).unwrap(), 3e-3).unwrap();
    let times = |told: &PushesEstimate| -> Vec<f64> {
        told.pushes.iter().flat_map(|push| push.instants.iter().map(|instant| instant.t)).collect()
    };
    assert_eq!(times(&own), times(&told));
}

/// Work is done at the finger and on the object: forces of the wrong sign or with their axes exchanged, poses in the wrong order, and an object that
/// never moves are no pushes.
#[test]
fn forces_that_do_not_push_are_refused() {
    let log = made(&rectangle(), 20, PushDisturbances::default()).log;
    let told = |change: &dyn Fn(&mut object_dynamics::pushing::Push)| {
        let mut pushes = log.pushes().to_vec();
        pushes.iter_mut().for_each(change);
        estimate_pushes(&PushLog::new(pushes).unwrap(), 3e-3)
    };
    assert!(told(&|_| ()).is_ok());
    let refused = |change: &dyn Fn(&mut object_dynamics::pushing::Push)| {
        assert!(matches!(told(change), Err(PushesError::Against { pushes: 20, .. })));
    };
    refused(&|push| push.samples.iter_mut().for_each(|s| s.force = -s.force));
    refused(&|push| push.samples.iter_mut().for_each(|s| s.force = DVec2::new(s.force.y, s.force.x)));
    refused(&|push| std::mem::swap(&mut push.before, &mut push.after));
    refused(&|push| push.after = push.before);
}
