//! Modes of several contacts: agreement of formulations, invariants, and where rigid bodies have no answer.

use contact_kinematics::{
    Direction, Ellipsoid, MotionLaw, MotionPart, Palm, PalmSurface, SupportFunction, SurfaceMotion,
    SurfacePose,
};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::*;
use proptest::prelude::*;
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

const G: f64 = 9.81;

fn ellipsoid() -> (Ellipsoid, MassProperties) {
    let axes = DVec3::new(0.05, 0.04, 0.03);
    (Ellipsoid::new(axes).unwrap(), MassProperties::uniform_ellipsoid(0.2, axes).unwrap())
}

/// Three planes through the origin at 55 degrees to the horizontal, a third of a turn apart.
pub(crate) fn funnel(friction: f64) -> Vec<ScenePalm> {
    let palm = |k: u32| {
        let frame = contact_kinematics::PalmFrame::from_azimuth_slope(f64::from(k) * 2.1, 0.96);
        let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation())).unwrap();
        ScenePalm {
            surface: PalmSurface::Plane,
            drive: PalmDrive::Prescribed(SurfaceMotion::immobile(pose)),
            friction,
        }
    };
    (0..3).map(palm).collect()
}

/// A body that touches all three planes of a funnel at a given orientation and angular velocity.
fn in_funnel(body: &Ellipsoid, palms: &[ScenePalm], R_WO: DQuat, w_WO: DVec3) -> BodyState {
    let states: Vec<_> = palms
        .iter()
        .map(|palm| match &palm.drive {
            PalmDrive::Prescribed(motion) => motion.at(0.0),
            _ => unreachable!(),
        })
        .collect();
    let n = [0, 1, 2].map(|i| states[i].R_WP.z_axis);
    let matrix = DMat3::from_cols(n[0], n[1], n[2]).transpose();
    let jets = n.map(|n| body.jet(Direction::new(R_WO.inverse() * -n).unwrap()));
    let p_WCm = matrix.inverse() * DVec3::from_array(jets.map(|jet| jet.value));
    // n . (v + w x b) = 0 on palms at rest.
    let lift = [0, 1, 2].map(|i| -n[i].dot(w_WO.cross(R_WO * jets[i].point)));
    BodyState { p_WCm, R_WO, v_WCm: matrix.inverse() * DVec3::from_array(lift), w_WO }
}

pub(crate) fn energy_defect(scene: &ContactScene<Ellipsoid>, simulation: &ContactSimulation) -> f64 {
    let first = scene.energy(&simulation.instants[0].state.body);
    let defect = |now: &ContactInstant| {
        scene.energy(&now.state.body) - first - now.friction_work - now.palm_work - now.blow_work
    };
    simulation.instants.iter().map(|now| defect(now).abs()).fold(0.0, f64::max)
}

/// Largest violation of gaps (m), cones (N) and sticking (m/s) over a run.
pub(crate) fn violations(scene: &ContactScene<Ellipsoid>, simulation: &ContactSimulation) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    for now in &simulation.instants {
        for (i, mode) in now.modes.iter().enumerate() {
            let (gap, force) = (now.contacts[i].gap, now.forces[i]);
            let normal = now.contacts[i].n.dot(force);
            let tangential = now.contacts[i].in_tangent(force).length();
            match mode {
                ContactMode::Off => worst[0] = worst[0].max(-gap),
                _ => worst[0] = worst[0].max(gap.abs()),
            }
            worst[1] = worst[1].max(-normal).max(tangential - scene.palms()[i].friction * normal);
            if *mode == ContactMode::Stick {
                worst[2] = worst[2].max(now.rates[i].slip.length());
            }
        }
    }
    worst
}

struct Random(Pcg64);

