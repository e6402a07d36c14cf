//! Where an object is between parallel palms, as a file that `recon next` goes on from.

use super::state::STATE;
use crate::error::CliError;
use crate::pipeline::folder::Extra;
use glam::{DQuat, DVec2, DVec3};
use recon::contact_kinematics::Direction;
use recon::exploration::parallel::{Hold, ParallelWorkspace, Wall};
use serde_json::{Value, json};
use std::path::Path;

/// Where the object is, and what palms can do.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Placed {
    pub(crate) hold: Hold,
    pub(crate) workspace: ParallelWorkspace,
    /// Strokes so far.
    pub(crate) stroke: usize,
    /// Standard deviations of a contact per axis (m) and of its normal about each tangent axis (rad), in axes of the object and no less than those of any; none of exact
    /// contacts.
    pub(crate) noise: Option<[f64; 2]>,
    /// Where friction stopped strokes.
    pub(crate) walls: Vec<Wall>,
}

const NOISE: [&str; 2] = ["contact_off_m", "normal_off_rad"];
const STOPPED: &str = "stopped_by_friction";

/// Quaternions shorter than this are none.
const NO_TURN: f64 = 1e-6;

impl Placed {
    /// Reads it.
    ///
    /// # Errors
    /// [`CliError::NotExplored`] names what is missing.
    pub(crate) fn read(path: &Path) -> Result<Self, CliError> {
        let wrong = |what: String| CliError::NotExplored { path: path.to_owned(), what };
        let text = std::fs::read_to_string(path).map_err(|e| wrong(e.to_string()))?;
        let state: Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        let number = |key: &str, value: &Value| {
            let value = value.as_f64().filter(|v| v.is_finite());
            value.ok_or_else(|| wrong(format!("`{key}` is not all numbers")))
        };
        let pad = |k: usize| {
            let [x, y] = [0, 1].map(|i| number("pads_m", &state["pads_m"][k][i]));
            Ok::<_, CliError>(DVec2::new(x?, y?))
        };
        let of = |k: usize| number("orientation_xyzw", &state["orientation_xyzw"][k]);
        let turn = DQuat::from_xyzw(of(0)?, of(1)?, of(2)?, of(3)?);
        if turn.length() < NO_TURN {
            return Err(wrong("`orientation_xyzw` is no orientation".to_owned()));
        }
        let hold = Hold { R_WO: turn.normalize(), pads: [pad(0)?, pad(1)?] };
        let workspace = ParallelWorkspace::for_size(
            number("width_m", &state["width_m"])?,
            number("friction", &state["friction"])?,
        );
        let noise = NOISE.map(|key| state.get(key).map(|value| number(key, value)).transpose());
        let [point, normal] = noise;
        let stroke =
            state["stroke"].as_u64().ok_or_else(|| wrong("`stroke` is no number of strokes".to_owned()))?;
        let noise = point?.zip(normal?).map(|(point, normal)| [point, normal]);
        let walls = walls(&state, number, wrong)?;
        Ok(Self { hold, workspace, stroke: stroke as usize, noise, walls })
    }
}

/// Where friction stopped strokes; none where nothing is said of it.
fn walls(
    state: &Value,
    number: impl Fn(&str, &Value) -> Result<f64, CliError>,
    wrong: impl Fn(String) -> CliError,
) -> Result<Vec<Wall>, CliError> {
    let vector = |value: &Value| {
        let [x, y, z] = [0, 1, 2].map(|i| number(STOPPED, &value[i]));
        Direction::new(DVec3::new(x?, y?, z?))
            .map_err(|_| wrong(format!("`{STOPPED}` has a vector of no length")))
    };
    let wall = |stopped: &Value| {
        let (at, along) = (vector(&stopped["up_normal"])?, vector(&stopped["along"])?);
        Ok(Wall { at, along: along.get() })
    };
    let Some(stopped) = state.get(STOPPED) else { return Ok(Vec::new()) };
    let all = stopped.as_array().ok_or_else(|| wrong(format!("`{STOPPED}` is no list")))?;
    all.iter().map(wall).collect()
}

/// As a file.
pub(super) fn state_file(placed: &Placed) -> Extra {
    let Placed { hold, workspace, stroke, noise, walls } = placed;
    let stopped = walls
        .iter()
        .map(|wall| json!({ "up_normal": wall.at.get().to_array(), "along": wall.along.to_array() }));
    let mut state = json!({
        "orientation_xyzw": hold.R_WO.to_array(),
        "pads_m": hold.pads.map(|pad| pad.to_array()),
        "friction": workspace.friction,
        "width_m": workspace.size,
        "stroke": stroke,
        STOPPED: stopped.collect::<Vec<_>>(),
    });
    for (key, value) in NOISE.iter().zip(noise.iter().flatten()) {
        state[*key] = (*value).into();
    }
    (STATE.to_owned(), format!("{state:#}\n").into_bytes())
}
