use super::reconstruct::tell;
use crate::cli::DemoArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{reconstruct, simulate, write_reconstruction_folder};
use crate::progress::Progress;
use recon_io::{FolderTarget, Scene, SceneError, write_log};
use std::path::Path;

/// The scene of the paper's Fig. 5, with what the paper leaves open filled in.
const SCENE: &str = include_str!("../../scenes/fig5.toml");

pub(crate) fn run(args: &DemoArgs, console: &Console) -> Result<Outcome, CliError> {
    let path = Path::new("scene.toml");
    let scene = Scene::parse(SCENE).map_err(|kind| SceneError { path: path.to_owned(), kind })?;
    let target = FolderTarget::new(&args.output, &[], args.force)?;
    let progress = Progress::new(4, console.is_json());
    progress.step("simulating");
    let simulated = simulate(&scene, path, 1e-12)?;
    let title = "An ellipsoid on three palms (Fig. 5 of Moll and Erdmann, 2002)";
    let mut log = Vec::new();
    write_log(&simulated.log, &mut log).map_err(CliError::StandardOutput)?;
    let made = reconstruct(simulated.log, &scene, title, false, &progress)?;
    progress.step("writing the results");
    let extras = [("scene.toml".to_owned(), SCENE.into()), ("log.csv".to_owned(), log)];
    let figures = write_reconstruction_folder(target, &made, &extras)?;
    drop(progress);
    tell(console, &made, figures, &args.output)
}
