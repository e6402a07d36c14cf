use super::failure::Failure;
use super::log::Log;
use super::options::{parsed, unlike};
use crate::cli::Command;
use crate::commands::simulate::{Made, MadeLog, in_space};
use crate::error::Outcome;
use recon_io::Scene;
use serde_json::Value;
use std::path::PathBuf;

/// A simulated log, and what is said of it.
pub struct Simulated {
    /// The log, with the truth beside the readings.
    pub log: Log,
    /// In words.
    pub text: String,
    /// What `recon simulate --json` prints.
    pub summary: Value,
    /// The page that shows it, of scenes with `[[palm]]` tables.
    pub report: Option<Vec<u8>>,
    /// Whether it goes on to the end that was asked for.
    pub is_whole: bool,
}

impl Simulated {
    /// Simulates a scene of space; `options` is `--tolerance`.
    ///
    /// # Errors
    /// What the scene lacks, or why there is no motion.
    pub fn of(scene: &Scene, options: &[String], with_report: bool) -> Result<Self, Failure> {
        let mut words = options.to_vec();
        words.extend(["the scene", "--output=-"].map(str::to_owned));
        if with_report && scene.palms.is_some() {
            words.push("--report=page".to_owned());
        }
        let Command::Simulate(args) = parsed("simulate", &words)? else { return Err(unlike("simulate")) };
        let Made { log, report, text, figures, outcome } = in_space(scene, &args)?;
        let MadeLog::Space(log) = log else {
            return Err(unlike("a simulation in space"));
        };
        let log = Log::new(log, PathBuf::from("the simulated log"));
        Ok(Self { log, text, summary: figures, report, is_whole: outcome == Outcome::Done })
    }
}
