//! `recon formats`: columns, frames and units of files.

mod table;

use crate::cli::FormatsArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use serde_json::{Value, json};
use std::fmt::Write;
use table::{FORMATS, Format};

const ALL: &str = "\
SI units everywhere: m, s, kg, N, rad. The world's z axis points up, gravity is (0, 0, -g). Tables are CSV in UTF-8 with one header row; \
columns are found by name, in any order, and others are left alone. Quaternions have the scalar first.";

pub(crate) fn run(args: &FormatsArgs, console: &Console) -> Result<Outcome, CliError> {
    let chosen: Vec<&Format> = match &args.name {
        None => FORMATS.iter().collect(),
        Some(name) => FORMATS.iter().filter(|format| format.name == name).collect(),
    };
    if chosen.is_empty() {
        let names = FORMATS.map(|format| format.name).join(", ");
        return Err(CliError::NoFormat { name: args.name.clone().unwrap_or_default(), names });
    }
    let mut text = format!("{ALL}\n");
    for format in &chosen {
        text += &described(format);
    }
    console.result(&text, &chosen.iter().map(|format| figures(format)).collect())?;
    Ok(Outcome::Done)
}

fn described(format: &Format) -> String {
    let mut text = format!("\n{}: {}\n", format.name, format.about);
    let wide = |of: fn(&table::Column) -> &str| format.columns.iter().map(|c| of(c).len()).max().unwrap_or(0);
    let (names, units) = (wide(|c| c.name), wide(|c| c.unit));
    for column in format.columns {
        let needed = if column.needed { "*" } else { " " };
        let _ =
            writeln!(text, "  {needed} {:<names$}  {:<units$}  {}", column.name, column.unit, column.meaning);
    }
    if format.columns.iter().any(|column| column.needed) {
        text += "  * is needed\n";
    }
    text
}

fn figures(format: &Format) -> Value {
    let column = |column: &table::Column| json!({ "name": column.name, "unit": column.unit, "meaning": column.meaning, "needed": column.needed });
    json!({
        "name": format.name,
        "about": format.about,
        "columns": format.columns.iter().map(column).collect::<Vec<_>>(),
    })
}