impl Random {
    fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }
    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn direction(&mut self) -> DVec3 {
        loop {
            let v = DVec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - DVec3::ONE;
            if v.length() > 0.1 && v.length() < 1.0 {
                return v.normalize();
            }
        }
    }
    fn rotation(&mut self) -> DQuat {
        DQuat::from_axis_angle(self.direction(), 6.0 * self.unit())
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn three_frictionless_planes_are_the_minimal_coordinates(seed in 0..u64::MAX) {
        let mut random = Random::new(seed);
        let (body, mass) = ellipsoid();
        let law = |random: &mut Random| MotionLaw::Sinusoid { mean: 1.0, amplitude: 0.1, frequency: 3.0, phase: 6.0 * random.unit() };
        let laws: Vec<MotionLaw> = (0..3).map(|_| law(&mut random)).collect();
        let palms = [0, 1, 2].map(|k| Palm::new(2.1 * k as f64, laws[k]).unwrap());
        let minimal = ThreePalmScene::new(body, mass, palms, G).unwrap();
        let (R_WO, w_WO) = (random.rotation(), 3.0 * random.direction());
        let now = minimal.instant(0.0, R_WO, w_WO).unwrap();
        let general = palms.map(|palm| {
            // A palm of slope zero, turned about its horizontal axis through the origin.
            let frame = contact_kinematics::PalmFrame::from_azimuth_slope(palm.azimuth(), 0.0);
            let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation())).unwrap();
            let axis = Direction::new(frame.t1).unwrap();
            let parts = vec![MotionPart::Turn { pivot: DVec3::ZERO, axis, law: palm.motion() }];
            let drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts });
            ScenePalm { surface: PalmSurface::Plane, drive, friction: 0.0 }
        });
        let scene = ContactScene::new(body, mass, general.to_vec(), G).unwrap();
        let state = BodyState { p_WCm: now.touch.p_WCm, R_WO, v_WCm: now.rates.v_WCm, w_WO };
        let other = scene
            .instant(&SceneState { t: 0.0, body: state, palms: scene.palms_at_start() }, &[ContactMode::Slide; 3])
            .unwrap();
        let size = 1.0 + now.accelerations.alpha_WO.length();
        prop_assert!((other.alpha_WO - now.accelerations.alpha_WO).length() < 1e-10 * size);
        prop_assert!((other.a_WCm - now.accelerations.a_WCm).length() < 1e-11 * size);
        for i in 0..3 {
            prop_assert!(other.contacts[i].gap.abs() < 1e-15 && other.rates[i].gap_rate.abs() < 1e-14);
            prop_assert!((other.contacts[i].n.dot(other.forces[i]) - now.accelerations.forces[i]).abs() < 1e-10 * size);
        }
    }
}

#[test]
fn runs_agree_with_the_minimal_coordinates() {
    let (body, mass) = ellipsoid();
    let palms = funnel(0.0);
    let start = in_funnel(
        &body,
        &palms,
        DQuat::from_axis_angle(DVec3::ONE.normalize(), 0.4),
        DVec3::new(0.5, -0.3, 0.2),
    );
    let scene = ContactScene::new(body, mass, palms, G).unwrap();
    let times = SampleTimes { duration: 1.0, rate: 10.0 };
    let general = scene.simulate(&ContactStart::touching(start), times, 1e-12).unwrap();
    let palms = [0, 1, 2].map(|k| Palm::fixed(f64::from(k) * 2.1, 0.96).unwrap());
    let minimal = ThreePalmScene::new(body, mass, palms, G).unwrap();
    let first = InitialMotion { R_WO: start.R_WO, w_WO: start.w_WO };
    let minimal = minimal.simulate(first, times, Tolerance::uniform(1e-13)).unwrap();
    for (a, b) in general.instants.iter().zip(&minimal.instants) {
        assert!((a.state.body.p_WCm - b.touch.p_WCm).length() < 1e-10);
        assert!((a.state.body.w_WO - b.w_WO).length() < 1e-8);
    }
    assert_eq!(general.instants.len(), minimal.instants.len());
    assert!(energy_defect(&scene, &general) < 1e-11);
}

