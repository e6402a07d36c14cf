//! A motion as it becomes known, row by row.

use crate::log::TRUTH;
use crate::number::exact;
use crate::report::MotionState;
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
}

/// Writes the header: `t`, the columns of truth of the sensor-log format, and what the rows add to them.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_header(mut to: impl Write) -> io::Result<()> {
    let more = "std_cm,std_v,std_w,std_turn,stage,relied_on,misfit,mass,std_mass";
    writeln!(to, "t,{},{more}", TRUTH.join(","))
}

/// Writes a row, with numbers that read back bit for bit; `nan` where there is none.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_row(row: &StreamRow, mut to: impl Write) -> io::Result<()> {
    let motion = row.motion.map_or([f64::NAN; 13], |motion| {
        let (p, q, v, w) = (motion.p_WCm, motion.R_WO, motion.v_WCm, motion.w_WO);
        [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z]
    });
    let [mass, std_mass] = row.mass.unwrap_or([f64::NAN; 2]);
    let numbers: Vec<String> =
        [row.t].iter().chain(&motion).chain(&row.deviations).map(|x| exact(*x)).collect();
    let rest = [row.misfit, mass, std_mass].map(exact).join(",");
    writeln!(to, "{},{},{},{rest}", numbers.join(","), row.stage, u8::from(row.relied_on))
}
