//! Covariance of the estimate: white sensor noise carried through the linearised estimator.
//!
//! The estimate minimises the contact residuals; noise reaches them directly, through the contact coordinates, and
//! with a memory, through the impulses and moments that the forces are integrated to. Both are carried to the
//! unknowns by the adjoint of the linearised motion.

use super::momentum::{MomentumProblem, StateRow, UNKNOWNS};
use super::random::Normal;
use nalgebra::{SMatrix, SVector};

type Square = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Standard deviations of white sensor noise, per sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoiseLevel {
    /// Of each contact coordinate, m.
    pub contact: f64,
    /// Of each contact force, N.
    pub force: f64,
}

/// What the linearised motion says at one sample.
pub(super) struct Linearised {
    /// Derivatives of the residuals by position, velocity, angular momentum and orientation at the sample.
    pub(super) by_state: [StateRow; 3],
    /// Derivatives of the residuals by the contact coordinates `(s1, s2)`.
    pub(super) by_contact: [[f64; 2]; 3],
    /// What a unit of force for a unit of time does to the state.
    pub(super) by_force: [SVector<f64, UNKNOWNS>; 3],
    /// What a unit of contact coordinate for a unit of time does to the state, through the torque.
    pub(super) through_torque: [[SVector<f64, UNKNOWNS>; 2]; 3],
    /// Rate of the state's deviation.
    pub(super) flow: Square,
    /// Time to the next sample, s.
    pub(super) step: f64,
}

/// How the samples of the log enter the nodes of a track that was thinned from it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sampling {
    /// Samples of the log for one node.
    pub(super) per_node: f64,
    /// Residuals of the fit for one of the node: `per_node` when all samples were fitted, 1 when the nodes were.
    pub(super) weight: f64,
    /// Variance of the summed contact noise of those residuals, in variances of one sample.
    pub(super) direct: f64,
}

/// Covariance of the scaled unknowns, and the root mean square of the residuals that noise alone leaves after the fit.
pub(super) struct Propagated<const P: usize> {
    pub(super) covariance: SMatrix<f64, P, P>,
    pub(super) residual: f64,
}

/// Carries white sensor noise through the fit whose information has the given inverse.
pub(super) fn propagate(
    problem: &MomentumProblem<'_>,
    start: &super::StartState,
    information_inverse: &Square,
    noise: &NoiseLevel,
    sampling: Sampling,
) -> Propagated<UNKNOWNS> {
    let (steps, rows) = problem.linearised(start);
    propagate_to(&steps, &rows, information_inverse, noise, sampling)
}

/// The same for the unknowns whose derivatives are the `rows`: those of the motion, and others beside them.
pub(super) fn propagate_to<const P: usize>(
    steps: &[Linearised],
    rows: &[[SVector<f64, P>; 3]],
    information_inverse: &SMatrix<f64, P, P>,
    noise: &NoiseLevel,
    sampling: Sampling,
) -> Propagated<P> {
    let transitions: Vec<Square> = steps.windows(2).map(|w| transition(&w[0], &w[1])).collect();
    let spread = spread(steps, rows, &transitions, noise, sampling);
    let residual = residual_after_fit(steps, rows, &transitions, information_inverse, noise, sampling);
    Propagated { covariance: information_inverse * spread * information_inverse, residual }
}

/// State transition from one node to the next, to second order.
fn transition(here: &Linearised, next: &Linearised) -> Square {
    let flow = (here.flow + next.flow) * (0.5 * here.step);
    Square::identity() + flow + flow * flow * 0.5
}

