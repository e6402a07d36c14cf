use crate::cli::NextArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    InPlane, InSpace, Placed, STATE, Settings, State, goal_of, next_motion, next_stroke, next_touch, until_of,
};
use recon_io::{SummaryOf, Touches, read_touches};
use serde_json::Value;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &NextArgs) -> Result<Outcome, CliError> {
    let (contacts, earlier) = inputs(&args.input)?;
    let (told, exit) = planned(args, &contacts, &earlier, &read_touches(&contacts)?)?;
    // For a program in any case: there is nothing else to say.
    Console::new(true, false).result("", &told)?;
    Ok(exit)
}

/// The next touch after those of the file `contacts`, and whether one is needed; `earlier` is a summary of `recon explore`.
pub(crate) fn planned(
    args: &NextArgs,
    contacts: &Path,
    earlier: &Value,
    touches: &Touches,
) -> Result<(Value, Outcome), CliError> {
    let until = args.until.clone().or_else(|| until_of(earlier));
    let until = until.ok_or_else(|| CliError::NoGoal { path: args.input.clone() })?;
    if args.goal.contact_noise.is_some() != args.goal.normal_noise.is_some() {
        return Err(CliError::HalfNoise);
    }
    // What is proven at a confidence is in the summary; of exact contacts it follows from them.
    let same = until_of(earlier).is_some_and(|earlier| earlier.is_of(&until));
    let stated = earlier["proof"]["at_most"].as_f64().filter(|_| same).unwrap_or(f64::INFINITY);
    match touches {
        Touches::Contacts { curves, .. } if earlier["schema"] == SummaryOf::Strokes.schema() => {
            let settings = Settings::new(&args.goal, earlier, 3);
            let placed = Placed::read(&contacts.with_file_name(STATE))?;
            let stated = if placed.noise.is_some() { stated } else { f64::INFINITY };
            next_stroke(&curves.concat(), &placed, goal_of::<InSpace>(&until)?, &settings, stated)
        }
        Touches::Contacts { curves, .. } => {
            let settings = Settings::new(&args.goal, earlier, 3);
            next_touch::<InSpace>(&curves.concat(), goal_of::<InSpace>(&until)?, &settings)
        }
        Touches::PlanarContacts { curves, .. } if earlier["schema"] == SummaryOf::Rolling.schema() => {
            let settings = Settings::new(&args.goal, earlier, 2);
            let state = State::read(&contacts.with_file_name(STATE))?;
            let proven = settings.sensors.map(|_| stated);
            next_motion(&curves.concat(), &state, goal_of::<InPlane>(&until)?, &settings, proven)
        }
        Touches::PlanarContacts { curves, .. } => {
            let settings = Settings::new(&args.goal, earlier, 2);
            next_touch::<InPlane>(&curves.concat(), goal_of::<InPlane>(&until)?, &settings)
        }
        Touches::Poses(_) => Err(CliError::PosesExplored { path: contacts.to_owned() }),
    }
}

/// The file of contacts, and the summary beside it where a folder is named.
pub(crate) fn inputs(input: &Path) -> Result<(PathBuf, Value), CliError> {
    if !input.is_dir() {
        return Ok((input.to_owned(), Value::Null));
    }
    let path = input.join("summary.json");
    let wrong = |what: String| CliError::NotExplored { path: path.clone(), what };
    let text = std::fs::read_to_string(&path).map_err(|e| wrong(e.to_string()))?;
    let summary: Value = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
    let contacts = input.join("contacts.csv");
    let followed = [SummaryOf::Contour, SummaryOf::Relief].iter().any(|of| summary["schema"] == of.schema());
    if followed {
        return Err(CliError::Followed { path: input.to_owned() });
    }
    if !contacts.exists() {
        let curves = Some(input.join("contact_curves.csv")).filter(|path| path.exists());
        return Err(CliError::NoContactsToGoOn { folder: input.to_owned(), curves });
    }
    Ok((contacts, summary))
}
