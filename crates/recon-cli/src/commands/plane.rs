//! `recon bounds` for contacts in the plane.

use crate::error::CliError;
use crate::interrupt::while_writing;
use crate::pipeline::{PlanarBounds, fit_words};
use glam::DVec2;
use recon_io::{FigureCurve, FigurePanel, FolderTarget, brief, brief_to, write_figures};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::io::{self, Write};

pub(super) fn figures(made: &PlanarBounds, count: usize) -> Value {
    let [lower, upper] = made.areas;
    json!({
        "recon": env!("CARGO_PKG_VERSION"),
        "input": format!("{count} contacts in the plane"),
        "about": made.about,
        "bounds": {
            "lower_area_m2": lower,
            "upper_area_m2": upper,
            "lower_over_upper": lower / upper,
            "largest_gap_m": made.largest_gap(),
            "contradiction_m": made.contradiction,
        },
        "warnings": made.warnings,
    })
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
    if let Some(gap) = made.largest_gap() {
        let _ = writeln!(text, "  gap, at most           {} m", brief(gap));
    }
    if made.about["fit"].is_object() {
        text += &fit_words(&made.about["fit"]);
    }
    text
}

pub(super) fn write_folder(
    target: FolderTarget,
    made: &PlanarBounds,
    figures: &Value,
) -> Result<(), CliError> {
    while_writing(|| {
        let mut folder = target.begin()?;
        folder.write("bounds.svg", |to| write_figures(&panels(made), to))?;
        for (name, outline) in made.drawn_outlines() {
            folder.write(name, |to| corners(outline, to))?;
        }
        if !made.fitted.is_empty() {
            folder.write("fitted_shape.csv", |to| corners(&made.fitted, to))?;
        }
        folder.write("summary.json", |to| writeln!(to, "{figures:#}"))?;
        folder.commit()?;
        Ok(())
    })
}

fn corners(outline: &[DVec2], to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "x,y")?;
    outline.iter().try_for_each(|p| writeln!(to, "{:?},{:?}", p.x, p.y))
}

/// The bounds with the contacts between them, and how far they are apart in each direction.
fn panels(made: &PlanarBounds) -> Vec<FigurePanel> {
    let closed = |name: &str, outline: &[DVec2]| FigureCurve {
        name: name.to_owned(),
        points: outline.iter().chain(outline.first()).map(|p| p.to_array()).collect(),
        ..FigureCurve::default()
    };
    let [lower, upper] = &made.outlines;
    let mut curves = vec![closed("lower bound", lower), closed("upper bound", upper)];
    curves.push(FigureCurve {
        name: "contacts".to_owned(),
        points: made.points.iter().map(DVec2::to_array).collect(),
        dots: true,
        ..FigureCurve::default()
    });
    if !made.fitted.is_empty() {
        curves.push(closed("fit", &made.fitted));
    }
    let gap =
        FigureCurve { name: "upper - lower".to_owned(), points: made.gaps.clone(), ..FigureCurve::default() };
    vec![
        FigurePanel {
            title: "Bounds".to_owned(),
            axes: ["x in m".to_owned(), "y in m".to_owned()],
            equal: true,
            curves: curves.into_iter().filter(|c| !c.points.is_empty()).collect(),
            ..FigurePanel::default()
        },
        FigurePanel {
            title: "Gap between the bounds".to_owned(),
            axes: ["direction of the normal in rad".to_owned(), "gap in m".to_owned()],
            curves: vec![gap],
            ..FigurePanel::default()
        },
    ]
}
