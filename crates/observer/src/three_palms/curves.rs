//! Contact curves and radius functions that follow from the contacts and a motion.

use super::estimate::EstimateError;
use super::momentum::MotionState;
use super::momentum::StartState;
use super::quadrature::derivative;
use super::refine::Refined;
use super::sensitivity::cross_matrix;
use super::track::Track;
use contact_kinematics::{ContactCurve, CurvePoint, body_normal, body_normal_rate};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::SMatrix;

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

/// How well the contact curves are known at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveUncertainty {
    /// Time as in the log, s.
    pub t: f64,
    /// Standard deviations of the radius function values, m.
    pub radii: [f64; 3],
    /// Covariances of the contact points `beta_O`, body axes, m^2: of motion and contact noise together.
    pub points: [DMat3; 3],
    /// Covariances of the outward normals `n_O`, body axes.
    pub normals: [DMat3; 3],
}

/// The uncertainty of the curves at the nodes of a most probable motion, in body axes that stand at `axes` in the model's.
///
/// `r = n . p`, `beta = R' (c - p)`, `n_O = -R' n`: with a true orientation `exp([theta]x) R`, `d beta = R' (b x theta -
/// dp)` and `d n_O = R' (theta x n)`, `b = c - p`. Errors of the axes themselves, where the inertia was unknown, turn the
/// curve as a whole and are not among these.
pub(super) fn uncertainty<const N: usize>(
    track: &Track,
    refined: &Refined<N>,
    axes: DQuat,
) -> Vec<CurveUncertainty> {
    let times: Vec<f64> = track.times().collect();
    let solution = &refined.solution;
    let contact = refined.model.contact_variance();
    let states = refined.states();
    let one = |((&k, state), covariance): ((&usize, &StartState), &SMatrix<f64, N, N>)| {
        let block = |row: usize, column: usize| {
            DMat3::from_cols_array_2d(&std::array::from_fn(|j| {
                std::array::from_fn(|i| covariance[(3 * row + i, 3 * column + j)])
            }))
        };
        let (pp, pt, tt) = (block(0, 0), block(0, 3), block(3, 3));
        let to_body = DMat3::from_quat((state.R_WO * axes).inverse());
        let node = &track.nodes[k];
        let in_body = |m: DMat3| to_body * m * to_body.transpose();
        let frame = |i: usize| &node.palms[i].frame;
        CurveUncertainty {
            t: times[k],
            radii: std::array::from_fn(|i| frame(i).n.dot(pp * frame(i).n).max(0.0).sqrt()),
            points: std::array::from_fn(|i| {
                let b = cross_matrix(node.p_WC[i] - state.p_WCm);
                let cross = b * pt.transpose();
                let n = frame(i).n;
                let tangent = DMat3::IDENTITY - DMat3::from_cols(n * n.x, n * n.y, n * n.z);
                in_body(b * tt * b.transpose() + pp - cross - cross.transpose() + tangent * contact)
            }),
            normals: std::array::from_fn(|i| {
                let n = cross_matrix(frame(i).n);
                in_body(n * tt * n.transpose())
            }),
        }
    };
    refined.nodes.iter().zip(&states).zip(&solution.covariances).map(one).collect()
}
