//! `recon reconstruct --without-forces`: from contacts and palm poses alone.

use crate::cli::ReconstructArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{three_palms, without_forces};
use crate::progress::Progress;
use recon_io::Scene;

pub(super) fn run(args: &ReconstructArgs, scene: &Scene, console: &Console) -> Result<Outcome, CliError> {
    let target = super::reconstruct::target(args)?;
    let progress = Progress::new(4, console.is_quiet());
    progress.step("reading the log");
    let (log, warnings) = three_palms(super::reconstruct::source(args, scene), console)?;
    let made = without_forces(log, warnings, scene, &progress)?;
    progress.step("writing the results");
    let title = args.log.file_name().unwrap_or(args.log.as_os_str()).to_string_lossy();
    let figures = made.write(target, &title)?;
    drop(progress);
    let text = format!("{}\n{}", made.describe(), args.output.join("report.html").display());
    console.written(&text, &figures)?;
    Ok(if made.bounded.is_some() { Outcome::Done } else { Outcome::WithReservations })
}
