//! Laws that hold for any body on any three palms, and the errors of scenes that cannot be.

use contact_kinematics::*;
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::*;
use proptest::prelude::*;

type Body = MinkowskiSum<Ellipsoid, PolynomialSupport>;

fn body(axes: DVec3, offset: DVec3, dent: f64) -> Body {
    let mut terms = vec![Monomial { powers: [1, 1, 1], coefficient: dent }];
    for axis in 0..3 {
        let mut powers = [0; 3];
        powers[axis] = 1;
        terms.push(Monomial { powers, coefficient: offset[axis] });
    }
    MinkowskiSum(Ellipsoid::new(axes).unwrap(), PolynomialSupport::new(terms).unwrap())
}

#[derive(Debug)]
struct Case {
    scene: ThreePalmScene<Body>,
    start: InitialMotion,
    t: f64,
}

fn vector(low: f64, high: f64) -> impl Strategy<Value = DVec3> {
    (low..high, low..high, low..high).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn case() -> impl Strategy<Value = Case> {
    let palm = (-0.4..0.4f64, 0.5..1.2f64, 0.0..0.2f64, 0.5..3.0f64, 0.0..6.0f64);
    let shape = (vector(1.4, 2.5), vector(-0.3, 0.3), 0.0..0.08f64);
    let inertia = (0.5..3.0f64, vector(0.8, 1.2), vector(-1.0, 1.0));
    (shape, inertia, [palm.clone(), palm.clone(), palm], vector(-3.0, 3.0), vector(-1.0, 1.0), 0.0..5.0f64)
        .prop_map(|((axes, offset, dent), (mass, moments, turn), palms, start, w_WO, t)| {
            let axes_of_inertia = DMat3::from_quat(DQuat::from_scaled_axis(turn));
            let tensor = axes_of_inertia * DMat3::from_diagonal(mass * moments) * axes_of_inertia.transpose();
            let mut azimuth = 0.3;
            let palms = palms.map(|(shift, slope, amplitude, frequency, phase)| {
                azimuth += std::f64::consts::TAU / 3.0;
                Palm::new(azimuth + shift, MotionLaw::Sinusoid { mean: slope, amplitude, frequency, phase })
                    .unwrap()
            });
            let mass = MassProperties::new(mass, tensor).unwrap();
            let scene = ThreePalmScene::new(body(axes, offset, dent), mass, palms, 9.81).unwrap();
            Case { scene, start: InitialMotion { R_WO: DQuat::from_scaled_axis(start), w_WO }, t }
        })
}

proptest! {
    #[test]
    fn minimal_and_multiplier_forms_agree(case in case()) {
        let now = case.scene.instant(case.t, case.start.R_WO, case.start.w_WO).unwrap();
        let state = BodyState {
            p_WCm: now.touch.p_WCm,
            R_WO: now.R_WO,
            v_WCm: now.rates.v_WCm,
            w_WO: now.w_WO,
        };
        let other = case.scene.multiplier_form(case.t, &state).unwrap().unwrap();
        let (a, b) = (&now.accelerations, &other.accelerations);
        let scale = 1.0 + a.alpha_WO.length() + a.a_WCm.length();
        prop_assert!((a.alpha_WO - b.alpha_WO).length() < 1e-12 * scale);
        prop_assert!((a.a_WCm - b.a_WCm).length() < 1e-12 * scale);
        for i in 0..3 {
            prop_assert!((a.forces[i] - b.forces[i]).abs() < 1e-11 * scale);
            prop_assert!(other.gaps[i].abs() < 1e-13 && other.gap_rates[i].abs() < 1e-13);
        }
    }

    #[test]
    fn newton_and_euler_hold(case in case()) {
        let now = case.scene.instant(case.t, case.start.R_WO, case.start.w_WO).unwrap();
        let mass = case.scene.mass();
        let R = DMat3::from_quat(now.R_WO);
        let inertia = R * mass.inertia() * R.transpose();
        let (mut force, mut torque) = (mass.mass() * case.scene.gravity(), DVec3::ZERO);
        for i in 0..3 {
            let f = now.accelerations.forces[i] * now.palms[i].frame.n;
            force += f;
            torque += now.touch.contacts[i].b_W.cross(f);
        }
        let w = now.w_WO;
        let scale = 1.0 + force.length() + torque.length();
        prop_assert!((mass.mass() * now.accelerations.a_WCm - force).length() < 1e-12 * scale);
        let moment = inertia * now.accelerations.alpha_WO + w.cross(inertia * w);
        prop_assert!((moment - torque).length() < 1e-11 * scale);
    }

    #[test]
    fn energy_balance_holds_along_any_motion(case in case()) {
        let times = SampleTimes { duration: 0.2, rate: 100.0 };
        let Ok(simulation) = case.scene.simulate(case.start, times, Tolerance::uniform(1e-12)) else {
            // A palm would have to pull at the start: that is an error of its own, tested below.
            return Ok(());
        };
        let n = simulation.instants.len();
        prop_assume!(n >= 3);
        let used = &simulation.instants[..n - (n + 1) % 2];
        let work: f64 = used.windows(3).step_by(2)
            .map(|w| (w[0].palm_power() + 4.0 * w[1].palm_power() + w[2].palm_power()) / 300.0).sum();
        let gained = used.last().unwrap().energy(&case.scene) - used[0].energy(&case.scene);
        prop_assert!((gained - work).abs() < 1e-5, "{gained} {work}");
    }
}

fn ellipsoid_scene(gravity: f64) -> ThreePalmScene<Ellipsoid> {
    let axes = DVec3::new(2.5, 2.0, 1.0);
    let palms = [270.0, 30.0, 150.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, gravity).unwrap()
}

const TIMES: SampleTimes = SampleTimes { duration: 1.0, rate: 100.0 };
const SPIN: InitialMotion = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.3, 0.3) };

