//! A body between two parallel palms, rolled by strokes of the upper one.

use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, PalmSurface, SupportFunction, SurfaceMotion, SurfacePose,
};
use exploration::parallel::*;
use exploration::space::{Noise, SpaceKnowledge};
use exploration::{Confidence, Goal, Heading, Knowledge, Outcome, Shortfall, Source, Spending};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::*;
use observer::rolling::{RollingError, RollingNoise, RollingReading};
use proptest::prelude::*;

fn ellipsoid(axes: DVec3) -> impl Fn(Direction) -> DVec3 {
    move |n| axes * axes * n.get() / (axes * n.get()).length()
}

fn palms_on(
    axes: DVec3,
    workspace: ParallelWorkspace,
    R_WO: DQuat,
) -> SimulatedParallelPalms<impl Fn(Direction) -> DVec3> {
    SimulatedParallelPalms::new(ellipsoid(axes), workspace, R_WO).unwrap()
}

#[test]
fn a_ball_moves_the_palm_twice_as_far_as_it_rolls() {
    let (r, turn, heading) = (0.7, 0.8, 2.1);
    let workspace = ParallelWorkspace::for_size(2.0 * r, 0.5);
    let mut palms = palms_on(DVec3::splat(r), workspace, DQuat::from_rotation_y(0.3));
    let before = palms.feel().unwrap();
    let felt = palms.roll(heading, turn).unwrap();
    let along = glam::DVec2::from_angle(heading);
    assert!((felt.way - 2.0 * r * turn).abs() < 1e-4, "chords of steps of 0.01 rad: {}", felt.way);
    // A contact stays where the two palms face each other: the arc goes forward on the lower pad, back on the upper one.
    assert!((felt.hold.pads[1] - along * (r * turn)).length() < 1e-4, "{:?}", felt.hold.pads);
    assert!((felt.hold.pads[0] + along * (r * turn)).length() < 1e-4, "{:?}", felt.hold.pads);
    for (from, to) in before.contacts.iter().zip(&felt.contacts) {
        assert!((from.normal.angle_to(to.normal) - turn).abs() < 1e-12);
        assert!((to.point - to.normal.get() * r).length() < 1e-12);
    }
    assert!(felt.contacts[0].normal.angle_to(-felt.contacts[1].normal) < 1e-12);
}

