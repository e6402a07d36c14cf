//! Simulation of scenes in the plane, through contact modes.

use super::modes::ModesTold;
use crate::error::CliError;
use recon::least_model::Pose;
use recon::object_dynamics::planar::{
    ContactEventKind as Kind, ContactLog, ContactNoise, ContactSimulation, ContactStart, in_space,
    turn_in_space,
};
use recon_io::{PlanarScene, planar_mode_spans};

/// A simulated scene in the plane, and its log with the noise of its sensors.
pub(crate) struct PlanarContactRun {
    pub(crate) simulation: ContactSimulation,
    pub(crate) log: ContactLog,
    /// How far the object was moved, m, to lie on the palms that it touches at the start.
    pub(crate) laid: f64,
}

/// Simulates the scene, with sensor noise where it gives it. The object is first laid on the palms that it touches.
pub(crate) fn simulate_planar_contacts(
    scene: &PlanarScene,
    tolerance: f64,
) -> Result<PlanarContactRun, CliError> {
    let body = match &scene.touches[..] {
        [] => scene.start,
        palms => scene.world.place(0.0, scene.start, palms)?,
    };
    let start = ContactStart { body, contacts: scene.touches.clone() };
    let simulation = scene.world.simulate(&start, &scene.times.all()?, tolerance)?;
    let ideal = simulation.log(&scene.world)?;
    let noise = scene.noise();
    let log = if noise == ContactNoise::default() { ideal } else { noise.add_to(&ideal, scene.seed) };
    Ok(PlanarContactRun { simulation, log, laid: body.p_WCm.distance(scene.start.p_WCm) })
}

impl PlanarContactRun {
    pub(crate) fn poses(&self) -> Vec<Pose> {
        let pose = |now: &recon::object_dynamics::planar::ContactInstant| Pose {
            p_WCm: in_space(now.body.p_WCm),
            R_WO: turn_in_space(now.body.phi0),
        };
        self.simulation.instants.iter().map(pose).collect()
    }

    pub(crate) fn told(&self) -> ModesTold {
        let count = |kind| self.simulation.events.iter().filter(|event| event.kind == kind).count();
        let instants = &self.simulation.instants;
        let ends = instants.first().zip(instants.last());
        ModesTold {
            samples: instants.len(),
            duration: ends.map_or(0.0, |(first, last)| last.t - first.t),
            turn: ends.map_or(0.0, |(first, last)| last.body.phi0 - first.body.phi0),
            changes: vec![
                ("touches", count(Kind::Touches)),
                ("lifts", count(Kind::Lifts)),
                ("slip_ends", count(Kind::SlipEnds)),
                ("slip_begins", count(Kind::ConeLeft)),
                ("squeeze_ends", count(Kind::SqueezeEnds)),
            ],
            spans: (0..self.log.surfaces().len())
                .map(|palm| planar_mode_spans(&self.simulation, palm))
                .collect(),
        }
    }
}
