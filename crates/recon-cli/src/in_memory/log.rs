use super::failure::Failure;
use crate::error::CliError;
use crate::pipeline::{LoadedLog, LogSource, load};
use recon_io::{
    AnyLog, FileTarget, LogFileError, OutputError, Scene, log_of_columns, write_contact_log, write_log,
};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A sensor log: of three flat palms through the origin (version 1), or of palms of any number, shape and motion (version 2).
#[derive(Clone)]
pub struct Log {
    pub(super) loaded: Arc<LoadedLog>,
    /// Where it is from.
    pub(super) path: PathBuf,
}

impl Log {
    /// Reads a CSV file, or a bag of ROS 2 by its mapping. Logs of version 2 and bags need the palms of the scene.
    ///
    /// # Errors
    /// What is wrong with the file, at which line and column.
    pub fn read(path: &Path, scene: &Scene, mapping: Option<&Path>) -> Result<Self, Failure> {
        let loaded = Arc::new(load(LogSource { path, scene, mapping })?);
        Ok(Self { loaded, path: path.to_owned() })
    }

    /// A log from its columns in memory, with names and units of the format.
    ///
    /// # Errors
    /// What is wrong with which column, at which row (from 0).
    pub fn of_columns(names: &[String], columns: &[&[f64]], scene: &Scene) -> Result<Self, Failure> {
        let path = PathBuf::from("the log");
        let log = log_of_columns(names, columns, scene.palm_setups().as_deref())
            .map_err(|kind| Failure::in_rows(LogFileError { path: path.clone(), kind }.into()))?;
        Ok(Self::new(log, path))
    }

    pub(super) fn new(log: AnyLog, path: PathBuf) -> Self {
        Self { loaded: Arc::new(log.into()), path }
    }

    /// The log itself.
    pub fn log(&self) -> &AnyLog {
        &self.loaded.log
    }

    /// Times of the samples, s.
    pub fn times(&self) -> Vec<f64> {
        match self.log() {
            AnyLog::ThreePalms(log) => log.samples().iter().map(|sample| sample.t).collect(),
            AnyLog::Contacts(log) => log.times().to_vec(),
        }
    }

    /// Number of palms.
    pub fn palms(&self) -> usize {
        match self.log() {
            AnyLog::ThreePalms(_) => 3,
            AnyLog::Contacts(log) => log.palms().len(),
        }
    }

    /// What was done to a bag, and what the reader must know.
    pub fn notes(&self) -> Vec<String> {
        self.loaded.notes.iter().chain(&self.loaded.warnings).cloned().collect()
    }

    /// Name of where it is from.
    pub fn title(&self) -> String {
        self.path.file_name().unwrap_or(self.path.as_os_str()).to_string_lossy().into_owned()
    }

    /// The log as CSV text, which reads back bit for bit.
    ///
    /// # Errors
    /// Those of `to`.
    pub fn write_to(&self, to: &mut dyn Write) -> io::Result<()> {
        match self.log() {
            AnyLog::ThreePalms(log) => write_log(log, to),
            AnyLog::Contacts(log) => write_contact_log(log, to),
        }
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
