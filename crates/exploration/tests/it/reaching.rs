//! What planners need on seeded bodies. Seeds here are those on which planners were tuned; the study `reaching` has others.

use crate::rolling::few_or_all;
use contact_kinematics::Direction;
use exploration::generators::{Family, outline, polygon, solid};
use exploration::{Goal, Knowledge, Motion, Planner, Task, explore, least_touches, planar, space};
use glam::DVec3;

/// Seeds from here on are those of tuning.
const TUNING: u64 = 1000;

/// Touches and radians that each body took, `None` where the goal was not reached.
type Runs = Vec<Option<(usize, f64)>>;

type MakePlanar = fn(u64) -> Box<dyn Planner<planar::PlanarKnowledge>>;
type MakeSpace = fn(u64) -> Box<dyn Planner<space::SpaceKnowledge>>;

fn in_plane(make: MakePlanar, goal: f64, each: u64) -> Runs {
    let mut runs = Vec::new();
    for family in Family::ALL {
        for seed in TUNING..TUNING + each {
            let mut finger = planar::SimulatedFinger::new(outline(family, seed), Motion::Plane);
            let mut known = planar::PlanarKnowledge::exact();
            let mut way = 0.0;
            let task = Task::new(Goal::Gap(goal), 200);
            let ended = explore(&mut known, &mut *make(seed), &mut finger, &task, |s, _| way += s.turned);
            runs.push(ended.unwrap().is_reached().then_some((known.touches(), way)));
        }
    }
    runs
}

fn in_space(make: MakeSpace, goal: f64, each: u64) -> Runs {
    let mut runs = Vec::new();
    for family in Family::ALL {
        for seed in TUNING..TUNING + each {
            let mut finger = space::SimulatedFinger::new(solid(family, seed), Motion::Plane);
            let mut known = space::SpaceKnowledge::exact();
            let mut way = 0.0;
            let task = Task::new(Goal::Gap(goal), 400);
            let ended = explore(&mut known, &mut *make(seed), &mut finger, &task, |s, _| way += s.turned);
            runs.push(ended.unwrap().is_reached().then_some((known.touches(), way)));
        }
    }
    runs
}

/// The smallest value that a share of the runs does not exceed: a run that did not reach the goal counts as the worst.
fn quantile(runs: &Runs, share: f64) -> (f64, f64) {
    let of = |part: fn(&(usize, f64)) -> f64| {
        let mut all: Vec<f64> = runs.iter().map(|r| r.as_ref().map_or(f64::INFINITY, part)).collect();
        all.sort_by(f64::total_cmp);
        all[((share * all.len() as f64).ceil() as usize).clamp(1, all.len()) - 1]
    };
    (of(|r| r.0 as f64), of(|r| r.1))
}

fn median(runs: &Runs) -> (f64, f64) {
    quantile(runs, 0.5)
}

#[test]
fn ten_per_cent_in_the_plane_take_eleven_touches_and_less_than_fifteen_radians() {
    let path: MakePlanar = |seed| Box::new(planar::PathAware::new(planar::turned_start(5, seed)));
    let random: MakePlanar = |seed| Box::new(planar::RandomTouches::new(planar::turned_start(3, seed), seed));
    let runs = in_plane(path, 0.1, 10);
    let (touches, way) = median(&runs);
    assert!(touches <= 11.0 && way <= 15.0, "{touches} {way}");
    assert!(quantile(&runs, 0.9).0 <= 12.0, "{:?}", quantile(&runs, 0.9));
    let blind = median(&in_plane(random, 0.1, 10)).0;
    assert!(blind >= 1.9 * touches, "{blind} {touches}");
}

#[test]
fn twenty_per_cent_in_space_take_45_touches_and_less_than_forty_radians() {
    let path: MakeSpace = |seed| Box::new(space::PathAware::new(space::turned_tetrahedron(seed)));
    let random: MakeSpace = |seed| Box::new(space::RandomTouches::new(space::turned_tetrahedron(seed), seed));
    let each = few_or_all(5, 10);
    let runs = in_space(path, 0.2, each);
    let (touches, way) = median(&runs);
    assert!(touches <= 45.0 && way <= 40.0, "{touches} {way}");
    assert!(quantile(&runs, 0.9).0 <= 47.0, "{:?}", quantile(&runs, 0.9));
    let blind = median(&in_space(random, 0.2, each)).0;
    assert!(blind >= 2.0 * touches, "{blind} {touches}");
    // The first ones are ellipsoids, for which the best pattern is known.
    let ellipsoids: Runs = runs[..each as usize].to_vec();
    let least = least_touches(3, 0.2);
    assert!(median(&ellipsoids).0 <= 1.2 * least && ellipsoids.iter().flatten().all(|r| r.0 as f64 > least));
}

