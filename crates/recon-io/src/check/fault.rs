use std::path::PathBuf;
use thiserror::Error;

/// What does not hold in a folder of results.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum Fault {
    /// A file is not there.
    #[error("{file} is missing")]
    Missing {
        /// Its name.
        file: String,
    },
    /// A file is not as recon wrote it.
    #[error("{file} was changed since recon wrote it (its size or CRC-32 is not that of manifest.json)")]
    Changed {
        /// Its name.
        file: String,
    },
    /// A file is not what its name says.
    #[error("{file} cannot be read: {what}")]
    Unreadable {
        /// Its name.
        file: String,
        /// Why.
        what: String,
    },
    /// A cell of a table is no finite number.
    #[error("{file}: line {line}, column `{column}` is `{text}`; it must be a finite number")]
    Cell {
        /// Its name.
        file: String,
        /// From 1, with the header.
        line: usize,
        /// By the header.
        column: String,
        /// As it stands there.
        text: String,
    },
    /// A cell of a table is a number that its column cannot have.
    #[error("{file}: line {line}, column `{column}` is `{text}`; it must be {must}")]
    Range {
        /// Its name.
        file: String,
        /// From 1, with the header.
        line: usize,
        /// By the header.
        column: String,
        /// As it stands there.
        text: String,
        /// What it must be.
        must: &'static str,
    },
    /// A motion is marked as relied on at another share of its rows than is stated.
    #[error("motion.csv: {ones} of {rows} rows are relied on, stated is a share of {stated}")]
    ReliedOn {
        /// Rows.
        rows: usize,
        /// Those relied on.
        ones: usize,
        /// In summary.json.
        stated: f64,
    },
    /// A row of a table has too few cells or too many.
    #[error("{file}: line {line} has {found} cells; the header has {expected}")]
    Row {
        /// Its name.
        file: String,
        /// From 1, with the header.
        line: usize,
        /// By the header.
        expected: usize,
        /// In the row.
        found: usize,
    },
    /// A surface has a hole, or faces that are turned against each other.
    #[error("{file}: at the edge of corners {} and {} its faces are open or turned against each other", edge[0] + 1, edge[1] + 1)]
    Open {
        /// Its name.
        file: String,
        /// Corners of an edge, from 0.
        edge: [u32; 2],
    },
    /// A bound is not convex.
    #[error("{file} is not convex: {why}")]
    NotConvex {
        /// Its name.
        file: String,
        /// Where and how.
        why: String,
    },
    /// A surface or outline is not as large as is said.
    #[error("{file} has {found} {unit}, stated are {stated} (they may differ by {tolerance:.1e})")]
    Size {
        /// Its name.
        file: String,
        /// From the corners.
        found: f64,
        /// In summary.json.
        stated: f64,
        /// By which they may differ.
        tolerance: f64,
        /// Unit of these.
        unit: &'static str,
    },
    /// A bound is stated but has no file, or the other way round.
    #[error("{file} and the size of this bound in summary.json do not go together: one of them is missing")]
    Unpaired {
        /// Its name.
        file: String,
    },
    /// The lower bound stands out of the upper one.
    #[error("corner {} of {file} is {distance:.1e} m outside of the upper bound; {allowed:.1e} m may be rounding or stated", corner + 1)]
    Outside {
        /// File of the lower bound.
        file: String,
        /// From 0.
        corner: usize,
        /// How far, m.
        distance: f64,
        /// How far it may be, m.
        allowed: f64,
    },
    /// The lower bound is larger than the upper one.
    #[error("the lower bound ({lower}) is larger than the upper one ({upper})")]
    Crossed {
        /// m^3 or m^2.
        lower: f64,
        /// The same.
        upper: f64,
    },
    /// Contacts contradict each other, and nothing is said about it.
    #[error("the bounds contradict each other by {distance:.1e} m, and no warning says so")]
    Contradiction {
        /// m.
        distance: f64,
    },
    /// A number is not there.
    #[error("summary.json: `{place}` is no number, and no warning says why")]
    Null {
        /// Where.
        place: String,
    },
    /// A fit does not say how it ended.
    #[error("summary.json: {fit} has no status (`{status}`)")]
    NoStatus {
        /// Which fit.
        fit: String,
        /// Where its status should stand.
        status: String,
    },
    /// A fit did not settle, and nothing is said about it.
    #[error("summary.json: `{status}` is {found}, and no warning says so")]
    NotSettled {
        /// Where the status stands.
        status: String,
        /// The status.
        found: String,
    },
}

/// Why a folder of results has no certificate.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CheckError {
    /// It is not one.
    #[error("{} holds no manifest.json of recon, by which its results could be known", path.display())]
    NoManifest {
        /// The folder.
        path: PathBuf,
    },
    /// It cannot be read.
    #[error("{} cannot be read: {source}", path.display())]
    Io {
        /// The folder.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Something in it does not hold.
    #[error("{}", listed(faults))]
    Faults {
        /// What, one or more.
        faults: Vec<Fault>,
    },
}

/// Faults that are told one by one.
const TOLD: usize = 10;

fn listed(faults: &[Fault]) -> String {
    let more = faults.len().saturating_sub(TOLD);
    let more = (more > 0).then(|| format!("and {more} more"));
    faults.iter().take(TOLD).map(Fault::to_string).chain(more).collect::<Vec<_>>().join("; ")
}
