//! What a body's surface was seen to do, as CSV: contact points with normals, in space or in the plane, or poses above a
//! plane.

mod columns;
mod contacts;
mod error;
mod memory;
mod planar;
mod poses;

pub use contacts::{parse_contacts, read_contacts, write_contacts};
pub use error::{TouchesError, TouchesErrorKind};
pub use memory::touches_of_columns;
pub use planar::parse_planar_contacts;
pub use poses::parse_poses;

use recon::shape_bounds::poses::BodyPose;
use recon::shape_bounds::{ContactSample, planar as flat};
use std::io::Read;
use std::path::Path;

/// What bounds of a body can be made from.
#[derive(Clone, Debug, PartialEq)]
pub enum Touches {
    /// Contact points with outward normals.
    Contacts {
        /// One list for each curve, in the order of the file.
        curves: Vec<Vec<ContactSample>>,
        /// By how much the length of a normal is off 1 in the file at most: by what its digits were rounded, if by nothing else.
        rounding: f64,
    },
    /// The same in the plane.
    PlanarContacts {
        /// One list for each curve, in the order of the file.
        curves: Vec<Vec<flat::ContactSample>>,
        /// By how much the length of a normal is off 1 in the file at most.
        rounding: f64,
    },
    /// Poses of a body above a plane, one list for each run, in the order of time.
    Poses(Vec<Vec<BodyPose>>),
}

/// Reads contacts (columns of [`parse_contacts`]; in the plane, of [`parse_planar_contacts`]) or poses (columns of
/// [`parse_poses`]), told apart by the header.
///
/// # Errors
/// [`TouchesError`] names the file, the line and the column.
pub fn read_touches(path: impl AsRef<Path>) -> Result<Touches, TouchesError> {
    let path = path.as_ref();
    let in_file = |kind| TouchesError { path: path.to_owned(), kind };
    let text = read_text(path).map_err(|e| in_file(e.into()))?;
    let header = text.lines().next().unwrap_or_default();
    let is_poses = header.split(',').any(|name| name.trim().trim_matches('"') == "qw");
    let touches = if is_poses {
        parse_poses(text.as_bytes()).map(Touches::Poses)
    } else if planar::is_planar(header) {
        planar::contacts_and_rounding(text.as_bytes())
            .map(|(curves, rounding)| Touches::PlanarContacts { curves, rounding })
    } else {
        contacts::contacts_and_rounding(text.as_bytes())
            .map(|(curves, rounding)| Touches::Contacts { curves, rounding })
    };
    touches.map_err(in_file)
}

/// A whole file as text; bytes that are no text become marks that no number has.
fn read_text(path: &Path) -> std::io::Result<String> {
    let mut bytes = Vec::new();
    std::fs::File::open(path)?.read_to_end(&mut bytes)?;
    String::from_utf8(bytes)
        .map_err(|_| std::io::Error::new(std::io::ErrorKind::InvalidData, "not UTF-8 text"))
}
