//! Contact points with outward normals in the plane: `x, y, nx, ny`.

use super::columns::{CURVES, Numbers, by_group, read_columns};
use super::contacts::UNIT_TOLERANCE;
use super::error::TouchesErrorKind;
use glam::DVec2;
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::ContactSample;
use std::io::Read;

pub(super) const COLUMNS: [&str; 4] = ["x", "y", "nx", "ny"];

/// Whether a header is one of contacts in the plane: normals in it, and nothing of a third axis.
pub(super) fn is_planar(header: &str) -> bool {
    let has = |column: &str| header.split(',').any(|name| name.trim().trim_matches('"') == column);
    has("nx") && has("ny") && !has("z") && !has("nz")
}

/// Reads contact points with outward normals in the plane from CSV text: the columns `x, y` (m) and `nx, ny`, and where
/// there is a column `palm` or `curve`, a new curve where its number changes. Columns are found by name; others are
/// ignored.
///
/// # Errors
/// [`TouchesErrorKind`] names the line and the column.
pub fn parse_planar_contacts(text: impl Read) -> Result<Vec<Vec<ContactSample>>, TouchesErrorKind> {
    contacts_and_rounding(text).map(|(curves, _)| curves)
}

/// The same, and by how much the length of a normal is off 1 at most.
pub(super) fn contacts_and_rounding(
    text: impl Read,
) -> Result<(Vec<Vec<ContactSample>>, f64), TouchesErrorKind> {
    of_rows(read_columns(text, COLUMNS, &CURVES)?)
}

/// The same from numbers.
pub(super) fn of_rows(rows: Vec<Numbers<4>>) -> Result<(Vec<Vec<ContactSample>>, f64), TouchesErrorKind> {
    let (mut contacts, mut rounding) = (Vec::new(), 0.0_f64);
    for row in rows {
        let [x, y, nx, ny] = row.values;
        let normal = Direction::from_unit(DVec2::new(nx, ny), UNIT_TOLERANCE)
            .map_err(|source| TouchesErrorKind::PlanarNormal { line: row.line, source })?;
        rounding = rounding.max((DVec2::new(nx, ny).length() - 1.0).abs());
        contacts.push((row.group, ContactSample { point: DVec2::new(x, y), normal }));
    }
    Ok((by_group(contacts), rounding))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planar_contacts_are_read_and_bad_ones_named() {
        let good = "palm,x,y,nx,ny\n1,1,0,1,0\n1,0,1,0,1\n2,-1,0,-1,0\n";
        let curves = parse_planar_contacts(good.as_bytes()).unwrap();
        assert_eq!(curves.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert_eq!(curves[1][0].point, DVec2::NEG_X);
        let refused =
            |from: &str, to: &str| parse_planar_contacts(good.replacen(from, to, 1).as_bytes()).unwrap_err();
        assert!(matches!(
            refused("1,0,1,0,1", "1,0,1,0.2,1"),
            TouchesErrorKind::PlanarNormal { line: 3, .. }
        ));
        assert!(matches!(
            refused("1,1,0", "1,inf,0"),
            TouchesErrorKind::NotANumber { line: 2, column: "x", .. }
        ));
    }

    #[test]
    fn a_column_that_is_missing_in_space_does_not_make_a_plane() {
        assert!(is_planar("x,y,nx,ny") && is_planar("curve, x, y, \"nx\", ny"));
        assert!(!is_planar("x,y,z,nx,ny") && !is_planar("x,y,nx,ny,nz") && !is_planar("x,y"));
    }
}
