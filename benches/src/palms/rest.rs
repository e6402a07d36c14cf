//! Where a body lies lowest on three planes through the origin of the world.

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::BodyState;

/// Steps downhill at most: in a valley between palms that are nearly flat, or nearly parallel, small steps go from side to side for minutes.
const MOST: usize = 20_000;

/// The body at rest on three planes through the world's origin with these normals (world, into the object), turned from an orientation
/// downhill to where its centre lies lowest.
#[must_use]
pub fn lowest(body: &impl SupportFunction, normals: [DVec3; 3], start: DQuat) -> BodyState {
    let inverse = DMat3::from_cols(normals[0], normals[1], normals[2]).transpose().inverse();
    let place = |R_WO: DQuat| {
        let support = |i: usize| Direction::new(R_WO.inverse() * -normals[i]).map(|u| body.value(u));
        inverse * DVec3::from_array([0, 1, 2].map(|i| support(i).unwrap_or(f64::NAN)))
    };
    let height = |x: DVec3, R: DQuat| place(DQuat::from_scaled_axis(x) * R).z;
    let (mut R_WO, mut step) = (start.normalize(), 0.3);
    // Downhill until the height says no more: at rest without friction, well inside of the cones with it.
    for _ in 0..MOST {
        if step <= 1e-7 {
            break;
        }
        let slope = DVec3::AXES.map(|e| (height(1e-5 * e, R_WO) - height(-1e-5 * e, R_WO)) / 2e-5);
        let down = -DVec3::from_array(slope).normalize_or_zero();
        if height(step * down, R_WO) < height(DVec3::ZERO, R_WO) {
            R_WO = (DQuat::from_scaled_axis(step * down) * R_WO).normalize();
        } else {
            step *= 0.5;
        }
    }
    BodyState { p_WCm: place(R_WO), R_WO, v_WCm: DVec3::ZERO, w_WO: DVec3::ZERO }
}
