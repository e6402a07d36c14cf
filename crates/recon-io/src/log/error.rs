use super::contacts::PoseAgainstScene;
use crate::separator::advice;
use recon::contact_kinematics::{DirectionError, PalmError, SurfaceError};
use recon::object_dynamics::planar::{self, PlanarLogError};
use recon::object_dynamics::pushing::PushLogError;
use recon::object_dynamics::{ContactLogError, LogError};
use std::path::PathBuf;
use thiserror::Error;

/// A sensor log that cannot be used: which file, and what is wrong with it where.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct LogFileError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: LogFileErrorKind,
}

/// What is wrong with a sensor log. Lines count from 1, the header being line 1.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LogFileErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] std::io::Error),
    /// The bytes are not UTF-8 text, or not CSV.
    #[error("is not a CSV file in UTF-8: {0}")]
    Csv(csv::Error),
    /// Nothing in it.
    #[error("is empty; a sensor log has a header row and at least two samples")]
    Empty,
    /// A header, and nothing after it.
    #[error("has a header and no row after it; a push has a sample in each row, and two samples at least")]
    NoRows,
    /// A column that every log needs is not there.
    #[error("column `{column}` is missing{}; found: {found}{}", hint(similar.as_deref()), advice(found))]
    MissingColumn {
        /// The name looked for.
        column: String,
        /// A column that differs only in case or punctuation, if there is one.
        similar: Option<String>,
        /// The header as found.
        found: String,
    },
    /// Two columns share a name that has a meaning.
    #[error("column `{column}` occurs more than once; keep one")]
    RepeatedColumn {
        /// The name.
        column: String,
    },
    /// A row is shorter or longer than the header.
    #[error("line {line} has {found} fields where the header has {expected}")]
    FieldCount {
        /// Line number.
        line: u64,
        /// Fields in the header.
        expected: usize,
        /// Fields in the row.
        found: usize,
    },
    /// Columns in memory that are not of one length.
    #[error(
        "column `{column}` has {found} values where the first column has {expected}; give all of them the same number"
    )]
    ColumnLength {
        /// Name of the column.
        column: String,
        /// Its length.
        found: usize,
        /// That of the first one.
        expected: usize,
    },
    /// A field is not a number.
    #[error(
        "line {line}, column `{column}`: `{text}` is not a number; write one as 1.5e-3, or nan where there is no reading"
    )]
    NotANumber {
        /// Line number.
        line: u64,
        /// Column name.
        column: String,
        /// The field as found.
        text: String,
    },
    /// A field is NaN or infinite where it must not be.
    #[error("line {line}, column `{column}` is {value}; it must be finite{}", contact_note(column))]
    NotFinite {
        /// Line number.
        line: u64,
        /// Column name.
        column: String,
        /// The value.
        value: f64,
    },
    /// One sensor coordinate is there and the other is not.
    #[error(
        "line {line}: s1_{palm} = {s1} but s2_{palm} = {s2}; without contact both are nan, with contact neither"
    )]
    HalfContact {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// First coordinate.
        s1: f64,
        /// Second coordinate.
        s2: f64,
    },
    /// A force without a place where it acts.
    #[error(
        "line {line}: palm {palm} has no contact (s1, s2 = nan) but f_{palm} = {force} N; without contact it is 0"
    )]
    ForceWithoutContact {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// Force in N.
        force: f64,
    },
    /// A palm normal is not a unit vector.
    #[error("line {line}: normal of palm {palm} (nx_{palm}, ny_{palm}, nz_{palm}): {source}")]
    Normal {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: DirectionError,
    },
    /// A palm that has no frame.
    #[error("line {line}: palm {palm}: {source}")]
    Palm {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: PalmError,
    },
    /// Palms that share a line throughout the log.
    #[error("the palms never span space, here at line {line}: {source}")]
    Palms {
        /// Line of the sample at which they come nearest to it.
        line: u64,
        /// How far from it they are there.
        source: PalmError,
    },
    /// A log of general palms without a description of these palms.
    #[error(
        "has the columns of palms of any shape, which say nothing of the shapes; give a scene with a [[palm]] for each"
    )]
    NoPalms,
    /// A palm of a log of general palms whose samples are followed has no force.
    #[error(
        "palm {palm} has no force: samples are followed with columns fx_{palm}, fy_{palm}, fz_{palm}, or fn_{palm} without friction"
    )]
    NoForce {
        /// From 1.
        palm: usize,
    },
    /// A log of general palms where one of palms through the origin is read.
    #[error(
        "has the columns px_i or sx_i of palms of any shape, and here logs of {read} are read; `recon reconstruct` takes it"
    )]
    AnyPalms {
        /// What is read, with its columns.
        read: &'static str,
    },
    /// A log of contacts in the plane where another one is read.
    #[error(
        "is a planar log of version 2 (px_i, py_i, angle_i): `recon reconstruct` takes it with a scene that says `plane = true` and has a \
         [[palm]] for each palm; `recon planar` takes logs of two palms hinged at the origin (t, phi1, phi2, s1, s2)"
    )]
    PlanarContacts,
    /// Log and scene have different numbers of palms.
    #[error("has {found} palm(s) by its columns px_i or sx_i where the scene has {expected}")]
    PalmCount {
        /// Palms of the scene.
        expected: usize,
        /// Palms of the log.
        found: usize,
    },
    /// The same quantity stands in two sets of columns.
    #[error("has both {first} and {second}, which say the same; keep one")]
    TwoWays {
        /// Columns of the one.
        first: String,
        /// Columns of the other.
        second: String,
    },
    /// Nothing says where a palm is.
    #[error(
        "palm {palm} has no pose; give it by the columns Px_{palm}..Pz_{palm} and Qw_{palm}..Qz_{palm}, or as `pose` of the \
         scene's [[palm]] if it does not move"
    )]
    NoPose {
        /// Palm from 1.
        palm: usize,
    },
    /// A pose of a palm that is none.
    #[error("line {line}: pose of palm {palm} (Px_{palm}..Pz_{palm}, Qw_{palm}..Qz_{palm}): {source}")]
    Pose {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: SurfaceError,
    },
    /// Part of a contact point is there and part is not.
    #[error(
        "line {line}: contact of palm {palm} ({columns}) is ({}); without contact all of these are nan, with contact none is",
        value.iter().map(f64::to_string).collect::<Vec<_>>().join(", ")
    )]
    PartOfContact {
        /// Line number.
        line: u64,
        /// Palm from 1.
        palm: usize,
        /// Its columns.
        columns: String,
        /// What stands there.
        value: Vec<f64>,
    },
    /// A force without a place where it acts, in general logs.
    #[error(
        "line {line}, column `{column}`: palm {palm} is not touched but exerts {force} N; without contact it is 0 or nan"
    )]
    ForceOffContact {
        /// Line number.
        line: u64,
        /// Column name.
        column: String,
        /// Palm from 1.
        palm: usize,
        /// As given, in N.
        force: f64,
    },
    /// A palm stands elsewhere than the scene says.
    #[error(transparent)]
    PoseAgainstScene(PoseAgainstScene),
    /// A table of poses over time that cannot be used; `line` is that of the pose at fault, where one is.
    #[error("{}{source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    PoseTable {
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: SurfaceError,
    },
    /// A mode that is none.
    #[error("line {line}, column `{column}` is {value}; a mode is 0 (off), 1 (slides) or 2 (sticks)")]
    Mode {
        /// Line number.
        line: u64,
        /// Column name.
        column: String,
        /// As given.
        value: f64,
    },
    /// The samples do not make a log of general palms; `line` is that of the sample named by `source`, where it names one.
    #[error("{}{source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    ContactSamples {
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: ContactLogError,
    },
    /// The true orientation is not a unit quaternion.
    #[error("line {line}: true orientation (qw, qx, qy, qz) has length {length}; it must be 1")]
    TrueOrientation {
        /// Line number.
        line: u64,
        /// Its length.
        length: f64,
    },
    /// The samples do not make a log; `line` is that of the sample named by `source`, where it names one.
    #[error("{}{source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    Samples {
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: LogError,
    },
    /// The samples do not make a log of planar palms; `line` as above.
    #[error("{}{source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    PlanarContactSamples {
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: planar::ContactLogError,
    },
    /// A number of a log or of a push that is none.
    #[error(
        "line {line}, column `{column}` is {value}; logs and pushes are numbered by whole numbers from 0"
    )]
    PushNumber {
        /// Line number.
        line: u64,
        /// Column name.
        column: String,
        /// As given.
        value: f64,
    },
    /// Samples of a push whose poses are not known.
    #[error(
        "line {line}: push {push} of log {log} has no row in the file of poses; add its poses, or leave its samples out"
    )]
    NoPoseOfPush {
        /// Line of its first sample.
        line: u64,
        /// Its log.
        log: u32,
        /// Its number.
        push: u32,
    },
    /// Poses of a push without samples.
    #[error(
        "line {line}: push {push} of log {log} has no sample in the file of pushes; add its samples, or leave its poses out"
    )]
    PoseWithoutPush {
        /// Line number.
        line: u64,
        /// Its log.
        log: u32,
        /// Its number.
        push: u32,
    },
    /// Two rows of poses for one push.
    #[error("line {line}: push {push} of log {log} has poses already in line {first}; keep one row")]
    PoseTwice {
        /// Line number.
        line: u64,
        /// Its log.
        log: u32,
        /// Its number.
        push: u32,
        /// Line of the other row.
        first: u64,
    },
    /// The samples do not make a log of pushes; `line` as above.
    #[error("{}log {log}: {source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    Pushes {
        /// Number of the log.
        log: u32,
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: PushLogError,
    },
    /// The samples do not make a planar log; `line` as above.
    #[error("{}{source}", line.map_or(String::new(), |line| format!("line {line}: ")))]
    PlanarSamples {
        /// Line number.
        line: Option<u64>,
        /// Why.
        source: PlanarLogError,
    },
}

fn hint(similar: Option<&str>) -> String {
    similar.map_or_else(String::new, |name| format!(" (is it `{name}`?)"))
}

fn contact_note(column: &str) -> &'static str {
    if column.starts_with("f_") { " (nan only goes with a palm that has no contact)" } else { "" }
}
