//! The estimator in the loop: bounds hold, goals are proven, what is wrong is named.

use contact_kinematics::planar::{FourierBody, RadiusFunction};
use exploration::planar::PlanarKnowledge;
use exploration::rolling::{
    Hands, HandsError, InformationRate, RollError, RollTask, SensedError, SensedOutcome, SensedStep,
    SensedTask, SimulatedHands, Workspace, explore_sensed, noisy_curves,
};
use exploration::{ConfidenceError, Goal, Heading, Knowledge, KnowledgeError};
use object_dynamics::planar::{PlanarMass, PlanarObject};
use observer::contacts::{ContactNoiseLevel, ImpulseNoise};
use observer::planar::{PlaneOptions, estimate_plane};
use shape_bounds::exact_hull::planar::Direction;

const GRAVITY: f64 = 9.81;
const RATE: f64 = 250.0;
/// Of contacts, m, and of forces, N: 0.1 % of the size and of the weight.
const NOISE: [f64; 2] = [5e-5, 2e-3];

fn shape() -> FourierBody {
    FourierBody::new(&[0.05, 0.002, 0.004, 0.0015], &[0.0, -0.003, 0.002, -0.001]).unwrap()
}

fn hands(phi: f64, seed: u64) -> SimulatedHands<FourierBody> {
    rubbing(0.0, phi, seed)
}

fn rubbing(friction: f64, phi: f64, seed: u64) -> SimulatedHands<FourierBody> {
    let mass = PlanarMass::from_gyration(0.2, 1.1e-3).unwrap();
    let object = PlanarObject { shape: shape(), mass, gravity: GRAVITY };
    SimulatedHands::new(object, friction, 0.4, [0.7, 2.4], phi, RATE).unwrap().with_noise(NOISE, seed)
}

fn task(gap: f64) -> SensedTask {
    let [contact, force_fixed] = NOISE;
    let impulse = Some(ImpulseNoise { fixed: force_fixed / RATE, share: 0.0 });
    let noise = ContactNoiseLevel { contact, force_fixed, force_share: 0.0, impulse, floor: 1e-6 };
    let friction = vec![Some(0.0); 2];
    let sensors = PlaneOptions::new(noise, GRAVITY, friction);
    let workspace = Workspace::in_motion(0.1, GRAVITY);
    SensedTask {
        roll: RollTask { motions: 12, ..RollTask::new(Goal::Gap(gap), workspace) },
        sensors,
        level: 0.95,
    }
}

fn run(phi: f64, seed: u64, task: &SensedTask) -> (SensedOutcome, Vec<SensedStep>) {
    let (mut hands, body) = (hands(phi, seed), shape());
    let (mut planner, mut steps) = (InformationRate::new(seed, 1).per_radian(), Vec::new());
    let ended = explore_sensed(&mut planner, &mut hands, task, |step, look| {
        steps.push(step.clone());
        let Some(look) = look.filter(|look| look.proven.bounds().is_some()) else { return };
        for u in Direction::spread(90) {
            let (low, high) = look.proven.support(u);
            // Axes of the estimate are those of the world at the first sample, where the body stood at `phi`.
            let h = body.jet(u.angle() - phi_of(phi, seed)).r;
            assert!(low <= h && h <= high, "{low} {h} {high} along {} after {step:?}", u.angle());
        }
    });
    (ended.unwrap(), steps)
}

/// Where the body is laid down from `phi` on.
fn phi_of(phi: f64, seed: u64) -> f64 {
    hands(phi, seed).start_phi()
}

/// A certificate under noise, of what was sensed alone.
#[test]
fn a_gap_is_proven_by_the_estimate_and_the_body_is_between_the_bounds() {
    let task = task(0.15);
    let (ended, steps) = run(0.3, 1, &task);
    let certificate = ended.certificate.unwrap();
    assert!(ended.short.is_none() && certificate.proven <= 0.15, "{:?}", ended.short);
    assert_eq!(certificate.confidence.map(|(level, _)| level), Some(0.95));
    assert!(steps.windows(2).all(|w| w[1].seconds > w[0].seconds && w[1].radians >= w[0].radians));
    assert_eq!(steps.last().unwrap().progress, certificate.proven);
    // The same seed gives the same run, to the last bit.
    assert_eq!(run(0.3, 1, &task).1, steps);
}

