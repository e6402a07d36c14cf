//! Results as CSV tables, with numbers that read back bit for bit.

use crate::log::TRUTH;
use crate::mode_columns::{mode_columns, probabilities, push_modes};
use crate::number::push_row;
use crate::report::{MotionState, PalmContact};
use glam::DVec3;
use recon::object_dynamics::MOST_PALMS;
use recon::observer::contacts::ContactEstimate;
use std::io::{self, Write};

/// Writes the motion as `t`, the truth columns of the sensor-log format, and its standard deviations: centre of mass (m), velocity (m/s),
/// angular velocity (rad/s) and turn since the first sample (rad), world axes.
///
/// # Errors
/// Those of `to`.
pub fn write_motion(
    times: &[f64],
    motion: &[MotionState],
    deviations: &[[DVec3; 4]],
    mut to: impl Write,
) -> io::Result<()> {
    writeln!(to, "t,{},{}", TRUTH.join(","), DEVIATIONS.join(","))?;
    let (mut row, mut numbers) = (String::new(), Vec::new());
    for ((t, state), deviations) in times.iter().zip(motion).zip(deviations) {
        row.clear();
        numbers.clear();
        numbers.extend(cells(*t, state));
        numbers.extend(deviations.iter().flat_map(|of| of.to_array()));
        push_row(&mut row, &numbers);
        writeln!(to, "{row}")?;
    }
    to.flush()
}

const DEVIATIONS: [&str; 12] = [
    "std_cmx",
    "std_cmy",
    "std_cmz",
    "std_vx",
    "std_vy",
    "std_vz",
    "std_wx",
    "std_wy",
    "std_wz",
    "std_turnx",
    "std_turny",
    "std_turnz",
];

/// Writes a motion estimated from contacts of `palms` palms: the columns of [`write_motion`], the contact mode of each
/// palm (`mode_i`: 0 off, 1 slides, 2 sticks), where they are estimated its probabilities to slide and to stick (`p_slide_i`, `p_stick_i`)
/// and `relied_on` (1 or 0).
///
/// # Errors
/// Those of `to`.
pub fn write_estimated_motion(
    times: &[f64],
    estimate: &ContactEstimate,
    palms: usize,
    mut to: impl Write,
) -> io::Result<()> {
    let odds = estimate.mode_odds.as_ref().map(|found| &found.odds);
    let modes = mode_columns(palms, odds.is_some());
    writeln!(to, "t,{},{}{modes},relied_on", TRUTH.join(","), DEVIATIONS.join(","))?;
    let (mut row, mut numbers) = (String::new(), Vec::new());
    for (k, t) in times.iter().enumerate() {
        row.clear();
        numbers.clear();
        numbers.extend(cells(*t, &estimate.states[k].into()));
        numbers.extend(estimate.deviations[k].iter().flat_map(|of| of.to_array()));
        push_row(&mut row, &numbers);
        let few = palms.min(MOST_PALMS);
        push_modes(&mut row, &estimate.modes[k][..few], odds.map(|odds| &odds[k][..few]));
        writeln!(to, "{row},{}", u8::from(estimate.relied_on[k]))?;
    }
    to.flush()
}

/// Names of the numbers of a pose in a table of its covariances: centre of mass and turn since the first sample.
pub const POSE: [&str; 6] = ["cmx", "cmy", "cmz", "turnx", "turny", "turnz"];
/// The same in the plane.
pub const POSE_IN_PLANE: [&str; 3] = ["x", "y", "phi0"];

/// Writes covariances of poses over time: position (m) and turn (rad), world axes, row by row on and above the diagonal.
///
/// # Errors
/// Those of `to`.
pub fn write_covariances<const N: usize>(
    pose: [&str; N],
    times: &[f64],
    covariances: &[[[f64; N]; N]],
    mut to: impl Write,
) -> io::Result<()> {
    let above = || (0..N).flat_map(|i| (i..N).map(move |k| (i, k)));
    let names: Vec<String> = above().map(|(i, k)| format!("cov_{}_{}", pose[i], pose[k])).collect();
    writeln!(to, "t,{}", names.join(","))?;
    let (mut row, mut numbers) = (String::new(), Vec::new());
    for (t, of) in times.iter().zip(covariances) {
        row.clear();
        numbers.clear();
        numbers.push(*t);
        numbers.extend(above().map(|(i, k)| of[i][k]));
        push_row(&mut row, &numbers);
        writeln!(to, "{row}")?;
    }
    to.flush()
}

/// How probable it is that each of some palms slides and that it sticks, sample by sample, to a millionth: more of the digits are chance.
/// None where it is not estimated.
#[must_use]
pub fn mode_probabilities(estimate: &ContactEstimate, palms: usize) -> Option<Vec<Vec<[f64; 2]>>> {
    let odds = estimate.mode_odds.as_ref()?.odds.iter();
    Some(odds.map(|all| all.iter().take(palms).map(probabilities).collect()).collect())
}

/// A time and a state in the order of the truth columns.
pub(crate) fn cells(t: f64, state: &MotionState) -> [f64; 14] {
    let (p, q, v, w) = (state.p_WCm, state.R_WO, state.v_WCm, state.w_WO);
    [t, p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z]
}

/// Writes the contact curves of some palms on the object: `palm, t, x, y, z, nx, ny, nz` in body axes, with outward normals, one
/// palm after the other. [`crate::read_contacts`] reads the file.
///
/// # Errors
/// Those of `to`.
pub fn write_contact_curves(
    times: &[f64],
    palms: &[&[Option<PalmContact>]],
    mut to: impl Write,
) -> io::Result<()> {
    writeln!(to, "palm,t,x,y,z,nx,ny,nz")?;
    let mut row = String::new();
    for (i, contacts) in palms.iter().enumerate() {
        for (t, contact) in times.iter().zip(*contacts) {
            let Some(contact) = contact else { continue };
            let (p, n) = (contact.p_OC, contact.normal);
            row.clear();
            push_row(&mut row, &[*t, p.x, p.y, p.z, n.x, n.y, n.z]);
            writeln!(to, "{},{row}", i + 1)?;
        }
    }
    to.flush()
}

/// Writes the radius functions over time: `t, r_1, r_2, ...`, `nan` where a palm does not touch.
///
/// # Errors
/// Those of `to`.
pub fn write_radius_functions(
    times: &[f64],
    palms: &[&[Option<PalmContact>]],
    mut to: impl Write,
) -> io::Result<()> {
    let names: Vec<String> = (1..=palms.len()).map(|i| format!("r_{i}")).collect();
    writeln!(to, "t,{}", names.join(","))?;
    let (mut row, mut numbers) = (String::new(), Vec::new());
    for (k, t) in times.iter().enumerate() {
        row.clear();
        numbers.clear();
        numbers.push(*t);
        numbers.extend(palms.iter().map(|palm| palm[k].map_or(f64::NAN, |c| c.radius)));
        push_row(&mut row, &numbers);
        writeln!(to, "{row}")?;
    }
    to.flush()
}
