//! The most probable motion: states, constants and data adjusted together, over all nodes of a log.

use super::state_space::{NodeInput, ThreePalmModel, Touch};
use crate::core::{BatchOptions, BatchSolution, ObserverError, Sample, Start, Status, solve_batch_along};
use nalgebra::SVector;

/// Linearisations at most, in each of the two passes.
const ITERATIONS: usize = 15;
/// Length of a step at which the iteration has settled, in relative contact noise.
const STEP_TOLERANCE: f64 = 0.01;
/// Deviation, in natural units, of the turning rates in the first pass: the start is not better known.
const FIRST_SLIDE: f64 = 0.1;

/// Gauss-Newton on the whole motion, relinearised at the adjusted data: Gauss-Helmert estimation in linear time.
///
/// In two passes: the noise of a contact condition depends on how fast the body turns against the palm, and its
/// expectation on how well that is known. The second pass takes it from the first.
pub(super) fn most_probable<const N: usize>(
    model: &ThreePalmModel<N>,
    inputs: &[NodeInput],
    states: &[SVector<f64, N>],
    prior: &Start<N>,
) -> Result<BatchSolution<N>, ObserverError> {
    let rate = model.natural_rate();
    let mut samples: Vec<Sample<NodeInput, 3>> = inputs
        .iter()
        // The contact condition is zero, and the model gives it in standard deviations.
        .map(|&input| Sample { input, measured: SVector::zeros(), information: SVector::repeat(1.0) })
        .collect();
    set_slides(&mut samples, |_, _| [(FIRST_SLIDE * rate).powi(2); 3]);
    let options = BatchOptions {
        iterations: ITERATIONS,
        step_tolerance: STEP_TOLERANCE * model.relative_noise(),
        damping: 0.0,
    };
    let first = solve_batch_along(model, &samples, prior, states, &options)?;
    if first.report.status == Status::Diverged {
        return Ok(first);
    }
    set_slides(&mut samples, |k, touch| model.slide_variances(&first.states[k], &first.covariances[k], touch));
    let second = solve_batch_along(model, &samples, prior, &first.states, &options)?;
    Ok(BatchSolution { iterations: first.iterations + second.iterations, ..second })
}

