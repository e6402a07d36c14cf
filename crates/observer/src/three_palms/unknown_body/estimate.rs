//! Motion, mass and inertia with the evidence for them.

use super::principal::{PrincipalFrame, principal_frame};
use super::problem::{BODY_UNKNOWNS, BodyPoint, BodyProblem, MASS, constants};
use super::search::{mass_of_weight, scales_of_ball, search};
use crate::least_squares::{Fit, FitStatus, LevenbergMarquardt, Observability};
use crate::three_palms::convexity::largest_violation;
use crate::three_palms::correlation::whiteness;
use crate::three_palms::estimate::{
    EstimateError, LARGEST_MISFIT, MotionEstimate, RANK_TOLERANCE, WORTH_ADJUSTING, floored, judge,
};
use crate::three_palms::evidence::{Evidence, Reason, WeakDirection, too_short};
use crate::three_palms::momentum::{MomentumProblem, Scales, StartState};
use crate::three_palms::noise::noise_level;
use crate::three_palms::refine::{Refined, Setting, refine};
use crate::three_palms::state_space::Parameters;
use crate::three_palms::track::Track;
use crate::three_palms::{NoiseLevel, curves};
use glam::{DQuat, DVec3};
use nalgebra::SMatrix;
use object_dynamics::{MassProperties, SensorLog};

/// States of the model: motion, mass and inertia.
const STATES: usize = 19;

/// Least relative contact noise that the data are adjusted with: below it, blocks of samples are not exact enough.
const FAINTEST: f64 = 1e-5;

/// What is known beside the log of a body of which nothing is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnknownBody {
    /// Acceleration of free fall, world, m/s^2.
    pub gravity: DVec3,
    /// Moments of inertia of the palms about their axes, kg m^2: needed only for logs of torques on moving palms.
    pub palm_inertias: Option<[f64; 3]>,
    /// Sensor noise; where it is not known it is taken from the roughness of the readings.
    pub noise: Option<NoiseLevel>,
}

/// Mass and inertia as found, with their deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IdentifiedBody {
    /// Mass and principal moments, ascending along the body's axes.
    pub mass: MassProperties,
    /// Standard deviation of the mass, kg.
    pub mass_deviation: f64,
    /// Standard deviations of the principal moments, kg m^2.
    pub moment_deviations: DVec3,
    /// Standard deviations of the directions of the principal axes: rotations about the body's x, y and z, rad. Infinite
    /// where two moments are equal.
    pub axis_deviations: DVec3,
}

/// Motion, mass and inertia of a body of which nothing was known.
#[derive(Clone, Debug)]
pub struct BodyEstimate {
    /// Mass and inertia. The body's axes are its principal ones.
    pub body: IdentifiedBody,
    /// Motion and contact curves of those axes. Half turns about them change nothing that can be felt.
    pub motion: MotionEstimate,
}

/// Estimates motion, mass and inertia over a log, with no guess of any of them.
///
/// 16 unknowns: centre of mass, velocity, angular momentum, mass and the six numbers of the inertia tensor, in which
/// every value is a body that can exist. Contact conditions are fitted in the momentum form on windows that grow; then
/// data and unknowns are adjusted together.
///
/// # Errors
/// [`EstimateError`] when the log cannot be used at all; an estimate that should not be believed is returned with
/// [`Reliability::Unreliable`](crate::Reliability) and its reasons.
pub fn estimate_body(log: &SensorLog, known: &UnknownBody) -> Result<BodyEstimate, EstimateError> {
    if !(known.gravity.is_finite() && known.gravity.length() > 0.0) {
        return Err(EstimateError::Gravity { gravity: known.gravity });
    }
    let track = Track::new(log, 1.0, known.gravity, known.palm_inertias).map_err(EstimateError::Track)?;
    let weight = mass_of_weight(&track).ok_or(EstimateError::NoFit)?;
    let track = track.of_mass(weight);
    let scales = scales_of_ball(&track).ok_or(EstimateError::NoFit)?;
    let noise = floored(known.noise.unwrap_or_else(|| noise_level(&track)), &track, &scales);
    let mut fit = search(&track, scales, noise).into_iter().next().ok_or(EstimateError::NoFit)?;
    if noise.contact <= WORTH_ADJUSTING * scales.length {
        let solver = LevenbergMarquardt { iterations: 300, step_tolerance: 1e-11, damping: 1e-9, prior: 0.0 };
        fit = solver.fit(&BodyProblem::new(&track, scales, f64::INFINITY), fit.point);
    }
    finish(&track, scales, noise, &fit)
}

