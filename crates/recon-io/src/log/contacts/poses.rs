use super::super::columns::{Field, Header};
use super::super::error::{LogFileError, LogFileErrorKind as Kind};
use super::super::read::Table;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{PoseTable, SurfaceError, SurfacePose};
use std::io::{BufReader, Read};
use std::path::Path;

const COLUMNS: [&str; 8] = ["t", "Px", "Py", "Pz", "Qw", "Qx", "Qy", "Qz"];

/// Reads poses of a palm over time from a CSV file with the columns `t`, `Px..Pz` (m) and `Qw..Qz` (palm to world).
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub(crate) fn read_pose_table(path: impl AsRef<Path>) -> Result<PoseTable, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_pose_table(BufReader::new(file)).map_err(in_file)
}

pub(super) fn parse_pose_table(text: impl Read) -> Result<PoseTable, Kind> {
    let table = Table::open(text)?;
    let header = Header::new(&table.header);
    let fields = COLUMNS.map(|name| header.need(name.to_owned()));
    let [t, px, py, pz, qw, qx, qy, qz] = fields;
    let fields: [Field; COLUMNS.len()] = [t?, px?, py?, pz?, qw?, qx?, qy?, qz?];
    let count = header.names.len();
    let (mut rows, mut lines) = (Vec::new(), Vec::new());
    table.each_row(|row| {
        row.check_count(count)?;
        let [t, px, py, pz, qw, qx, qy, qz] = row.vector(&fields)?;
        let pose = SurfacePose::new(DVec3::new(px, py, pz), DQuat::from_xyzw(qx, qy, qz, qw));
        let source = |source| Kind::PoseTable { line: Some(row.line), source };
        rows.push((t, pose.map_err(source)?));
        lines.push(row.line);
        Ok(())
    })?;
    PoseTable::new(&rows).map_err(|source| {
        let line = match source {
            // Too few rows have no line at fault.
            SurfaceError::Table { row, .. } | SurfaceError::Jump { row, .. } if row > 0 => {
                lines.get(row).copied()
            }
            _ => None,
        };
        Kind::PoseTable { line, source }
    })
}
