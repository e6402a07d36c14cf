//! Motion, mass and inertia with the evidence for them.

use super::principal::{PrincipalFrame, principal_frame};
use super::problem::{BODY_UNKNOWNS, BodyPoint, BodyProblem};
use super::search::{fit_near, mass_of_weight, scales_of_ball, search};
use crate::least_squares::{FitStatus, LeastSquares, Observability};
use crate::three_palms::clean::{Clean, clean_covariance, stride};
use crate::three_palms::estimate::{EstimateError, MotionEstimate, floored};
use crate::three_palms::evidence::{Evidence, WeakDirection};
use crate::three_palms::inertia::numbers_of_inertia;
use crate::three_palms::momentum::{MomentumProblem, MotionState, Scales, StartState};
use crate::three_palms::noise::noise_level;
use crate::three_palms::polish::{Conditions, polish_all};
use crate::three_palms::pose_errors::{self, Pose};
use crate::three_palms::track::Track;
use crate::three_palms::verdict::judge;
use crate::three_palms::{NoiseLevel, PoseErrors, curves};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{SMatrix, SVector};
use object_dynamics::{MassProperties, SensorLog};

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
    let (track, scales) = track(log, known)?;
    let noise = floored(known.noise.unwrap_or_else(|| noise_level(&track)), &track, &scales);
    let found = search(&track, scales, noise).into_iter().next().ok_or(EstimateError::NoFit)?;
    clean_estimate(&track, scales, noise, found.point)
}

/// As [`estimate_body`] from a body and a start of its motion that are known to be near, without a search: the minimum that
/// they lie above.
///
/// # Errors
/// As [`estimate_body`].
pub fn estimate_body_from(
    log: &SensorLog,
    known: &UnknownBody,
    mass: &MassProperties,
    near: &StartState,
) -> Result<BodyEstimate, EstimateError> {
    let (track, scales) = track(log, known)?;
    let R = DMat3::from_quat(near.R_WO);
    let near = BodyPoint {
        start: StartState { R_WO: DQuat::IDENTITY, ..*near },
        log_mass: mass.mass().ln(),
        inertia: numbers_of_inertia(R * mass.inertia() * R.transpose()),
    };
    let noise = floored(known.noise.unwrap_or_else(|| noise_level(&track)), &track, &scales);
    let found = fit_near(&track, scales, near).ok_or(EstimateError::NoFit)?;
    clean_estimate(&track, scales, noise, found.point)
}

fn track(log: &SensorLog, known: &UnknownBody) -> Result<(Track, Scales), EstimateError> {
    if !(known.gravity.is_finite() && known.gravity.length() > 0.0) {
        return Err(EstimateError::Gravity { gravity: known.gravity });
    }
    let track = Track::new(log, 1.0, known.gravity, known.palm_inertias).map_err(EstimateError::Track)?;
    let weight = mass_of_weight(&track).ok_or(EstimateError::NoFit)?;
    let track = track.of_mass(weight);
    let scales = scales_of_ball(&track).ok_or(EstimateError::NoFit)?;
    Ok((track, scales))
}

/// What an estimate is put together from.
struct Found {
    scales: Scales,
    /// Mass, in axes of the world at the start.
    mass: MassProperties,
    start: StartState,
    motion: Vec<MotionState>,
    residuals: Vec<[f64; 3]>,
    /// Residual that noise explains, m/s.
    predicted: f64,
    /// Covariance of the 16 unknowns.
    covariance: SMatrix<f64, BODY_UNKNOWNS, BODY_UNKNOWNS>,
    observability: Observability<BODY_UNKNOWNS>,
    noise: NoiseLevel,
    iterations: usize,
    status: FitStatus,
}