fn finish(
    track: &Track,
    scales: Scales,
    noise: NoiseLevel,
    fit: &Fit<BodyPoint, BODY_UNKNOWNS>,
) -> Result<BodyEstimate, EstimateError> {
    let mass = fit.point.mass().ok_or(EstimateError::NoFit)?;
    let track = track.of_mass(mass.mass());
    let adjusted = noise.contact > WORTH_ADJUSTING * scales.length;
    // Covariances are proportional to the noise squared: logs with next to none are weighed as if they had some.
    let faint = (FAINTEST * scales.length / noise.contact).max(1.0);
    let weighed = NoiseLevel { contact: noise.contact * faint, force: noise.force * faint };
    let setting =
        Setting { scales, noise: weighed, constants: constants(), deviations: &[], axes_chosen: true };
    let mut refined = refine::<STATES>(&track, &mass, Parameters::new(&mass), &fit.point.start, &setting)
        .map_err(|_| EstimateError::NoFit)?;
    if adjusted && !too_short(&track, &scales) {
        refined.widen(&track, &weighed);
    }
    let (mass, start) = if adjusted { of_state(&refined)? } else { (mass, fit.point.start) };
    let track = track.of_mass(mass.mass());
    let problem = MomentumProblem::new(&track, &mass, scales, f64::INFINITY);
    let motion = if adjusted {
        problem.motion_through(&refined.nodes, &refined.states())
    } else {
        problem.motion(&start)
    };
    let (residuals, predicted) = problem.residuals_along(&motion, noise.contact);
    let rms = (residuals.iter().flatten().map(|e| e * e).sum::<f64>() / (3 * residuals.len()) as f64).sqrt();
    // Without noise to speak of, what is left are lasting errors: as in the fit of a known body.
    let excess = if adjusted { 1.0 } else { (rms / predicted).powi(2).max(1.0) };
    let covariance = body_covariance(&refined, excess / (faint * faint));
    let frame = principal_frame(&mass, &covariance).ok_or(EstimateError::NoFit)?;
    let observability = Observability::new(&fit.normal.information);
    let eigenvalues = observability.eigenvalues;
    let largest = eigenvalues[BODY_UNKNOWNS - 1];
    let sizes = BodyProblem::new(&track, scales, f64::INFINITY).sizes();
    let scaled = SMatrix::<f64, BODY_UNKNOWNS, BODY_UNKNOWNS>::from_fn(|i, j| {
        covariance[(i, j)] / (sizes[i] * sizes[j])
    });
    let spectrum = Observability::new(&scaled);
    let weakest = WeakDirection::of_body(
        &spectrum.directions.column(BODY_UNKNOWNS - 1).into_owned(),
        spectrum.eigenvalues[BODY_UNKNOWNS - 1].max(0.0).sqrt(),
    );
    let evidence = Evidence {
        samples: track.len(),
        duration: track.duration(),
        residual_rms: rms,
        noise_explains: predicted,
        whiteness: whiteness(&residuals),
        rank: eigenvalues.iter().filter(|&&v| v > RANK_TOLERANCE * largest).count(),
        condition: (largest / eigenvalues[0].max(0.0)).sqrt(),
        smallest_information: eigenvalues[0],
        weakest,
        noise,
        log_odds: f64::INFINITY,
        bias: if adjusted { refined.shift } else { 0.0 },
        iterations: fit.iterations + refined.solution.iterations,
    };
    let settled = if adjusted { refined.settled() } else { fit.status == FitStatus::Converged };
    let status = if settled { FitStatus::Converged } else { FitStatus::Stalled };
    let mut reliability = judge(&evidence, status, &scales);
    let misfit = refined.misfit(BODY_UNKNOWNS);
    if adjusted && (misfit.is_nan() || misfit > LARGEST_MISFIT) {
        reliability.add(Reason::Inconsistent { misfit });
    }
    if adjusted {
        reliability.check_length(&track, &scales);
    }
    let PrincipalFrame { body, axes, covariance } = frame;
    // From the axes of the world at the start to the principal ones.
    let turned: Vec<_> =
        motion.into_iter().map(|m| crate::three_palms::MotionState { R_WO: m.R_WO * axes, ..m }).collect();
    let contact_curves = curves::contact_curves(&track, &turned)?;
    let radii = curves::radii(&track, &turned);
    let uncertainty = if adjusted { curves::uncertainty(&track, &refined, axes) } else { Vec::new() };
    reliability.check_convexity(largest_violation(&track, &refined.nodes, &turned, &uncertainty));
    let motion = MotionEstimate {
        start: StartState { R_WO: axes, ..start },
        motion: turned,
        curves: contact_curves,
        radii,
        uncertainty,
        covariance,
        evidence,
        reliability,
    };
    Ok(BodyEstimate { body, motion })
}

/// Mass, in axes of the world at the start, and the start of the motion in the first state.
fn of_state(refined: &Refined<STATES>) -> Result<(MassProperties, StartState), EstimateError> {
    let first = &refined.solution.states[0];
    let parameters = refined.model.parameters(first);
    let mass = MassProperties::new(parameters.mass, parameters.inertia_tensor())
        .map_err(|_| EstimateError::NoFit)?;
    Ok((mass, StartState { R_WO: DQuat::IDENTITY, ..refined.model.motion(first) }))
}

/// Covariance of the 16 unknowns: the orientation at the start is chosen and drops out.
fn body_covariance(refined: &Refined<STATES>, factor: f64) -> SMatrix<f64, BODY_UNKNOWNS, BODY_UNKNOWNS> {
    let all = &refined.solution.covariances[0];
    let place = |i: usize| if i < MASS { i } else { i + 3 };
    SMatrix::from_fn(|i, j| factor * all[(place(i), place(j))])
}
