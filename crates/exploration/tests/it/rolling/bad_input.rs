use super::{SIZE, palms};
use exploration::generators::Family;
use exploration::planar::{Noise, PlanarKnowledge};
use exploration::rolling::{
    LargestGap, PalmsError, RollError, RollTask, SimulatedPalms, Workspace, WorkspaceError, explore_rolling,
};
use exploration::{Confidence, Goal, GoalError, Spending};

fn refused(task: &RollTask) -> RollError {
    let mut known = PlanarKnowledge::exact();
    let mut hands = palms(Family::Egg, 1);
    explore_rolling(&mut known, &mut LargestGap::new(1), &mut hands, task, |_, _| ()).unwrap_err()
}

fn task() -> RollTask {
    RollTask::new(Goal::Gap(0.1), Workspace::for_size(SIZE))
}

#[test]
fn goals_and_settings_that_are_none_are_named() {
    let with = |goal| refused(&RollTask { goal: Goal::Gap(goal), ..task() });
    assert_eq!(with(0.0), RollError::Goal(GoalError::Zero));
    assert!(matches!(with(f64::NAN), RollError::Goal(GoalError::NotFinite { .. })));
    assert!(matches!(with(-1.0), RollError::Goal(GoalError::Negative { .. })));
    for radians in [0.0, f64::NAN] {
        assert!(matches!(refused(&RollTask { radians, ..task() }), RollError::Setting { .. }));
    }
    for risk in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(refused(&RollTask { risk, ..task() }), RollError::Setting { what: "risk", .. }));
    }
    assert!(matches!(refused(&RollTask { spacing: -0.1, ..task() }), RollError::Setting { .. }));
}

#[test]
fn limits_that_are_none_or_contradict_each_other_are_named() {
    let workspace = Workspace::for_size(SIZE);
    let with = |workspace| refused(&RollTask { workspace, ..task() });
    for length in [0.0, f64::NAN, f64::INFINITY] {
        let reason = with(Workspace { length, ..workspace });
        assert!(matches!(reason, RollError::Workspace(WorkspaceError::Positive { .. })));
    }
    for wedge in [[-0.1, 1.0], [1.0, 3.2], [2.0, 1.0], [f64::NAN, 1.0]] {
        let reason = with(Workspace { wedge, ..workspace });
        assert!(matches!(reason, RollError::Workspace(WorkspaceError::Interval { .. })), "{reason}");
    }
    let narrow = Workspace { angles: [[0.5, 0.6], [2.0, 2.1]], wedge: [0.3, 0.5], ..workspace };
    assert!(matches!(with(narrow), RollError::Workspace(WorkspaceError::Contradiction { .. })));
    // The palms stand at 0.7 and 2.4 rad.
    let elsewhere = Workspace { angles: [[0.1, 0.5], [1.5, 2.9]], ..workspace };
    assert!(matches!(with(elsewhere), RollError::Outside { .. }));
}

#[test]
fn palms_without_a_wedge_hold_nothing() {
    for palms in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0]] {
        let made = SimulatedPalms::new(super::body(Family::Sum, 1), 5.0, palms, 0.0);
        assert!(matches!(made.err(), Some(PalmsError::Wedge { .. })));
    }
}

#[test]
fn a_goal_below_the_noise_is_refused_before_a_palm_turns() {
    let spending = Spending::Budget(60);
    let confidence = Confidence::new(0.95, spending).unwrap();
    let mut known = PlanarKnowledge::noisy(Noise { point: 0.01, normal: 0.01, confidence });
    let mut hands = palms(Family::Egg, 1);
    let task = RollTask { goal: Goal::Gap(0.01), spending: Some(spending), ..task() };
    let refused = explore_rolling(&mut known, &mut LargestGap::new(1), &mut hands, &task, |_, _| ());
    assert!(matches!(refused, Err(RollError::BelowNoise { .. })));
}