/// Who does not know the normals must touch each corner, then each edge.
#[test]
fn a_polygon_is_exact_after_twice_its_corners_and_one_touch() {
    type Reaches = Box<dyn Planner<planar::PlanarKnowledge>>;
    let planners: [fn(u64) -> Reaches; 2] = [
        |seed| Box::new(planar::AreaGreedy::new(planar::turned_start(3, seed % 10))),
        |seed| Box::new(planar::PathAware::new(planar::turned_start(3, seed % 10))),
    ];
    for (corners, planner) in (3..10).flat_map(|corners| planners.map(|planner| (corners, planner))) {
        // The last two have corners of the upper bound at one place, past which a climb has to get; of triangles the first touches may find one
        // side alone, whose ends must not be touched again.
        let sides = if corners == 3 { 1000..1300 } else { 0..0 };
        for seed in (0..6).chain([1235, 78_009]).chain(sides) {
            let (body, points) = polygon(corners, seed);
            let mut known = planar::PlanarKnowledge::exact();
            let mut finger = planar::SimulatedFinger::new(body, Motion::Plane);
            let task = Task::new(Goal::Gap(1e-9), 100);
            let ended = explore(&mut known, &mut *planner(seed), &mut finger, &task, |_, _| ()).unwrap();
            assert!(ended.is_reached(), "{corners} {seed} {ended:?}");
            assert!(known.touches() <= 2 * corners + 1, "{corners} {seed}: {}", known.touches());
            let lower = known.bounds().unwrap().lower().polygon().unwrap();
            assert_eq!(lower.sources().len(), points.len());
        }
    }
}

/// Where a facet was touched the bounds meet but for rounding, and what a touch there would pay is none: else the nearest of all that pay well is that one,
/// time after time.
#[test]
fn a_facet_of_a_polyhedron_is_touched_once() {
    let solids: [&[[f64; 3]]; 2] = [
        &[
            [-0.05148202647275424, -0.6703048536179725, -0.6255168345972877],
            [0.7815320455759613, -0.11044203343210413, 0.93001499217727],
            [-0.23652698970703234, 0.8146076644057378, 0.8084450581884768],
            [0.5770808385031454, 0.9872417346439379, -0.13326148969632867],
            [0.27832792926039285, 0.2489874495709823, 0.4107921756878501],
        ],
        &[
            [0.06250295483287349, 0.018792077429021115, -0.03272982752624709],
            [-0.6077111748741593, 0.919630911940621, 0.9208266365856785],
            [0.07220597257377936, -0.5974375395243343, 0.023239422966268686],
            [-0.32297692062597294, -0.8977267565089486, 0.4874370815485125],
            [0.5532167629234725, 0.7358943239925055, 0.8264655967733379],
            [0.2056755274344737, 0.6524981075833796, -0.8771907015770304],
        ],
    ];
    for (corners, seed) in solids.into_iter().zip([1, 32]) {
        let corners: Vec<DVec3> = corners.iter().copied().map(DVec3::from_array).collect();
        let body = move |u: Direction| {
            let height = |corner: &DVec3| corner.dot(u.get());
            *corners.iter().max_by(|a, b| height(a).total_cmp(&height(b))).unwrap()
        };
        let mut known = space::SpaceKnowledge::exact();
        let mut planner = space::PathAware::new(space::turned_tetrahedron(seed));
        let mut finger = space::SimulatedFinger::new(Box::new(body), Motion::Plane);
        let task = Task::new(Goal::Gap(1e-2), 60);
        let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
        assert!(ended.is_reached(), "{seed} {ended:?}");
    }
}

