//! The paper's own way: integrate its system (35) to (37) from given initial conditions, by prediction and correction,
//! with the constraints (15) and (24).
//!
//! It is exponentially unstable (errors of the start grow about 1e5-fold over the paper's Fig. 5), takes no force as
//! redundant and never uses Newton's law (30) but in the constraint. It stays as an oracle for data without noise, and
//! on the charts; to estimate, use [`crate::contacts::estimate_contacts`].
//!
//! ```
//! use contact_kinematics::{Ellipsoid, Palm};
//! use glam::{DQuat, DVec3};
//! use object_dynamics::integrate::Tolerance;
//! use object_dynamics::{InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
//! use observer::three_palms::Track;
//! use observer::three_palms::paper_method::{
//!     PaperMethod, PaperStart, PredictorCorrector, integrate_paper_system,
//! };
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // What three palms sense, exactly, for a second.
//! let axes = DVec3::new(0.05, 0.045, 0.04);
//! let mass = MassProperties::uniform_ellipsoid(0.3, axes)?;
//! let palm = |k: f64| Palm::fixed(k * std::f64::consts::TAU / 3.0, 0.8);
//! let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palm(0.0)?, palm(1.0)?, palm(2.0)?], 9.81)?;
//! let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(2.0, -1.0, 4.0) };
//! let times = SampleTimes { duration: 1.0, rate: 500.0 };
//! let run = scene.simulate(start, times, Tolerance::uniform(1e-12))?;
//! let log = run.sensor_log(&scene)?;
//! let touch = &run.instants[0].touch;
//! let exact = PaperStart { radii: touch.contacts.map(|c| c.jet.value), R_WO: start.R_WO, w_WO: start.w_WO };
//! let method = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
//! let track = Track::new(&log, scene.gravity(), None)?;
//! let found = integrate_paper_system(&track, scene.mass(), &exact, method)?;
//! assert_eq!((found.diverged_at, found.radii.len()), (None, 501));
//! let last = run.instants[500].touch.contacts[0].jet.value;
//! assert!((found.radii[500][0] - last).abs() < 1e-8);
//! assert!(found.amplification() > 1.0); // an error of the start grows
//! # Ok(())
//! # }
//! ```

use super::motion_state::MotionState;
use super::paper_system::{State, System};
use super::track::Track;
use contact_kinematics::PalmError;
use glam::{DQuat, DVec3};
use nalgebra::SMatrix;
use object_dynamics::MassProperties;
use thiserror::Error;

/// Radius functions, rotation and angular velocity: what (35) to (37) integrate.
pub(super) const STATES: usize = 9;
/// Scheme of prediction and correction, of the step of the samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PredictorCorrector {
    /// Euler predictor, trapezoidal corrector: order 2.
    Heun,
    /// Adams-Bashforth predictor and Adams-Moulton corrector of four steps, each evaluated once: order 4. Needs a
    /// constant sample rate; the first three steps come from Picard's iteration.
    Adams4,
}

/// How to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperMethod {
    /// Scheme.
    pub scheme: PredictorCorrector,
    /// Whether each step is pulled onto the acceleration constraint (24) by the smallest change of radii and angular
    /// velocity. It holds the constraint, and with it needs second differences of the contacts: for clean data only.
    pub enforce_constraint: bool,
}

/// Initial conditions, which the paper assumes to be known (angular velocity) or searches for (radii).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperStart {
    /// Radius functions at the three contacts, m.
    pub radii: [f64; 3],
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Angular velocity, rad/s, world axes.
    pub w_WO: DVec3,
}

/// Why the paper's system cannot be integrated.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PaperError {
    /// The palms do not determine the centre of mass.
    #[error("at t = {t} s: {source}")]
    Palms {
        /// Time as in the log, s.
        t: f64,
        /// Why.
        source: PalmError,
    },
    /// The initial conditions are not numbers.
    #[error("initial {what} is not finite")]
    NotFinite {
        /// Which.
        what: &'static str,
    },
    /// The four-step scheme needs equal steps.
    #[error(
        "samples {index} and {next} are {step} s apart, the first two {first} s; this scheme needs a constant sample rate"
    )]
    UnevenSamples {
        /// Index of the sample before the uneven step.
        index: usize,
        /// Index after it.
        next: usize,
        /// The step, s.
        step: f64,
        /// The first step, s.
        first: f64,
    },
}

