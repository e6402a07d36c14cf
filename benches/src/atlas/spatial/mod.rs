//! Estimates of motion on three palms.

mod contacts;
pub(super) use contacts::Rubbed;
mod estimate;
mod lost;
mod paper;
pub(super) mod scene;
mod sensed;
mod stream;
mod without_forces;

pub(super) use estimate::{KNOWN, UNKNOWN, friction_and_sensing, of_spec as whole_log};
pub(super) use paper::METHOD as PAPER;
pub(super) use stream::METHOD as STREAM;
pub(super) use without_forces::METHOD as WITHOUT_FORCES;

use glam::DVec3;
use recon::object_dynamics::BodyState;

/// What concerns an estimate of an unknown body.
const WAYS: &[super::Way] = {
    use super::Way::*;
    &[
        Parallel,
        Flat,
        Steep,
        Sphere,
        Revolution,
        Pole,
        Relative,
        Force,
        Drop,
        Loss,
        Held,
        Hinge,
        Slow,
        Window,
        Noise,
        Unstated,
        Bias,
        Gain,
        Delay,
        Correlation,
        Taxels,
        Outliers,
        Gap,
        Dropped,
        Rate,
        Palm,
        Friction,
        Shaking,
        Long,
        Switches,
        Size,
    ]
};

/// The same, and what is stated of the body.
const WAYS_OF_KNOWN: &[super::Way] = {
    use super::Way::*;
    &[
        Parallel,
        Flat,
        Steep,
        Sphere,
        Revolution,
        Pole,
        Relative,
        Force,
        Drop,
        Loss,
        Held,
        Hinge,
        Slow,
        Window,
        Noise,
        Unstated,
        Bias,
        Gain,
        Delay,
        Correlation,
        Taxels,
        Outliers,
        Gap,
        Dropped,
        Rate,
        Mass,
        Inertia,
        Palm,
        Friction,
        Shaking,
        Long,
        Switches,
        Size,
    ]
};

/// Largest error of place, velocity and angular velocity in their deviations.
fn in_deviations(found: &BodyState, truth: &BodyState, deviations: &[DVec3]) -> f64 {
    let errors = [found.p_WCm - truth.p_WCm, found.v_WCm - truth.v_WCm, found.w_WO - truth.w_WO];
    let parts = errors.iter().zip(deviations).flat_map(|(error, of)| (error.abs() / *of).to_array());
    // What is no number must not be lost in a maximum.
    parts.fold(0.0, |worst, part| if part > worst || part.is_nan() { part } else { worst })
}

/// The larger one, and what is no number where one is none.
fn worse(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
