//! The coefficient of friction that motions are predicted with.

use glam::DVec2;
use object_dynamics::ContactMode;
use object_dynamics::planar::ContactLog;
use observer::planar::PlaneEstimate;

/// The median ratio of friction to normal force where contacts slide, by the modes of the estimate; zero where none has slid.
pub(super) fn of_sliding(log: &ContactLog, estimate: &PlaneEstimate) -> f64 {
    let mut ratios = Vec::new();
    for (k, (sample, state)) in log.samples().iter().zip(&estimate.states).enumerate() {
        let turned = DVec2::from_angle(state.phi0);
        for (i, palm) in sample.palms.iter().enumerate() {
            let Some(contact) = estimate.contacts[i][k] else { continue };
            let inward = -turned.rotate(contact.normal);
            let pressing = palm.force.dot(inward);
            if estimate.modes[k][i] == ContactMode::Slide && pressing > 0.0 {
                ratios.push(palm.force.perp_dot(inward).abs() / pressing);
            }
        }
    }
    let middle = ratios.len() / 2;
    if ratios.is_empty() { 0.0 } else { *ratios.select_nth_unstable_by(middle, f64::total_cmp).1 }
}
