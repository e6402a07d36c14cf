//! Whether a motion leaves room for a convex body: a check that the estimate itself does not use.

use super::curves::CurveUncertainty;
use super::momentum::MotionState;
use super::track::Track;
use glam::DVec3;

/// Nodes of the motion that are compared, at most.
const NODES: usize = 64;

/// A contact in body axes.
struct Contact<'a> {
    point: DVec3,
    normal: DVec3,
    at: &'a CurveUncertainty,
    palm: usize,
}

/// Farthest that a contact lies outside the plane touched at another, in standard deviations.
///
/// A convex body lies behind each of its tangent planes, so `n_b . (x_a - x_b) <= 0` for all contacts `a` and `b` at all times,
/// in body axes. Motions that are wrong turn the contacts and planes of other times out of this order. Errors of the two
/// contacts are added as if they were independent; most of what they share cancels, so that this errs on the side of silence.
pub(super) fn largest_violation(
    track: &Track,
    nodes: &[usize],
    motion: &[MotionState],
    uncertainty: &[CurveUncertainty],
) -> f64 {
    let stride = nodes.len().div_ceil(NODES).max(1);
    let contacts: Vec<Contact<'_>> = nodes
        .iter()
        .zip(uncertainty)
        .step_by(stride)
        .flat_map(|(&k, at)| {
            let to_body = motion[k].R_WO.inverse();
            (0..3).map(move |palm| Contact {
                point: to_body * (track.nodes[k].p_WC[palm] - motion[k].p_WCm),
                normal: -(to_body * track.nodes[k].palms[palm].frame.n),
                at,
                palm,
            })
        })
        .collect();
    let mut largest = 0.0f64;
    for plane in &contacts {
        let normals = plane.at.normals[plane.palm];
        for other in &contacts {
            let arm = other.point - plane.point;
            let outside = plane.normal.dot(arm);
            if outside > 0.0 {
                let variance = plane.normal.dot(other.at.points[other.palm] * plane.normal)
                    + plane.at.radii[plane.palm].powi(2)
                    + arm.dot(normals * arm);
                largest = largest.max(outside / variance.sqrt());
            }
        }
    }
    largest
}
