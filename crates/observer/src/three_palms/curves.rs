//! Contact curves and radius functions that follow from the contacts and a motion.

use super::estimate::EstimateError;
use super::momentum::MotionState;
use super::quadrature::derivative;
use super::track::Track;
use contact_kinematics::{ContactCurve, CurvePoint, body_normal, body_normal_rate};
use glam::{DMat3, DVec3};

/// `beta_i = R_WO' (c_i - p_WCm)` and its rate, from differences of the curve in the plane of its normal.
pub(super) fn contact_curves(
    track: &Track,
    motion: &[MotionState],
) -> Result<[ContactCurve; 3], EstimateError> {
    // An estimate that left the numbers is none.
    if !motion.iter().all(|m| m.p_WCm.is_finite() && m.R_WO.is_finite()) {
        return Err(EstimateError::NoFit);
    }
    let mut curves = [ContactCurve::default(), ContactCurve::default(), ContactCurve::default()];
    let t: Vec<f64> = motion.iter().map(|m| m.t).collect();
    for (i, curve) in curves.iter_mut().enumerate() {
        let points: Vec<DVec3> = motion
            .iter()
            .zip(&track.nodes)
            .map(|(m, node)| m.R_WO.inverse() * (node.p_WC[i] - m.p_WCm))
            .collect();
        let rates = derivative(&t, &points, DVec3::ZERO);
        let point = |(k, m): (usize, &MotionState)| {
            let (rotation, palm) = (DMat3::from_quat(m.R_WO), &track.nodes[k].palms[i]);
            let n_O = body_normal(rotation, palm.frame.n);
            CurvePoint {
                t: m.t,
                beta_O: points[k],
                n_O,
                beta_dot_O: rates[k] - n_O.get() * n_O.get().dot(rates[k]),
                n_dot_O: body_normal_rate(rotation, palm, m.w_WO),
            }
        };
        *curve = ContactCurve::new(motion.iter().enumerate().map(point).collect())
            .map_err(|source| EstimateError::Curve { palm: i + 1, source })?;
    }
    Ok(curves)
}

/// `r_i = n_i . p_WCm` at every sample, m.
pub(super) fn radii(track: &Track, motion: &[MotionState]) -> Vec<[f64; 3]> {
    let one = |(m, node): (&MotionState, &super::track::Node)| node.palms.map(|p| p.frame.n.dot(m.p_WCm));
    motion.iter().zip(&track.nodes).map(one).collect()
}
