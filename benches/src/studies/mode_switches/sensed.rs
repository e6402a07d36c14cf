//! What a run looks like to a classifier: forces and slips with noise.

use super::scenes::{Exact, Run};
use nalgebra::{Matrix2, Vector2, Vector6};
use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::{ContactReading, ContactSeen, ContactSlip};
use recon_tests::Random;
use std::f64::consts::TAU;

/// Deviations over the noise stated: of a force that is there, of its own size and of the weight; of velocity and angular velocity
/// of the body, of natural ones.
const OF_FORCE: f64 = 1.0;
const OF_WEIGHT: f64 = 0.1;
const OF_TWIST: [f64; 2] = [0.3, 1.0];
/// Own error of each slip beside that of the twist, natural speeds.
const OWN: f64 = 3e-4;
/// Time constant of the errors of the twist, s: those of an estimate last.
pub(super) const LASTING: f64 = 0.05;

/// What is read of each contact at each sample, and the deviation of an unloaded force, N.
pub(super) fn sensed(run: &Run, noise: f64, seed: u64) -> (Vec<Vec<ContactSeen>>, f64) {
    let mut random = Random::new(seed);
    let mut draw = || {
        let (a, b) = (random.within(0.0, 1.0), random.within(0.0, 1.0));
        (-2.0 * (1.0 - a).ln()).sqrt() * (TAU * b).cos()
    };
    let deviations = Vector6::from_fn(|i, _| match i {
        0..3 => OF_TWIST[0] * noise * run.natural_speed(),
        _ => OF_TWIST[1] * noise * run.natural_rate(),
    });
    let mut error = deviations.map(|deviation| deviation * draw());
    let kept = (-Run::DT / LASTING).exp();
    let unloaded = OF_WEIGHT * noise * run.weight;
    let samples = run.samples.iter().map(|contacts| {
        let fresh = deviations.map(|deviation| deviation * draw());
        error = kept * error + (1.0 - kept * kept).sqrt() * fresh;
        contacts.iter().map(|exact| read(exact, run, noise, &deviations, &error, &mut draw)).collect()
    });
    (samples.collect(), unloaded)
}

fn read(
    exact: &Exact,
    run: &Run,
    noise: f64,
    deviations: &Vector6<f64>,
    error: &Vector6<f64>,
    draw: &mut impl FnMut() -> f64,
) -> ContactSeen {
    let size = exact.normal.hypot(exact.friction.norm());
    let force_deviation = noise * (OF_FORCE * size).hypot(OF_WEIGHT * run.weight);
    let own = OWN * run.natural_speed();
    let mut both = |deviation: f64| Vector2::new(draw(), draw()) * deviation;
    let velocity = exact.slip + exact.slope * error + both(own);
    let friction = exact.friction + both(force_deviation);
    let normal_force = exact.normal + both(force_deviation).x;
    let spread = exact.slope * nalgebra::Matrix6::from_diagonal(&deviations.map(|d| d * d));
    let covariance = spread * exact.slope.transpose() + Matrix2::identity() * (own * own);
    // Of a contact that is off there is no slip to speak of.
    let slip = (exact.mode != ContactMode::Off).then_some(ContactSlip { velocity, covariance });
    ContactSeen::Read(ContactReading { normal_force, friction, force_deviation, slip, touches: false })
}
