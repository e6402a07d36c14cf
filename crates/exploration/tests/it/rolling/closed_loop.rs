use super::{Body, SIZE, body, few_or_all, palms};
use exploration::generators::Family;
use exploration::planar::{Noise, PlanarKnowledge};
use exploration::rolling::{
    InformationRate, LargestGap, NearestGap, PalmSweep, Palms, RandomTurns, RollEnd, RollOutcome,
    RollPlanner, RollStep, RollTask, RollingBody, Workspace, explore_rolling,
};
use exploration::{Confidence, Goal, Heading, Knowledge, Spending};
use shape_bounds::exact_hull::planar::Direction;

/// All planners; a test that runs over them runs over every one.
fn planners(seed: u64) -> Vec<Box<dyn RollPlanner>> {
    vec![
        Box::new(LargestGap::new(seed)),
        Box::new(NearestGap::new(seed)),
        Box::new(InformationRate::new(seed, 2)),
        Box::new(InformationRate::new(seed, 2).per_radian()),
        Box::new(PalmSweep::new()),
        Box::new(RandomTurns::new(seed)),
    ]
}

fn task(gap: f64) -> RollTask {
    RollTask { radians: 40.0, ..RollTask::new(Goal::Gap(gap), Workspace::for_size(SIZE)) }
}

/// Largest amount, in m, by which the true body protrudes from the bounds.
fn protrusion(known: &PlanarKnowledge, truth: &Body) -> f64 {
    let off = |u: &Direction| {
        let (low, high) = known.support(*u);
        let h = truth.farthest(u.angle()).dot(u.get());
        (low - h).max(h - high)
    };
    Direction::spread(90).iter().map(off).fold(f64::NEG_INFINITY, f64::max)
}

fn run(
    planner: &mut dyn RollPlanner,
    family: Family,
    seed: u64,
    task: &RollTask,
) -> (RollOutcome, Vec<RollStep>) {
    let mut known = PlanarKnowledge::exact();
    let (truth, mut steps) = (body(family, seed), Vec::new());
    let outcome = explore_rolling(&mut known, planner, &mut palms(family, seed), task, |step, known| {
        steps.push(*step);
        assert!(protrusion(known, &truth) < 1e-9, "{family:?} {seed} after {step:?}");
    });
    (outcome.unwrap(), steps)
}

#[test]
fn the_body_is_between_the_bounds_at_every_step_of_every_planner() {
    // A few: every planner on one family, every family with one planner at least, to a coarser goal. All: each with each.
    let goal = few_or_all(0.2, 0.1);
    for (k, family) in Family::ALL.into_iter().enumerate() {
        let here = |j: usize| few_or_all(j % Family::ALL.len() == k, true);
        for (_, mut planner) in planners(3).into_iter().enumerate().filter(|(j, _)| here(*j)) {
            let (outcome, steps) = run(&mut *planner, family, 3, &task(goal));
            let proven = outcome.certificate().proven;
            assert!(steps.windows(2).all(|w| w[1].progress <= w[0].progress + 1e-12), "{}", planner.name());
            assert!(steps.windows(2).all(|w| w[1].radians >= w[0].radians && w[1].seconds >= w[0].seconds));
            assert_eq!(steps.last().unwrap().progress, proven);
            assert_eq!(matches!(outcome, RollOutcome::Reached(_)), proven <= goal);
        }
    }
}

#[test]
fn planned_motions_reach_a_gap() {
    let (seeds, wanted) = few_or_all((1, 1), (6, 4));
    let mut reached = 0;
    for seed in 0..seeds {
        let mut planner = InformationRate::new(seed, 2).per_radian();
        let (outcome, _) = run(&mut planner, Family::Sum, seed, &task(0.1));
        reached += usize::from(matches!(outcome, RollOutcome::Reached(_)));
    }
    assert!(reached >= wanted, "{reached} of {seeds}");
}

#[test]
fn the_same_seed_gives_the_same_motions_in_any_number_of_threads() {
    let task = RollTask { radians: few_or_all(0.7, 40.0), ..task(0.1) };
    let one = |k: usize| run(&mut *planners(5).swap_remove(k), Family::Egg, 5, &task);
    let alone: Vec<_> = (0..planners(5).len()).map(one).collect();
    let together: Vec<_> = std::thread::scope(|scope| {
        let all: Vec<_> = (0..alone.len()).map(|k| scope.spawn(move || one(k))).collect();
        all.into_iter().map(|t| t.join().unwrap()).collect()
    });
    assert_eq!(alone, together);
}

