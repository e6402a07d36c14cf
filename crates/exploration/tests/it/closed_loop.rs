//! What the loop proves, what it refuses, and what it says when a goal cannot be had.

use contact_kinematics::Direction;
use exploration::generators::{Family, outline, solid};
use exploration::{
    Cone, Confidence, ExploreError, Goal, GoalError, Heading, Knowledge, KnowledgeError, Limits, Motion,
    Outcome, Shortfall, Spending, Task, explore, planar, space,
};
use glam::DVec3;
use proptest::prelude::*;
use shape_bounds::exact_hull::planar as flat;
use shape_bounds::{ContactSample, planar::ContactSample as FlatSample};

fn mean_width(family: Family, seed: u64) -> f64 {
    let body = outline(family, seed);
    let lattice = flat::Direction::spread(360);
    2.0 * lattice.iter().map(|u| body(*u).dot(u.get())).sum::<f64>() / 360.0
}

/// Points off by 0.1 % of the mean width, normals by 2 mrad.
fn planar_noise(width: f64, spending: Spending) -> planar::Noise {
    let confidence = Confidence::new(0.95, spending).unwrap();
    planar::Noise { point: 1e-3 * width, normal: 2e-3, confidence }
}

/// Largest amount, in m, by which the true body protrudes from the bounds; at most rounding if the bounds hold.
fn protrusion(known: &planar::PlanarKnowledge, family: Family, seed: u64) -> f64 {
    let body = outline(family, seed);
    let off = |u: &flat::Direction| {
        let (low, high) = known.support(*u);
        let h = body(*u).dot(u.get());
        (low - h).max(h - high)
    };
    flat::Direction::spread(720).iter().map(off).fold(f64::NEG_INFINITY, f64::max)
}

#[test]
fn under_noise_the_goal_is_reached_and_the_bounds_hold() {
    let (mut wrong, mut touches) = (0, Vec::new());
    for spending in [Spending::Budget(30), Spending::Unlimited] {
        for family in [Family::Ellipsoid, Family::Sum, Family::Egg] {
            for seed in 0..20 {
                let width = mean_width(family, seed);
                let mut known = planar::PlanarKnowledge::noisy(planar_noise(width, spending));
                let mut finger = planar::SimulatedFinger::new(outline(family, seed), Motion::Plane)
                    .with_noise(1e-3 * width, 2e-3, seed);
                let mut planner = planar::PathAware::new(planar::turned_start(5, seed));
                let task = Task { spending: Some(spending), ..Task::new(Goal::Gap(0.1), 100) };
                let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
                assert!(ended.is_reached(), "{family:?} {seed} {ended:?}");
                assert_eq!(ended.certificate().confidence, Some((0.95, spending)));
                wrong += usize::from(protrusion(&known, family, seed) > 1e-12);
                touches.push(known.touches());
            }
        }
    }
    // 120 runs at 95 %: more than 12 wrong ones have a probability of one in a hundred if the confidence is met exactly.
    assert!(wrong <= 12, "{wrong} of {}", touches.len());
    touches.sort_unstable();
    assert!(touches[60] <= 15, "{touches:?}");
}

#[test]
fn a_goal_below_the_noise_is_refused_before_the_first_touch() {
    let spending = Spending::Budget(50);
    let mut known = planar::PlanarKnowledge::noisy(planar_noise(1.0, spending));
    let mut finger = planar::SimulatedFinger::new(outline(Family::Ellipsoid, 1), Motion::Plane);
    let mut planner = planar::PathAware::new(planar::turned_start(5, 1));
    let task = Task { spending: Some(spending), width: Some(1.0), ..Task::new(Goal::Gap(0.005), 50) };
    let refused = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ());
    assert!(
        matches!(refused, Err(ExploreError::BelowNoise { floor, .. }) if floor > 0.005 && floor < 0.04),
        "{refused:?}"
    );
    assert_eq!(known.touches(), 0);
    // Without a width it is said as soon as the upper bound is closed.
    let task = Task { width: None, ..task };
    let refused = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ());
    assert!(matches!(refused, Err(ExploreError::BelowNoise { .. })) && known.touches() <= 5);
}

/// What is said to be out of reach of the noise is: many touches do not get there.
#[test]
fn many_touches_do_not_get_below_the_noise_floor() {
    for (family, seed) in [(Family::Ellipsoid, 3), (Family::Egg, 4), (Family::Rounded, 5)] {
        let width = mean_width(family, seed);
        let spending = Spending::Budget(150);
        let mut known = planar::PlanarKnowledge::noisy(planar_noise(width, spending));
        let floor = known.noise_floor(&Goal::Gap(0.1), width);
        let mut finger = planar::SimulatedFinger::new(outline(family, seed), Motion::Plane).with_noise(
            1e-3 * width,
            2e-3,
            seed,
        );
        let mut planner = planar::FixedSweep::new(planar::turned_start(5, seed));
        let task = Task { spending: Some(spending), ..Task::new(Goal::Gap(floor), 150) };
        let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
        let proven = ended.certificate().proven;
        assert!(!ended.is_reached() && proven > floor && proven < 4.0 * floor, "{family:?} {proven} {floor}");
    }
}

