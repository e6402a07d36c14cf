//! Poses of a body above a plane: `qw, qx, qy, qz, px, py, pz`.

use super::columns::{Numbers, RUNS, by_group, read_columns};
use super::error::TouchesErrorKind;
use glam::{DQuat, DVec3};
use recon::shape_bounds::poses::BodyPose;
use std::io::Read;

/// Largest departure of a quaternion's length from 1: measured ones are rounded, other things are not near it.
const UNIT_TOLERANCE: f64 = 1e-3;

pub(super) const COLUMNS: [&str; 7] = ["qw", "qx", "qy", "qz", "px", "py", "pz"];

/// Reads poses from CSV text: a unit quaternion `qw, qx, qy, qz` (body to world) and a position `px, py, pz` (m) of the body's origin above a world whose z points up. Where
/// there is a column `toss` or `run`, a new run begins where its number changes; where there is a column `frame`, it must
/// count by ones in a run.
///
/// # Errors
/// [`TouchesErrorKind`] names the line and the column.
pub fn parse_poses(mut text: impl Read) -> Result<Vec<Vec<BodyPose>>, TouchesErrorKind> {
    let mut all = Vec::new();
    text.read_to_end(&mut all)?;
    let rows = read_columns(&all[..], COLUMNS, &RUNS)?;
    let frames = match read_columns(&all[..], ["frame"], &RUNS) {
        Err(TouchesErrorKind::MissingColumn { .. }) => Vec::new(),
        frames => frames?,
    };
    of_rows(rows, &frames)
}

/// The same from numbers, with those of the frames where they are numbered.
pub(super) fn of_rows(
    rows: Vec<Numbers<7>>,
    frames: &[Numbers<1>],
) -> Result<Vec<Vec<BodyPose>>, TouchesErrorKind> {
    check_frames(frames)?;
    let mut poses = Vec::with_capacity(rows.len());
    for row in rows {
        let [w, x, y, z, px, py, pz] = row.values;
        let R_WO = DQuat::from_xyzw(x, y, z, w);
        let length = R_WO.length();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(TouchesErrorKind::Quaternion { line: row.line, length });
        }
        poses.push((row.group, BodyPose { R_WO: R_WO.normalize(), p_WO: DVec3::new(px, py, pz) }));
    }
    Ok(by_group(poses))
}

/// Margins of the bounds rest on differences between neighbouring frames, which a gap would falsify.
fn check_frames(rows: &[Numbers<1>]) -> Result<(), TouchesErrorKind> {
    for pair in rows.windows(2) {
        let ([before], [frame]) = (pair[0].values, pair[1].values);
        if pair[0].group == pair[1].group && frame != before + 1.0 {
            return Err(TouchesErrorKind::FrameGap { line: pair[1].line, frame, before });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tosses_are_told_apart_and_bad_poses_named() {
        let good =
            "toss,frame,qw,qx,qy,qz,px,py,pz\n0,0,1,0,0,0,0,0,1\n0,1,0.6,0.8,0,0,0,0,1\n1,0,1,0,0,0,0,0,2\n";
        let runs = parse_poses(good.as_bytes()).unwrap();
        assert_eq!(runs.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        let refused = |from: &str, to: &str| parse_poses(good.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(matches!(refused("0.6", "0.7"), TouchesErrorKind::Quaternion { line: 3, .. }));
        assert!(matches!(refused("0,1,0.6", "0,3,0.6"), TouchesErrorKind::FrameGap { line: 3, .. }));
        assert!(matches!(refused("0.6", "inf"), TouchesErrorKind::NotANumber { line: 3, column: "qw", .. }));
        assert!(matches!(refused("pz", "height"), TouchesErrorKind::MissingColumn { column: "pz", .. }));
    }
}
