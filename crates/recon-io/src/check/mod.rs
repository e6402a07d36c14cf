//! The certificate of a folder of results: what can be checked from the files alone, by code that had no part in making
//! them.
//!
//! Corners are compared as they stand in the files, by exact signs (Shewchuk's predicates, from the crate `robust`).
//! What is left to a tolerance is what writing rounds: see [`rounding`].

mod bounds;
mod fault;
mod figures;
mod mesh_file;
mod table;
#[cfg(test)]
mod tests;

pub use bounds::{outline_stands_out, stands_out};
pub use fault::{CheckError, Fault};

use crate::TriangleMesh;
use crate::output::manifest::{MANIFEST, Manifest, State};
use certificate::{Outline, Surface};
use glam::DVec2;
use recon::contact_kinematics::at_once;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufReader};
use std::path::Path;

/// Checks a folder of results again, by its files alone: that they are those that recon wrote, that meshes are closed and
/// turned one way, bounds convex, as large as stated and the lower one inside the upper one, that all numbers are finite,
/// and that every fit says how it ended. Returns what was found to hold, in words.
///
/// # Errors
/// [`CheckError`] names everything that does not hold.
pub fn check(folder: impl AsRef<Path>) -> Result<Vec<String>, CheckError> {
    let path = folder.as_ref();
    let in_folder = |source| CheckError::Io { path: path.to_owned(), source };
    let manifest = Manifest::of(path).map_err(in_folder)?;
    let manifest = manifest.ok_or_else(|| CheckError::NoManifest { path: path.to_owned() })?;
    let mut faults = Vec::new();
    let mut sound = Vec::new();
    for entry in &manifest.files {
        let file = entry.name.clone();
        match entry.state(path).map_err(in_folder)? {
            State::AsWritten => sound.push(file),
            State::Changed => {
                faults.push(Fault::Changed { file: file.clone() });
                sound.push(file);
            }
            State::Missing => faults.push(Fault::Missing { file }),
        }
    }
    let written = format!("{} files as written by recon {}", manifest.files.len(), manifest.recon);
    match certify(path, &sound) {
        Ok(held) if faults.is_empty() => Ok(std::iter::once(written).chain(held).collect()),
        Ok(_) => Err(CheckError::Faults { faults }),
        Err(further) => Err(CheckError::Faults { faults: faults.into_iter().chain(further).collect() }),
    }
}

/// Checks results that are written nowhere, as [`check`] does with those of a folder: what is stated of them, and their
/// surfaces and outlines (corners counter-clockwise), each by the name of the file that it would be.
///
/// # Errors
/// [`CheckError::Faults`] names everything that does not hold.
pub fn check_unwritten(
    summary: &Value,
    surfaces: &[(&str, &TriangleMesh)],
    outlines: &[(&str, &[DVec2])],
) -> Result<(), CheckError> {
    let mut found = Found { summary: Some(summary.clone()), ..Found::default() };
    for (file, mesh) in surfaces {
        match mesh.surface() {
            Ok(surface) => found.take(file, surface),
            Err(error) => {
                found.faults.push(Fault::Unreadable { file: (*file).to_owned(), what: error.to_string() });
            }
        }
    }
    let outline = |(file, corners): &(&str, &[DVec2])| (file.to_string(), Outline::new(corners.to_vec()));
    found.outlines.extend(outlines.iter().map(outline));
    found.certificate().map(drop).map_err(|faults| CheckError::Faults { faults })
}

/// Checks the contents of files in a folder, whoever wrote them.
pub(crate) fn certify(folder: &Path, names: &[String]) -> Result<Vec<String>, Vec<Fault>> {
    let files = || names.iter().filter(|name| *name != MANIFEST);
    // The table of a motion is as long to read as all the rest.
    let motion = || Found::of(folder, files().filter(|name| *name == MOTION));
    let (motion, rest) = at_once(motion, || Found::of(folder, files().filter(|name| *name != MOTION)));
    motion.with(rest).certificate()
}

const MOTION: &str = "motion.csv";

const SUMMARY: &str = "summary.json";
/// An approximation that need not close between contacts, if the summary says so.
const MAY_BE_OPEN: &str = "smooth_surface.ply";

/// What was read from a folder.
#[derive(Default)]
struct Found {
    summary: Option<Value>,
    surfaces: BTreeMap<String, Surface>,
    outlines: BTreeMap<String, Outline>,
    /// An edge at which the surface that may be open is.
    open: Option<[u32; 2]>,
    /// Of the table of a motion.
    relied_on: table::LastColumn,
    /// What holds, in words.
    held: Vec<String>,
    faults: Vec<Fault>,
}