#[test]
fn energy_cones_and_gaps_hold_over_ten_seconds_of_every_mode() {
    let (body, mass) = ellipsoid();
    let (mut seen, mut changes) = ([false; 3], 0);
    for (seed, friction, drop) in [(1, 0.05, 0.0), (2, 0.3, 0.0), (3, 0.0, 0.0), (4, 0.2, 0.05)] {
        let palms = funnel(friction);
        let mut random = Random::new(seed);
        let mut start = in_funnel(&body, &palms, random.rotation(), 6.0 * random.direction());
        start.p_WCm.z += drop;
        let scene = ContactScene::new(body, mass, palms, G).unwrap();
        let times = SampleTimes { duration: 10.0, rate: 20.0 };
        let from = ContactStart { in_flight: drop > 0.0, ..ContactStart::touching(start) };
        let simulation = scene.simulate(&from, times, 1e-11).unwrap();
        let energy = scene.energy(&start).abs();
        let defect = energy_defect(&scene, &simulation);
        assert!(defect < 1e-10 * energy.max(0.1), "friction {friction}: {defect:.1e} J");
        let [gap, cone, creep] = violations(&scene, &simulation);
        assert!(gap < 1e-9 && cone < 1e-9 && creep < 1e-12, "{friction}: {gap:.1e} {cone:.1e} {creep:.1e}");
        changes += simulation.events.len();
        for now in &simulation.instants {
            now.modes.iter().for_each(|mode| seen[mode.number() as usize] = true);
        }
    }
    assert!(seen == [true; 3] && changes >= 8, "{seen:?} {changes}");
}

#[test]
fn the_error_falls_with_the_tolerance_through_located_events() {
    // An ellipsoid spins and slides on a plane until it sticks: the event is at another place for every tolerance.
    let (body, mass) = ellipsoid();
    let palms = vec![ScenePalm {
        surface: PalmSurface::Plane,
        drive: PalmDrive::Prescribed(SurfaceMotion::immobile(
            SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).unwrap(),
        )),
        friction: 0.4,
    }];
    let R_WO = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 0.7);
    let h = body.value(Direction::new(R_WO.inverse() * -DVec3::Z).unwrap());
    let b = R_WO * body.point(Direction::new(R_WO.inverse() * -DVec3::Z).unwrap());
    let w_WO = DVec3::new(1.0, -3.0, 2.0);
    let v_WCm = DVec3::new(0.3, 0.1, -w_WO.cross(b).z);
    let start = BodyState { p_WCm: h * DVec3::Z, R_WO, v_WCm, w_WO };
    let scene = ContactScene::new(body, mass, palms, G).unwrap();
    let run = |tolerance: f64| {
        let times = SampleTimes { duration: 0.4, rate: 10.0 };
        scene.simulate(&ContactStart::touching(start), times, tolerance).unwrap()
    };
    let exact = run(1e-13);
    assert!(!exact.events.is_empty());
    let place = |s: &ContactSimulation| s.instants.last().unwrap().state.body.p_WCm;
    let error = |tolerance: f64| (place(&run(tolerance)) - place(&exact)).length();
    let errors = [1e-5, 1e-7, 1e-9, 1e-11].map(error);
    // In proportion to the tolerance, a decade more or less, and never far above it.
    let fall = (errors[0] / errors[3]).log10();
    assert!((4.5..7.5).contains(&fall), "{errors:?}");
    assert!(errors.iter().zip([1e-5, 1e-7, 1e-9, 1e-11]).all(|(e, t)| *e < 10.0 * t), "{errors:?}");
}

/// A body that slides on `count` planes with random normals and slip directions.
fn sliding(random: &mut Random, count: usize, friction: f64) -> (ContactScene<Ellipsoid>, BodyState) {
    let (body, mass) = ellipsoid();
    let R_WO = random.rotation();
    let start = BodyState { p_WCm: DVec3::ZERO, R_WO, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    let mut palms = Vec::new();
    for _ in 0..count {
        let n = random.direction();
        let c = R_WO * body.point(Direction::new(R_WO.inverse() * -n).unwrap());
        let slip = random.direction().cross(n).normalize();
        let pose = SurfacePose::new(c, DQuat::from_rotation_arc(DVec3::Z, n)).unwrap();
        let law = MotionLaw::Steady { start: 0.0, rate: -1.0 };
        let parts = vec![MotionPart::Shift { direction: Direction::new(slip).unwrap(), law }];
        let drive = PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts });
        palms.push(ScenePalm { surface: PalmSurface::Plane, drive, friction });
    }
    (ContactScene::new(body, mass, palms, G).unwrap(), start)
}

