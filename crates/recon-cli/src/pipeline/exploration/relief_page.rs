//! The page of a body in space that a finger came down on.

use super::relief::{Descending, Known};
use crate::error::Outcome as Exit;
use crate::pipeline::views::{VIEWS, seen, views};
use glam::DVec3;
use recon_io::{ContourPage, Fact, FigureCurve, FigurePanel, JumpRow, Level, Verdict, brief_to};

const KICKER: &str = "A body that a round finger came down on: what it felt, and what that proves";
const CAPTION: &str = "Outlines: bounds of the hull. Dots: where the finger touched, both contacts of each jump, and rims, beyond which no direction sees how the surface \
                       goes on. Sections: touches within a spacing of a plane through the origin, with a finger of that size.";
const ABOUT_JUMPS: &str = "One row for each place where jumps are next to each other, with the widest of them: what lies between its contacts was not felt, as the finger touches \
                           both sides at once. Or it was, and is a hollow with a radius of curvature of no more than the last column says. Nothing else is known of it but that what the finger swept is free.";
/// Places in the table at most.
const PLACES: usize = 60;
/// Points of the finger's circle.
const ROUND: usize = 48;

pub(super) fn page(
    title: &str,
    known: &Known,
    descending: &Descending,
    (statement, exit): (&str, Exit),
) -> ContourPage {
    let relief = &known.relief;
    let level = if exit == Exit::Done { Level::Good } else { Level::Caution };
    let row = |(b, _): &(recon::exploration::relief::Bridge, usize)| JumpRow {
        after: b.touches[0] + 1,
        ends: b.touches.map(|k| relief.touches[k].point.to_array().to_vec()),
        mouth: b.mouth,
        radius_at_most: b.radius_at_most,
    };
    let points =
        |of: &mut dyn Iterator<Item = usize>| -> Vec<DVec3> { of.map(|k| relief.touches[k].point).collect() };
    let touches = points(&mut (0..relief.touches.len()));
    let jumps = points(&mut relief.bridges.iter().flat_map(|b| b.touches));
    let rims = points(&mut relief.rims.iter().copied());
    let bodies = [
        ("hull, lower bound", known.lower.as_ref().map_or(&[][..], |hull| hull.vertices())),
        ("hull, upper bound", known.upper.as_ref().map_or(&[][..], |hull| hull.vertices())),
    ];
    let dots = [("touches", &touches[..]), ("jumps", &jumps), ("rims", &rims)];
    let mut panels = views(&bodies, &dots, None);
    panels.extend(VIEWS.map(|(_, axes)| section(known, descending, axes)));
    ContourPage {
        kicker: KICKER,
        title: title.to_owned(),
        verdict: Verdict { level, text: statement.to_owned() },
        facts: facts(known, descending),
        panels,
        pictured: "Where it was felt",
        caption: CAPTION.to_owned(),
        jumps: known.places.iter().take(PLACES).map(row).collect(),
        about_jumps: ABOUT_JUMPS,
    }
}

fn facts(known: &Known, descending: &Descending) -> Vec<Fact> {
    let relief = &known.relief;
    let mut facts = vec![
        ("Lines", relief.readings.to_string(), ""),
        ("Touches", relief.touches.len().to_string(), ""),
        ("Places jumped at", known.places.len().to_string(), ""),
        ("Places with rims", known.rims.to_string(), ""),
    ];
    if let Some(radius) = relief.least_hollow {
        facts.push(("Narrowest hollow felt", brief_to(3, radius), "m"));
    }
    if let Some(volume) = known.volume {
        facts.push(("Volume at most", brief_to(4, volume), "m³"));
    }
    if let Some(lower) = &known.lower {
        facts.push(("Hull, lower bound", brief_to(4, lower.volume()), "m³"));
    }
    if let Some(upper) = &known.upper {
        facts.push(("Hull, upper bound", brief_to(4, upper.volume()), "m³"));
        facts.push(("Largest gap of the hull", brief_to(3, known.gap), "m"));
    }
    if let Some((_, level)) = descending.noise {
        facts.push(("Confidence", brief_to(4, 100.0 * level), "%"));
    }
    facts
}

/// What was touched next to a plane through the origin.
fn section(known: &Known, descending: &Descending, axes: [usize; 2]) -> FigurePanel {
    let (relief, across) = (&known.relief, 3 - axes[0] - axes[1]);
    let near = |p: DVec3| p[across].abs() < descending.probing.spacing;
    let touches =
        relief.touches.iter().map(|t| t.point).filter(|p| near(*p)).map(|p| seen(p, axes)).collect();
    let dots = |name: &str, points: Vec<[f64; 2]>| FigureCurve {
        name: name.to_owned(),
        points,
        dots: true,
        ..FigureCurve::default()
    };
    let jumps = relief.bridges.iter().map(|b| b.touches.map(|k| relief.touches[k].point));
    let jumps = jumps.filter(|ends| ends.iter().all(|p| near(*p)));
    let jumps = jumps.flat_map(|[a, b]| [seen(a, axes), seen(b, axes), [f64::NAN; 2]]).collect();
    // Above all of it, out of the way.
    let q = relief.radius;
    let top = relief.touches.iter().map(|t| t.point[axes[1]]).fold(0.0, f64::max);
    let round = |k: usize| {
        let (sin, cos) = (std::f64::consts::TAU * k as f64 / ROUND as f64).sin_cos();
        [q * cos, top + 1.2 * q + q * sin]
    };
    let names = axes.map(|axis| format!("{} in m", ["x", "y", "z"][axis]));
    let line = |name: &str, points| FigureCurve { name: name.to_owned(), points, ..FigureCurve::default() };
    let curves = [
        dots("touches", touches),
        line("jumped over", jumps),
        line("finger", (0..=ROUND).map(round).collect()),
    ];
    FigurePanel {
        title: format!("Section at {} = 0", ["x", "y", "z"][across]),
        axes: names,
        equal: true,
        curves: curves.into_iter().filter(|c| !c.points.is_empty()).collect(),
        ..FigurePanel::default()
    }
}
