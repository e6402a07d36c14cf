//! What can go wrong between figures and files.

use std::io;
use std::path::PathBuf;

/// Why a chart was not written.
#[derive(Debug, thiserror::Error)]
pub enum ChartError {
    /// The name cannot be the stem of a file.
    #[error("chart name {name:?} is no file stem: use lower-case letters, digits and hyphens")]
    BadName {
        /// The name.
        name: String,
    },
    /// No point has a place on the axes.
    #[error(
        "chart {chart} has no point to draw ({left_out} failed, or are zero or not finite): measure at least one"
    )]
    NothingToDraw {
        /// Name of the chart.
        chart: String,
        /// Points that were left out.
        left_out: usize,
    },
    /// The raster image could not be made.
    #[error("chart {chart} cannot be rendered as PNG: {reason}")]
    Raster {
        /// Name of the chart.
        chart: String,
        /// The renderer's words.
        reason: String,
    },
    /// A file or folder cannot be written.
    #[error("{} cannot be written: {source}", path.display())]
    Unwritable {
        /// Which one.
        path: PathBuf,
        /// The system's reason.
        source: io::Error,
    },
}
