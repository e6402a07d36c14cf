//! Results as CSV tables, with numbers that read back bit for bit.

use crate::log::TRUTH;
use crate::number::exact;
use crate::report::{MotionState, ReportData};
use std::io::{self, Write};

/// Writes the motion as `t` and the truth columns of the sensor-log format.
///
/// # Errors
/// Those of `to`.
pub fn write_motion(times: &[f64], motion: &[MotionState], mut to: impl Write) -> io::Result<()> {
    writeln!(to, "t,{}", TRUTH.join(","))?;
    for (t, state) in times.iter().zip(motion) {
        let (p, q, v, w) = (state.p_WCm, state.R_WO, state.v_WCm, state.w_WO);
        let row = [*t, p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z];
        writeln!(to, "{}", row.map(exact).join(","))?;
    }
    to.flush()
}

/// Writes the contact curves on the object: `palm, t, x, y, z, nx, ny, nz` in body axes, with outward normals, one
/// palm after the other. [`crate::read_contacts`] reads the file.
///
/// # Errors
/// Those of `to`.
pub fn write_contact_curves(data: &ReportData, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "palm,t,x,y,z,nx,ny,nz")?;
    for (i, palm) in data.palms.iter().enumerate() {
        for (t, contact) in data.times.iter().zip(&palm.contacts) {
            let Some(contact) = contact else { continue };
            let (p, n) = (contact.p_OC, contact.normal);
            writeln!(to, "{},{}", i + 1, [*t, p.x, p.y, p.z, n.x, n.y, n.z].map(exact).join(","))?;
        }
    }
    to.flush()
}

/// Writes the radius functions over time: `t, r_1, r_2, r_3`, `nan` where a palm does not touch.
///
/// # Errors
/// Those of `to`.
pub fn write_radius_functions(data: &ReportData, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "t,r_1,r_2,r_3")?;
    for (k, t) in data.times.iter().enumerate() {
        let radius = |i: usize| data.palms[i].contacts[k].map_or(f64::NAN, |c| c.radius);
        writeln!(to, "{}", [*t, radius(0), radius(1), radius(2)].map(exact).join(","))?;
    }
    to.flush()
}
