//! Contact points with outward normals: `x, y, z, nx, ny, nz`.

use super::columns::{CURVES, Numbers, by_group, read_columns};
use super::error::{TouchesError, TouchesErrorKind};
use crate::number::exact;
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::ContactSample;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

/// Largest departure of a normal's length from 1: three printed digits are off by 9e-4.
pub(super) const UNIT_TOLERANCE: f64 = 1e-3;

pub(super) const COLUMNS: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Reads contact points with outward normals, curve by curve.
///
/// # Errors
/// [`TouchesError`] names the file, the line and the column.
pub fn read_contacts(path: impl AsRef<Path>) -> Result<Vec<Vec<ContactSample>>, TouchesError> {
    let path = path.as_ref();
    let in_file = |kind| TouchesError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(e.into()))?;
    parse_contacts(BufReader::new(file)).map_err(in_file)
}

/// [`read_contacts`] from CSV text: the columns `x, y, z` (m) and `nx, ny, nz`, and where there is a column `palm` or
/// `curve`, a new curve where its number changes. Columns are found by name; others are ignored. Normals may be rounded to
/// three digits and are made unit vectors.
///
/// # Errors
/// [`TouchesErrorKind`] names the line and the column.
pub fn parse_contacts(text: impl Read) -> Result<Vec<Vec<ContactSample>>, TouchesErrorKind> {
    contacts_and_rounding(text).map(|(curves, _)| curves)
}

/// The same, and by how much the length of a normal is off 1 at most.
pub(super) fn contacts_and_rounding(
    text: impl Read,
) -> Result<(Vec<Vec<ContactSample>>, f64), TouchesErrorKind> {
    of_rows(read_columns(text, COLUMNS, &CURVES)?)
}

/// The same from numbers.
pub(super) fn of_rows(rows: Vec<Numbers<6>>) -> Result<(Vec<Vec<ContactSample>>, f64), TouchesErrorKind> {
    let (mut contacts, mut rounding) = (Vec::new(), 0.0_f64);
    for row in rows {
        let [x, y, z, nx, ny, nz] = row.values;
        let normal = Direction::from_unit(DVec3::new(nx, ny, nz), UNIT_TOLERANCE)
            .map_err(|source| TouchesErrorKind::Normal { line: row.line, source })?;
        rounding = rounding.max((DVec3::new(nx, ny, nz).length() - 1.0).abs());
        contacts.push((row.group, ContactSample { point: DVec3::new(x, y, z), normal }));
    }
    Ok((by_group(contacts), rounding))
}

/// Writes contact points so that [`parse_contacts`] reads them back.
///
/// # Errors
/// Those of `to`.
pub fn write_contacts(contacts: &[ContactSample], mut to: impl Write) -> io::Result<()> {
    writeln!(to, "{}", COLUMNS.join(","))?;
    for ContactSample { point: p, normal } in contacts {
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
            .map(|(x, y)| ContactSample {
                point: DVec3::new(x, y, 1e-17),
                normal: Direction::new(DVec3::new(x, y, 0.3)).unwrap(),
            })
            .collect();
        let mut text = Vec::new();
        write_contacts(&contacts, &mut text).unwrap();
        let back = parse_contacts(&text[..]).unwrap().concat();
        for (a, b) in contacts.iter().zip(&back) {
            assert_eq!(a.point, b.point);
            assert!((a.normal.get() - b.normal.get()).length() < 4.0 * f64::EPSILON);
        }
    }

    #[test]
    fn curves_are_told_apart_where_they_are_numbered() {
        let text = "palm,x,y,z,nx,ny,nz\n1,0,0,1,0,0,1\n1,0,0,2,0,0,1\n2,0,0,3,0,0,1\n";
        let lengths: Vec<usize> = parse_contacts(text.as_bytes()).unwrap().iter().map(Vec::len).collect();
        assert_eq!(lengths, [2, 1]);
    }

    #[test]
    fn bad_lists_are_named() {
        let parse = |text: &str| parse_contacts(text.as_bytes()).unwrap_err();
        assert!(matches!(parse(""), TouchesErrorKind::Empty));
        assert!(matches!(parse("x,y,z,nx,ny,nz\n"), TouchesErrorKind::Empty));
        assert!(matches!(parse("x,y,z,nx,ny\n"), TouchesErrorKind::MissingColumn { column: "nz", .. }));
        assert!(matches!(
            parse("x,y,z,nx,ny,nz\n0,0,nan,0,0,1\n"),
            TouchesErrorKind::NotANumber { line: 2, column: "z", .. }
        ));
        assert!(matches!(
            parse("x,y,z,nx,ny,nz\n0,0,1,0,0\n"),
            TouchesErrorKind::NotANumber { line: 2, column: "nz", .. }
        ));
        assert!(matches!(parse("x,y,z,nx,ny,nz\n0,0,1,0,0,2\n"), TouchesErrorKind::Normal { line: 2, .. }));
    }
}
