//! The model against exact logs: its flow and output at the truth, its derivatives against differences.

use super::*;
use crate::core::Model;
use crate::three_palms::cold_start::scales;
use crate::three_palms::covariance::NoiseLevel;
use crate::three_palms::momentum::StartState;
use crate::three_palms::track::Track;
use contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use glam::{DQuat, DVec3};
use nalgebra::SVector;
use object_dynamics::integrate::Tolerance;
use object_dynamics::{InitialMotion, MassProperties, SampleTimes, Simulation, ThreePalmScene};

const ALL: [Constant; 7] = [
    Constant::LogMass,
    Constant::Inertia(0),
    Constant::Inertia(1),
    Constant::Inertia(2),
    Constant::Inertia(3),
    Constant::Inertia(4),
    Constant::Inertia(5),
];
const N: usize = MOTION_STATES + ALL.len();

fn moving_scene() -> (MassProperties, Simulation, Track) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palm = |azimuth, phase| {
        let motion = MotionLaw::Sinusoid { mean: 1.0, amplitude: 0.08, frequency: 1.7, phase };
        Palm::new(azimuth, motion).unwrap()
    };
    let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let times = SampleTimes { duration: 1.0, rate: 1000.0 };
    let run = scene.simulate(start, times, Tolerance::uniform(1e-13)).unwrap();
    let track = Track::new(&run.sensor_log(&scene).unwrap(), mass.mass(), scene.gravity(), None).unwrap();
    (mass, run, track)
}

fn model(mass: &MassProperties, track: &Track, contact: f64) -> ThreePalmModel<N> {
    let noise = NoiseLevel { contact, force: 10.0 * contact };
    ThreePalmModel::new(Parameters::new(mass), &ALL, track.gravity, noise, scales(track, mass)).unwrap()
}

/// So many samples, an odd number.
fn block(start: usize, samples: usize) -> Block {
    Block { start, reach: samples / 2 }
}

fn truth(run: &Simulation, mass: &MassProperties, k: usize) -> StartState {
    let now = &run.instants[k];
    let L_WO = now.R_WO * (mass.inertia() * (now.R_WO.inverse() * now.w_WO));
    StartState { p_WCm: now.touch.p_WCm, v_WCm: now.rates.v_WCm, L_WO, R_WO: now.R_WO }
}

/// Along the true motion the conditions vanish and the flow leads from node to node, to the order of the node's spacing.
#[test]
fn the_true_motion_is_a_solution_to_high_order() {
    let (mass, run, track) = moving_scene();
    let errors = |stride: usize| {
        let model = model(&mass, &track, 0.0);
        let base = Parameters::new(&mass);
        let cut: Vec<Block> = (0..track.len() / stride).map(|k| block(k * stride, stride)).collect();
        let mut inputs = NodeInputs::default();
        let (mut flow, mut output): (f64, f64) = (0.0, 0.0);
        for k in 1..cut.len() {
            let input = &inputs.after(&track, &cut[k - 1], &cut[k]);
            let at = |k: usize| model.state(&truth(&run, &mass, cut[k].node()), &base);
            flow =
                flow.max(model.difference(&model.advance(&at(k - 1), input), &at(k)).amax() / input.duration);
            for condition in model.conditions(&at(k), &input.here) {
                output = output.max(condition.value.abs());
            }
        }
        (flow, output)
    };
    let ((fine_flow, fine_output), (coarse_flow, coarse_output)) = (errors(11), errors(41));
    // Steps of order 4 with one order to spare; means of blocks to second order in their length.
    let orders = ((coarse_flow / fine_flow).log2() / 2.0, (coarse_output / fine_output).log2() / 2.0);
    println!("{coarse_flow:e} {fine_flow:e} {coarse_output:e} {fine_output:e}");
    assert!(orders.0 > 3.5, "flow: {coarse_flow:e} {fine_flow:e}");
    assert!(orders.1 > 1.7 && fine_output < 1e-4, "output: {coarse_output:e} {fine_output:e}");
}

/// At single samples every derivative of flow and output is that of differences, with all constants as states. Away from
/// the truth the foot of the contact moves: derivatives leave out how its direction turns, so the state is near it.
#[test]
fn derivatives_are_those_of_differences() {
    let (mass, run, track) = moving_scene();
    let model = model(&mass, &track, 1e-3);
    let thin = track.thinned(20);
    let parameters = Parameters::new(&mass);
    let x = model.state(&truth(&run, &mass, 200), &parameters);
    let input = &NodeInputs::default().after(&thin, &block(10, 1), &block(11, 1));
    let (_, transition) = model.flow(&x, input);
    let scales = model.scales();
    for j in 0..N {
        let moved = |h: f64| {
            let step = SVector::<f64, N>::from_fn(|i, _| if i == j { h * scales[j] } else { 0.0 });
            model.retract(&x, &step)
        };
        let h = 1e-5;
        let (ahead, behind) = (moved(h), moved(-h));
        let slope =
            model.difference(&model.advance(&ahead, input), &model.advance(&behind, input)) / (2.0 * h);
        let expected = transition.column(j) * scales[j];
        let error = (slope - expected).component_div(&scales).amax();
        assert!(error < 2e-5, "flow by {}: {error:e}", model.names()[j]);
        let here = |x: &SVector<f64, N>| model.conditions(x, &input.here).map(|c| c.value);
        let (a, b) = (here(&ahead), here(&behind));
        let rows = model.conditions(&x, &input.here);
        for i in 0..3 {
            let error = ((a[i] - b[i]) / (2.0 * h) - rows[i].row[j] * scales[j]).abs();
            let foot = rows[i].value.abs();
            assert!(error < 1e-7 + 20.0 * foot, "output {i} by {}: {error:e}, {foot:e}", model.names()[j]);
        }
    }
}

#[test]
fn steps_and_differences_undo_each_other() {
    let (mass, run, track) = moving_scene();
    let model = model(&mass, &track, 1e-3);
    let x = model.state(&truth(&run, &mass, 500), &Parameters::new(&mass));
    let step = SVector::<f64, N>::from_fn(|i, _| 0.3 * ((i * i) as f64).sin());
    let moved = model.retract(&x, &step);
    assert!((model.difference(&moved, &x) - step).amax() < 1e-13);
}
