use super::clean::{Clean, clean_covariance, stride};
use super::cold_start::{cold_start, fit_near, scales};
use super::covariance::NoiseLevel;
use super::evidence::{Evidence, Reliability, WeakDirection};
use super::momentum::{MomentumProblem, MotionState, Row, Scales, StartState, UNKNOWNS};
use super::noise::noise_level;
use super::orientations::nearest_to_identity;
use super::polish::polish_all;
use super::pose_errors::{self, PoseErrors};
use super::track::{Track, TrackError};
use super::verdict::judge;
use crate::least_squares::{LeastSquares, Observability};
use contact_kinematics::{ContactCurve, CurveError};
use glam::DVec3;
use nalgebra::SMatrix;
use object_dynamics::{MassProperties, SensorLog};
use thiserror::Error;

/// Contact noise, relative to length, above which data are worth adjusting: below it, plain least squares is as good.
pub(super) const WORTH_ADJUSTING: f64 = 1e-7;
/// No sensor is better than rounding to 12 digits: floor of the noise level, relative to length and force.
const NOISE_FLOOR: f64 = 1e-12;

/// What is known beside the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownBody {
    /// Mass and inertia.
    pub mass: MassProperties,
    /// Acceleration of free fall, world, m/s^2.
    pub gravity: DVec3,
    /// Moments of inertia of the palms about their axes, kg m^2: needed only for logs of torques on moving palms.
    pub palm_inertias: Option<[f64; 3]>,
    /// Sensor noise; where it is not known it is taken from the roughness of the readings.
    pub noise: Option<NoiseLevel>,
}

/// Why there is no estimate.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum EstimateError {
    /// The log cannot be used.
    #[error("{0}")]
    Track(#[source] TrackError),
    /// Gravity is not a number.
    #[error("gravity ({}, {}, {}) m/s^2 is not finite", gravity.x, gravity.y, gravity.z)]
    Gravity {
        /// As given.
        gravity: DVec3,
    },
    /// No start leads to a finite residual.
    #[error(
        "no motion fits the log: the residual is not finite from any start; check units and frames of the log"
    )]
    NoFit,
    /// The estimated curves are not curves.
    #[error("contact curve of palm {palm}: {source}")]
    Curve {
        /// Palm number from 1.
        palm: usize,
        /// Why.
        source: CurveError,
    },
}

/// Motion of a body of known mass and inertia, with the evidence for it.
#[derive(Clone, Debug)]
pub struct MotionEstimate {
    /// Motion at the first sample. Of the four orientations that differ by half turns about principal axes, and that
    /// no data can tell apart, the one nearest to the world's axes.
    pub start: StartState,
    /// Motion at every sample in contact.
    pub motion: Vec<MotionState>,
    /// Contact curves of the three palms on the body.
    pub curves: [ContactCurve; 3],
    /// Radius function values at the contacts, m: one triple a sample.
    pub radii: Vec<[f64; 3]>,
    /// How far all poses together may be off, for bounds on the shape. None where not a single motion could be drawn.
    pub pose_errors: Option<PoseErrors>,
    /// Covariance of the start: centre of mass (m), velocity (m/s), angular momentum (kg m^2/s), orientation (rotation
    /// vector in world axes, rad), three each.
    pub covariance: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    /// How well the data determine it, and how well it explains them.
    pub evidence: Evidence,
    /// Whether to believe it.
    pub reliability: Reliability,
}

/// Estimates the motion over a log, with no guess of any of its parts (the paper assumes the initial angular velocity
/// to be known).
///
/// Unknown are centre of mass, velocity, angular momentum and orientation at the first sample, 12 numbers. Contact
/// conditions at all samples up to the first loss of contact are fitted by least squares in the momentum form, on
/// windows that grow.
///
/// # Errors
/// [`EstimateError`] when the log cannot be used at all; an estimate that should not be believed is returned with
/// [`Reliability::Unreliable`] and its reasons.
pub fn estimate_motion(log: &SensorLog, known: &KnownBody) -> Result<MotionEstimate, EstimateError> {
    let track = track(log, known)?;
    let scales = scales(&track, &known.mass);
    let noise = floored(known.noise.unwrap_or_else(|| noise_level(&track)), &track, &scales);
    let best = cold_start(&track, &known.mass, noise).into_iter().next().ok_or(EstimateError::NoFit)?;
    clean_estimate(&track, known, scales, noise, best.point)
}

