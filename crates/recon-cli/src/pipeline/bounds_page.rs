//! The page of bounds, in space and in the plane.

use super::bounds::BoundsResult;
use super::evidence::row;
use super::fitted::unit_of;
use super::plane::PlanarBounds;
use super::views::views;
use glam::DVec3;
use recon_io::EvidenceValue::{Count, Number, Text};
use recon_io::{Evidence, Fact, FigurePanel, FiguresPage, Level, ShapeMarks, Verdict, brief, brief_to};
use serde_json::Value;

const KICKER: &str = "What touch guarantees about a shape";
const IN_SPACE: &str = "Bounds as they are seen along the axes and from all around, and the contacts. The body lies between the outlines.";
const TOUCH_NEXT: &str = " The arrow shows where they are farthest apart: a touch there tells most.";
const MARKED: &str =
    " Below, contacts by what they are on; other ones are smooth, or the odds leave them open.";
const IN_PLANE: &str = "Outlines of the bounds with the contacts, and how far they are apart.";

/// The page of bounds in space, from `what` at these points.
pub(crate) fn bounds_page(
    title: &str,
    (made, about, what): (&BoundsResult, &Value, &str),
    points: &[DVec3],
) -> FiguresPage {
    let lower = &made.drawn.lower.mesh.vertices[..];
    let upper = made.drawn.upper.as_ref().map_or(&[][..], |upper| &upper.mesh.vertices);
    let other =
        |file: &str| made.others.iter().find(|(name, ..)| *name == file).map(|(.., mesh)| &mesh.vertices[..]);
    let fitted = other("fitted_shape.ply").unwrap_or_default();
    let smooth = other("smooth_surface.ply").unwrap_or_default();
    let mut bodies = vec![("lower", lower), ("upper", upper)];
    bodies.extend((!fitted.is_empty()).then_some(("fit", fitted)));
    let dots = [("contacts", points), ("surface", smooth)];
    let next = made.drawn.largest_gap.map(|gap| gap.outer);
    let marks = made.marks();
    let touch = if next.is_some() { TOUCH_NEXT } else { "" };
    let marked_below = if marks.is_some() { MARKED } else { "" };
    let ShapeMarks { facts: more, panels: marked } = marks.unwrap_or_default();
    let sizes = [Some(made.drawn.lower.volume), made.drawn.upper.as_ref().map(|upper| upper.volume)];
    FiguresPage {
        kicker: KICKER,
        title: title.to_owned(),
        verdict: verdict(about, what, sizes, made.contradicts()),
        warnings: made.warnings.clone(),
        facts: facts(sizes, "m³", made.drawn.largest_gap.map(|gap| gap.distance), about)
            .into_iter()
            .chain(more)
            .collect(),
        heading: "Bounds on the shape",
        panels: views(&bodies, &dots, next).into_iter().chain(marked).collect(),
        caption: format!("{IN_SPACE}{touch}{marked_below}"),
        table: FiguresPage::RESTS_ON,
        evidence: evidence(about, made.contradiction),
    }
}

/// The page of bounds in the plane.
pub(crate) fn plane_bounds_page(
    title: &str,
    made: &PlanarBounds,
    what: &str,
    panels: Vec<FigurePanel>,
) -> FiguresPage {
    let sizes = made.areas.map(|area| Some(area).filter(|area| area.is_finite()));
    FiguresPage {
        kicker: KICKER,
        title: title.to_owned(),
        verdict: verdict(&made.about, what, sizes, false),
        warnings: made.warnings.clone(),
        facts: facts(sizes, "m²", made.largest_gap, &made.about),
        heading: "Bounds on the outline",
        panels,
        caption: IN_PLANE.to_owned(),
        table: FiguresPage::RESTS_ON,
        evidence: evidence(&made.about, made.contradiction),
    }
}