impl Found {
    fn of<'a>(folder: &Path, files: impl Iterator<Item = &'a String>) -> Self {
        let mut found = Self::default();
        for file in files {
            if let Err(error) = found.read(folder, file) {
                found.faults.push(Fault::Unreadable { file: file.clone(), what: error.to_string() });
            }
        }
        found
    }

    /// What was read of the table of a motion, with what was read of other files.
    fn with(self, rest: Self) -> Self {
        let Self { relied_on, mut held, mut faults, .. } = self;
        held.extend(rest.held);
        faults.extend(rest.faults);
        Self { relied_on, held, faults, ..rest }
    }

    fn read(&mut self, folder: &Path, file: &str) -> io::Result<()> {
        let open = || Ok::<_, io::Error>(BufReader::new(File::open(folder.join(file))?));
        let extension = Path::new(file).extension().and_then(|e| e.to_str()).unwrap_or_default();
        match (file, extension) {
            (SUMMARY, _) => self.summary = Some(serde_json::from_reader(open()?)?),
            ("lower_bound.csv" | "upper_bound.csv", _) => match table::corners(file, open()?)? {
                Ok(corners) => {
                    self.outlines.insert(file.to_owned(), Outline::new(corners));
                }
                Err(fault) => self.faults.push(fault),
            },
            (MOTION, _) => {
                match table::numbers(file, open()?, table::Columns::Last, |row| self.relied_on.count(row))? {
                    None => self.held.push(format!("{file}: all numbers are finite")),
                    Some(fault) => self.faults.push(fault),
                }
            }
            (_, "csv") => match table::numbers(file, open()?, table::Columns::Last, |_| ())? {
                None => self.held.push(format!("{file}: all numbers are finite")),
                Some(fault) => self.faults.push(fault),
            },
            (_, "ply") => self.take(file, mesh_file::from_ply(open()?)?),
            (_, "obj") => self.take(file, mesh_file::from_obj(open()?)?),
            _ => {}
        }
        Ok(())
    }

    /// What holds of all that was read, in words.
    fn certificate(mut self) -> Result<Vec<String>, Vec<Fault>> {
        match &self.summary {
            Some(summary) => self.faults.extend(figures::faults(summary)),
            None => self.faults.push(Fault::Missing { file: SUMMARY.to_owned() }),
        }
        self.check_relied_on();
        self.check_open();
        self.check_bounds();
        if self.faults.is_empty() { Ok(self.held) } else { Err(self.faults) }
    }

    /// That so many rows of the motion are marked as relied on as is stated.
    fn check_relied_on(&mut self) {
        let stated = self.summary.as_ref().and_then(|s| s["relied_on_share"].as_f64());
        let table::LastColumn { rows, ones } = self.relied_on;
        let Some(stated) = stated.filter(|_| rows > 0) else { return };
        // A whole number of rows, but for the rounding of a share that was written and read.
        if (stated * rows as f64 - ones as f64).abs() < 1e-6 {
            self.held.push(format!("motion.csv: relied on at {ones} of {rows} rows, as stated"));
        } else {
            self.faults.push(Fault::ReliedOn { rows, ones, stated });
        }
    }

    fn check_open(&mut self) {
        let Some(edge) = self.open else { return };
        let stated = self.summary.as_ref().and_then(|s| s["about"]["surface"]["is_closed"].as_bool());
        if stated == Some(false) {
            self.held.push(format!("{MAY_BE_OPEN}: open, as stated"));
        } else {
            self.faults.push(Fault::Open { file: MAY_BE_OPEN.to_owned(), edge });
        }
    }

    fn take(&mut self, file: &str, surface: Surface) {
        // Of bounds more is asked, which includes it: `Surface::not_convex`.
        let open = if file.ends_with("_bound.ply") { None } else { Some(surface.open_edge()) };
        match open {
            Some(Some(edge)) if file == MAY_BE_OPEN => self.open = Some(edge),
            Some(Some(edge)) => self.faults.push(Fault::Open { file: file.to_owned(), edge }),
            None => {}
            Some(None) => {
                self.held.push(format!("{file}: closed, {} faces turned one way", surface.triangles().len()))
            }
        }
        self.surfaces.insert(file.to_owned(), surface);
    }
}

/// How far rounding moves a corner or a plane through it, at most, m: a corner is the rounded intersection of planes whose
/// offsets were rounded, each by a few units in the last place of the farthest corner's distance from the origin.
fn rounding(reach: f64) -> f64 {
    64.0 * f64::EPSILON * reach
}
