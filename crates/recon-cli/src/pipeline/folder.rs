use super::bounds::{BoundsResult, LOWER, UPPER};
use super::features::MARKS;
use super::least_model::choice_figures;
use super::{AnyPalms, ContactRun, Estimated};
use crate::error::CliError;
use crate::interrupt::{Checked, check, while_writing};
use glam::DVec3;
use recon::contact_kinematics::at_once;
use recon_io::{
    FiguresPage, FolderTarget, MotionState, OutputFolder, TriangleMesh, estimate_summary,
    write_contact_curves, write_contact_log, write_contact_report, write_estimated_motion,
    write_figures_page, write_motion, write_ply, write_radius_functions,
};
use serde_json::Value;
use std::io::{self, Write};

/// A further file of a folder: its name and its contents.
pub(crate) type Extra = (String, Vec<u8>);

/// The summary of a motion that was estimated from contacts of any palms.
pub(crate) fn estimate_figures(made: &AnyPalms) -> Value {
    let mut figures = estimate_summary(&made.data);
    state_contradiction(&mut figures, made.bounds.as_ref().map_or(0.0, |bounds| bounds.contradiction));
    if let Some(features) = made.bounds.as_ref().and_then(BoundsResult::not_smooth) {
        figures["features"] = features.figures();
    }
    if let Some(choice) = &made.choice {
        figures["least_model"] = choice_figures(choice);
    }
    figures
}

/// Writes everything about a motion that was estimated from contacts of any palms; returns the summary.
pub(crate) fn write_estimate_folder(
    target: FolderTarget,
    estimated: &Estimated,
    extras: &[Extra],
) -> Result<Value, CliError> {
    let made = &estimated.made;
    let data = &made.data;
    let figures = estimated.figures();
    let (times, palms) = (data.log.times(), data.log.palms().len());
    let curves: Vec<_> = data.curves.iter().map(Vec::as_slice).collect();
    while_writing(|| {
        let folder = Folder(target.begin()?);
        // The table of the motion is as long to write as all the rest.
        let motion =
            || folder.write("motion.csv", |to| write_estimated_motion(times, &data.estimate, palms, to));
        let rest = || {
            folder.write("contact_curves.csv", |to| write_contact_curves(times, &curves, to))?;
            folder.write_bounds(made.bounds.as_ref())?;
            for (name, contents) in extras {
                folder.write(name, |to| to.write_all(contents))?;
            }
            if estimated.of_planes {
                folder.write("radius_functions.csv", |to| write_radius_functions(times, &curves, to))?;
            }
            folder.write("report.html", |to| estimated.write_page(to))?;
            folder.write("summary.json", |to| writeln!(to, "{figures:#}"))
        };
        let (motion, rest) = at_once(motion, rest);
        motion.and(rest)?;
        folder.commit()
    })?;
    Ok(figures)
}

/// Writes what contacts without forces give.
pub(crate) fn write_touch_folder(
    target: FolderTarget,
    times: &[f64],
    (motion, deviations): (&[MotionState], &[[DVec3; 4]]),
    bounds: Option<&BoundsResult>,
    (page, figures): (&FiguresPage, &Value),
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = Folder(target.begin()?);
        folder.write("motion.csv", |to| write_motion(times, motion, deviations, to))?;
        folder.write_bounds(bounds)?;
        folder.write("report.html", |to| write_figures_page(page, to))?;
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()
    })
}

/// Writes everything about a simulated scene of any palms.
pub(crate) fn write_contact_folder(
    target: FolderTarget,
    title: &str,
    run: &ContactRun,
    extras: &[Extra],
    figures: &Value,
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = Folder(target.begin()?);
        folder.write("log.csv", |to| write_contact_log(&run.log, to))?;
        for (name, contents) in extras {
            folder.write(name, |to| to.write_all(contents))?;
        }
        folder.write("report.html", |to| write_contact_report(title, &run.world, &run.simulation, to))?;
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()
    })
}

/// Writes files that are made already, and what is said of them.
pub(crate) fn write_files_folder(
    target: FolderTarget,
    files: &[Extra],
    figures: &Value,
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = Folder(target.begin()?);
        for (name, contents) in files {
            folder.write(name, |to| to.write_all(contents))?;
        }
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()
    })
}

/// Writes the meshes of bounds and their figures.
pub(crate) fn write_bounds_folder(
    target: FolderTarget,
    made: &BoundsResult,
    (page, extras): (&FiguresPage, &[Extra]),
    figures: &Value,
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = Folder(target.begin()?);
        folder.write_mesh(LOWER, "inside the object; metres", made.lower.as_ref())?;
        folder.write_mesh(UPPER, "around the object; metres", made.upper.as_ref())?;
        folder.write_marks(made)?;
        for (name, comment, mesh) in &made.others {
            folder.write_mesh(name, comment, Some(mesh))?;
        }
        for (name, contents) in extras {
            folder.write(name, |to| to.write_all(contents))?;
        }
        folder.write("report.html", |to| write_figures_page(page, to))?;
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()
    })
}

/// Says how far the lower bound stands out of the upper one, m, where bounds are stated.
fn state_contradiction(figures: &mut Value, stands_out: f64) {
    if let Some(bounds) = figures["bounds"].as_object_mut() {
        bounds.insert("contradiction_m".to_owned(), stands_out.into());
    }
}

/// An output folder whose writing can be interrupted.
struct Folder(OutputFolder);

impl Folder {
    fn write(
        &self,
        name: &str,
        contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<(), CliError> {
        check()?;
        Ok(self.0.write(name, |to| contents(&mut Checked(to)))?)
    }

    fn write_bounds(&self, bounds: Option<&BoundsResult>) -> Result<(), CliError> {
        let (lower, upper) = bounds.map_or((None, None), |b| (b.lower.as_ref(), b.upper.as_ref()));
        self.write_mesh(LOWER, "inside the object; metres, body axes", lower)?;
        self.write_mesh(UPPER, "around the object; metres, body axes", upper)?;
        let Some(bounds) = bounds else { return Ok(()) };
        for (name, comment, mesh) in &bounds.others {
            self.write_mesh(name, comment, Some(mesh))?;
        }
        self.write_marks(bounds)
    }

    /// What each contact is on, where something is not smooth.
    fn write_marks(&self, bounds: &BoundsResult) -> Result<(), CliError> {
        let Some(features) = bounds.not_smooth() else { return Ok(()) };
        self.write(MARKS, |to| to.write_all(&features.table()))
    }

    fn write_mesh(&self, name: &str, comment: &str, mesh: Option<&TriangleMesh>) -> Result<(), CliError> {
        mesh.map_or(Ok(()), |mesh| self.write(name, |to| write_ply(mesh, comment, to)))
    }

    fn commit(self) -> Result<(), CliError> {
        check()?;
        Ok(self.0.commit()?)
    }
}
