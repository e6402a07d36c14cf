use crate::error::CliError;
use recon::least_model::Pose;
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{End, InitialMotion, SampleTimes, SensorLog, SensorNoise, ThreePalmScene};
use recon_io::Scene;
use std::path::Path;

/// A simulated log and how the simulation ended.
pub(crate) struct Simulated {
    pub(crate) log: SensorLog,
    pub(crate) end: End,
    /// Time asked for, s.
    pub(crate) duration: f64,
    poses: Vec<Pose>,
}

impl Simulated {
    pub(crate) fn poses(&self) -> Vec<Pose> {
        self.poses.clone()
    }
}

/// Simulates the scene of three flat palms through the origin read from `path`, with sensor noise where the scene gives it.
pub(crate) fn simulate(scene: &Scene, path: &Path, tolerance: f64) -> Result<Simulated, CliError> {
    let stated = scene.simulation.as_ref().and_then(|simulation| Some((simulation, simulation.palms?)));
    let (simulation, three) = stated.ok_or_else(|| CliError::NothingToSimulate { path: path.to_owned() })?;
    let mass = known_body(scene)?;
    let body = simulation.body()?;
    let mut palms = ThreePalmScene::new(body.as_ref(), mass, three, scene.gravity)?;
    if let Some(inertia) = scene.palm_inertia {
        palms = palms.with_palm_inertias(inertia)?;
    }
    let start = InitialMotion { R_WO: simulation.R_WO, w_WO: simulation.w_WO };
    let times = SampleTimes { duration: simulation.duration, rate: simulation.sample_rate };
    let run = palms.simulate(start, times, Tolerance::uniform(tolerance))?;
    let ideal = run.sensor_log(&palms)?;
    let noise = SensorNoise {
        contact: scene.sensors.contact_std.unwrap_or(0.0),
        force: scene.sensors.force_std.unwrap_or(0.0),
        torque: scene.sensors.torque_std.unwrap_or(0.0),
    };
    let log = if noise == SensorNoise::default() {
        ideal
    } else {
        ideal.with_noise(&noise, simulation.seed).map_err(CliError::Noise)?
    };
    let poses = run.instants.iter().map(|now| Pose { p_WCm: now.touch.p_WCm, R_WO: now.R_WO }).collect();
    Ok(Simulated { log, end: run.end, duration: simulation.duration, poses })
}

/// Mass and inertia of a scene that must have them.
pub(crate) fn known_body(scene: &Scene) -> Result<recon::object_dynamics::MassProperties, CliError> {
    // Both were checked when the scene was read.
    scene.mass_properties().ok().flatten().ok_or(CliError::UnknownBody)
}