/// Palms that hardly move see little: what is left is said, and lies beyond what was felt.
#[test]
fn normals_that_no_motion_was_found_for_are_named() {
    let narrow =
        Workspace { angles: [[0.6, 0.9], [2.2, 2.5]], wedge: [1.4, 1.8], ..Workspace::for_size(SIZE) };
    let task = RollTask { workspace: narrow, ..task(0.05) };
    for mut planner in planners(2).into_iter().take(4) {
        let (outcome, steps) = run(&mut *planner, Family::Egg, 2, &task);
        let RollOutcome::Short { end: RollEnd::NotFound { directions }, .. } = outcome else {
            panic!("{}: {outcome:?}", planner.name());
        };
        assert!(!directions.is_empty());
        let felt = || steps.iter().flat_map(|s| s.reading.contacts.map(|c| c.normal));
        let nearest = felt().map(|n| n.angle_to(directions[0])).fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.1, "{} {nearest}", planner.name());
    }
}

/// Where it is said that no motion uncovers more, a raster of all angles, four times as fine as the planners' lattice there, feels nothing that is new either.
#[test]
fn where_nothing_is_left_to_do_a_raster_feels_nothing_new() {
    let room = 0.1;
    let angles = [[0.7 - room, 0.7 + room], [2.4 - room, 2.4 + room]];
    let workspace = Workspace { angles, ..Workspace::for_size(SIZE) };
    let task = RollTask { workspace, motions: 400, ..task(0.05) };
    let mut said = 0;
    for seed in 2..few_or_all(5, 14) {
        let family = Family::ALL[seed as usize % Family::ALL.len()];
        let (outcome, steps) = run(&mut LargestGap::new(seed), family, seed, &task);
        if !matches!(outcome, RollOutcome::Short { end: RollEnd::NotFound { .. }, .. }) {
            continue;
        }
        said += 1;
        let felt: Vec<Direction> =
            steps.iter().flat_map(|step| step.reading.contacts.map(|c| c.normal)).collect();
        let mut palms = palms(family, seed);
        for row in 0..=4 {
            for column in 0..=4 {
                let [one, two] = [row, column].map(|k| 0.05 * f64::from(k) - room);
                let reading = palms.turn([0.7 + one, 2.4 + two]).unwrap();
                for contact in reading.contacts {
                    let nearest =
                        felt.iter().map(|n| n.angle_to(contact.normal)).fold(f64::INFINITY, f64::min);
                    assert!(
                        nearest < task.spacing,
                        "{family:?} {seed}: {nearest} rad from all that was felt"
                    );
                }
            }
        }
    }
    assert!(said >= 2, "{said}");
}

#[test]
fn under_noise_bounds_hold_and_the_goal_is_proven() {
    let spending = Spending::Budget(60);
    let (mut wrong, mut reached) = (0, 0);
    let (seeds, most, least) = few_or_all((4, 1, 2), (8, 2, 5));
    for seed in 0..seeds {
        let confidence = Confidence::new(0.95, spending).unwrap();
        let mut known = PlanarKnowledge::noisy(Noise { point: 1.5e-3, normal: 2e-3, confidence });
        let mut hands = palms(Family::Sum, seed).with_noise(1.5e-3, 2e-3, seed);
        let mut planner = InformationRate::new(seed, 1).per_radian();
        let task = RollTask { spending: Some(spending), ..task(0.2) };
        let outcome = explore_rolling(&mut known, &mut planner, &mut hands, &task, |_, _| ()).unwrap();
        wrong += usize::from(protrusion(&known, &body(Family::Sum, seed)) > 1e-9);
        reached += usize::from(matches!(outcome, RollOutcome::Reached(_)));
    }
    // At 95 % more than 1 of 4 have a probability of one in seventy, more than 2 of 8 of six in a thousand.
    assert!(wrong <= most && reached >= least, "{wrong} {reached}");
}
