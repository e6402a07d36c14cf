//! Simulation of the paper's Fig. 5: cost against error, for formulations, integrators and other simulators.

use super::{Chart, Drawn, mujoco};
use crate::fig5::largest_error;
use crate::multipliers::{Pose, by_multipliers, turning};
use crate::{Axis, Budget, Method, Study, WorkPrecision};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::integrate::{FixedScheme, Tolerance, integrate_fixed};
use recon::object_dynamics::{InitialMotion, SampleTimes, ThreePalmScene};

pub(super) const CHART: Chart =
    Chart { name: "fig5-simulation", about: "integrators and formulations on the paper's Fig. 5", draw };

const DURATION: f64 = 4.2;
/// Samples that the errors are taken over: every 0.2 s.
const SAMPLES: usize = 21;
/// The same scene to 16 digits.
const EXACT: &str = include_str!("../../../tests/data/golden_A_fig5.csv");

fn draw(budget: Budget) -> Drawn {
    let (scene, start) = recon_tests::fig5(9.81);
    let exact = exact_poses()?;
    let error = |poses: &Vec<Pose>| largest_error(poses, &exact);
    let mut study = Study::new();
    for exponent in [3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14] {
        let (scene, tolerance) = (&scene, Tolerance::uniform(10f64.powi(-exponent)));
        let setting = format!("1e-{exponent}");
        study.fallible_case(
            "minimal coordinates, DOP853",
            setting.clone(),
            move || minimal(scene, start, tolerance),
            error,
        );
        if exponent % 2 == 0 {
            let run = move || by_multipliers(scene, start, (0.2, SAMPLES + 1), tolerance);
            study.fallible_case("multiplier form (30)-(34), DOP853", setting, run, error);
        }
    }
    for steps in [4u32, 8, 16, 32, 64, 128] {
        let scene = &scene;
        let setting = format!("{} ms", 200.0 / f64::from(steps));
        let run = move || minimal_fixed(scene, start, steps as usize);
        study.fallible_case("minimal coordinates, Runge-Kutta 4", setting, run, error);
    }
    let methods = study.measure(budget, DURATION);
    let mut chart = WorkPrecision::new(
        "fig5-simulation",
        "Simulation of the paper's Fig. 5: cost against error",
    )
    .subtitle(
        "largest pose error (m, rad) over 4.2 s, every 0.2 s, exact to 16 digits; points: tolerance or step",
    )
    .axes(Axis::log("pose error", "m, rad"), Axis::log("cost", "ms per simulated second"))
    .methods(methods);
    // Our own settings of MuJoCo, and those of the logs' maker beside them: neither should look worse than it can.
    chart = chart.method(mujoco::measure(&exact)).method(recorded_mujoco());
    let chart = chart
        .method(
            Method::recorded("Drake 1.51", "the log's README")
                .point("discrete 1 ms", 1.2e-2, 21.0)
                .point("RK3, k 1e6", 4.1e-5, 46.0)
                .point("RK3, k 1e8", 2.1e-7, 314.0),
        )
        .method(Method::recorded("SciPy DOP853 in Python", "the log's README").point("1e-7", 2.9e-7, 22.0))
        .goal("1/100 of MuJoCo", 1e-4, 0.16)
        .goal("1/500 of MuJoCo", 1e-6, 0.59);
    Ok(vec![chart.into()])
}

fn recorded_mujoco() -> Method {
    Method::recorded("MuJoCo 4.0", "the log's README")
        .point("Euler 2 ms", 1.6e-2, 2.0)
        .point("RK4 1 ms", 1.8e-4, 15.0)
        .point("RK4 0.1 ms", 1.7e-6, 148.0)
}

type Failure = Box<dyn std::error::Error + Send + Sync>;
type Poses = Result<Vec<Pose>, String>;

fn minimal(scene: &ThreePalmScene<Ellipsoid>, start: InitialMotion, tolerance: Tolerance) -> Poses {
    let times = SampleTimes { duration: DURATION, rate: 5.0 };
    let run = scene.simulate(start, times, tolerance).map_err(|e| e.to_string())?;
    Ok(run.instants.iter().map(|now| (now.touch.p_WCm, now.R_WO)).collect())
}

/// Orientation and angular velocity by Runge-Kutta 4, `steps` to each 0.2 s.
fn minimal_fixed(scene: &ThreePalmScene<Ellipsoid>, start: InitialMotion, steps: usize) -> Poses {
    let field = |t: f64, y: &[f64; 7]| {
        let (q, w) = (quaternion(y), DVec3::new(y[4], y[5], y[6]));
        let alpha = scene.instant(t, q.normalize(), w).map_err(|e| e.to_string())?.accelerations.alpha_WO;
        let rate = turning(q, w);
        Ok::<_, String>([rate.w, rate.x, rate.y, rate.z, alpha.x, alpha.y, alpha.z])
    };
    let (q, w) = (start.R_WO, start.w_WO);
    let mut y = [q.w, q.x, q.y, q.z, w.x, w.y, w.z];
    let mut poses = Vec::with_capacity(SAMPLES);
    for k in 0..SAMPLES + 1 {
        let t = k as f64 * 0.2;
        let q = quaternion(&y).normalize();
        let now = scene.instant(t, q, DVec3::new(y[4], y[5], y[6])).map_err(|e| e.to_string())?;
        poses.push((now.touch.p_WCm, q));
        if k < SAMPLES {
            y = integrate_fixed(FixedScheme::Rk4, field, t, y, t + 0.2, steps)?;
        }
    }
    Ok(poses)
}

fn quaternion(y: &[f64; 7]) -> DQuat {
    DQuat::from_xyzw(y[1], y[2], y[3], y[0])
}

fn exact_poses() -> Result<Vec<Pose>, Failure> {
    let log = recon_io::parse_log(EXACT.as_bytes())?;
    let truth = log.truth().ok_or("the exact log has no truth columns")?;
    Ok(truth.iter().map(|state| (state.p_WCm, state.R_WO)).collect())
}