/// Palms whose friction is not known: the estimate tells it, and motions are predicted with it.
#[test]
fn palms_that_rub_are_planned_for_with_the_friction_that_was_felt() {
    let (mut hands, mut task) = (rubbing(0.2, 0.3, 1), task(0.3));
    task.sensors.friction = vec![None; 2];
    let (mut planner, mut told) = (InformationRate::new(1, 1).per_radian(), Vec::new());
    let (first, body) = (hands.start_phi(), shape());
    let ended = explore_sensed(&mut planner, &mut hands, &task, |_, look| {
        let Some(look) = look else { return };
        told.extend(look.track.dynamics.map(|dynamics| dynamics.friction));
        for u in Direction::spread(90).into_iter().filter(|_| look.proven.bounds().is_some()) {
            let (low, high) = look.proven.support(u);
            let h = body.jet(u.angle() - first).r;
            assert!(low <= h && h <= high, "{low} {h} {high} along {}", u.angle());
        }
    });
    assert!(ended.unwrap().short.is_none() && !told.is_empty());
    assert!(told.iter().all(|friction| (friction - 0.2).abs() < 0.01), "{told:?}");
}

#[test]
fn an_estimate_takes_no_contact_beside_it() {
    let mut hands = hands(0.3, 2);
    exploration::rolling::Hands::turn(&mut hands, [0.4, 2.2], 0.2, 0.4).unwrap();
    let log = exploration::rolling::Hands::log(&hands).unwrap();
    let estimate = estimate_plane(&log, &task(0.1).sensors).unwrap();
    let curves = noisy_curves(&log, &estimate, NOISE[0]);
    let mut known = PlanarKnowledge::estimated(&curves, 0.99, 0.95).unwrap();
    assert_eq!(known.confidence(), Some(0.95));
    let contact = curves[0][0].contact;
    assert_eq!(known.insert(contact), Err(KnowledgeError::Estimated));
}

/// A body that rests and rolls without slip between palms that rub: its contacts are known as well as their floor there, and nothing between samples is noise
/// that does not count.
#[test]
fn a_body_that_rolls_on_palms_that_rub_is_followed() {
    let mass = PlanarMass::from_gyration(0.2, 1.1e-3).unwrap();
    let object = PlanarObject { shape: shape(), mass, gravity: GRAVITY };
    let rate = 500.0;
    let hands = SimulatedHands::new(object, 0.2, 0.4, [0.7, 2.4], 0.3, rate).unwrap();
    let mut hands = hands.with_noise(NOISE, 5);
    for to in [[0.1, 2.5], [0.1, 2.1], [1.15, 2.0], [0.6, 2.6]] {
        Hands::turn(&mut hands, to, 0.25, 0.1).unwrap();
    }
    let log = Hands::log(&hands).unwrap();
    let impulse = Some(ImpulseNoise { fixed: NOISE[1] / rate, share: 0.0 });
    let noise = ContactNoiseLevel { impulse, floor: 7e-7, ..task(0.1).sensors.noise };
    let sensors = PlaneOptions::new(noise, GRAVITY, vec![Some(0.2); 2]);
    let estimate = estimate_plane(&log, &sensors).unwrap();
    assert!(estimate.reliability.is_reliable(), "{:?}", estimate.reliability);
    assert!(estimate.evidence.misfit < 1.1, "{:?}", estimate.evidence);
    let relied_on = estimate.relied_on.iter().filter(|relied_on| **relied_on).count();
    assert!(relied_on * 100 >= 99 * log.samples().len(), "{relied_on} of {}", log.samples().len());
}

#[test]
fn tasks_that_are_none_are_named() {
    let refused = |task: &SensedTask| {
        let (mut hands, mut planner) = (hands(0.3, 1), InformationRate::new(1, 1));
        explore_sensed(&mut planner, &mut hands, task, |_, _| ()).err().unwrap()
    };
    assert!(matches!(refused(&task(0.0)), SensedError::Task(RollError::Goal(_))));
    for level in [0.4, 1.0, f64::NAN] {
        let reason = refused(&SensedTask { level, ..task(0.1) });
        assert!(matches!(reason, SensedError::Confidence(ConfidenceError::Level(_))), "{reason}");
    }
    let elsewhere = Workspace { angles: [[0.1, 0.5], [1.5, 2.9]], ..Workspace::in_motion(0.1, GRAVITY) };
    let roll = RollTask { workspace: elsewhere, ..task(0.1).roll };
    assert!(matches!(
        refused(&SensedTask { roll, ..task(0.1) }),
        SensedError::Task(RollError::Outside { .. })
    ));
    let mass = PlanarMass::from_gyration(0.2, 1.1e-3).unwrap();
    let object = || PlanarObject { shape: shape(), mass, gravity: GRAVITY };
    let made = SimulatedHands::new(object(), -0.1, 0.4, [0.7, 2.4], 0.3, RATE);
    assert!(matches!(made.err(), Some(HandsError::Scene(_))));
    let made = SimulatedHands::new(object(), 0.0, 0.4, [0.7, 2.4], f64::NAN, RATE);
    assert!(matches!(made.err(), Some(HandsError::Start(_))));
}
