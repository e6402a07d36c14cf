use super::failure::Failure;
use super::options::{parsed, unlike};
use super::reconstruct::arguments;
use crate::cli::Command;
use crate::commands::planar::write_estimated;
use crate::commands::simulate::{Made, MadeLog, in_the_plane};
use crate::error::CliError;
use crate::pipeline::{PlanarMotion, PlanarSource, planar_motion, read_planar, with_palms};
use crate::progress::{Progress, Watch};
use glam::DVec2;
use recon::object_dynamics::ContactMode;
use recon::object_dynamics::planar::{BodyState, ContactLog};
use recon::observer::planar::{PlaneContact, PlaneDeviations};
use recon_io::{
    Evidence, FileTarget, FolderTarget, OutputError, PlanarKnown, PlanarScene, SceneError,
    write_planar_contact_log,
};
use serde_json::Value;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene in the plane.
#[derive(Clone)]
pub struct PlaneScene {
    text: String,
    known: PlanarKnown,
    path: PathBuf,
}

impl PlaneScene {
    /// Reads a scene file (TOML) with `plane = true`.
    ///
    /// # Errors
    /// What is wrong with which key.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let text = std::fs::read_to_string(path)
            .map_err(|error| CliError::from(SceneError { path: path.to_owned(), kind: error.into() }))?;
        Self::new(text, path.to_owned())
    }

    /// The same from TOML text.
    ///
    /// # Errors
    /// As for [`Self::read`].
    pub fn parse(text: String) -> Result<Self, Failure> {
        Self::new(text, PathBuf::from("the scene"))
    }

    fn new(text: String, path: PathBuf) -> Result<Self, Failure> {
        match PlanarScene::parse_known(&text) {
            Ok(known) => Ok(Self { text, known, path }),
            Err(kind) => Err(CliError::from(SceneError { path, kind }).into()),
        }
    }

    /// What it tells an estimate; no palms stand for two that are hinged at the origin.
    pub fn known(&self) -> &PlanarKnown {
        &self.known
    }
}

/// A sensor log in the plane.
#[derive(Clone)]
pub struct PlaneLog {
    log: Arc<ContactLog>,
    path: PathBuf,
}

impl PlaneLog {
    /// Reads a CSV file: of the palms of the scene, or of two hinged ones where it has none.
    ///
    /// # Errors
    /// What is wrong with the file, at which line and column.
    pub fn read(path: &Path, scene: &PlaneScene) -> Result<Self, Failure> {
        let log = Arc::new(read_planar(&PlanarSource::File(path), &scene.known)?);
        Ok(Self { log, path: path.to_owned() })
    }

    /// A log from its columns in memory, with names and units of the format.
    ///
    /// # Errors
    /// What is wrong with which column, at which row (from 0).
    pub fn of_columns(names: &[String], columns: &[&[f64]], scene: &PlaneScene) -> Result<Self, Failure> {
        let path = PathBuf::from("the log");
        let read = read_planar(&PlanarSource::Columns(names, columns, &path), &scene.known);
        Ok(Self { log: Arc::new(read.map_err(Failure::in_rows)?), path })
    }

    /// Times of the samples, s.
    pub fn times(&self) -> Vec<f64> {
        self.log.samples().iter().map(|sample| sample.t).collect()
    }

    /// Number of palms.
    pub fn palms(&self) -> usize {
        self.log.surfaces().len()
    }

    /// The log as CSV text (version 2), which reads back bit for bit.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_to(&self, to: &mut dyn Write) -> io::Result<()> {
        write_planar_contact_log(&self.log, to)
    }

    /// Writes the log as a CSV file, whole or not at all.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Failure> {
        let written = || -> Result<(), CliError> {
            let mut file = FileTarget::new(path, &[])?.begin()?;
            let failed = |source| OutputError::Io { action: "write", path: path.to_owned(), source };
            self.write_to(&mut file).map_err(failed)?;
            Ok(file.commit()?)
        };
        Ok(written()?)
    }
}

/// A simulated log in the plane, and what is said of it.
pub struct PlaneSimulated {
    /// The log, with the truth beside the readings.
    pub log: PlaneLog,
    /// In words.
    pub text: String,
    /// What `recon simulate --json` prints.
    pub summary: Value,
    /// The page that shows it, where it is asked for.
    pub report: Option<Vec<u8>>,
}

impl PlaneSimulated {
    /// Simulates a scene; `options` is `--tolerance`.
    ///
    /// # Errors
    /// What the scene lacks, or why there is no motion.
    pub fn of(scene: &PlaneScene, options: &[String], with_report: bool) -> Result<Self, Failure> {
        let mut words = options.to_vec();
        words.extend(["the scene", "--output=-"].map(str::to_owned));
        words.extend(with_report.then(|| "--report=page".to_owned()));
        let Command::Simulate(args) = parsed("simulate", &words)? else { return Err(unlike("simulate")) };
        let full = PlanarScene::parse(&scene.text)
            .map_err(|kind| CliError::from(SceneError { path: scene.path.clone(), kind }))?;
        let Made { log, report, text, figures, .. } = in_the_plane(&full, &args)?;
        let MadeLog::Plane(log) = log else { return Err(unlike("a simulation in the plane")) };
        let log = PlaneLog { log: Arc::new(log), path: PathBuf::from("the simulated log") };
        Ok(Self { log, text, summary: figures, report })
    }
}

/// Everything that a log in the plane tells.
pub struct PlaneReconstructed {
    made: Box<PlanarMotion>,
    log: PlaneLog,
    figures: Value,
    text: String,
}