fn set_slides(samples: &mut [Sample<NodeInput, 3>], slide: impl Fn(usize, &Touch) -> [f64; 3]) {
    for k in 0..samples.len() {
        let variance = slide(k, &samples[k].input.here);
        samples[k].input.here.slide_variance = variance;
        if let Some(next) = samples.get_mut(k + 1) {
            next.input.from.slide_variance = variance;
        }
    }
    if let [first, ..] = samples {
        first.input.from.slide_variance = first.input.here.slide_variance;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use super::super::cold_start::scales;
    use super::super::covariance::NoiseLevel;
    use super::super::state_space::block_inputs;
    use super::super::track::Track;
    use super::super::momentum::{MomentumProblem, StartState};
    use super::super::state_space::{Parameters, blocks};
    use contact_kinematics::{Ellipsoid, Palm};
    use glam::{DQuat, DVec3};
    use object_dynamics::integrate::Tolerance;
    use object_dynamics::{InitialMotion, MassProperties, SampleTimes, SensorNoise, ThreePalmScene};
    use crate::core::Model;

    #[test]
    fn proto() {
        let axes = DVec3::new(1.0, 2.0, 2.5);
        let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
        let palms = [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
        let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.3, 0.3) };
        for (rate, duration, contact, force, strides) in [ (1000.0, 4.0, 2.5e-3, 0.065, [14]), (1000.0, 4.0, 2.5e-4, 0.065, [14]), (1000.0, 4.0, 2.5e-4, 0.065, [1]),(1000.0, 4.0, 2.5e-5, 0.065, [14]), (1000.0, 4.0, 2.5e-5, 0.065, [1]), (200.0, 4.2, 2.5e-3, 0.065, [1]), (200.0, 4.2, 2.5e-3, 0.065, [3])] {
            let times = SampleTimes { duration, rate };
            let run = scene.simulate(start, times, Tolerance::uniform(1e-12)).unwrap();
            let log = run.sensor_log(&scene).unwrap();
            let now = &run.instants[0];
            let L_WO = mass.inertia() * now.w_WO;
            let truth = StartState { p_WCm: now.touch.p_WCm, v_WCm: now.rates.v_WCm, L_WO, R_WO: DQuat::IDENTITY };
            let track = |log: &object_dynamics::SensorLog| Track::new(log, mass.mass(), scene.gravity(), None).unwrap();
            let clean = track(&log);
            let sizes = scales(&clean, &mass);
            let noise = NoiseLevel { contact, force };
            let base = Parameters::new(&mass);
            let model = ThreePalmModel::<12>::new(base, &[], scene.gravity(), noise, sizes).unwrap();
            let x0 = model.state(&truth, &base);
            let prior = Start::guess(x0);
            let along = |track: &Track, from: &StartState, stride: usize| -> Vec<SVector<f64, 12>> {
                let problem = MomentumProblem::new(track, &mass, sizes, f64::INFINITY);
                let fit = crate::LevenbergMarquardt::default().fit(&problem, *from);
                let motion = problem.motion(&fit.point);
                let at = blocks(track.len(), stride);
                at.into_iter().map(|b| { let m = &motion[b.node()]; model.state(&StartState { p_WCm: m.p_WCm, v_WCm: m.v_WCm, R_WO: m.R_WO, L_WO: m.R_WO * (mass.inertia() * (m.R_WO.inverse() * m.w_WO)) }, &base) }).collect()
            };
            let bound = most_probable(&model, &block_inputs(&clean, &blocks(clean.len(), strides[0]), 0.0), &along(&clean, &truth, strides[0]), &prior).unwrap();
            println!("rate {rate} clean nees {:.2e} T {duration} contact {contact}: clean chi {:.3e} it {} err {:.1e}", bound.report.nees(&model.difference(&bound.states[0], &x0)) / 12.0, bound.chi_squared, bound.iterations, model.difference(&bound.states[0], &x0).amax());
            for stride in strides {
                let (mut nees, mut chi, mut nees_end, mut ratio, mut its, mut ms) = (0.0, 0.0, 0.0, SVector::<f64, 12>::zeros(), 0, 0.0);
                let mut last_dof = 0; let mut nees_crb = 0.0; let mut logdet = 0.0;
                let runs = 20;
                for seed in 0..runs {
                    let noisy = track(&log.with_noise(&SensorNoise { contact, force, torque: 0.0 }, seed).unwrap());
                    let first = along(&noisy, &truth, stride);
                    let clock = std::time::Instant::now();
                    let inputs = block_inputs(&noisy, &blocks(noisy.len(), stride), std::env::var("REACH").unwrap().parse::<f64>().unwrap());
                    let s = most_probable(&model, &inputs, &first, &prior).unwrap();
                    ms += 1e3 * clock.elapsed().as_secs_f64() / runs as f64;
                    let e = model.difference(&s.states[0], &x0);
                    let one = s.report.nees(&e);
                    nees_crb += bound.report.nees(&e) / 12.0 / runs as f64;
                    logdet += (s.report.covariance.determinant() / bound.report.covariance.determinant()).ln() / runs as f64;
                    nees += one / 12.0 / runs as f64;
                    let end = run.instants.last().unwrap();
                    let end = StartState { p_WCm: end.touch.p_WCm, v_WCm: end.rates.v_WCm, L_WO: end.R_WO * (mass.inertia() * (end.R_WO.inverse() * end.w_WO)), R_WO: end.R_WO };
                    let ee = model.difference(s.states.last().unwrap(), &model.state(&end, &base));
                    nees_end += ee.dot(&s.covariances.last().unwrap().try_inverse().unwrap_or_default().lu().solve(&ee).unwrap_or_default()) * 0.0 + ee.dot(&(s.covariances.last().unwrap().try_inverse().unwrap() * ee)) / 12.0 / runs as f64;
                    last_dof = s.channels - 12;
                    chi += s.chi_squared / last_dof as f64 / runs as f64;
                    its += s.iterations;
                    ratio += e.component_mul(&e) / runs as f64;
                    if one > 30.0 { println!("   seed {seed} nees {:.2} chi {:.2} its {} {:?}", one / 12.0, s.chi_squared / last_dof as f64, s.iterations, s.report.status); }
                }
                let crb = bound.report.covariance.diagonal();
                let r = ratio.component_div(&crb).map(|v| v.sqrt());
                println!("  stride {stride}: crb nees {nees_crb:.3} logdet {logdet:.3} nees {nees:.3} end {nees_end:.3} chi2/dof {chi:.3} (dof {last_dof}) rmse/crb {:.3} max {:.3} its {} ms {ms:.1}", (r.map(|v| v.ln()).mean()).exp(), r.max(), its / runs as usize);
            }
        }
    }
}