#[test]
fn a_budget_is_kept_to() {
    let spending = Spending::Budget(8);
    let mut known = planar::PlanarKnowledge::noisy(planar_noise(2.0, spending));
    let mut finger = planar::SimulatedFinger::new(outline(Family::Ellipsoid, 1), Motion::Plane);
    let mut planner = planar::PathAware::new(planar::turned_start(5, 1));
    let task = Task { spending: Some(spending), ..Task::new(Goal::Gap(0.1), 100) };
    let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
    assert!(matches!(ended, Outcome::Short { shortfall: Shortfall::Budget, .. }));
    assert_eq!(known.touches(), 8);
    let more = FlatSample { point: glam::DVec2::X, normal: flat::Direction::from_angle(0.0) };
    assert!(matches!(known.insert(more), Err(KnowledgeError::Confidence(_))));
}

fn task_for(goal: Goal<Direction>) -> Result<Outcome<Direction>, ExploreError> {
    let mut known = space::SpaceKnowledge::exact();
    let mut finger = space::SimulatedFinger::new(solid(Family::Ellipsoid, 1), Motion::Plane);
    let mut planner = space::PathAware::new(space::turned_tetrahedron(1));
    explore(&mut known, &mut planner, &mut finger, &Task::new(goal, 60), |_, _| ())
}

#[test]
fn goals_that_are_none_are_refused() {
    assert_eq!(task_for(Goal::Gap(0.0)), Err(ExploreError::Goal(GoalError::Zero)));
    assert_eq!(task_for(Goal::Hausdorff(-1.0)), Err(ExploreError::Goal(GoalError::Negative { value: -1.0 })));
    assert!(matches!(task_for(Goal::Gap(f64::NAN)), Err(ExploreError::Goal(GoalError::NotFinite { .. }))));
}

#[test]
fn a_goal_that_is_met_already_takes_no_touch() {
    let ended = task_for(Goal::Gap(1.0)).unwrap();
    assert!(ended.is_reached() && ended.certificate().touches == 0);
}

/// From above alone: the upper bound stays open, or what is below stays unknown, and is named.
#[test]
fn what_is_out_of_reach_is_named() {
    for half_angle in [1.2, 2.2] {
        let limits = Limits::new(vec![Cone { axis: Direction::Z, half_angle }], vec![]).unwrap();
        let mut known = space::SpaceKnowledge::exact();
        let mut finger = space::SimulatedFinger::new(solid(Family::Ellipsoid, 2), Motion::Plane);
        let mut planner = space::PathAware::new(space::turned_tetrahedron(2));
        let task = Task { limits, ..Task::new(Goal::Gap(0.01), 300) };
        let ended = explore(&mut known, &mut planner, &mut finger, &task, |step, _| {
            assert!(step.proposal.along.angle_to(Direction::Z) <= half_angle + 1e-6);
        });
        let Outcome::Short { shortfall, .. } = ended.unwrap() else { panic!("reached from above") };
        if half_angle < 1.5 {
            let Shortfall::Unreachable { directions } = shortfall else { panic!("{shortfall:?}") };
            let named = |d: &Vec<f64>| Direction::new(DVec3::from_slice(d)).unwrap();
            assert!(!directions.is_empty());
            assert!(directions.iter().all(|d| named(d).angle_to(Direction::Z) > half_angle));
        } else {
            assert!(matches!(shortfall, Shortfall::Unreachable { .. } | Shortfall::Budget));
        }
    }
}

#[test]
fn contacts_that_contradict_each_other_are_refused_and_not_taken() {
    let mut known = space::SpaceKnowledge::exact();
    let body = solid(Family::Ellipsoid, 1);
    for n in Direction::spread(12) {
        known.insert(ContactSample { point: body(n), normal: n }).unwrap();
    }
    let before = known.measures();
    let wrong = ContactSample { point: DVec3::splat(30.0), normal: Direction::Z };
    assert!(matches!(known.insert(wrong), Err(KnowledgeError::Space { touch: 13, .. })));
    assert!(known.insert(ContactSample { point: DVec3::NAN, normal: Direction::Z }).is_err());
    assert_eq!((known.touches(), known.measures()), (12, before));
    // And the next right one is.
    known.insert(ContactSample { point: body(Direction::X), normal: Direction::X }).unwrap();
    assert_eq!(known.touches(), 13);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]
    /// Laws of exact touches, whoever chooses them: the lower bound grows, the upper one shrinks, the body is between them.
    #[test]
    fn bounds_only_narrow_and_hold_the_body(seed in 0..5000_u64, family in 0..5_usize, touches in 5..25_usize) {
        let family = Family::ALL[family];
        let body = solid(family, seed);
        let mut known = space::SpaceKnowledge::exact();
        let mut finger = space::SimulatedFinger::new(solid(family, seed), Motion::Plane);
        let mut planner = space::RandomTouches::new(space::turned_tetrahedron(seed), seed);
        let (mut lower, mut upper, mut hausdorff) = (0.0, f64::INFINITY, f64::INFINITY);
        let task = Task::new(Goal::Gap(1e-6), touches);
        explore(&mut known, &mut planner, &mut finger, &task, |step, known| {
            assert!(step.lower >= lower * (1.0 - 1e-12) && step.upper <= upper * (1.0 + 1e-12));
            let now = known.hausdorff();
            assert!(now <= hausdorff + 1e-9, "{now} after {hausdorff}");
            (lower, upper, hausdorff) = (step.lower, step.upper, now);
        }).unwrap();
        for n in Direction::spread(50) {
            let (low, high) = known.support(n);
            let h = body(n).dot(n.get());
            prop_assert!(low <= h + 1e-9 && h <= high + 1e-9, "{low} {h} {high}");
        }
    }
}
