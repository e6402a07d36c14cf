//! Simulation of scenes of any palms, through contact modes.

use super::modes::ModesTold;
use crate::error::CliError;
use recon::least_model::Pose;
use recon::object_dynamics::{ContactLog, ContactNoise, ContactScene, ContactSimulation};
use recon_io::{BoxedShape, Scene, SceneError, mode_spans};
use std::path::Path;

/// A simulated scene of any palms, and its log with the noise of its sensors.
pub(crate) struct ContactRun {
    pub(crate) world: ContactScene<BoxedShape>,
    pub(crate) simulation: ContactSimulation,
    pub(crate) log: ContactLog,
}

/// Simulates the scene of any palms read from `path`, with sensor noise where the scene gives it.
pub(crate) fn simulate_contacts(scene: &Scene, path: &Path, tolerance: f64) -> Result<ContactRun, CliError> {
    let in_file = |kind| SceneError { path: path.to_owned(), kind };
    let world = scene.contact_scene().map_err(in_file)?;
    let (start, times) = scene.contact_start().map_err(in_file)?;
    let simulation = world.simulate(&start, times, tolerance)?;
    let ideal = ContactLog::from_simulation(&world, &simulation).map_err(CliError::ContactNoise)?;
    let noise = scene.sensors.contact_noise();
    let seed = scene.simulation.as_ref().map_or(0, |simulation| simulation.seed);
    let log = if noise == ContactNoise::default() {
        ideal
    } else {
        ideal.with_noise(&noise, seed).map_err(CliError::ContactNoise)?
    };
    Ok(ContactRun { world, simulation, log })
}

impl ContactRun {
    pub(crate) fn poses(&self) -> Vec<Pose> {
        self.simulation.instants.iter().map(|now| Pose::from(now.state.body)).collect()
    }

    pub(crate) fn told(&self) -> ModesTold {
        use recon::object_dynamics::ContactEventKind::{ConeLeft, Lifts, SlipEnds, Touches};
        let count = |kind| self.simulation.events.iter().filter(|event| event.kind == kind).count();
        let instants = &self.simulation.instants;
        let ends = instants.first().zip(instants.last());
        ModesTold {
            samples: self.log.times().len(),
            duration: self.log.duration(),
            turn: ends.map_or(0.0, |(first, last)| first.state.body.R_WO.angle_between(last.state.body.R_WO)),
            changes: vec![
                ("touches", count(Touches)),
                ("lifts", count(Lifts)),
                ("slip_ends", count(SlipEnds)),
                ("slip_begins", count(ConeLeft)),
            ],
            spans: (0..self.world.palms().len()).map(|palm| mode_spans(&self.simulation, palm)).collect(),
        }
    }
}