/// `J' S J` with `S` the covariance of the residuals: backwards in time, by the adjoint. Noise at a node moves the
/// state after it.
fn spread<const P: usize>(
    steps: &[Linearised],
    rows: &[[SVector<f64, P>; 3]],
    transitions: &[Square],
    noise: &NoiseLevel,
    sampling: Sampling,
) -> SMatrix<f64, P, P> {
    let Sampling { per_node, weight, direct } = sampling;
    let (vs, vf) = (noise.contact.powi(2), noise.force.powi(2));
    let mut adjoint = SMatrix::<f64, P, UNKNOWNS>::zeros();
    let mut spread = SMatrix::<f64, P, P>::zeros();
    for (k, (here, rows)) in steps.iter().zip(rows).enumerate().rev() {
        if let Some(transition) = transitions.get(k) {
            adjoint *= transition;
        }
        // Each sample holds its reading until the next.
        let hold = here.step / per_node;
        for i in 0..3 {
            let kick: SVector<f64, P> = adjoint * here.by_force[i] * hold;
            spread.ger(vf * per_node, &kick, &kick, 1.0);
            for axis in 0..2 {
                let at_once: SVector<f64, P> = rows[i] * here.by_contact[i][axis];
                let later: SVector<f64, P> = adjoint * here.through_torque[i][axis] * hold;
                spread.ger(vs * direct, &at_once, &at_once, 1.0);
                spread.ger(vs * per_node, &later, &later, 1.0);
                spread.ger(vs * weight, &at_once, &later, 1.0);
                spread.ger(vs * weight, &later, &at_once, 1.0);
            }
        }
        for i in 0..3 {
            adjoint += rows[i] * here.by_state[i].transpose() * weight;
        }
    }
    spread
}

/// Root mean square of the residuals that noise leaves after the fit, from a few draws of the linearised motion.
///
/// Drawn and not computed: the noise that forces leave in the motion is fitted away but for about one part in two
/// hundred, so a difference of two variances would be mostly rounding of the transitions.
fn residual_after_fit<const P: usize>(
    steps: &[Linearised],
    rows: &[[SVector<f64, P>; 3]],
    transitions: &[Square],
    information_inverse: &SMatrix<f64, P, P>,
    noise: &NoiseLevel,
    sampling: Sampling,
) -> f64 {
    let mut random = Normal::default();
    let mut lasting = 0.0;
    for _ in 0..DRAWS {
        let smooth = draw_residuals(steps, transitions, noise, sampling, &mut random);
        let mut gradient = SVector::<f64, P>::zeros();
        let pairs = || rows.iter().flatten().zip(smooth.iter().flatten());
        for (row, e) in pairs() {
            gradient.axpy(sampling.weight * e, row, 1.0);
        }
        let fitted = information_inverse * gradient;
        lasting += pairs().map(|(row, e)| (e - row.dot(&fitted)).powi(2)).sum::<f64>() / f64::from(DRAWS);
    }
    // Contact noise that enters at once is too rough to be fitted away.
    let at_once = noise.contact.powi(2) * sampling.direct / sampling.weight;
    let rough: f64 =
        steps.iter().flat_map(|s| s.by_contact).map(|[s1, s2]| at_once * (s1 * s1 + s2 * s2)).sum();
    ((lasting + rough) / (3 * steps.len().max(1)) as f64).sqrt()
}

/// Residuals that one draw of the noise causes through the motion.
fn draw_residuals(
    steps: &[Linearised],
    transitions: &[Square],
    noise: &NoiseLevel,
    sampling: Sampling,
    random: &mut Normal,
) -> Vec<[f64; 3]> {
    let mut state = StateRow::zeros();
    let one = |(k, here): (usize, &Linearised)| {
        let residuals = std::array::from_fn(|i| here.by_state[i].dot(&state));
        // The sum of the noise of the node's samples, each held until the next.
        let hold = here.step / sampling.per_node.sqrt();
        for i in 0..3 {
            state.axpy(noise.force * hold * random.draw(), &here.by_force[i], 1.0);
            for column in &here.through_torque[i] {
                state.axpy(noise.contact * hold * random.draw(), column, 1.0);
            }
        }
        if let Some(transition) = transitions.get(k) {
            state = transition * state;
        }
        residuals
    };
    steps.iter().enumerate().map(one).collect()
}

/// Draws of the residual: their mean square is then known to a few percent, from about twenty independent values each.
const DRAWS: u32 = 8;