#[test]
fn impossible_scenes_are_named() {
    let axes = DVec3::ONE;
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let palm = |degrees: f64| Palm::fixed(degrees.to_radians(), 1.0).unwrap();
    let scene = |body: Box<dyn SupportFunction>, palms, g| ThreePalmScene::new(body, mass, palms, g).err();
    let apart = [palm(0.0), palm(120.0), palm(240.0)];
    let ball = || -> Box<dyn SupportFunction> { Box::new(Sphere::new(1.0).unwrap()) };
    assert!(matches!(
        scene(ball(), [palm(0.0), palm(0.0), palm(120.0)], 9.81),
        Some(SceneError::Palms { source: PalmError::Parallel { .. }, .. })
    ));
    assert!(matches!(scene(ball(), apart, -9.81), Some(SceneError::Gravity { .. })));
    assert!(matches!(scene(ball(), apart, f64::NAN), Some(SceneError::Gravity { .. })));
    let dented = Box::new(PolynomialSupport::egg(1.0, 0.1, 0.9).unwrap());
    assert!(matches!(scene(dented, apart, 9.81), Some(SceneError::Shape(ShapeError::NotConvex { .. }))));
    let inertias = ellipsoid_scene(9.81).with_palm_inertias([0.1, -0.1, 0.1]);
    assert!(matches!(inertias.err(), Some(SceneError::PalmInertia { palm: 2, .. })));
}

#[test]
fn impossible_starts_are_named() {
    let scene = ellipsoid_scene(9.81);
    let tolerance = Tolerance::uniform(1e-9);
    let run = |start, times| scene.simulate(start, times, tolerance).err();
    let still = InitialMotion { w_WO: DVec3::ZERO, ..SPIN };
    assert!(matches!(
        run(InitialMotion { w_WO: DVec3::NAN, ..SPIN }, TIMES),
        Some(SimulationError::InitialMotion { what: "angular velocity" })
    ));
    let no_turn = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert!(matches!(
        run(InitialMotion { R_WO: no_turn, ..SPIN }, TIMES),
        Some(SimulationError::InitialMotion { what: "orientation" })
    ));
    for times in [SampleTimes { duration: -1.0, ..TIMES }, SampleTimes { rate: f64::NAN, ..TIMES }] {
        assert!(matches!(run(still, times), Some(SimulationError::SampleTimes { .. })));
    }
    let endless = SampleTimes { duration: 1e9, rate: 1e9 };
    assert!(matches!(
        run(still, endless),
        Some(SimulationError::SampleTimes { what: "number of samples", .. })
    ));
    let fast = InitialMotion { w_WO: DVec3::new(0.0, 30.0, 0.0), ..SPIN };
    assert!(matches!(run(fast, TIMES), Some(SimulationError::NotInContact { .. })));
}

