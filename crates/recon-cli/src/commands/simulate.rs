use crate::cli::SimulateArgs;
use crate::console::{Console, listened};
use crate::error::{CliError, Outcome};
use crate::interrupt::{Checked, while_writing};
use crate::pipeline::{Simulated, simulate};
use crate::progress::Progress;
use recon::object_dynamics::{End, SensorLog};
use recon_io::{FileTarget, OutputError, Scene, is_standard_output, write_log};
use serde_json::{Value, json};
use std::io;
use std::path::Path;
use std::slice;

pub(crate) fn run(args: &SimulateArgs, console: &Console) -> Result<Outcome, CliError> {
    let scene = Scene::read(&args.scene)?;
    let inputs = slice::from_ref(&args.scene);
    let target = match is_standard_output(&args.output) {
        true => None,
        false => Some(FileTarget::new(&args.output, inputs)?),
    };
    let progress = Progress::new(2, console.is_json());
    progress.step("simulating");
    let simulated = simulate(&scene, &args.scene, args.tolerance)?;
    progress.step("writing the log");
    let to_standard_output = target.is_none();
    match target {
        None => listened(write_log(&simulated.log, io::stdout().lock()))?,
        Some(target) => write(&simulated.log, target, &args.output)?,
    }
    drop(progress);
    let text = describe(&simulated);
    if to_standard_output {
        console.note(&text);
    } else {
        console.result(&format!("{}: {text}", args.output.display()), &figures(&simulated, &args.output))?;
    }
    Ok(if simulated.end == End::Completed { Outcome::Done } else { Outcome::WithReservations })
}

fn write(log: &SensorLog, target: FileTarget, path: &Path) -> Result<(), CliError> {
    while_writing(|| {
        let mut file = target.begin()?;
        write_log(log, Checked(&mut file)).map_err(|source| OutputError::Io {
            action: "write",
            path: path.to_owned(),
            source,
        })?;
        Ok(file.commit()?)
    })
}

fn describe(simulated: &Simulated) -> String {
    let samples = simulated.log.samples().len();
    match simulated.end {
        End::Completed => {
            format!("{samples} samples over {} s, in contact with all three palms", simulated.duration)
        }
        End::ContactLost { palm, t } => format!(
            "{samples} samples up to t = {t:.6} s, where palm {} loses contact; {} s were asked for",
            palm + 1,
            simulated.duration
        ),
    }
}

fn figures(simulated: &Simulated, output: &Path) -> Value {
    let lost = match simulated.end {
        End::Completed => Value::Null,
        End::ContactLost { palm, t } => json!({ "palm": palm + 1, "t_s": t }),
    };
    json!({
        "log": output.to_string_lossy(),
        "samples": simulated.log.samples().len(),
        "duration_s": simulated.log.duration(),
        "contact_lost": lost,
    })
}
