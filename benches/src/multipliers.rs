//! The motion on three palms by the paper's thirteen states and multipliers: the independent way to it.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::integrate::{Dop853, Tolerance};
use recon::object_dynamics::{BodyState, InitialMotion, ThreePalmScene};

/// Position of the centre of mass and orientation.
pub type Pose = (DVec3, DQuat);

/// Poses at so many times that are `step` seconds apart, the first one at zero.
///
/// # Errors
/// Words of what the integrator refuses.
pub fn by_multipliers<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    (step, count): (f64, usize),
    tolerance: Tolerance,
) -> Result<Vec<Pose>, String> {
    let field = |t: f64, y: &[f64; 13]| {
        let state = maximal(y);
        let solution = scene.multiplier_form(t, &state).map_err(|e| e.to_string())?;
        let solution = solution.ok_or("singular multiplier system")?.accelerations;
        let rate = turning(state.R_WO, state.w_WO);
        let (v, a, alpha) = (state.v_WCm, solution.a_WCm, solution.alpha_WO);
        Ok::<_, String>([
            v.x, v.y, v.z, rate.w, rate.x, rate.y, rate.z, a.x, a.y, a.z, alpha.x, alpha.y, alpha.z,
        ])
    };
    let now = scene.instant(0.0, start.R_WO, start.w_WO).map_err(|e| e.to_string())?;
    let (p, q, v, w) = (now.touch.p_WCm, start.R_WO, now.rates.v_WCm, start.w_WO);
    let y = [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z];
    let mut solver = Dop853::new(field, 0.0, y, tolerance).map_err(|e| e.to_string())?;
    let mut poses = vec![(p, q)];
    let duration = step * count.saturating_sub(1) as f64;
    while poses.len() < count {
        let normalise = |y: &mut [f64; 13]| {
            let length = (y[3] * y[3] + y[4] * y[4] + y[5] * y[5] + y[6] * y[6]).sqrt();
            y[3..7].iter_mut().for_each(|v| *v /= length);
        };
        solver.step(duration, normalise).map_err(|e| e.to_string())?;
        let Some(dense) = solver.dense().map_err(|e| e.to_string())? else { continue };
        while poses.len() < count && poses.len() as f64 * step <= solver.time() + 1e-9 * step {
            let state = maximal(&dense.at(poses.len() as f64 * step));
            poses.push((state.p_WCm, state.R_WO.normalize()));
        }
    }
    Ok(poses)
}

fn maximal(y: &[f64; 13]) -> BodyState {
    BodyState {
        p_WCm: DVec3::new(y[0], y[1], y[2]),
        R_WO: DQuat::from_xyzw(y[4], y[5], y[6], y[3]).normalize(),
        v_WCm: DVec3::new(y[7], y[8], y[9]),
        w_WO: DVec3::new(y[10], y[11], y[12]),
    }
}

/// Rate of a quaternion at an angular velocity in world axes.
pub(crate) fn turning(q: DQuat, w: DVec3) -> DQuat {
    DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * q * 0.5
}
