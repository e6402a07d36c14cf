use crate::separator::advice;
use recon::contact_kinematics::DirectionError;
use recon::shape_bounds::exact_hull::planar;
use std::io;
use std::path::PathBuf;
use thiserror::Error;

/// A file of contacts or poses that cannot be used.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct TouchesError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: TouchesErrorKind,
}

/// What is wrong with contacts or poses. Lines count from 1, the header being line 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TouchesErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] io::Error),
    /// Not CSV, or not UTF-8.
    #[error("is not a CSV file in UTF-8: {0}")]
    Csv(csv::Error),
    /// No row in it.
    #[error(
        "holds no rows; it needs a header `x,y,z,nx,ny,nz` (in the plane `x,y,nx,ny`) and one row per contact, or \
         `qw,qx,qy,qz,px,py,pz` and one row per pose"
    )]
    Empty,
    /// A column is not there.
    #[error("column `{column}` is missing; found: {found}{}", advice(found))]
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
    /// A normal in the plane is not a unit vector.
    #[error("line {line}: normal (nx, ny): {source}")]
    PlanarNormal {
        /// Line number.
        line: u64,
        /// Why.
        source: planar::DirectionError,
    },
    /// A quaternion is not of unit length.
    #[error("line {line}: the quaternion (qw, qx, qy, qz) has the length {length}, not 1")]
    Quaternion {
        /// Line number.
        line: u64,
        /// Its length.
        length: f64,
    },
    /// Poses that are not sampled evenly.
    #[error(
        "line {line}: frame {frame} follows frame {before} of the same toss; frames must follow one by one: number the \
         parts before and after a gap as two tosses"
    )]
    FrameGap {
        /// Line number.
        line: u64,
        /// The frame there.
        frame: f64,
        /// The one before.
        before: f64,
    },
}