/// Oracle: the equations of motion with Coulomb friction, the upper palm on a spring that squeezes.
#[test]
fn a_stroke_ends_where_the_equations_of_motion_bring_the_body() {
    let (axes, aside, turn) = (DVec3::new(0.03, 0.028, 0.025), 0.4, 0.6);
    let workspace = ParallelWorkspace::for_size(0.055, 0.9);
    let start = DQuat::from_rotation_z(aside);
    let mut palms = palms_on(axes, workspace, start);
    let felt = palms.roll(aside, turn).unwrap();
    assert_eq!(felt.stop, None);

    let shift = |direction: DVec3, height: f64, start: f64, duration: f64| MotionPart::Shift {
        direction: Direction::new(direction).unwrap(),
        law: MotionLaw::Ramp { height, start, duration },
    };
    let heading = DVec3::new(aside.cos(), aside.sin(), 0.0);
    // 3 N of squeeze, then the stroke, in 20 natural times or so.
    let parts = vec![shift(-DVec3::Z, 0.003, 0.0, 0.2), shift(heading, felt.way, 0.3, 1.5)];
    let down =
        SurfacePose::new(DVec3::new(0.0, 0.0, 2.0 * axes.z), DQuat::from_rotation_x(std::f64::consts::PI));
    let upper = PalmSpring {
        command: SurfaceMotion::Parts { pose: down.unwrap(), parts },
        stiffness: DMat3::from_diagonal(DVec3::new(1e5, 1e5, 1e3)),
        damping: DMat3::from_diagonal(DVec3::new(100.0, 100.0, 10.0)),
        mass: 0.05,
    };
    let table = SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap();
    let palm = |drive| ScenePalm { surface: PalmSurface::Plane, drive, friction: workspace.friction };
    let lower = PalmDrive::Prescribed(SurfaceMotion::immobile(table));
    let body = Ellipsoid::new(axes).unwrap();
    assert!((body.point(Direction::Z) - DVec3::Z * axes.z).length() < 1e-15);
    let mass = MassProperties::uniform_ellipsoid(0.02, axes).unwrap();
    let scene =
        ContactScene::new(body, mass, vec![palm(PalmDrive::Spring(upper)), palm(lower)], 0.0).unwrap();
    let still = BodyState { p_WCm: DVec3::Z * axes.z, R_WO: start, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    let times = SampleTimes { duration: 2.0, rate: 50.0 };
    let run = scene.simulate(&ContactStart::touching(still), times, 1e-8).unwrap();
    let last = run.instants.last().unwrap();
    let off = (last.state.body.R_WO.inverse() * felt.hold.R_WO).to_axis_angle().1;
    let off = off.min(std::f64::consts::TAU - off);
    let turned = (last.state.body.R_WO.inverse() * start).to_axis_angle().1;
    println!("turned by {turned:.6}, off by {off:.2e} rad");
    assert!((turned - turn).abs() < 0.02, "{turned}");
    assert!(off < 2e-3, "{off:.1e} rad from where the stroke ends, of {turn}");
}

#[test]
fn the_ratio_of_forces_is_the_slope_of_the_width() {
    let axes = DVec3::new(1.4, 1.0, 0.9);
    let body = ellipsoid(axes);
    let width = |u: DVec3| (axes * u.normalize()).length() * 2.0;
    // A stop is where the slope is what friction holds.
    let workspace = ParallelWorkspace { pad: 100.0, ..ParallelWorkspace::for_size(2.2, 0.3) };
    let mut palms = SimulatedParallelPalms::new(&body, workspace, DQuat::IDENTITY).unwrap();
    let felt = palms.roll(0.0, 1.5).unwrap();
    assert_eq!(felt.stop, Some(Stop::Shear));
    let u = felt.contacts[0].normal;
    let (e, f) = u.tangent_basis();
    let h = 1e-5;
    let slope = |t: DVec3| (width(u.get() + t * h) - width(u.get() - t * h)) / (2.0 * h);
    let ratio = slope(e).hypot(slope(f)) / width(u.get());
    assert!(ratio <= workspace.most_shear() + 1e-9 && ratio > workspace.most_shear() - 0.02, "{ratio}");
    // And back.
    assert_eq!(palms.roll(std::f64::consts::PI, 0.3).unwrap().stop, None);
}

fn task(goal: f64, size: f64, friction: f64) -> ParallelTask {
    ParallelTask::new(Goal::Gap(goal), ParallelWorkspace::for_size(size, friction))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn bodies_are_between_the_bounds_and_the_same_seed_rolls_them_alike(
        a in 1.0..1.5f64, b in 1.0..1.5f64, seed in 0..1000u64, which in 0..5usize,
    ) {
        let axes = DVec3::new(1.0, 1.0 / a, 1.0 / b);
        let task = task(0.4, 2.0 * (axes.x + axes.y + axes.z) / 3.0, 1.0);
        let run = || {
            let planner: &mut dyn ParallelPlanner = match which {
                0 => &mut PathRate::new(seed, 2),
                1 => &mut NearestGap::new(seed),
                2 => &mut LargestGap::new(seed),
                3 => &mut RasterSweep::new(),
                _ => &mut RandomStrokes::new(seed),
            };
            let mut palms = palms_on(axes, task.workspace, Source::new(seed).rotation());
            let (mut known, mut steps) = (SpaceKnowledge::exact(), Vec::new());
            let outcome = explore_parallel(&mut known, planner, &mut palms, &task, |step, known| {
                steps.push(*step);
                for u in <Direction as Heading>::spread(50) {
                    let (low, high) = known.support(u);
                    let h = (axes * u.get()).length();
                    assert!(low - 1e-9 <= h && h <= high + 1e-9);
                }
                assert!(step.reading.hold.pads.iter().all(|pad| pad.length() <= task.workspace.pad));
            });
            (outcome.unwrap(), steps)
        };
        let (outcome, steps) = run();
        prop_assert!(outcome.is_reached() || which > 2, "{:?}", outcome);
        prop_assert!(steps.windows(2).all(|s| s[1].way >= s[0].way && s[1].progress <= s[0].progress + 1e-12));
        let (again, the_same) = run();
        prop_assert_eq!(&again, &outcome);
        prop_assert!(steps == the_same);
    }
}

/// Palms that sense, with an observer of what they sense: nothing else is known of the body.
#[test]
fn bodies_are_between_the_bounds_of_what_an_observer_tells() {
    let noise = RollingNoise { contact: 2e-3, palm: 2e-4, spin: 1e-3 };
    let spending = Spending::Budget(120);
    let mut reached = 0;
    for seed in 0..6 {
        let axes = DVec3::new(1.0, 0.9, 0.85);
        let task = ParallelTask { spending: Some(spending), ..task(0.35, 1.83, 1.0) };
        let palms = palms_on(axes, task.workspace, Source::new(seed).rotation());
        let (R, p) = palms.pose();
        let mut palms = EstimatedPalms::new(palms.with_noise(noise, seed), noise).unwrap();
        let confidence = Confidence::new(0.95, spending).unwrap();
        let mut known = SpaceKnowledge::noisy(Noise { point: noise.palm, normal: 0.0, confidence });
        let outcome =
            explore_parallel(&mut known, &mut PathRate::new(seed, 1), &mut palms, &task, |_, known| {
                for u in <Direction as Heading>::spread(50) {
                    let (low, high) = known.support(u);
                    let h = (axes * (R.inverse() * u.get())).length() + p.dot(u.get());
                    // Six runs at 95 %: none is expected to fail, nor does with these seeds.
                    assert!(low - 1e-9 <= h && h <= high + 1e-9, "{low} {h} {high}");
                }
            });
        reached += usize::from(outcome.unwrap().is_reached());
        // The axes are those of the world at first, and what is told of the turn holds.
        let pose = palms.pose();
        assert!(pose.deviations().0 > 1e-3 && pose.deviations().0 < 0.02, "{:?}", pose.deviations());
    }
    assert!(reached >= 4, "{reached}");
}

/// What slides on its palm has another height than what rolls.
struct Sliding<P>(P, DVec3);

impl<P: SensedPalms> SensedPalms for Sliding<P> {
    fn sense(&mut self) -> Result<RollingReading, ParallelPalmsError> {
        self.0.sense()
    }

    fn stroke(
        &mut self,
        heading: f64,
        turn: f64,
    ) -> Result<(Vec<RollingReading>, Option<Stop>), ParallelPalmsError> {
        let (mut sensed, stop) = self.0.stroke(heading, turn)?;
        for reading in &mut sensed {
            self.1 += glam::DVec2::from_angle(heading).extend(0.0) * 5e-3;
            reading.upper += self.1;
            reading.contacts[0] -= self.1.truncate();
        }
        Ok((sensed, stop))
    }
}

#[test]
fn a_palm_that_slides_ahead_is_told_and_what_was_learned_before_stays() {
    let noise = RollingNoise { contact: 1e-3, palm: 1e-4, spin: 0.0 };
    let axes = DVec3::new(1.0, 0.8, 0.7);
    let task = ParallelTask { spending: Some(Spending::Budget(120)), ..task(0.2, 1.67, 1.0) };
    let palms = palms_on(axes, task.workspace, Source::new(4).rotation()).with_noise(noise, 4);
    let mut palms = EstimatedPalms::new(Sliding(palms, DVec3::ZERO), noise).unwrap();
    let confidence = Confidence::new(0.95, Spending::Budget(120)).unwrap();
    let mut known = SpaceKnowledge::noisy(Noise { point: noise.palm, normal: 0.0, confidence });
    let ended = explore_parallel(&mut known, &mut RasterSweep::new(), &mut palms, &task, |_, _| ());
    let error = ended.unwrap_err();
    assert!(
        matches!(error, ParallelError::Palms(ParallelPalmsError::Sensed(RollingError::Slipped { .. }))),
        "{error}"
    );
    assert!(known.touches() >= 2);
}

#[test]
fn what_friction_does_not_let_be_reached_is_said() {
    let axes = DVec3::new(2.0, 1.0, 0.9);
    let task = task(0.1, 2.6, 0.15);
    let mut palms = palms_on(axes, task.workspace, DQuat::from_rotation_x(0.4));
    let mut known = SpaceKnowledge::exact();
    let outcome =
        explore_parallel(&mut known, &mut PathRate::new(1, 1), &mut palms, &task, |_, _| ()).unwrap();
    let Outcome::Short { shortfall: Shortfall::NotFound { directions }, certificate } = outcome else {
        panic!("{outcome:?}")
    };
    assert!(!directions.is_empty() && directions.iter().all(|d| d.len() == 3));
    // What is left is towards the long axis, where the width is steepest on the way.
    assert!(directions[0][0].abs() > 0.5, "{directions:?}");
    assert!(certificate.proven > 0.1);
}

#[test]
fn what_is_no_task_is_named() {
    let good = task(0.3, 2.0, 0.5);
    let try_it = |task: &ParallelTask| {
        let mut palms = palms_on(DVec3::ONE, good.workspace, DQuat::IDENTITY);
        let mut known = SpaceKnowledge::exact();
        explore_parallel(&mut known, &mut RasterSweep::new(), &mut palms, task, |_, _| ())
    };
    let with = |workspace: ParallelWorkspace| ParallelTask { workspace, ..good };
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for workspace in [
            ParallelWorkspace { friction: value, ..good.workspace },
            ParallelWorkspace { pad: value, ..good.workspace },
            ParallelWorkspace { size: value, ..good.workspace },
        ] {
            let error = try_it(&with(workspace)).unwrap_err();
            assert!(matches!(error, ParallelError::Workspace(ParallelWorkspaceError::Positive { .. })));
        }
    }
    let error = try_it(&with(ParallelWorkspace { share: 1.5, ..good.workspace })).unwrap_err();
    assert_eq!(error, ParallelError::Workspace(ParallelWorkspaceError::Share { value: 1.5 }));
    let error = try_it(&ParallelTask { goal: Goal::Gap(0.0), ..good }).unwrap_err();
    assert!(matches!(error, ParallelError::Goal(_)), "{error}");
    for spacing in [0.0, f64::NAN] {
        assert!(matches!(try_it(&ParallelTask { spacing, ..good }), Err(ParallelError::Setting { .. })));
    }
    let mut palms = palms_on(DVec3::ONE, good.workspace, DQuat::IDENTITY);
    assert!(matches!(palms.roll(f64::NAN, 1.0), Err(ParallelPalmsError::Stroke { .. })));
    assert!(matches!(palms.roll(0.0, f64::INFINITY), Err(ParallelPalmsError::Stroke { .. })));
    // A goal that is met before anything is felt is none of a gap: its bounds have no size yet.
    let mut known = SpaceKnowledge::exact();
    let wide = ParallelTask { goal: Goal::Gap(0.999), ..good };
    let outcome =
        explore_parallel(&mut known, &mut RasterSweep::new(), &mut palms, &wide, |_, _| ()).unwrap();
    assert!(outcome.is_reached() && known.touches() > 3);
}
