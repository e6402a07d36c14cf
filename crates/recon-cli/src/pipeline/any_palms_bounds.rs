//! Bounds on the shape from contacts of any palms.

use super::bounds::BoundsResult;
use super::sound::{PosedContact, bounds_of_poses, in_tangent};
use crate::error::CliError;
use recon::contact_kinematics::{Direction, PalmSurface};
use recon::object_dynamics::{ContactLog, LoggedPalm};
use recon::observer::contacts::ContactEstimate;
use recon::shape_bounds::ContactSample;
use recon_io::PalmContact;

/// Samples whose contacts bound the body, at most. Of six logs three times as many made the gap smaller by up to 4 % (the densest, a minute at 1 kHz) and by
/// 0.0002 to 0.4 % otherwise, at four times the time and with three times the corners.
const SAMPLES: usize = 2000;

/// Bounds that hold at `confidence` for the noise of the contacts (`contact_noise`, m) and for the errors of the poses, in body axes
/// in which the estimated poses are right on the average. None where no sample is known well enough.
pub(super) fn estimate_bounds(
    log: &ContactLog,
    estimate: &ContactEstimate,
    curves: &[Vec<Option<PalmContact>>],
    contact_noise: f64,
    confidence: f64,
) -> Result<Option<BoundsResult>, CliError> {
    let Some(errors) = &estimate.pose_errors else { return Ok(None) };
    let samples = estimate.states.len();
    let used = (0..samples).step_by(samples.div_ceil(SAMPLES)).filter(|&k| estimate.relied_on[k]);
    let used: Vec<usize> = used.collect();
    let curve = |(palm, curve): (&LoggedPalm, &Vec<Option<PalmContact>>)| -> Vec<PosedContact> {
        let turning = contact_noise * curvature(palm.surface());
        let noisy = |&sample: &usize| {
            let PalmContact { p_OC, normal, .. } = curve[sample]?;
            let contact = ContactSample { point: p_OC, normal: Direction::new_unchecked(normal) };
            let point = in_tangent(&contact, contact_noise * contact_noise);
            Some(PosedContact { sample, contact, point, normal: turning })
        };
        used.iter().filter_map(noisy).collect()
    };
    let curves: Vec<_> = log.palms().iter().zip(curves).map(curve).collect();
    if curves.iter().all(Vec::is_empty) {
        return Ok(None);
    }
    bounds_of_poses(errors, &curves, confidence)
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
