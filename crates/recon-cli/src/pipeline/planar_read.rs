//! Logs in the plane, from files and from memory.

use super::planar_motion::hinged_pair;
use crate::error::CliError;
use recon::object_dynamics::planar::ContactLog;
use recon_io::{
    LogFileError, PlanarKnown, planar_contact_log_of_columns, planar_log_of_columns, read_planar_contact_log,
    read_planar_log,
};
use std::path::{Path, PathBuf};

/// Where the readings are.
pub(crate) enum PlanarSource<'a> {
    /// In a CSV file.
    File(&'a Path),
    /// In memory: names and columns, and what the log is called.
    Columns(&'a [String], &'a [&'a [f64]], &'a Path),
}

/// A log of the palms of a scene; where the scene has none, of two that are hinged at the origin.
pub(crate) fn read_planar(source: &PlanarSource, known: &PlanarKnown) -> Result<ContactLog, CliError> {
    let named = |path: &Path, kind| LogFileError { path: path.to_owned(), kind };
    if known.palms.is_empty() {
        let (path, log): (PathBuf, _) = match *source {
            PlanarSource::File(path) => (path.to_owned(), read_planar_log(path)?),
            PlanarSource::Columns(names, columns, path) => {
                (path.to_owned(), planar_log_of_columns(names, columns).map_err(|kind| named(path, kind))?)
            }
        };
        return log.contact_log([0.0; 2]).ok_or(CliError::PlanarForces { path });
    }
    let surfaces: Vec<_> = known.palms.iter().map(|(surface, _)| *surface).collect();
    Ok(match *source {
        PlanarSource::File(path) => read_planar_contact_log(path, &surfaces)?,
        PlanarSource::Columns(names, columns, path) => {
            planar_contact_log_of_columns(names, columns, &surfaces).map_err(|kind| named(path, kind))?
        }
    })
}

/// What a scene knows, with two hinged palms without friction where it has none.
pub(crate) fn with_palms(mut known: PlanarKnown) -> PlanarKnown {
    if known.palms.is_empty() {
        known.palms = hinged_pair(known.gravity, None, None, None).palms;
    }
    known
}
