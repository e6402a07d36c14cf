//! Where palms and object are after an exploration by palms, as a file that `recon next` goes on from.

use crate::error::CliError;
use crate::pipeline::folder::Extra;
use glam::DVec2;
use recon::exploration::rolling::{Dynamics, Track, Workspace};
use recon::object_dynamics::planar::PlanarMass;
use serde_json::{Value, json};
use std::path::Path;

/// The file.
pub(crate) const STATE: &str = "state.json";

/// Where palms and object are, and what palms can do.
#[derive(Clone, Debug)]
pub(crate) struct State {
    /// Palms and object.
    pub(crate) track: Track,
    /// Motions so far.
    pub(crate) motion: usize,
    /// The object's size and what the palms can do.
    pub(crate) workspace: Workspace,
    /// Centre of mass in body axes, m.
    centre: DVec2,
}

impl State {
    /// Of an object that lies between palms; contacts are about `middle` (m, body axes).
    pub(super) fn at_rest(track: &Track, motion: usize, workspace: &Workspace, middle: DVec2) -> Self {
        let centre = track.centre(middle);
        Self { track: track.clone(), motion, workspace: *workspace, centre }
    }

    /// Of one in motion, in axes about its centre of mass.
    pub(super) fn in_motion(track: &Track, motion: usize, workspace: &Workspace) -> Self {
        Self { track: track.clone(), motion, workspace: *workspace, centre: DVec2::ZERO }
    }

    fn figures(&self) -> Value {
        let mut state = json!({
            "palms_rad": self.track.palms,
            "orientation_rad": self.track.phi,
            "centre_m": self.centre.to_array(),
            "motion": self.motion,
            "width_m": self.workspace.size,
        });
        if let Some(Dynamics { mass, gravity, omega, friction }) = self.track.dynamics {
            state["angular_velocity_rad_per_s"] = omega.into();
            state["mass_kg"] = mass.mass().into();
            state["inertia_kg_m2"] = mass.inertia().into();
            state["gravity_m_per_s2"] = gravity.into();
            state["friction"] = friction.into();
        }
        state
    }

    /// Reads it.
    ///
    /// # Errors
    /// [`CliError::NotExplored`] names what is missing.
    pub(crate) fn read(path: &Path) -> Result<Self, CliError> {
        let wrong = |what: String| CliError::NotExplored { path: path.to_owned(), what };
        let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
        let state: Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        let number = |key: &str| {
            let value = state[key].as_f64().filter(|v| v.is_finite());
            value.ok_or_else(|| wrong(format!("`{key}` is no number")))
        };
        let pair = |key: &str| {
            let [a, b] = [0, 1].map(|k| state[key][k].as_f64().filter(|v| v.is_finite()));
            a.zip(b).map(|(a, b)| [a, b]).ok_or_else(|| wrong(format!("`{key}` is no pair of numbers")))
        };
        let motion =
            state["motion"].as_u64().ok_or_else(|| wrong("`motion` is no number of motions".to_owned()))?;
        let size = number("width_m")?;
        let (palms, phi, centre) =
            (pair("palms_rad")?, number("orientation_rad")?, DVec2::from(pair("centre_m")?));
        let dynamics = match state["angular_velocity_rad_per_s"].is_null() {
            true => None,
            false => {
                let mass = PlanarMass::new(number("mass_kg")?, number("inertia_kg_m2")?);
                let (mass, gravity) = (mass.map_err(|e| wrong(e.to_string()))?, number("gravity_m_per_s2")?);
                let omega = number("angular_velocity_rad_per_s")?;
                let friction = if state["friction"].is_null() { 0.0 } else { number("friction")? };
                Some(Dynamics { mass, gravity, omega, friction })
            }
        };
        let workspace = match dynamics {
            Some(Dynamics { gravity, .. }) => Workspace::in_motion(size, gravity),
            None => Workspace::for_size(size),
        };
        let track = Track::about(palms, phi, centre, dynamics);
        Ok(Self { track, motion: motion as usize, workspace, centre })
    }
}

/// As a file.
pub(super) fn state_file(state: &State) -> Extra {
    (STATE.to_owned(), format!("{:#}\n", state.figures()).into_bytes())
}
