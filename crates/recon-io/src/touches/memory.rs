//! Contacts or poses from numbers in memory.

use super::columns::{CURVES, RUNS, numbers};
use super::error::TouchesErrorKind;
use super::{Touches, contacts, planar, poses};

/// Contacts or poses from columns of the same length, with the names and units of the format; `names` and `columns` are in the same order.
/// What a CSV file of these numbers gives, to the last bit.
///
/// # Errors
/// [`TouchesErrorKind`] names the column and the row, counted from 0, where it says "line".
pub fn touches_of_columns(names: &[String], columns: &[&[f64]]) -> Result<Touches, TouchesErrorKind> {
    if names.iter().any(|name| name.trim() == "qw") {
        let rows = numbers(names, columns, poses::COLUMNS, &RUNS)?;
        let frames = match numbers(names, columns, ["frame"], &RUNS) {
            Err(TouchesErrorKind::MissingColumn { .. }) => Vec::new(),
            frames => frames?,
        };
        return poses::of_rows(rows, &frames).map(Touches::Poses);
    }
    if planar::is_planar(&names.join(",")) {
        let (curves, rounding) = planar::of_rows(numbers(names, columns, planar::COLUMNS, &CURVES)?)?;
        return Ok(Touches::PlanarContacts { curves, rounding });
    }
    let (curves, rounding) = contacts::of_rows(numbers(names, columns, contacts::COLUMNS, &CURVES)?)?;
    Ok(Touches::Contacts { curves, rounding })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn touches(names: &str, columns: &[&[f64]]) -> Result<Touches, TouchesErrorKind> {
        touches_of_columns(&names.split(',').map(str::to_owned).collect::<Vec<_>>(), columns)
    }

    #[test]
    fn contacts_come_in_their_curves() {
        let (zero, one): (&[f64], &[f64]) = (&[0.0; 3], &[1.0; 3]);
        let found = touches("nz,x,y,z,nx,ny,palm", &[one, zero, zero, one, zero, zero, &[1.0, 1.0, 2.0]]);
        let Ok(Touches::Contacts { curves, rounding }) = found else {
            panic!("contacts in space: {found:?}")
        };
        assert_eq!(curves.iter().map(Vec::len).collect::<Vec<_>>(), [2, 1]);
        assert_eq!((curves[0][0].point.z, rounding), (1.0, 0.0));
        assert!(matches!(touches("x,y,nx,ny", &[zero, zero, one, zero]), Ok(Touches::PlanarContacts { .. })));
        let pose = touches("qw,qx,qy,qz,px,py,pz", &[one, zero, zero, zero, zero, zero, one]);
        assert!(matches!(pose, Ok(Touches::Poses(runs)) if runs[0].len() == 3));
    }

    #[test]
    fn what_is_wrong_is_named_with_its_row() {
        let (zero, one): (&[f64], &[f64]) = (&[0.0; 3], &[1.0; 3]);
        let wrong = touches("x,y,z,nx,ny,nz", &[zero, &[0.0, f64::NAN, 0.0], one, zero, zero, one]);
        assert!(matches!(wrong, Err(TouchesErrorKind::NotANumber { line: 1, column: "y", .. })), "{wrong:?}");
        let wrong = touches("x,y,z,nx,ny,nz", &[zero, zero, one, zero, zero, &[1.0, 1.0, 2.0]]);
        assert!(matches!(wrong, Err(TouchesErrorKind::Normal { line: 2, .. })), "{wrong:?}");
        let wrong = touches("x,y,z,nx,ny,nz", &[zero, zero, one, zero, zero, &[1.0]]);
        assert!(
            matches!(wrong, Err(TouchesErrorKind::NotANumber { line: 1, column: "nz", .. })),
            "{wrong:?}"
        );
        assert!(matches!(touches("x,y,z,nx,ny", &[zero; 5]), Err(TouchesErrorKind::MissingColumn { .. })));
    }
}
