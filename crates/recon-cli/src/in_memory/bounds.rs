use super::failure::Failure;
use super::options::{parsed, unlike};
use crate::cli::{BoundsArgs, Command};
use crate::commands::bounds::{Bounded as Made, bounded};
use crate::error::CliError;
use glam::DVec2;
use recon_io::{Bounds, FolderTarget, Touches, TouchesError, TriangleMesh, read_touches, touches_of_columns};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Bounds from contacts or poses: what `recon bounds` writes into a folder.
pub struct Bounded {
    made: Made,
    figures: Value,
    text: String,
    path: PathBuf,
}

/// Bounds in the plane: corners, or points along arcs, counter-clockwise; empty where there is none.
#[derive(Clone, Copy, Debug)]
pub struct Outlines<'a> {
    /// Inside of the object, m.
    pub lower: &'a [DVec2],
    /// Around it, m.
    pub upper: &'a [DVec2],
    /// Of a fitted shape, m.
    pub fitted: &'a [DVec2],
    /// Areas of both bounds, m^2.
    pub areas: [f64; 2],
    /// Largest distance between them, m.
    pub largest_gap: Option<f64>,
}

impl Bounded {
    /// Bounds from a CSV file; `options` are those of `recon bounds`.
    ///
    /// # Errors
    /// What is wrong with the file at which line, or with which option, or why there are no bounds.
    pub fn read(path: &Path, options: &[String]) -> Result<Self, Failure> {
        let args = arguments(path, options)?;
        let touches = read_touches(path).map_err(CliError::from)?;
        Self::of(&args, &touches).map_err(Failure::from)
    }

    /// Bounds from columns in memory, with the names and units of the format.
    ///
    /// # Errors
    /// As for [`Bounded::read`], with rows from 0 in place of lines.
    pub fn of_columns(names: &[String], columns: &[&[f64]], options: &[String]) -> Result<Self, Failure> {
        let path = PathBuf::from("the input");
        let args = arguments(&path, options)?;
        let touches = touches_of_columns(names, columns)
            .map_err(|kind| Failure::in_rows(TouchesError { path, kind }.into()))?;
        Self::of(&args, &touches).map_err(Failure::in_rows)
    }

    fn of(args: &BoundsArgs, touches: &Touches) -> Result<Self, CliError> {
        let made = bounded(args, touches)?;
        let figures = made.figures();
        made.check(&figures)?;
        let text = recon_io::with_brief_numbers(made.describe().trim_end());
        Ok(Self { made, figures, text, path: args.input.clone() })
    }

    /// What `summary.json` holds.
    pub fn summary(&self) -> &Value {
        &self.figures
    }

    /// What the command prints.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What the reader must know.
    pub fn warnings(&self) -> &[String] {
        match &self.made {
            Made::Space { made, .. } => &made.warnings,
            Made::Plane { made, .. } => &made.warnings,
        }
    }

    /// Whether both bounds are there, do not contradict each other, and a fit was not refused.
    pub fn is_whole(&self) -> bool {
        self.made.is_whole()
    }

    /// Volumes; none in the plane.
    pub fn bounds(&self) -> Option<&Bounds> {
        match &self.made {
            Made::Space { made, .. } => Some(&made.drawn),
            Made::Plane { .. } => None,
        }
    }

    /// Surfaces of the lower and the upper bound, in space.
    pub fn surfaces(&self) -> [Option<&TriangleMesh>; 2] {
        match &self.made {
            Made::Space { made, .. } => [made.lower.as_ref(), made.upper.as_ref()],
            Made::Plane { .. } => [None, None],
        }
    }

    /// A further surface by the name of its file: `fitted_shape.ply`, `alpha_shape.ply`, `smooth_surface.ply`.
    pub fn surface(&self, file: &str) -> Option<&TriangleMesh> {
        match &self.made {
            Made::Space { made, .. } => {
                made.others.iter().find(|(name, ..)| *name == file).map(|(.., mesh)| mesh)
            }
            Made::Plane { .. } => None,
        }
    }

    /// Bounds in the plane.
    pub fn outlines(&self) -> Option<Outlines<'_>> {
        match &self.made {
            Made::Space { .. } => None,
            Made::Plane { made, .. } => Some(Outlines {
                lower: &made.outlines[0],
                upper: &made.outlines[1],
                fitted: &made.fitted,
                areas: made.areas,
                largest_gap: made.largest_gap,
            }),
        }
    }

    /// Writes the folder that the command writes; `options` are `--force` and `--mesh`.
    ///
    /// # Errors
    /// Where it cannot be written, or does not hold.
    pub fn write(&self, folder: &Path, options: &[String]) -> Result<(), Failure> {
        let mut words = options.to_vec();
        words.push("--output=folder".to_owned());
        let args = arguments(&self.path, &words)?;
        let inputs = std::slice::from_ref(&self.path);
        let target = FolderTarget::new(folder, inputs, args.force).map_err(CliError::from)?;
        let title = self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy();
        Ok(self.made.write(target, (&title, &args.mesh), &self.figures)?)
    }
}

fn arguments(input: &Path, options: &[String]) -> Result<BoundsArgs, Failure> {
    let mut words = options.to_vec();
    words.push("input".to_owned());
    match parsed("bounds", &words)? {
        Command::Bounds(args) => Ok(BoundsArgs { input: input.to_owned(), ..args }),
        _ => Err(unlike("bounds")),
    }
}
