//! What tests of estimates in the plane share; the scenes are those of the library.
#![allow(clippy::unwrap_used, reason = "helpers of tests, where a panic is the report")]
#![allow(dead_code, reason = "each test file uses its part of the shared scenes")]

use recon::contact_kinematics::planar::FourierBody;
use recon::object_dynamics::planar::{PlanarMass, PlanarObject, PlanarTruth};
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::{PlaneEstimate, PlaneOptions};

pub(crate) use recon_tests::planar_scenes::*;

/// `count + 1` sample times from zero, `rate` a second.
pub(crate) fn times(rate: f64, duration: f64) -> Vec<f64> {
    let count = (duration * rate).round() as u32;
    (0..=count).map(|k| f64::from(k) / rate).collect()
}

/// Noise of contacts (m) and forces (N), with what conditions of a body of the size `length` are off by beside that.
pub(crate) fn noise_level(contact: f64, force: f64, length: f64) -> ContactNoiseLevel {
    let floor = 3e-5 * (9.81 * length).sqrt();
    ContactNoiseLevel { contact, force_fixed: force, force_share: 0.0, impulse: None, floor }
}

/// A body by the harmonics of its radius function (m), its mass and its moment of inertia.
pub(crate) fn fourier_object(cosines: &[f64], sines: &[f64], mass: [f64; 2]) -> PlanarObject<FourierBody> {
    let shape = FourierBody::new(cosines, sines).unwrap();
    PlanarObject { shape, mass: PlanarMass::new(mass[0], mass[1]).unwrap(), gravity: 9.81 }
}

/// What is told of two palms without friction.
pub(crate) fn options(noise: ContactNoiseLevel, gravity: f64, body: Option<PlanarMass>) -> PlaneOptions {
    PlaneOptions { body, suspects: true, ..PlaneOptions::new(noise, gravity, vec![Some(0.0); 2]) }
}

/// Errors of an estimate at the samples that are relied on: largest of the centre of mass (m), of the turn (rad), and of any number in
/// its deviations; mean square of centre, velocity and angular velocity in theirs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Errors {
    pub(crate) place: f64,
    pub(crate) turn: f64,
    pub(crate) worst: f64,
    pub(crate) mean: f64,
    pub(crate) relied_on: usize,
}

pub(crate) fn errors(estimate: &PlaneEstimate, truth: &[PlanarTruth]) -> Errors {
    let (mut all, mut sum) = (Errors::default(), 0.0);
    for (k, truth_now) in truth.iter().enumerate().filter(|(k, _)| estimate.relied_on[*k]) {
        let (state, of) = (&estimate.states[k], &estimate.deviations[k]);
        let (p, v) = (state.p_WCm - truth_now.p_WCm, state.v_WCm - truth_now.v_WCm);
        let turn = state.phi0 - (truth_now.phi0 - truth[0].phi0);
        let [p_in, v_in] = [p / of.p_WCm, v / of.v_WCm];
        let spin = (state.omega0 - truth_now.omega0) / of.omega0;
        let five = [p_in.x, p_in.y, v_in.x, v_in.y, spin];
        all.place = all.place.max(p.length());
        all.turn = all.turn.max(turn.abs());
        all.worst = five.iter().fold(all.worst, |most, e| most.max(e.abs()));
        sum += five.iter().map(|e| e * e).sum::<f64>() / 5.0;
        all.relied_on += 1;
    }
    all.mean = sum / all.relied_on.max(1) as f64;
    all
}
