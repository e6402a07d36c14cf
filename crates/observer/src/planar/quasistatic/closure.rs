//! The one unknown of a quasistatic reconstruction, from a loop of the palms.

use super::{QuasistaticError, quasistatic_reconstruction};
use object_dynamics::integrate::find_root;
use object_dynamics::planar::PlanarLog;

/// Change of the closure over the bracket, in rad, below which it says nothing about the height.
const SMALLEST_CLOSURE: f64 = 1e-9;

/// Height of the centre of mass from the closure of the orientation on a loop of the palms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightFit {
    /// Height of the centre of mass at the first sample, m.
    pub height: f64,
    /// Change of the closure with the height, rad/m. The deviation of the height is that of the closing orientation over this.
    pub sensitivity: f64,
}

/// Height of the centre of mass at the first sample for which the orientation closes on a loop of the palms, between two
/// heights (m).
///
/// On a loop that ends where it began the object is back in the same equilibrium, if it stayed on one stable branch. The
/// height enters the closure only weakly, and not at all while the angle between the palms is constant.
///
/// # Errors
/// [`QuasistaticError`]: no loop, no closure within the bracket, or what [`quasistatic_reconstruction`] refuses.
pub fn height_from_closure(log: &PlanarLog, bracket: [f64; 2]) -> Result<HeightFit, QuasistaticError> {
    let samples = log.samples();
    let (first, last) = (samples[0].angles, samples[samples.len() - 1].angles);
    let distance = (first[0] - last[0]).hypot(first[1] - last[1]);
    let path: f64 = samples
        .windows(2)
        .map(|w| (w[1].angles[0] - w[0].angles[0]).hypot(w[1].angles[1] - w[0].angles[1]))
        .sum();
    if distance.is_nan() || distance > 1e-6 * path {
        return Err(QuasistaticError::NoLoop { distance });
    }
    let closure = |height: f64| {
        quasistatic_reconstruction(log, height).map(|p| p.points.last().map_or(f64::NAN, |p| p.phi0))
    };
    let (low, high) = (closure(bracket[0])?, closure(bracket[1])?);
    let size = bracket[0].abs().max(bracket[1].abs());
    let root = find_root(|h| closure(h).unwrap_or(f64::NAN), bracket[0], bracket[1], 1e-12 * size);
    let height = match root {
        Ok(height) if (high - low).abs() > SMALLEST_CLOSURE => height,
        _ => return Err(QuasistaticError::NoClosure { low, high }),
    };
    let step = 1e-4 * (bracket[1] - bracket[0]);
    let sensitivity = (closure(height + step)? - closure(height - step)?) / (2.0 * step);
    Ok(HeightFit { height, sensitivity })
}
