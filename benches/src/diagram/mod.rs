//! Diagrams: what they hold, how they are drawn, and their files.

mod axis;
mod backend;
mod csv;
mod drawing;
mod error;
mod files;
mod notes;
mod outline;
mod style;
mod work_precision;

use std::path::Path;

pub use axis::{Axis, Scale};
pub use error::ChartError;
pub use files::WrittenChart;
pub use outline::{Outlines, Stroke};
pub use work_precision::{Goal, Method, Outcome, Point, WorkPrecision};

/// Any diagram.
#[derive(Clone, Debug, PartialEq)]
pub enum Diagram {
    /// Cost against error.
    WorkPrecision(WorkPrecision),
    /// Outlines in the plane.
    Outlines(Outlines),
}

impl Diagram {
    /// The stem of its files.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::WorkPrecision(chart) => &chart.name,
            Self::Outlines(outlines) => &outlines.name,
        }
    }

    /// Writes `name.csv`, `name.svg` and `name.png` into a folder, which is made where it is missing.
    ///
    /// Nothing is written before all three have been rendered, and each file is replaced in one step.
    ///
    /// # Errors
    /// A name that is no file stem, a diagram without a point, a raster image that cannot be rendered, a folder or
    /// file that cannot be written.
    pub fn save(&self, folder: &Path) -> Result<WrittenChart, ChartError> {
        let (csv, drawing) = match self {
            Self::WorkPrecision(chart) => (chart.csv(), chart.drawing()?),
            Self::Outlines(outlines) => (outlines.csv(), outlines.drawing()?),
        };
        let scene = backend::scene(&drawing);
        let svg = backend::svg(&scene);
        let png = backend::png(&scene)
            .map_err(|reason| ChartError::Raster { chart: self.name().to_owned(), reason })?;
        files::write(folder, self.name(), &csv, &svg, &png)
    }
}

impl From<WorkPrecision> for Diagram {
    fn from(chart: WorkPrecision) -> Self {
        Self::WorkPrecision(chart)
    }
}
