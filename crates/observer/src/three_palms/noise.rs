//! Sensor noise from the roughness of the readings themselves.

use super::covariance::NoiseLevel;
use super::track::Track;
use crate::roughness::Rough;
use glam::DVec3;

/// Standard deviations of white noise in contact coordinates and forces.
pub(super) fn noise_level(track: &Track) -> NoiseLevel {
    let times: Vec<f64> = track.times().collect();
    let contact = |i: usize, k: usize| {
        let node = &track.nodes[k];
        node.palms[i].frame.sensor_from_contact(node.p_WC[i])
    };
    NoiseLevel { contact: roughness(&times, contact), force: along(&times, |i, k| track.nodes[k].forces[i]) }
}

/// Standard deviation of the white noise that is common to the contact coordinates of three palms, by palm and sample.
pub(super) fn roughness(times: &[f64], contact: impl Fn(usize, usize) -> [f64; 2]) -> f64 {
    let mut rough = Rough::default();
    for i in 0..3 {
        let point = |k: usize| Some(DVec3::new(contact(i, k)[0], contact(i, k)[1], 0.0));
        rough.add(times, point, |_| vec![DVec3::X, DVec3::Y]);
    }
    rough.deviation()
}

fn along(times: &[f64], force: impl Fn(usize, usize) -> f64) -> f64 {
    let mut rough = Rough::default();
    for i in 0..3 {
        rough.add(times, |k| Some(DVec3::X * force(i, k)), |_| vec![DVec3::X]);
    }
    rough.deviation()
}