#[test]
fn wedged_states_are_named_and_not_integrated_through() {
    let mut random = Random::new(7);
    let (mut wedged, states) = (0, 600);
    for _ in 0..states {
        let (scene, body) = sliding(&mut random, 3, 0.5);
        let state = SceneState { t: 0.0, body, palms: scene.palms_at_start() };
        let minor = scene.wedging(&state, &[ContactMode::Slide; 3]).unwrap();
        let run =
            scene.simulate(&ContactStart::touching(body), SampleTimes { duration: 1e-6, rate: 1e6 }, 1e-8);
        if minor <= 0.0 {
            wedged += 1;
            let Err(ContactSimulationError::Modes { state: named, .. }) = run else {
                panic!("integrated through")
            };
            assert!(
                (named.body.p_WCm - body.p_WCm).length() < 1e-12
                    && named.body.R_WO.dot(body.R_WO) > 1.0 - 1e-12
            );
        } else {
            assert!(run.is_ok(), "{:?}", run.err());
        }
    }
    // 0.181 of such states; a deviation of 600 is 0.016.
    let share = f64::from(wedged) / f64::from(states);
    assert!((share - 0.181).abs() < 3.0 * 0.016, "{share}");
}

#[test]
fn bad_scenes_and_starts_are_named() {
    let (body, mass) = ellipsoid();
    let mut palms = funnel(0.3);
    palms[1].friction = -0.1;
    let error = ContactScene::new(body, mass, palms, G).unwrap_err().to_string();
    assert!(error.contains("palm 2") && error.contains("-0.1"), "{error}");
    let cup = ScenePalm { surface: PalmSurface::Cup { radius: 0.05 }, ..funnel(0.3)[0].clone() };
    let error = ContactScene::new(body, mass, vec![cup], G).unwrap_err().to_string();
    assert!(error.contains("largest radius of curvature"), "{error}");
    assert!(ContactScene::new(body, mass, vec![], G).is_err());
    let palms = funnel(0.3);
    let start = in_funnel(&body, &palms, DQuat::IDENTITY, DVec3::ZERO);
    let scene = ContactScene::new(body, mass, palms, G).unwrap();
    let times = SampleTimes { duration: 0.1, rate: 100.0 };
    let run = |body| scene.simulate(&ContactStart::touching(body), times, 1e-9);
    let lower = BodyState { p_WCm: start.p_WCm - 0.01 * DVec3::Z, ..start };
    assert!(
        matches!(run(lower), Err(ContactSimulationError::Penetration { depth, .. }) if (depth - 0.01 * 0.96_f64.cos()).abs() < 1e-9)
    );
    let higher = BodyState { p_WCm: start.p_WCm + 0.01 * DVec3::Z, ..start };
    assert!(matches!(run(higher), Err(ContactSimulationError::NotInContact { gap, .. }) if gap > 5e-3));
    assert!(run(BodyState { w_WO: DVec3::NAN, ..start }).is_err());
    assert!(run(BodyState { R_WO: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0), ..start }).is_err());
    let mut palms = funnel(0.3);
    palms[2].friction = 1e300;
    let error = ContactScene::new(body, mass, palms, G).unwrap_err().to_string();
    assert!(error.contains("palm 3") && error.contains("from 0 to 100"), "{error}");
}

