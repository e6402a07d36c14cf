//! A motion as it becomes known, row by row.

use crate::log::TRUTH;
use crate::mode_columns::{mode_columns, push_modes};
use crate::number::push_row;
use crate::report::MotionState;
use crate::table::cells;
use glam::{DQuat, DVec3};
use recon::object_dynamics::MOST_PALMS;
use recon::observer::contacts::stream::StreamModes;
use std::fmt::Write as _;
use std::io::{self, Write};

/// The motion at one time, and how well it is known then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamRow {
    /// s.
    pub t: f64,
    /// The motion; none before one was found.
    pub motion: Option<MotionState>,
    /// Standard deviations of centre of mass (m), velocity (m/s), angular velocity (rad/s) and orientation (rad), all axes together.
    pub deviations: [f64; 4],
    /// A word for how it stands.
    pub stage: &'static str,
    /// Whether it is to be relied on, to within its deviations.
    pub relied_on: bool,
    /// Squared corrections of the latest readings over what is expected; NaN while there is no motion.
    pub misfit: f64,
    /// Mass and its standard deviation, kg, where they are estimated.
    pub mass: Option<[f64; 2]>,
    /// Contact modes, where they are told.
    pub modes: Option<StreamModes>,
}

/// Writes the header: `t`, the columns of truth of the sensor-log format, what the rows add to them, and of so many palms whose modes are told those
/// of `motion.csv` and what is doubted of each.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_header(palms: usize, mut to: impl Write) -> io::Result<()> {
    let more = "std_cm,std_v,std_w,std_turn,stage,relied_on,misfit,mass,std_mass";
    let doubts: String = (1..=palms).map(|i| format!(",doubt_{i}")).collect();
    writeln!(to, "t,{},{more}{}{doubts}", TRUTH.join(","), mode_columns(palms, true))
}

/// Writes a row, with numbers that read back bit for bit; `nan` where there is none, and where no doubt is told, `none`.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_row(row: &StreamRow, palms: usize, mut to: impl Write) -> io::Result<()> {
    let no_number = MotionState {
        p_WCm: DVec3::NAN,
        R_WO: DQuat::from_vec4(glam::DVec4::NAN),
        v_WCm: DVec3::NAN,
        w_WO: DVec3::NAN,
    };
    let mut text = String::new();
    push_row(&mut text, &cells(row.t, &row.motion.unwrap_or(no_number)));
    text.push(',');
    push_row(&mut text, &row.deviations);
    let _ = write!(text, ",{},{},", row.stage, u8::from(row.relied_on));
    let [mass, std_mass] = row.mass.unwrap_or([f64::NAN; 2]);
    push_row(&mut text, &[row.misfit, mass, std_mass]);
    let palms = palms.min(MOST_PALMS);
    match &row.modes {
        Some(modes) => push_modes(&mut text, &modes.decided[..palms], Some(&modes.odds[..palms])),
        None => text += &",nan".repeat(3 * palms),
    }
    for palm in 0..palms {
        let _ = write!(text, ",{}", row.doubt(palm).unwrap_or("none"));
    }
    writeln!(to, "{text}")
}

impl StreamRow {
    /// What is doubted of the readings that a palm's modes rest on, in a word or two.
    #[must_use]
    pub fn doubt(&self, palm: usize) -> Option<&'static str> {
        let doubt = self.modes.as_ref()?.doubts.get(palm)?.as_ref()?;
        Some(doubt.about.name())
    }
}