fn verdict(about: &Value, what: &str, [lower, upper]: [Option<f64>; 2], contradicts: bool) -> Verdict {
    if contradicts {
        let text = format!("Do not rely on these bounds: the {what} contradict each other.");
        return Verdict { level: Level::Bad, text };
    }
    let sure = match about["confidence"].as_f64() {
        Some(confidence) => format!("at {} % confidence", brief(100.0 * confidence)),
        None => "if these are exact".to_owned(),
    };
    let (level, says) = match (lower.is_some_and(|size| size > 0.0), upper.is_some()) {
        (true, true) => (Level::Good, "the object lies between the lower and the upper bound"),
        (true, false) => (Level::Caution, "the object holds the lower bound; on some side it is not bounded"),
        (false, true) => {
            (Level::Caution, "the object lies within the upper bound; nothing is certain to be inside")
        }
        (false, false) => {
            (Level::Caution, "nothing is certain to be inside, and on some side it is not bounded")
        }
    };
    let mut text = format!("From {what}: {says}, {sure}.");
    if about["fit"]["status"] == "refused" {
        text += " No shape that was asked for fits the contacts.";
    }
    Verdict { level: if about["fit"]["status"] == "refused" { Level::Caution } else { level }, text }
}

fn facts([lower, upper]: [Option<f64>; 2], unit: &'static str, gap: Option<f64>, about: &Value) -> Vec<Fact> {
    let size = |size: Option<f64>| match size {
        Some(size) => (brief(size), unit),
        None => ("unbounded".to_owned(), ""),
    };
    let of = |name, (value, unit)| (name, value, unit);
    let mut facts = vec![of("Lower bound", size(lower)), of("Upper bound", size(upper))];
    if let Some((lower, upper)) = lower.zip(upper) {
        facts.push(("Lower / upper", brief_to(4, lower / upper), ""));
    }
    facts.extend(gap.map(|gap| ("Gap, at most", brief(gap), "m")));
    facts.extend(about["confidence"].as_f64().map(|level| ("Confidence", brief_to(4, 100.0 * level), "%")));
    if let Some(volume) = about["concave"]["alpha_volume_m3"].as_f64() {
        facts.push(("Alpha shape, about", brief(volume), "m³"));
    }
    facts
}

/// What stands in `about`, row by row.
fn evidence(about: &Value, contradiction: f64) -> Vec<Evidence> {
    let mut rows = Vec::new();
    let stands_out =
        "How far the lower bound stands out of the upper one: rounding alone, where nothing contradicts.";
    rows.push(row("contradiction", "Contradiction", Number(contradiction), "m", stands_out));
    rows.extend(noise(about));
    let mut count = |key: &str, name: &str, meaning: &str| {
        if let Some(all) = about[key].as_array() {
            let level = if all.is_empty() { Level::Good } else { Level::Caution };
            rows.push(Evidence { level, ..row(key, name, Count(all.len() as u64), "", meaning) });
        }
    };
    count("outliers", "Left out", "Contacts or poses that do not go with the others.");
    count("noise_doubts", "Doubts about the noise", "What tests say against the noise that was taken.");
    count("runs_left_out", "Runs left out", "Runs that contradict others.");
    let lengths = [
        ("margin_m", "Margin of the poses", "By how much planes are moved outward."),
        (
            "mesh_tolerance_m",
            "Tolerance of the meshes",
            "How far meshes are off the bounds, to the safe side.",
        ),
        (
            "outline_tolerance_m",
            "Tolerance of the outlines",
            "How far outlines are off the bounds, to the safe side.",
        ),
    ];
    rows.extend(in_metres(about, &lengths));
    if let Some([min, max]) = about["radii_of_curvature_m"].as_array().map(Vec::as_slice) {
        let text = Text(format!("{min} to {max}"));
        rows.push(row("radii_of_curvature", "Radii of curvature", text, "m", "As they were stated."));
    }
    rows.extend(fit(&about["fit"]));
    rows.extend(concave(&about["concave"]));
    rows.extend(surface(&about["surface"]));
    rows
}

