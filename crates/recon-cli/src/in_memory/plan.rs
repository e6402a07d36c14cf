//! Where to touch next.

use super::failure::Failure;
use super::options::{parsed, unlike};
use crate::cli::{Command, NextArgs};
use crate::commands::next::{inputs, planned};
use crate::error::CliError;
use recon_io::{TouchesError, read_touches, touches_of_columns};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// Where to touch next after the contacts of a file, or of a folder of `recon explore`: what `recon next` prints; `options` are its own.
///
/// # Errors
/// What is wrong with the file at which line, or with which option, or why the contacts give no bounds.
pub fn plan_of_file(path: &Path, options: &[String]) -> Result<Value, Failure> {
    let args = arguments(path, options)?;
    let (contacts, earlier) = inputs(path)?;
    let touches = read_touches(&contacts).map_err(CliError::from)?;
    Ok(planned(&args, &contacts, &earlier, &touches)?.0)
}

/// The same after contacts in memory, in columns with the names and units of the format.
///
/// # Errors
/// As for [`plan_of_file`], with rows from 0 in place of lines.
pub fn plan_of_columns(names: &[String], columns: &[&[f64]], options: &[String]) -> Result<Value, Failure> {
    let path = PathBuf::from("the input");
    let args = arguments(&path, options)?;
    let touches = touches_of_columns(names, columns)
        .map_err(|kind| Failure::in_rows(TouchesError { path: path.clone(), kind }.into()))?;
    Ok(planned(&args, &path, &Value::Null, &touches).map_err(Failure::in_rows)?.0)
}

fn arguments(input: &Path, options: &[String]) -> Result<NextArgs, Failure> {
    let mut words = options.to_vec();
    words.push("input".to_owned());
    match parsed("next", &words)? {
        Command::Next(args) => Ok(NextArgs { input: input.to_owned(), ..args }),
        _ => Err(unlike("next")),
    }
}