#[test]
fn goals_in_distance_and_width_are_reached_on_every_body() {
    for family in Family::ALL {
        for seed in TUNING..TUNING + 4 {
            let mut known = planar::PlanarKnowledge::exact();
            let mut finger = planar::SimulatedFinger::new(outline(family, seed), Motion::Plane);
            let mut planner = planar::PathAware::new(planar::turned_start(5, seed));
            let task = Task::new(Goal::Hausdorff(0.05), 100);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
            assert!(ended.is_reached() && known.hausdorff() <= 0.05, "{family:?} {seed} {ended:?}");

            let mut known = space::SpaceKnowledge::exact();
            let mut finger = space::SimulatedFinger::new(solid(family, seed), Motion::Plane);
            let mut planner = space::PathAware::new(space::turned_tetrahedron(seed));
            let task = Task::new(Goal::Hausdorff(0.1), 200);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
            assert!(ended.is_reached() && known.hausdorff() <= 0.1, "{family:?} {seed} {ended:?}");

            // Two touches more than the start, whatever the body.
            let along = Direction::new(DVec3::new(1.0, -2.0, 0.5)).unwrap();
            let mut known = space::SpaceKnowledge::exact();
            let task = Task::new(Goal::Width { along, within: 1e-9 }, 200);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
            assert!(ended.is_reached() && known.touches() <= 6, "{family:?} {seed} {ended:?}");
            let body = solid(family, seed);
            let width = along.get().dot(body(along) - body(-along));
            let (low, high) = (known.support(along), known.support(-along));
            assert!((low.0 + high.0 - width).abs() < 1e-9 && (low.1 + high.1 - width).abs() < 1e-9);
        }
    }
}

/// A ray meets the body where it is told, at the body's own normal, and is as good.
#[test]
fn a_finger_on_a_ray_reaches_the_goal_as_soon() {
    let mut touches = Vec::new();
    for family in Family::ALL {
        for seed in TUNING..TUNING + 3 {
            let mut known = space::SpaceKnowledge::exact();
            let body = solid(family, seed);
            let mut finger = space::SimulatedFinger::new(solid(family, seed), Motion::Ray);
            let mut planner = space::VolumeGreedy::new(space::turned_tetrahedron(seed));
            let task = Task::new(Goal::Gap(0.2), 100);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |step, _| {
                let contact = step.contact;
                // On the surface: as far along its normal as the body goes.
                let depth = contact.normal.get().dot(body(contact.normal) - contact.point);
                assert!(depth.abs() < 1e-7, "{family:?} {seed} touch {} {depth:e}", step.touch);
                if let Some([from, to]) = step.proposal.ray {
                    let off = (contact.point - from).cross((to - from).normalize()).length();
                    assert!(off < 1e-9, "{family:?} {seed} touch {} off its ray by {off:e}", step.touch);
                }
            });
            assert!(ended.unwrap().is_reached(), "{family:?} {seed}");
            touches.push(known.touches());

            let mut known = planar::PlanarKnowledge::exact();
            let mut finger = planar::SimulatedFinger::new(outline(family, seed), Motion::Ray);
            let mut planner = planar::AreaGreedy::new(planar::turned_start(5, seed));
            let task = Task::new(Goal::Gap(0.1), 30);
            let ended = explore(&mut known, &mut planner, &mut finger, &task, |_, _| ());
            assert!(
                ended.unwrap().is_reached() && known.touches() <= 14,
                "{family:?} {seed} {}",
                known.touches()
            );
        }
    }
    assert!(touches.iter().all(|n| *n <= 50), "{touches:?}");
}

#[test]
fn the_same_seed_gives_the_same_touches_to_the_last_bit_in_any_thread() {
    let run = || {
        let mut known = space::SpaceKnowledge::exact();
        let mut finger = space::SimulatedFinger::new(solid(Family::Sum, 3), Motion::Plane);
        let mut planner = space::PathAware::new(space::turned_tetrahedron(3));
        let task = Task::new(Goal::Gap(0.25), 100);
        explore(&mut known, &mut planner, &mut finger, &task, |_, _| ()).unwrap();
        let bits = |c: &shape_bounds::ContactSample| c.point.to_array().map(f64::to_bits);
        known.contacts().iter().map(bits).collect::<Vec<_>>()
    };
    let alone = run();
    let threads: Vec<_> = (0..4).map(|_| std::thread::spawn(run)).collect();
    for thread in threads {
        assert_eq!(thread.join().unwrap(), alone);
    }
}