impl PlaneReconstructed {
    /// Motion, mass and bounds on the outline. `options` are `--identify`, with which mass and inertia of the scene are not looked at, and
    /// `--accuracy`. Truth in the log is only compared with.
    ///
    /// # Errors
    /// Why the log gives no estimate.
    pub fn of(
        log: &PlaneLog,
        scene: &PlaneScene,
        options: &[String],
        watch: Option<Watch>,
    ) -> Result<Self, Failure> {
        let args = arguments(options, None)?;
        let mut known = with_palms(scene.known.clone());
        if args.identify {
            known.mass = None;
        }
        Progress::watched(watch).step("estimating the motion");
        let made = Box::new(planar_motion(log.log.as_ref().clone(), &known, args.accuracy, true)?);
        let figures = made.figures();
        let text = recon_io::with_brief_numbers(made.describe().trim_end());
        Ok(Self { made, log: log.clone(), figures, text })
    }

    /// What `summary.json` holds.
    pub fn summary(&self) -> &Value {
        &self.figures
    }

    /// What the command prints.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the result may be relied on, and why or why not.
    pub fn verdict(&self) -> (bool, String) {
        (self.made.is_reliable(), self.made.verdict())
    }

    /// What the reader must know.
    pub fn warnings(&self) -> Vec<String> {
        self.made.warnings()
    }

    /// What the estimate rests on, row by row.
    pub fn evidence(&self) -> Vec<Evidence> {
        self.made.evidence()
    }

    /// Times of the motion, s: those of the log, or of the part of it that an accuracy needs.
    pub fn times(&self) -> Vec<f64> {
        self.made.log().samples().iter().map(|sample| sample.t).collect()
    }

    /// The motion at these times: centre of mass (m), orientation (rad), velocity (m/s), angular velocity (rad/s).
    pub fn motion(&self) -> Vec<[f64; 6]> {
        let row = |of: &BodyState| [of.p_WCm.x, of.p_WCm.y, of.phi0, of.v_WCm.x, of.v_WCm.y, of.omega0];
        self.made.estimate().states.iter().map(row).collect()
    }

    /// Standard deviations there.
    pub fn deviations(&self) -> Vec<[f64; 6]> {
        let row = |of: &PlaneDeviations| [of.p_WCm.x, of.p_WCm.y, of.phi0, of.v_WCm.x, of.v_WCm.y, of.omega0];
        self.made.estimate().deviations.iter().map(row).collect()
    }

    /// Covariances of all poses: centre of mass (m), turn since the first sample (rad).
    pub fn pose_covariances(&self) -> &[[[f64; 3]; 3]] {
        &self.made.estimate().pose_covariances
    }

    /// Whether the motion of a sample is relied on to within its deviations.
    pub fn relied_on(&self) -> &[bool] {
        &self.made.estimate().relied_on
    }

    /// Contact modes of the palms at these times: 0 (off), 1 (slides), 2 (sticks).
    pub fn modes(&self) -> Vec<Vec<u8>> {
        let palms = self.log.palms();
        let numbers = |modes: &[ContactMode]| modes[..palms].iter().map(|mode| mode.number()).collect();
        self.made.estimate().modes.iter().map(|modes| numbers(modes)).collect()
    }

    /// Where each palm touched the object at these times, and the outward normal there: body axes, m from the centre of mass.
    pub fn contacts(&self) -> Vec<Vec<Option<[DVec2; 2]>>> {
        let one = |contact: &Option<PlaneContact>| contact.as_ref().map(|at| [at.p_OC, at.normal]);
        self.made.estimate().contacts.iter().map(|palm| palm.iter().map(one).collect()).collect()
    }

    /// Mass (kg) and moment of inertia (kg m^2), each with its standard deviation where it was estimated.
    pub fn body(&self) -> [(f64, Option<f64>); 2] {
        let estimate = self.made.estimate();
        let (mass, share) = estimate.mass;
        let (inertia, deviation) = estimate.inertia;
        let learned = |deviation| (!self.made.is_of_known_body()).then_some(deviation);
        [(mass, learned(mass * share)), (inertia, learned(deviation))]
    }

    /// Corners of the lower and the upper bound, and their areas (m^2); none where there are no bounds.
    pub fn bounds(&self) -> Option<([&[DVec2]; 2], [f64; 2])> {
        let bounds = self.made.bounds()?;
        Some((bounds.outlines.each_ref().map(Vec::as_slice), bounds.areas))
    }

    /// The page that the command writes.
    ///
    /// # Errors
    /// Where a number of it is not finite, which is a fault of recon.
    pub fn report(&self) -> Result<Vec<u8>, Failure> {
        let mut page = Vec::new();
        self.made.write_report(&self.title(), &mut page).map_err(CliError::Page)?;
        Ok(page)
    }

    /// Writes the folder that the command writes; `options` are `--force` and `--covariance`.
    ///
    /// # Errors
    /// Where it cannot be written.
    pub fn write(&self, folder: &Path, options: &[String]) -> Result<(), Failure> {
        let args = arguments(options, Some(folder))?;
        let inputs = [self.log.path.clone()];
        let target = FolderTarget::new(folder, &inputs, args.force).map_err(CliError::from)?;
        let extras = if args.covariance { vec![self.made.covariances()?] } else { Vec::new() };
        Ok(write_estimated(target, &self.made, (&self.title(), &self.figures), (None, &extras))?)
    }

    fn title(&self) -> String {
        self.log.path.file_name().unwrap_or(self.log.path.as_os_str()).to_string_lossy().into_owned()
    }
}
