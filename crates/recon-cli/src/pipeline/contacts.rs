//! Simulation of scenes of any palms, through contact modes.

use crate::error::CliError;
use recon::object_dynamics::{ContactLog, ContactMode, ContactNoise, ContactScene, ContactSimulation};
use recon_io::{BoxedShape, Scene, SceneError, mode_spans};
use serde_json::{Value, json};
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
    /// Changes of modes of each kind, by name, in the order of the kinds.
    fn changes(&self) -> [(&'static str, usize); 4] {
        use recon::object_dynamics::ContactEventKind::{ConeLeft, Lifts, SlipEnds, Touches};
        let count = |kind| self.simulation.events.iter().filter(|event| event.kind == kind).count();
        [
            ("touches", count(Touches)),
            ("lifts", count(Lifts)),
            ("slip_ends", count(SlipEnds)),
            ("slip_begins", count(ConeLeft)),
        ]
    }

    /// Time that each contact is off, slides and sticks, s.
    fn times_in_modes(&self) -> Vec<[f64; 3]> {
        let of = |palm| {
            let spans = mode_spans(&self.simulation, palm);
            ContactMode::ALL.map(|mode| {
                let lasting = spans.iter().filter(|span| span.mode == mode);
                lasting.fold(0.0, |sum, span| sum + (span.end - span.start))
            })
        };
        (0..self.world.palms().len()).map(of).collect()
    }

    /// What came out, for a person.
    pub(crate) fn describe(&self) -> String {
        let samples = self.log.times().len();
        let mut text = format!("{samples} samples over {} s", self.duration());
        let changes: Vec<String> = self
            .changes()
            .iter()
            .filter(|(_, count)| *count > 0)
            .map(|(name, count)| format!("{} {count}", name.replace('_', " ")))
            .collect();
        let count = self.simulation.events.len();
        text += &match changes.is_empty() {
            true => ", no change of modes".to_owned(),
            false => format!(", {count} change(s) of modes ({})", changes.join(", ")),
        };
        for (i, [off, slides, sticks]) in self.times_in_modes().into_iter().enumerate() {
            let palm = i + 1;
            text += &format!("\n  palm {palm}: off {off:.3} s, slides {slides:.3} s, sticks {sticks:.3} s");
        }
        text
    }

    /// The same for a program.
    pub(crate) fn figures(&self) -> Value {
        let changes: serde_json::Map<String, Value> =
            self.changes().into_iter().map(|(name, count)| (name.to_owned(), count.into())).collect();
        let palm = |(i, [off, slides, sticks]): (usize, [f64; 3])| json!({ "palm": i + 1, "off_s": off, "slides_s": slides, "sticks_s": sticks });
        json!({
            "samples": self.log.times().len(),
            "duration_s": self.duration(),
            "turn_rad": self.turn(),
            "mode_changes": changes,
            "palms": self.times_in_modes().into_iter().enumerate().map(palm).collect::<Vec<_>>(),
        })
    }

    /// Angle between the last orientation and the first, rad.
    pub(crate) fn turn(&self) -> f64 {
        let instants = &self.simulation.instants;
        let ends = instants.first().zip(instants.last());
        ends.map_or(0.0, |(first, last)| first.state.body.R_WO.angle_between(last.state.body.R_WO))
    }

    fn duration(&self) -> f64 {
        let times = self.log.times();
        times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first)
    }
}