#[test]
fn palms_that_overlap_are_named() {
    let (body, mass) = ellipsoid();
    let palm = |surface, p: DVec3, R: DQuat| ScenePalm {
        surface,
        drive: PalmDrive::Prescribed(SurfaceMotion::immobile(SurfacePose::new(p, R).unwrap())),
        friction: 0.5,
    };
    let still = DQuat::IDENTITY;
    let high = BodyState { p_WCm: DVec3::Z, R_WO: still, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO };
    let start = ContactStart { body: high, palms: None, in_flight: true };
    let times = SampleTimes { duration: 0.01, rate: 100.0 };
    let depth = |pair: [ScenePalm; 2]| {
        let scene = ContactScene::new(body, mass, pair.to_vec(), G).unwrap();
        match scene.simulate(&start, times, 1e-9) {
            Err(ContactSimulationError::PalmsOverlap { first: 1, second: 2, depth }) => Some(depth),
            Ok(_) => None,
            Err(other) => panic!("{other}"),
        }
    };
    let tip = |x: f64| palm(PalmSurface::Sphere { radius: 0.02 }, DVec3::X * x, still);
    let rod = |z: f64, R| palm(PalmSurface::Cylinder { radius: 0.02 }, DVec3::Z * z, R);
    let floor = palm(PalmSurface::Plane, DVec3::ZERO, still);
    let tilted = palm(PalmSurface::Plane, DVec3::ZERO, DQuat::from_rotation_y(0.3));
    let cup = palm(PalmSurface::Cup { radius: 3.0 }, DVec3::ZERO, still);
    for (pair, expected) in [
        ([tip(0.2), tip(0.23)], 0.01),
        ([floor.clone(), tip(0.0)], 0.02),
        ([cup.clone(), tip(2.99)], 0.01),
        // Along the plane, in either order; its axis given to six digits.
        ([floor.clone(), rod(0.015, still)], 0.005),
        ([rod(0.015, DQuat::from_rotation_y(5e-7)), floor.clone()], 0.005),
        ([rod(0.015, still), rod(-0.015, DQuat::from_rotation_z(1.0))], 0.01),
    ] {
        let found = depth(pair).unwrap();
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
    }
    for (same, kind) in [(floor.clone(), "flat"), (cup, "cup")] {
        let scene = ContactScene::new(body, mass, vec![same.clone(), same], G).unwrap();
        let error = scene.simulate(&start, times, 1e-9).unwrap_err();
        assert_eq!(error, ContactSimulationError::PalmsCoincide { first: 1, second: 2, kind });
    }
    // What crosses a plane is no overlap, nor is what only comes near.
    let crossing = rod(0.015, DQuat::from_rotation_y(0.3));
    for pair in [[floor.clone(), crossing], [floor.clone(), rod(0.021, still)], [floor, tilted]] {
        assert_eq!(depth(pair), None);
    }
}

#[test]
fn without_any_force_a_body_spins_on_between_two_palms() {
    let (body, mass) = ellipsoid();
    let palm = |z: f64, R| {
        let pose = SurfacePose::new(DVec3::Z * z, R).unwrap();
        let drive = PalmDrive::Prescribed(SurfaceMotion::immobile(pose));
        ScenePalm { surface: PalmSurface::Plane, drive, friction: 0.4 }
    };
    let palms = vec![palm(-0.03, DQuat::IDENTITY), palm(0.03, DQuat::from_rotation_x(std::f64::consts::PI))];
    let scene = ContactScene::new(body, mass, palms, 0.0).unwrap();
    // About the axis through both contacts: nothing accelerates, whatever the modes are called.
    let start =
        BodyState { p_WCm: DVec3::ZERO, R_WO: DQuat::IDENTITY, v_WCm: DVec3::ZERO, w_WO: 5.0 * DVec3::Z };
    let times = SampleTimes { duration: 1.0, rate: 100.0 };
    let off = |tolerance: f64| {
        let run = scene.simulate(&ContactStart::touching(start), times, tolerance).unwrap();
        for BodyState { p_WCm, w_WO, .. } in run.instants.iter().map(|now| now.state.body) {
            assert!((w_WO - start.w_WO).length() < 1e-12 && p_WCm.length() < 1e-12);
        }
        let last = run.instants.last().unwrap().state;
        (last.body.R_WO * DVec3::X - DQuat::from_rotation_z(5.0 * last.t) * DVec3::X).length()
    };
    // Contacts without force are open, and steps then half a radian at most: better than any tolerance that allows them.
    let (coarse, fine) = (off(1e-8), off(1e-12));
    assert!(fine < 1e-11 && coarse < 1e-11, "{coarse:e} {fine:e}");
}

#[test]
fn motion_too_fast_to_follow_ends_with_its_spin() {
    let (body, mass) = ellipsoid();
    let palms = funnel(0.3);
    let start = in_funnel(&body, &palms, DQuat::IDENTITY, DVec3::ZERO);
    let scene = ContactScene::new(body, mass, palms, G).unwrap();
    let times = SampleTimes { duration: 10.0, rate: 100.0 };
    let spinning = BodyState { w_WO: DVec3::new(1e5, 2e5, 3e5), ..start };
    let error = scene.simulate(&ContactStart::touching(spinning), times, 1e-9).unwrap_err();
    assert!(matches!(error, ContactSimulationError::TooSlow { spin, .. } if spin > 1e4), "{error}");
}
