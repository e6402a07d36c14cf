use crate::cli::CheckArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use serde_json::json;

pub(crate) fn run(args: &CheckArgs, console: &Console) -> Result<Outcome, CliError> {
    let held = recon_io::check(&args.folder)?;
    let text = format!("{}: holds\n  {}", args.folder.display(), held.join("\n  "));
    console.written(&text, &json!({ "folder": args.folder.to_string_lossy(), "holds": held }))?;
    Ok(Outcome::Done)
}