/// The least-squares body and motion of a log with next to no noise, from a start that is near.
fn clean_estimate(
    track: &Track,
    scales: Scales,
    noise: NoiseLevel,
    near: BodyPoint,
) -> Result<BodyEstimate, EstimateError> {
    let stride = stride(track, &scales);
    let thin = track.thinned(stride);
    let problem = BodyProblem::new(track, scales, f64::INFINITY);
    let thin_problem = BodyProblem::new(&thin, scales, f64::INFINITY);
    let fit = polish_all(&problem, &thin_problem, stride, near).ok_or(EstimateError::NoFit)?;
    let mass = fit.point.mass().ok_or(EstimateError::NoFit)?;
    let track = track.of_mass(mass.mass());
    let start = fit.point.start;
    let motion = MomentumProblem::new(&track, &mass, scales, f64::INFINITY);
    let moved = motion.motion(&start);
    let residuals = motion.residuals_along(&moved);
    let observability = Observability::new(&fit.normal.information);
    let thin_of_mass = thin.of_mass(mass.mass());
    let (steps, _) = MomentumProblem::new(&thin_of_mass, &mass, scales, f64::INFINITY).linearised(&start);
    let rows = thin_problem.slopes(&fit.point).ok_or(EstimateError::NoFit)?;
    let Clean { covariance: scaled, predicted, lasting } =
        clean_covariance(&steps, &rows, &observability, &noise, stride, &residuals);
    let poses = |step: &SVector<f64, BODY_UNKNOWNS>, axes: DQuat| -> Option<Vec<Pose>> {
        let point = thin_problem.retract(&fit.point, step);
        let mass = point.mass()?;
        let thin = thin.of_mass(mass.mass());
        let motion = MomentumProblem::new(&thin, &mass, scales, f64::INFINITY).motion(&point.start);
        Some(motion.iter().map(|m| (m.p_WCm, m.R_WO * axes)).collect())
    };
    let nodes: Vec<usize> = (0..track.len()).step_by(stride).collect();
    let joint =
        |axes: DQuat| pose_errors::of_start(nodes.clone(), &scaled, |step| poses(step, axes), lasting, false);
    let sizes = problem.sizes();
    let found = Found {
        scales,
        mass,
        start,
        motion: moved,
        residuals,
        predicted,
        covariance: SMatrix::from_fn(|i, j| scaled[(i, j)] * sizes[i] * sizes[j]),
        observability,
        noise,
        iterations: fit.iterations,
        status: fit.status,
    };
    assemble(&track, found, joint)
}

/// The estimate; `joint` gives the errors of the poses in body axes that stand so in those of the world at the start.
fn assemble(
    track: &Track,
    found: Found,
    joint: impl FnOnce(DQuat) -> Option<PoseErrors>,
) -> Result<BodyEstimate, EstimateError> {
    let evidence = evidence(track, &found);
    let Found { scales, mass, start, motion, covariance, status, .. } = found;
    let reliability = judge(&evidence, status, &scales);
    let frame = principal_frame(&mass, &covariance).ok_or(EstimateError::NoFit)?;
    let PrincipalFrame { body, axes, covariance } = frame;
    // From the axes of the world at the start to the principal ones.
    let turned: Vec<_> = motion.into_iter().map(|m| MotionState { R_WO: m.R_WO * axes, ..m }).collect();
    let motion = MotionEstimate {
        start: StartState { R_WO: axes, ..start },
        curves: curves::contact_curves(track, &turned)?,
        radii: curves::radii(track, &turned),
        motion: turned,
        pose_errors: joint(axes),
        covariance,
        evidence,
        reliability,
    };
    Ok(BodyEstimate { body, motion })
}

fn evidence(track: &Track, found: &Found) -> Evidence {
    let sizes = BodyProblem::new(track, found.scales, f64::INFINITY).sizes();
    let scaled = SMatrix::<f64, BODY_UNKNOWNS, BODY_UNKNOWNS>::from_fn(|i, j| {
        found.covariance[(i, j)] / (sizes[i] * sizes[j])
    });
    let spectrum = Observability::new(&scaled);
    let weakest = WeakDirection::of_body(
        &spectrum.directions.column(BODY_UNKNOWNS - 1).into_owned(),
        spectrum.eigenvalues[BODY_UNKNOWNS - 1].max(0.0).sqrt(),
    );
    let Found { residuals, predicted, observability, noise, iterations, .. } = found;
    Evidence::new(track, residuals, *predicted, observability, weakest, *noise, *iterations)
}
