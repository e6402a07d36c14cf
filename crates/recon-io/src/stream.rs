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
    /// The motion.
    pub motion: MotionState,
    /// Standard deviation of the centre of mass, all axes together, m.
    pub std_cm: f64,
    /// The same of its velocity, m/s.
    pub std_v: f64,
    /// A word for how it stands.
    pub stage: &'static str,
    /// Mean squared innovation over what is expected; NaN while there is no motion.
    pub innovation: f64,
    /// Mass and its standard deviation, kg, where they are estimated.
    pub mass: Option<[f64; 2]>,
}

/// Writes the header: `t`, the columns of truth of the sensor-log format, and what the rows add to them.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_header(mut to: impl Write) -> io::Result<()> {
    writeln!(to, "t,{},std_cm,std_v,stage,innovation,mass,std_mass", TRUTH.join(","))
}

/// Writes a row, with numbers that read back bit for bit; `nan` where there is none.
///
/// # Errors
/// Those of `to`.
pub fn write_stream_row(row: &StreamRow, mut to: impl Write) -> io::Result<()> {
    let (p, q, v, w) = (row.motion.p_WCm, row.motion.R_WO, row.motion.v_WCm, row.motion.w_WO);
    let numbers =
        [row.t, p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z, row.std_cm, row.std_v];
    let [mass, std_mass] = row.mass.unwrap_or([f64::NAN; 2]);
    let rest = [row.innovation, mass, std_mass].map(exact).join(",");
    writeln!(to, "{},{},{rest}", numbers.map(exact).join(","), row.stage)
}
