use crate::cli::BoundsArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{BoundsResult, bounds, write_bounds_folder};
use crate::progress::Progress;
use recon::shape_bounds::ContactSample;
use recon_io::read_contacts;
use serde_json::{Value, json};
use std::fmt::Write;

pub(crate) fn run(args: &BoundsArgs, console: &Console) -> Result<Outcome, CliError> {
    let progress = Progress::new(2, console.is_json());
    progress.step("reading the contacts");
    let contacts: Vec<ContactSample> = read_contacts(&args.contacts)?
        .into_iter()
        .map(|c| ContactSample { point: c.point, normal: c.normal })
        .collect();
    progress.step("bounding the shape");
    let made = bounds(&contacts)?;
    let figures = figures(&made, contacts.len());
    if let Some(folder) = &args.output {
        write_bounds_folder(folder, &made, &figures)?;
    }
    drop(progress);
    console.result(&describe(&made, contacts.len()), &figures)?;
    let whole = made.lower.is_some() && made.upper.is_some();
    Ok(if whole { Outcome::Done } else { Outcome::WithReservations })
}

fn figures(made: &BoundsResult, contacts: usize) -> Value {
    let (lower, upper) = (made.drawn.lower.volume, made.drawn.upper.as_ref().map(|u| u.volume));
    json!({
        "recon": env!("CARGO_PKG_VERSION"),
        "contacts": contacts,
        "bounds": {
            "lower_volume_m3": lower,
            "upper_volume_m3": upper,
            "lower_over_upper": upper.map(|u| lower / u),
            "largest_gap_m": made.drawn.largest_gap,
        },
        "warnings": made.warnings,
    })
}

fn describe(made: &BoundsResult, contacts: usize) -> String {
    let lower = made.drawn.lower.volume;
    let mut text = String::new();
    for warning in &made.warnings {
        let _ = writeln!(text, "Warning: {warning}");
    }
    let _ = writeln!(text, "{contacts} contacts\n  lower bound            {lower:.6} m^3");
    if let Some(upper) = &made.drawn.upper {
        let _ = writeln!(text, "  upper bound            {:.6} m^3", upper.volume);
        let _ = writeln!(text, "  lower / upper          {:.4}", lower / upper.volume);
    }
    if let Some(gap) = made.drawn.largest_gap {
        let _ = writeln!(text, "  gap, at most           {gap:.6} m");
    }
    text
}
