//! MuJoCo on the same scene, where Python on this machine has it.

use crate::Method;
use crate::fig5::largest_error;
use glam::{DQuat, DVec3};
use std::process::Command;

/// Runs the scene at several step sizes and prints, for each, a JSON line with its poses and its cost.
const SCRIPT: &str = include_str!("mujoco_fig5.py");

/// MuJoCo's points: those of this machine, or where `python3` cannot import it those of another one.
pub(super) fn measure(exact: &[(DVec3, DQuat)]) -> Method {
    here(exact).unwrap_or_else(|| {
        Method::recorded("MuJoCo 4.0.0, stiff contact", "AMD EPYC, 2 cores, by this script")
            .point("Euler 2 ms", 2.3e-2, 2.23)
            .point("RK4 1 ms", 5.9e-4, 17.4)
            .point("RK4 0.1 ms", 5.5e-6, 182.0)
    })
}

fn here(exact: &[(DVec3, DQuat)]) -> Option<Method> {
    let output = Command::new("python3").args(["-c", SCRIPT]).output().ok().filter(|o| o.status.success())?;
    let text = String::from_utf8(output.stdout).ok()?;
    let mut method: Option<Method> = None;
    for line in text.lines() {
        let run: serde_json::Value = serde_json::from_str(line).ok()?;
        let named = method.take().unwrap_or_else(|| {
            let version = run["version"].as_str().unwrap_or("unknown");
            Method::new(format!("MuJoCo {version}, stiff contact"))
        });
        let poses: Option<Vec<(DVec3, DQuat)>> = run["poses"].as_array()?.iter().map(pose).collect();
        let (setting, cost) = (run["setting"].as_str()?, run["ms_per_second"].as_f64()?);
        method = Some(named.point(setting, largest_error(&poses?, exact), cost));
    }
    method
}

/// `[x, y, z, qw, qx, qy, qz]`.
fn pose(row: &serde_json::Value) -> Option<(DVec3, DQuat)> {
    let v: Vec<f64> = row.as_array()?.iter().filter_map(serde_json::Value::as_f64).collect();
    let [x, y, z, qw, qx, qy, qz] = v.try_into().ok()?;
    Some((DVec3::new(x, y, z), DQuat::from_xyzw(qx, qy, qz, qw).normalize()))
}
