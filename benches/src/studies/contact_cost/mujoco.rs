//! What the peer has found.

use super::Anything;
use recon_benches::fig5::{Fig5, Pose};
use serde_json::Value;
use std::process::Command;

/// One step size of an integrator at its best settings.
pub(super) struct Run {
    pub(super) way: String,
    pub(super) integrator: String,
    /// s.
    pub(super) step: f64,
    /// Largest pose error, m or rad.
    pub(super) error: f64,
    /// Per simulated second.
    pub(super) ms: f64,
    /// In the peer's words.
    pub(super) settings: String,
}

/// Version and runs; none where Python has no MuJoCo.
pub(super) fn measure(scene: &Fig5, exact: &[Pose], repeats: usize) -> Anything<Option<(String, Vec<Run>)>> {
    let file = std::env::temp_dir().join(format!("contact-cost-{}.json", std::process::id()));
    std::fs::write(&file, scene.for_peer(exact).to_string())?;
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/contacts_mujoco.py");
    let output = Command::new("python3").arg(script).arg(&file).arg(repeats.to_string()).output();
    std::fs::remove_file(&file)?;
    let Ok(output) = output else { return Ok(None) };
    if !output.status.success() {
        eprintln!("no peer: {}", String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or_default());
        return Ok(None);
    }
    let (mut version, mut runs) = (String::new(), Vec::new());
    for line in String::from_utf8(output.stdout)?.lines().filter(|line| !line.is_empty()) {
        let said: Value = serde_json::from_str(line)?;
        let text = |key: &str| said[key].as_str().unwrap_or_default().to_owned();
        let number =
            |key: &str| said[key].as_f64().ok_or_else(|| format!("the peer gives no `{key}`: {line}"));
        version = text("version");
        runs.push(Run {
            way: text("way"),
            integrator: text("integrator"),
            step: number("step")?,
            error: number("error")?,
            ms: number("ms")?,
            settings: settings(&said["settings"]),
        });
    }
    Ok(Some((version, runs)))
}

fn settings(said: &Value) -> String {
    let named = said.as_object().into_iter().flatten();
    named.map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", ")
}

impl Run {
    /// Of a step, e.g. `0.2 ms`.
    pub(super) fn step_name(&self) -> String {
        format!("{} ms", (1e6 * self.step).round() / 1e3)
    }
}

/// Runs that no other beats in both error and cost, from the dearest to the cheapest.
pub(super) fn front(runs: &[Run]) -> Vec<&Run> {
    let beaten = |a: &Run| runs.iter().any(|b| b.error < a.error && b.ms < a.ms);
    let mut front: Vec<&Run> = runs.iter().filter(|run| !beaten(run)).collect();
    front.sort_by(|a, b| b.ms.total_cmp(&a.ms));
    front
}