/// As [`estimate_motion`] from a start that is known to be near, without a search: the minimum that it lies above.
///
/// # Errors
/// As [`estimate_motion`].
pub fn estimate_motion_from(
    log: &SensorLog,
    known: &KnownBody,
    near: &StartState,
) -> Result<MotionEstimate, EstimateError> {
    let track = track(log, known)?;
    let scales = scales(&track, &known.mass);
    let best = fit_near(&track, &known.mass, scales, *near).ok_or(EstimateError::NoFit)?;
    let noise = floored(known.noise.unwrap_or_else(|| noise_level(&track)), &track, &scales);
    clean_estimate(&track, known, scales, noise, best.point)
}

fn track(log: &SensorLog, known: &KnownBody) -> Result<Track, EstimateError> {
    if !known.gravity.is_finite() {
        return Err(EstimateError::Gravity { gravity: known.gravity });
    }
    Track::new(log, known.mass.mass(), known.gravity, known.palm_inertias).map_err(EstimateError::Track)
}

/// The least-squares motion of a log with next to no noise, from a start that is near.
fn clean_estimate(
    track: &Track,
    known: &KnownBody,
    scales: Scales,
    noise: NoiseLevel,
    near: StartState,
) -> Result<MotionEstimate, EstimateError> {
    let mass = &known.mass;
    let problem = MomentumProblem::new(track, mass, scales, f64::INFINITY);
    let stride = stride(track, &scales);
    let thin = track.thinned(stride);
    let thin_problem = MomentumProblem::new(&thin, mass, scales, f64::INFINITY);
    let mut fit = polish_all(&problem, &thin_problem, stride, near).ok_or(EstimateError::NoFit)?;
    fit.point.R_WO = nearest_to_identity(mass, fit.point.R_WO);
    let motion = problem.motion(&fit.point);
    let residuals = problem.residuals_along(&motion);
    let observability = Observability::new(&fit.normal.information);
    let (steps, rows) = thin_problem.linearised(&fit.point);
    let Clean { covariance, predicted, lasting } =
        clean_covariance(&steps, &rows, &observability, &noise, stride, &residuals);
    let nodes = (0..track.len()).step_by(stride).collect();
    let poses = |step: &Row| {
        let motion = thin_problem.motion(&thin_problem.retract(&fit.point, step));
        Some(motion.iter().map(|m| (m.p_WCm, m.R_WO)).collect())
    };
    let pose_errors = pose_errors::of_start(nodes, &covariance, poses, lasting, true);
    let weakest = weakest_direction(&covariance);
    let evidence =
        Evidence::new(track, &residuals, predicted, &observability, weakest, noise, fit.iterations);
    let reliability = judge(&evidence, fit.status, &scales);
    let curves = super::curves::contact_curves(track, &motion)?;
    let radii = super::curves::radii(track, &motion);
    let covariance = unscale(&covariance, &scales);
    Ok(MotionEstimate {
        start: fit.point,
        motion,
        curves,
        radii,
        pose_errors,
        covariance,
        evidence,
        reliability,
    })
}

pub(super) fn floored(noise: NoiseLevel, track: &Track, scales: &Scales) -> NoiseLevel {
    let weight = track.mass * track.gravity.length();
    NoiseLevel {
        contact: noise.contact.max(NOISE_FLOOR * scales.length),
        force: noise.force.max(NOISE_FLOOR * weight),
    }
}

fn weakest_direction(covariance: &SMatrix<f64, UNKNOWNS, UNKNOWNS>) -> WeakDirection {
    let spectrum = Observability::new(covariance);
    let last = UNKNOWNS - 1;
    let direction: Row = spectrum.directions.column(last).into_owned();
    WeakDirection::new(&direction, spectrum.eigenvalues[last].max(0.0).sqrt())
}

fn unscale(
    covariance: &SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    scales: &Scales,
) -> SMatrix<f64, UNKNOWNS, UNKNOWNS> {
    let scale = scales.by_block();
    SMatrix::from_fn(|i, j| covariance[(i, j)] * scale[i / 3] * scale[j / 3])
}
