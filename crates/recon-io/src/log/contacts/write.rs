use super::super::columns::TRUTH;
use super::super::write::true_values;
use crate::number::push_row;
use recon::object_dynamics::{ContactLog, ForceChannel, LoggedPalm, TwistSource};
use std::io::{self, Write};

/// Writes a sensor log, version 2, with numbers that read back bit for bit: contact points in the world, the poses of all
/// palms, twists where they were stated, and every other channel that a palm has.
///
/// Shapes and friction of the palms stand in the scene, not in the log.
///
/// # Errors
/// Those of `to`.
pub fn write_contact_log(log: &ContactLog, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "{}", header(log).join(","))?;
    let (mut row, mut values) = (String::new(), Vec::new());
    for (k, &t) in log.times().iter().enumerate() {
        row.clear();
        values.clear();
        values.push(t);
        log.palms().iter().for_each(|palm| push(palm, k, &mut values));
        values.extend(log.truth().map(|truth| true_values(&truth[k])).iter().flatten());
        push_row(&mut row, &values);
        writeln!(to, "{row}")?;
    }
    to.flush()
}

fn header(log: &ContactLog) -> Vec<String> {
    let mut names = vec!["t".to_owned()];
    for (i, palm) in log.palms().iter().enumerate() {
        names.extend(stems(palm).into_iter().map(|stem| format!("{stem}_{}", i + 1)));
    }
    if log.truth().is_some() {
        names.extend(TRUTH.map(str::to_owned));
    }
    names
}

fn stems(palm: &LoggedPalm) -> Vec<&'static str> {
    let mut stems = vec!["px", "py", "pz", "Px", "Py", "Pz", "Qw", "Qx", "Qy", "Qz"];
    if palm.twist_source() == TwistSource::Stated {
        stems.extend(["Vx", "Vy", "Vz", "Wx", "Wy", "Wz"]);
    }
    stems.extend(axes(palm.force_channel(), "fn", ["fx", "fy", "fz"]));
    stems.extend(axes(palm.impulse_channel(), "Jn", ["Jx", "Jy", "Jz"]));
    if palm.has_torque() {
        stems.push("tau");
    }
    if palm.truth(0).is_some() {
        stems.extend(["gap", "slip", "mode"]);
    }
    stems
}

fn axes(channel: &ForceChannel, normal: &'static str, three: [&'static str; 3]) -> Vec<&'static str> {
    match channel {
        ForceChannel::Missing => Vec::new(),
        ForceChannel::Normal(_) => vec![normal],
        ForceChannel::Three(_) => three.to_vec(),
    }
}

/// The values of a palm at sample `k`, in the order of [`stems`].
fn push(palm: &LoggedPalm, k: usize, values: &mut Vec<f64>) {
    let motion = palm.motion(k);
    let q = motion.pose.R_WP;
    values.extend(palm.touch(k).map_or([f64::NAN; 3], |touch| touch.p_WC.to_array()));
    values.extend(motion.pose.p_WP.to_array());
    values.extend([q.w, q.x, q.y, q.z]);
    if palm.twist_source() == TwistSource::Stated {
        values.extend(motion.v_WP.to_array());
        values.extend(motion.w_WP.to_array());
    }
    for channel in [palm.force_channel(), palm.impulse_channel()] {
        match channel {
            ForceChannel::Missing => {}
            ForceChannel::Normal(all) => values.push(all[k]),
            ForceChannel::Three(all) => values.extend(all[k].to_array()),
        }
    }
    if palm.has_torque() {
        values.push(palm.torque(k).unwrap_or(f64::NAN));
    }
    if let Some(truth) = palm.truth(k) {
        values.extend([truth.gap, truth.slip, f64::from(truth.mode.number())]);
    }
}
