//! One table of the results of many logs.

use super::one::Row;
use serde_json::Value;

/// Columns of which each summary has the number under that key of its evidence, or has none.
const OF_EVIDENCE: [(&str, &str); 8] = [
    ("moment_x_kg_m2", "moment_x"),
    ("std_moment_x_kg_m2", "std_moment_x"),
    ("moment_y_kg_m2", "moment_y"),
    ("std_moment_y_kg_m2", "std_moment_y"),
    ("moment_z_kg_m2", "moment_z"),
    ("std_moment_z_kg_m2", "std_moment_z"),
    ("misfit", "misfit"),
    ("relied_on_share", "relied_on"),
];

/// Columns of what is estimated in the plane, by their keys in the summary, which has tensors there for what is in space.
const IN_PLANE: [&str; 2] = ["inertia_kg_m2", "std_inertia_kg_m2"];

/// The table as CSV: `nan` where a number is not known.
pub(super) fn table(rows: &[Row]) -> String {
    let mut header: Vec<&str> =
        vec!["log", "state", "seconds", "samples", "duration_s", "mass_kg", "std_mass_kg"];
    header.extend(OF_EVIDENCE.iter().map(|(name, _)| *name));
    header.extend(IN_PLANE);
    header.extend([
        "lower_volume_m3",
        "upper_volume_m3",
        "lower_area_m2",
        "upper_area_m2",
        "warnings",
        "why",
    ]);
    let mut text = header.join(",") + "\n";
    for row in rows {
        text += &line(row);
    }
    text
}

fn line(row: &Row) -> String {
    let number = |value: Option<f64>| value.map_or_else(|| "nan".to_owned(), |value| value.to_string());
    let of = |value: &Value| number(value.as_f64());
    let summary = &row.summary;
    let ends = summary["t_first_s"].as_f64().zip(summary["t_last_s"].as_f64());
    let mut cells = vec![quoted(&row.log), row.state.word().to_owned(), row.seconds.to_string()];
    cells.extend([of(&summary["samples"]), number(ends.map(|(first, last)| last - first))]);
    cells.extend([number(row.mass()), number(row.std_mass())]);
    cells.extend(OF_EVIDENCE.iter().map(|(_, key)| number(row.evidence(key))));
    cells.extend(IN_PLANE.map(|key| of(&summary[key])));
    let bounds = ["lower_volume_m3", "upper_volume_m3", "lower_area_m2", "upper_area_m2"];
    cells.extend(bounds.map(|key| of(&summary["bounds"][key])));
    cells.push(summary["warnings"].as_array().map_or(0, Vec::len).to_string());
    cells.push(quoted(&row.why));
    cells.join(",") + "\n"
}

/// A text as a field.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('"', "\"\"").replace('\n', " "))
}