#[cfg(test)]
mod tests {
    use super::super::cold_start::scales;
    use super::super::momentum::Row;
    use super::super::{StartState, Track};
    use super::*;
    use crate::least_squares::{LeastSquares, LevenbergMarquardt};
    use contact_kinematics::{Ellipsoid, Palm};
    use glam::{DQuat, DVec3};
    use object_dynamics::integrate::Tolerance;
    use object_dynamics::{
        InitialMotion, MassProperties, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
    };

    #[test]
    fn residual_and_covariance_are_those_of_a_monte_carlo() {
        let axes = DVec3::new(1.0, 2.0, 2.5);
        let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
        let palms = [60.0, 180.0, 300.0f64].map(|a| Palm::fixed(a.to_radians(), 60f64.to_radians()).unwrap());
        let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
        let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.3, 0.3) };
        let times = SampleTimes { duration: 2.0, rate: 200.0 };
        let run = scene.simulate(start, times, Tolerance::uniform(1e-12)).unwrap();
        let log = run.sensor_log(&scene).unwrap();
        let now = &run.instants[0];
        let L_WO = mass.inertia() * now.w_WO;
        let truth =
            StartState { p_WCm: now.touch.p_WCm, v_WCm: now.rates.v_WCm, L_WO, R_WO: DQuat::IDENTITY };
        let track = |log: &SensorLog| Track::new(log, mass.mass(), scene.gravity(), None).unwrap();
        let clean = track(&log);
        let sizes = scales(&clean, &mass);
        // A tenth of the noise of the other tests, so that the fit is linear to a percent.
        for (contact, force) in [(2.5e-4, 0.0), (0.0, 6.5e-3), (2.5e-4, 6.5e-3)] {
            let noise = NoiseLevel { contact, force };
            let (mut square, mut errors) = (0.0, Row::zeros());
            let runs = 60;
            for seed in 0..runs {
                let noisy =
                    track(&log.with_noise(&SensorNoise { contact, force, torque: 0.0 }, seed).unwrap());
                let problem = MomentumProblem::new(&noisy, &mass, sizes, f64::INFINITY);
                let fit = LevenbergMarquardt::default().fit(&problem, truth);
                square += fit.normal.rms().powi(2) / runs as f64;
                let turn = fit.point.R_WO;
                let parts = [
                    (fit.point.p_WCm - truth.p_WCm) / sizes.length,
                    (fit.point.v_WCm - truth.v_WCm) / sizes.velocity,
                    (fit.point.L_WO - truth.L_WO) / sizes.momentum,
                    DVec3::new(turn.x, turn.y, turn.z) * 2.0 * turn.w.signum(),
                ];
                errors += Row::from_fn(|i, _| parts[i / 3][i % 3].powi(2)) / runs as f64;
            }
            let information =
                MomentumProblem::new(&clean, &mass, sizes, f64::INFINITY).linearise(&truth).unwrap();
            let inverse = information.information.try_inverse().unwrap();
            for stride in [1usize, 4] {
                let thin = clean.thinned(stride);
                let problem = MomentumProblem::new(&thin, &mass, sizes, f64::INFINITY);
                let per_node = stride as f64;
                let sampling = Sampling { per_node, weight: per_node, direct: per_node };
                let found = propagate(&problem, &truth, &inverse, &noise, sampling);
                let ratio = found.residual / square.sqrt();
                assert!((0.85..1.15).contains(&ratio), "residual, stride {stride}, noise {noise:?}: {ratio}");
                // Deviations from 60 runs are known to 1 / sqrt(120) = 9 %; three of those, and 4 % for the stride.
                for i in 0..UNKNOWNS {
                    let ratio = (found.covariance[(i, i)] / errors[i]).sqrt();
                    assert!(
                        (0.69..1.45).contains(&ratio),
                        "unknown {i}, stride {stride}, noise {noise:?}: {ratio}"
                    );
                }
            }
        }
    }
}