/// The noise that was taken, the largest of all curves.
fn noise(about: &Value) -> Vec<Evidence> {
    let Some(by_source) = about["noise"].as_object() else { return Vec::new() };
    let mut rows = Vec::new();
    for (source, levels) in by_source {
        let most = |key: &str| {
            levels
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(|level| level[key].as_f64())
                .fold(0.0, f64::max)
        };
        let meaning = format!("Standard deviation, as {source}; the largest of all curves.");
        let of = [
            ("across_m", "Noise across the surface", "m"),
            ("along_m", "Noise along the surface", "m"),
            ("normal_rad", "Noise of the normals", "rad"),
        ];
        rows.extend(of.map(|(key, name, unit)| row(key, name, Number(most(key)), unit, &meaning)));
    }
    rows
}

/// A fitted shape: its parameters with their deviations, or why there is none.
fn fit(fit: &Value) -> Vec<Evidence> {
    if fit["status"] == "refused" {
        let why = fit["reason"].as_str().unwrap_or_default();
        let refused = row("fit", "Fitted shape", Text("refused".to_owned()), "", why);
        return vec![Evidence { level: Level::Caution, ..refused }];
    }
    let Some(family) = fit["family"].as_str() else { return Vec::new() };
    let mut rows = vec![row("fit", "Fitted shape", Text(family.to_owned()), "", "It is no bound.")];
    for of in fit["parameters"].as_array().into_iter().flatten() {
        if let (Some(name), Some(value), Some(std)) =
            (of["name"].as_str(), of["value"].as_f64(), of["std"].as_f64())
        {
            rows.push(row(
                name,
                name,
                Number(value),
                unit_of(name),
                &format!("Standard deviation {}.", brief_to(2, std)),
            ));
        }
    }
    let residual = "Root mean square of what is left.";
    rows.extend(
        fit["residual_m"].as_f64().map(|left| row("residual", "Residual", Number(left), "m", residual)),
    );
    rows
}

/// What approximates a body that need not be convex.
fn concave(of: &Value) -> Vec<Evidence> {
    let kept = of["contacts_kept_for_the_upper_bound"].as_u64();
    let kept = kept
        .map(|n| row("kept", "Contacts of the hull", Count(n), "", "Those that the upper bound rests on."));
    let radius = of["alpha_radius_m"].as_f64();
    let meaning = "Of the balls that hollow the alpha shape out; it is no bound.";
    let radius = radius.map(|r| row("alpha_radius", "Radius of the alpha shape", Number(r), "m", meaning));
    [kept, radius].into_iter().flatten().collect()
}

/// Lengths that are there, by key, name and meaning.
fn in_metres<'a>(of: &'a Value, all: &'a [(&str, &str, &str)]) -> impl Iterator<Item = Evidence> + 'a {
    all.iter().filter_map(|(key, name, meaning)| {
        of[*key].as_f64().map(|value| row(key, name, Number(value), "m", meaning))
    })
}

/// A smooth surface.
fn surface(of: &Value) -> Vec<Evidence> {
    let Some(kind) = of["kind"].as_str() else { return Vec::new() };
    let open = if of["is_closed"] == false { ", open" } else { "" };
    let meaning = match kind {
        "principal" => "Through the midst of the contacts; it is no bound.",
        _ => "Through contacts and their normals; it is no bound.",
    };
    let mut rows = vec![row("surface", "Smooth surface", Text(format!("{kind}{open}")), "", meaning)];
    let lengths = [
        (
            "residual_m",
            "Contacts off the surface",
            "Root mean square; of a principal surface for what is left free.",
        ),
        (
            "bias_m",
            "Too far out by",
            "On the average, since it is curved, if contacts are off alike in all directions.",
        ),
    ];
    rows.extend(in_metres(of, &lengths));
    rows
}
