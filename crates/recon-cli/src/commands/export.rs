use crate::cli::ExportArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::write_files_folder;
use recon_io::{FolderTarget, Scene, SceneError, SceneModel, SummaryOf};
use serde_json::json;
use std::slice;

pub(crate) fn run(args: &ExportArgs, console: &Console) -> Result<Outcome, CliError> {
    let scene = Scene::read(&args.scene)?;
    let target = FolderTarget::new(&args.output, slice::from_ref(&args.scene), args.force)?;
    let in_file = |kind| SceneError { path: args.scene.clone(), kind };
    let files = SceneModel::new("scene", &scene).map_err(in_file)?.files()?;
    let names: Vec<String> = files.iter().map(|file| file.name.clone()).collect();
    let files: Vec<_> = files.into_iter().map(|file| (file.name, file.contents)).collect();
    let mut figures = SummaryOf::Export.named(json!({ "files": names }));
    write_files_folder(target, &files, &figures)?;
    figures["folder"] = args.output.to_string_lossy().into();
    let text = format!("{}: {}", args.output.display(), names.join(", "));
    console.written(&text, &figures)?;
    Ok(Outcome::Done)
}
