//! `recon bounds` for contacts in the plane.

use crate::error::CliError;
use crate::interrupt::while_writing;
use crate::pipeline::{PlanarBounds, fit_words, plane_bounds_page};
use recon_io::{
    FigureCurve, FigurePanel, FiguresPage, FolderTarget, SummaryOf, brief, brief_to, write_figures,
    write_figures_page,
};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::Write;

pub(super) fn figures(made: &PlanarBounds, count: usize) -> Value {
    SummaryOf::Bounds.named(json!({
        "input": format!("{count} contacts in the plane"),
        "about": made.about,
        "bounds": made.figures(),
        "warnings": made.warnings,
    }))
}

pub(super) fn describe(made: &PlanarBounds, count: usize) -> String {
    let mut text: String = made.warnings.iter().map(|w| format!("Warning: {w}\n")).collect();
    let _ = writeln!(text, "{count} contacts in the plane");
    if let Some(confidence) = made.about["confidence"].as_f64() {
        let _ = writeln!(text, "  confidence             {} %", 100.0 * confidence);
    }
    let [lower, upper] = made.areas;
    let _ = writeln!(text, "  lower bound            {} m^2", brief(lower));
    if upper.is_finite() {
        let _ = writeln!(text, "  upper bound            {} m^2", brief(upper));
        let _ = writeln!(text, "  lower / upper          {}", brief_to(4, lower / upper));
    }
    if let Some(gap) = made.largest_gap {
        let _ = writeln!(text, "  gap, at most           {} m", brief(gap));
    }
    if made.about["fit"].is_object() {
        text += &fit_words(&made.about["fit"]);
    }
    let next = match upper.is_finite() {
        true => "touch it where the outlines of bounds.svg are farthest apart",
        false => "touch the object from all sides: only then it has an upper bound",
    };
    let _ = writeln!(text, "  next                   {next}");
    text
}

pub(super) fn page(title: &str, made: &PlanarBounds, count: usize) -> FiguresPage {
    plane_bounds_page(title, made, &format!("{count} contacts in the plane"), panels(made))
}

pub(super) fn write_folder(
    target: FolderTarget,
    made: &PlanarBounds,
    page: &FiguresPage,
    figures: &Value,
) -> Result<(), CliError> {
    while_writing(|| {
        let folder = target.begin()?;
        folder.write("bounds.svg", |to| write_figures(&panels(made), to))?;
        for (name, outline) in made.drawn_outlines() {
            folder.write(name, |to| PlanarBounds::write_outline(outline, to))?;
        }
        if !made.fitted.is_empty() {
            folder.write("fitted_shape.csv", |to| PlanarBounds::write_outline(&made.fitted, to))?;
        }
        folder.write("report.html", |to| write_figures_page(page, to))?;
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()?;
        Ok(())
    })
}

/// The bounds with the contacts between them, and how far they are apart in each direction.
fn panels(made: &PlanarBounds) -> Vec<FigurePanel> {
    let gap =
        FigureCurve { name: "upper - lower".to_owned(), points: made.gaps.clone(), ..FigureCurve::default() };
    let apart = FigurePanel {
        title: "Gap between the bounds".to_owned(),
        axes: ["direction of the normal in rad".to_owned(), "gap in m".to_owned()],
        curves: vec![gap],
        ..FigurePanel::default()
    };
    vec![made.panel(), apart]
}
