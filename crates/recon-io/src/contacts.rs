//! Contact points with outward normals as CSV: `x, y, z, nx, ny, nz`.

use crate::number::exact;
use glam::DVec3;
use recon::contact_kinematics::{Direction, DirectionError};
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Largest departure of a normal's length from 1.
const UNIT_TOLERANCE: f64 = 1e-5;

const COLUMNS: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// A point of the surface and the outward unit normal there, in any one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Position in m.
    pub point: DVec3,
    /// Outward unit normal.
    pub normal: Direction,
}

/// A contact list that cannot be used.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct ContactsError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: ContactsErrorKind,
}

/// What is wrong with a contact list. Lines count from 1, the header being line 1.
#[derive(Debug, Error)]
pub enum ContactsErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// Not CSV, or not UTF-8.
    #[error("is not a CSV file in UTF-8: {0}")]
    Csv(csv::Error),
    /// No contact in it.
    #[error("holds no contacts; it needs a header `x,y,z,nx,ny,nz` and one row per contact")]
    Empty,
    /// A column is not there.
    #[error("column `{column}` is missing; found: {found}")]
    MissingColumn {
        /// The name.
        column: &'static str,
        /// The header as found.
        found: String,
    },
    /// A field is not a finite number.
    #[error("line {line}, column `{column}`: `{text}` is not a finite number")]
    NotANumber {
        /// Line number.
        line: u64,
        /// The column.
        column: &'static str,
        /// The field as found.
        text: String,
    },
    /// A normal is not a unit vector.
    #[error("line {line}: normal (nx, ny, nz): {source}")]
    Normal {
        /// Line number.
        line: u64,
        /// Why.
        source: DirectionError,
    },
}

/// Reads contact points with outward normals; columns are found by name, others are ignored.
///
/// # Errors
/// [`ContactsError`] names the file, the line and the column.
pub fn read_contacts(path: impl AsRef<Path>) -> Result<Vec<ContactPoint>, ContactsError> {
    let path = path.as_ref();
    let in_file = |kind| ContactsError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(e.into()))?;
    parse_contacts(BufReader::new(file)).map_err(in_file)
}

/// [`read_contacts`] from CSV text.
///
/// # Errors
/// [`ContactsErrorKind`] names the line and the column.
pub fn parse_contacts(text: impl Read) -> Result<Vec<ContactPoint>, ContactsErrorKind> {
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text);
    let mut rows = reader.records();
    let header = rows.next().ok_or(ContactsErrorKind::Empty)?.map_err(ContactsErrorKind::Csv)?;
    let mut places = [0; 6];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = header
            .iter()
            .position(|name| name.trim_start_matches('\u{feff}').trim() == column)
            .ok_or_else(|| ContactsErrorKind::MissingColumn {
                column,
                found: header.iter().collect::<Vec<_>>().join(", "),
            })?;
    }
    let contacts = rows
        .map(|row| contact(&row.map_err(ContactsErrorKind::Csv)?, places))
        .collect::<Result<Vec<_>, _>>()?;
    if contacts.is_empty() { Err(ContactsErrorKind::Empty) } else { Ok(contacts) }
}

fn contact(row: &csv::StringRecord, places: [usize; 6]) -> Result<ContactPoint, ContactsErrorKind> {
    let line = row.position().map_or(0, csv::Position::line);
    let mut values = [0.0; 6];
    for ((value, place), column) in values.iter_mut().zip(places).zip(COLUMNS) {
        let text = row.get(place).unwrap_or_default();
        *value = text
            .parse()
            .ok()
            .filter(|v: &f64| v.is_finite())
            .ok_or_else(|| ContactsErrorKind::NotANumber { line, column, text: text.to_owned() })?;
    }
    let [x, y, z, nx, ny, nz] = values;
    let normal = Direction::from_unit(DVec3::new(nx, ny, nz), UNIT_TOLERANCE)
        .map_err(|source| ContactsErrorKind::Normal { line, source })?;
    Ok(ContactPoint { point: DVec3::new(x, y, z), normal })
}

/// Writes contact points so that [`parse_contacts`] reads them back.
///
/// # Errors
/// Those of `to`.
pub fn write_contacts(contacts: &[ContactPoint], mut to: impl Write) -> io::Result<()> {
    writeln!(to, "{}", COLUMNS.join(","))?;
    for ContactPoint { point: p, normal } in contacts {
        let n = normal.get();
        writeln!(to, "{}", [p.x, p.y, p.z, n.x, n.y, n.z].map(exact).join(","))?;
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_reads_back() {
        let contacts: Vec<_> = (0..5)
            .map(|k| f64::from(k).sin_cos())
            .map(|(x, y)| ContactPoint {
                point: DVec3::new(x, y, 1e-17),
                normal: Direction::new(DVec3::new(x, y, 0.3)).unwrap(),
            })
            .collect();
        let mut text = Vec::new();
        write_contacts(&contacts, &mut text).unwrap();
        let back = parse_contacts(&text[..]).unwrap();
        for (a, b) in contacts.iter().zip(&back) {
            assert_eq!(a.point, b.point);
            assert!((a.normal.get() - b.normal.get()).length() < 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn bad_lists_are_named() {
        let parse = |text: &str| parse_contacts(text.as_bytes()).unwrap_err();
        assert!(matches!(parse(""), ContactsErrorKind::Empty));
        assert!(matches!(parse("x,y,z,nx,ny,nz\n"), ContactsErrorKind::Empty));
        assert!(matches!(parse("x,y,z,nx,ny\n"), ContactsErrorKind::MissingColumn { column: "nz", .. }));
        assert!(matches!(
            parse("x,y,z,nx,ny,nz\n0,0,nan,0,0,1\n"),
            ContactsErrorKind::NotANumber { line: 2, column: "z", .. }
        ));
        assert!(matches!(
            parse("x,y,z,nx,ny,nz\n0,0,1,0,0\n"),
            ContactsErrorKind::NotANumber { line: 2, column: "nz", .. }
        ));
        assert!(matches!(parse("x,y,z,nx,ny,nz\n0,0,1,0,0,2\n"), ContactsErrorKind::Normal { line: 2, .. }));
    }
}