/// What came of the integration.
#[derive(Clone, Debug)]
pub struct PaperReconstruction {
    /// Motion at every sample reached.
    pub motion: Vec<MotionState>,
    /// Radius functions at every sample reached, m.
    pub radii: Vec<[f64; 3]>,
    /// Time as in the log at which the solution left all bounds, if it did.
    pub diverged_at: Option<f64>,
    /// Largest difference of prediction and correction, in natural sizes: the paper's own measure of error.
    pub prediction_gap: f64,
    /// Root mean square of the acceleration constraint (24), m/s^2, before any enforcement: the residual.
    pub constraint_defect: f64,
    /// Derivative of the last state (radii in scene sizes, rotation vector, angular velocity in natural rates) by the
    /// first.
    pub sensitivity: SMatrix<f64, STATES, STATES>,
}

impl PaperReconstruction {
    /// Largest singular value of the sensitivity: how many times an error of the start has grown.
    #[must_use]
    pub fn amplification(&self) -> f64 {
        self.sensitivity.singular_values().max()
    }

    /// Directions of the start of which the last state keeps a trace in double precision.
    #[must_use]
    pub fn rank(&self) -> usize {
        let values = self.sensitivity.singular_values();
        values.iter().filter(|&&v| v > f64::EPSILON * values.max()).count()
    }

    /// Ratio of the largest to the smallest singular value of the sensitivity.
    #[must_use]
    pub fn condition(&self) -> f64 {
        let values = self.sensitivity.singular_values();
        values.max() / values.min()
    }

    /// Covariance of the last state, in the units of the sensitivity, for a given one of the first.
    #[must_use]
    pub fn covariance(&self, start: &SMatrix<f64, STATES, STATES>) -> SMatrix<f64, STATES, STATES> {
        self.sensitivity * start * self.sensitivity.transpose()
    }
}

/// Integrates (35) to (37) along a track from `start`.
///
/// # Errors
/// [`PaperError`]. Divergence is no error but an outcome: see [`PaperReconstruction::diverged_at`].
pub fn integrate_paper_system(
    track: &Track,
    mass: &MassProperties,
    start: &PaperStart,
    method: PaperMethod,
) -> Result<PaperReconstruction, PaperError> {
    if !start.radii.iter().all(|r| r.is_finite()) {
        return Err(PaperError::NotFinite { what: "radius function value" });
    }
    if !(start.R_WO.is_finite() && start.w_WO.is_finite()) {
        return Err(PaperError::NotFinite { what: "orientation or angular velocity" });
    }
    if method.scheme == PredictorCorrector::Adams4 {
        check_spacing(track)?;
    }
    let system = System::new(track, mass)?;
    let first = State { r: DVec3::from_array(start.radii), q: start.R_WO.normalize(), w: start.w_WO };
    let run = system.run(first, method);
    let sensitivity = system.sensitivity(first, method);
    let times: Vec<f64> = track.times().collect();
    let motion = run.states.iter().enumerate().map(|(k, s)| system.motion(times[k], k, s)).collect();
    Ok(PaperReconstruction {
        motion,
        radii: run.states.iter().map(|s| s.r.to_array()).collect(),
        diverged_at: (run.states.len() < track.len()).then(|| times[run.states.len()]),
        prediction_gap: run.gap,
        constraint_defect: (run.defect / run.states.len().max(1) as f64).sqrt(),
        sensitivity,
    })
}

fn check_spacing(track: &Track) -> Result<(), PaperError> {
    let first = track.t[1] - track.t[0];
    let uneven = (1..track.t.len()).find(|&k| (track.t[k] - track.t[k - 1] - first).abs() > 1e-6 * first);
    match uneven {
        Some(k) => {
            let step = track.t[k] - track.t[k - 1];
            Err(PaperError::UnevenSamples { index: k - 1, next: k, step, first })
        }
        None => Ok(()),
    }
}