#[test]
fn without_gravity_nothing_holds_the_body() {
    let start = InitialMotion { w_WO: DVec3::ZERO, ..SPIN };
    let result = ellipsoid_scene(0.0).simulate(start, TIMES, Tolerance::uniform(1e-9));
    assert!(matches!(result, Err(SimulationError::NotInContact { .. })));
}

#[test]
fn palms_that_turn_parallel_end_the_simulation_with_an_error() {
    // Palms 1 and 2 sink towards the horizontal together: their normals meet at vertical.
    let axes = DVec3::new(1.2, 1.0, 0.9);
    let sink = |azimuth| Palm::new(azimuth, MotionLaw::Steady { start: 0.6, rate: -0.6 }).unwrap();
    let palms = [sink(0.0), sink(2.1), Palm::fixed(4.2, 0.6).unwrap()];
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::ZERO };
    match scene.simulate(start, SampleTimes { duration: 2.0, rate: 100.0 }, Tolerance::uniform(1e-9)) {
        // Whichever comes first: contact is lost, or the equations become singular. Never a NaN.
        Ok(simulation) => {
            assert!(matches!(simulation.end, End::ContactLost { .. }));
            assert!(simulation.instants.iter().all(|now| now.w_WO.is_finite()));
        }
        Err(error) => assert!(matches!(error, SimulationError::Integration(_)), "{error}"),
    }
}

#[test]
fn torques_are_forces_times_levers() {
    let scene = ellipsoid_scene(9.81).with_palm_inertias([0.1, 0.2, 0.3]).unwrap();
    let simulation = scene.simulate(SPIN, TIMES, Tolerance::uniform(1e-10)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap();
    for palm in log.samples().iter().flat_map(|s| &s.palms) {
        let lever = palm.contact.unwrap()[1];
        assert!((palm.torque.unwrap() - palm.force.unwrap() * lever).abs() < 1e-12);
    }
}

#[cfg(feature = "noise")]
#[test]
fn noise_has_its_deviation_and_its_seed() {
    let scene = ellipsoid_scene(9.81);
    let times = SampleTimes { duration: 4.0, rate: 1000.0 };
    let log = scene.simulate(SPIN, times, Tolerance::uniform(1e-9)).unwrap().sensor_log(&scene).unwrap();
    let noise = SensorNoise { contact: 0.01, force: 0.1, torque: 0.0 };
    let noisy = log.with_noise(&noise, 7).unwrap();
    assert_eq!(noisy, log.with_noise(&noise, 7).unwrap());
    assert_ne!(noisy, log.with_noise(&noise, 8).unwrap());
    assert_eq!(noisy.truth(), log.truth());
    let pairs = || noisy.samples().iter().zip(log.samples()).flat_map(|(a, b)| a.palms.iter().zip(&b.palms));
    let deviation =
        |values: Vec<f64>| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let force = deviation(pairs().map(|(a, b)| a.force.unwrap() - b.force.unwrap()).collect());
    let contact = deviation(pairs().map(|(a, b)| a.contact.unwrap()[0] - b.contact.unwrap()[0]).collect());
    // 12003 draws: the deviation is known to 1 / sqrt(2 * 12003) = 0.65 %; 4 of those.
    assert!((force / 0.1 - 1.0).abs() < 0.026 && (contact / 0.01 - 1.0).abs() < 0.026, "{force} {contact}");
    let absurd = SensorNoise { force: f64::NAN, ..noise };
    assert!(matches!(log.with_noise(&absurd, 7), Err(LogError::ReadingNotFinite { what: "force", .. })));
}
