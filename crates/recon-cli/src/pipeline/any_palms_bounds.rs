//! Bounds on the shape from contacts of any palms.

use super::bounds::BoundsResult;
use super::sound::{SHARE_OF_POSES, finished, in_tangent};
use crate::error::CliError;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{Direction, PalmSurface};
use recon::object_dynamics::ContactLog;
use recon::observer::ContactEstimate;
use recon::shape_bounds::{CertainBounds, ContactNoise, ContactSample, NoisyContact, PoseNoise};
use recon_io::PalmContact;

/// Samples whose contacts bound the body, at most: each widens the margins of all a little.
const SAMPLES: usize = 1500;
/// Largest margin of a turn, rad: beyond it displacements are not those of small turns.
const LARGEST_TURN: f64 = 0.5;
/// Numbers of a pose, of which only the deviation of each is known.
const NUMBERS: f64 = 6.0;

/// Bounds that hold at `confidence` for the noise of the contacts (`contact_noise`, m) and for the motion's deviations, in body axes
/// that are those of the world at the first sample, about the centre of mass. None where no sample is known well enough.
///
/// Of the six errors of a pose the estimate tells the deviations `s`, and not how they go together. With the odds
/// `p = alpha / (6 n)` for each error of the `n` poses, all are within `z s` of zero together, `z^2 = 2 log(1 / p)` (the bound `exp(-z^2 / 2)` of
/// a normal variable's tails). Then `e' (6 D)^-1 e <= z^2` with `D = diag(s^2)`, whatever their correlations.
pub(super) fn estimate_bounds(
    log: &ContactLog,
    estimate: &ContactEstimate,
    curves: &[Vec<Option<PalmContact>>],
    contact_noise: f64,
    confidence: f64,
) -> Result<Option<BoundsResult>, CliError> {
    let samples = estimate.states.len();
    let used: Vec<usize> = (0..samples).step_by(samples.div_ceil(SAMPLES)).collect();
    let alpha = 1.0 - confidence;
    let deviations = (2.0 * (NUMBERS * used.len() as f64 / (SHARE_OF_POSES * alpha)).ln()).sqrt();
    let known = |k: &&usize| {
        let turn = deviations * NUMBERS.sqrt() * estimate.deviations[**k][3].max_element();
        estimate.relied_on[**k] && turn <= LARGEST_TURN
    };
    let used: Vec<usize> = used.iter().filter(known).copied().collect();
    let curve = |(palm, curve): (&recon::object_dynamics::LoggedPalm, &Vec<Option<PalmContact>>)| {
        let turning = contact_noise * curvature(palm.surface());
        let noisy = |k: &usize| {
            let PalmContact { p_OC, normal, .. } = curve[*k]?;
            let contact = ContactSample { point: p_OC, normal: Direction::new_unchecked(normal) };
            let point = in_tangent(&contact, contact_noise * contact_noise);
            Some(NoisyContact {
                contact,
                noise: ContactNoise { point, normal: turning, pose: pose_noise(estimate, *k) },
            })
        };
        used.iter().filter_map(noisy).collect::<Vec<_>>()
    };
    let curves: Vec<_> = log.palms().iter().zip(curves).map(curve).collect();
    if curves.iter().all(Vec::is_empty) {
        return Ok(None);
    }
    let confidence = 1.0 - (1.0 - SHARE_OF_POSES) * alpha;
    let bounds = CertainBounds::from_curves_of_poses(&curves, confidence, deviations)?;
    finished(&bounds, Vec::new()).map(Some)
}

/// Largest curvature of a palm, 1/m: by which noise along it turns the normal.
fn curvature(surface: PalmSurface) -> f64 {
    match surface {
        PalmSurface::Plane => 0.0,
        PalmSurface::Sphere { radius } | PalmSurface::Cup { radius } | PalmSurface::Cylinder { radius } => {
            1.0 / radius
        }
    }
}

/// The covariance `6 D`, in body axes.
fn pose_noise(estimate: &ContactEstimate, k: usize) -> PoseNoise {
    let [centre, _, _, turn] = estimate.deviations[k];
    let R_OW = DMat3::from_quat(estimate.states[k].R_WO).transpose();
    let covariance = |of: DVec3| {
        let c = R_OW * DMat3::from_diagonal(NUMBERS * of * of) * R_OW.transpose();
        // As symmetric as a covariance is.
        0.5 * (c + c.transpose())
    };
    PoseNoise { rotation: covariance(turn), translation: covariance(centre), cross: DMat3::ZERO }
}
