//! Plots of the page.

use super::Failure;
use super::row::Row;
use super::tables::{COVERAGE_ALL, COVERAGE_HELD, Compared, INERTIA, MOTION, Of};
use recon_benches::palms::{ESTIMATED, Interval, LOOKS, PalmKind, median_of};
use recon_benches::{Axis, Diagram, Method, WorkPrecision};
use std::path::Path;

/// Draws all into a folder.
pub(super) fn draw(compared: &Compared, folder: &Path) -> Result<(), Failure> {
    for diagram in [
        over_radians(
            compared,
            0,
            "palms-coverage",
            "Share of the sphere of normals that was seen",
            "coverage",
        ),
        over_radians(compared, 1, "palms-gap", "Gap between the bounds", "gap"),
        coverage(compared),
        known(compared),
    ] {
        diagram.save(folder)?;
    }
    Ok(())
}

/// Medians over all runs that were simulated, with what was seen up to a loss.
fn over_radians(compared: &Compared, what: usize, name: &str, title: &str, axis: &str) -> Diagram {
    let curve = |(k, kind): (usize, &PalmKind)| {
        (0..LOOKS).fold(Method::new(kind.name()), |method, look| {
            let all = compared.all[k].iter().filter(|r| r.simulated());
            let values: Vec<f64> = all.map(|r: &Row| r.looks[look][what]).collect();
            let radians = compared.radians * (look + 1) as f64 / LOOKS as f64;
            method.point("", radians, median_of(&values).median)
        })
    };
    let subtitle = format!(
        "median of all bodies that were simulated, over {:.1} s; radii in sizes of the body",
        compared.seconds
    );
    WorkPrecision::new(name, title)
        .subtitle(subtitle)
        .axes(Axis::linear("palm motion, all palms", "rad"), Axis::linear(axis, "1"))
        .methods(PalmKind::ALL.iter().enumerate().map(curve))
        .into()
}

/// Kinds by curvature, from the most hollow on.
fn by_curvature() -> Vec<(usize, f64)> {
    let mut all: Vec<(usize, f64)> = PalmKind::ALL.iter().map(|kind| kind.curvature()).enumerate().collect();
    all.sort_by(|a, b| a.1.total_cmp(&b.1));
    all
}

/// The median and both ends of its interval over curvature.
fn band(name: &str, of: impl Fn(usize) -> Interval) -> [Method; 3] {
    let one = |suffix: &str, pick: fn(Interval) -> f64| {
        by_curvature().into_iter().fold(Method::new(format!("{name}{suffix}")), |method, (k, curvature)| {
            let value = pick(of(k));
            if value.is_finite() { method.point("", curvature, value) } else { method }
        })
    };
    [one("", |i| i.median), one(", 2.5 %", |i| i.ends[0]), one(", 97.5 %", |i| i.ends[1])]
}

fn coverage(compared: &Compared) -> Diagram {
    let points = |of: Of| {
        move |k: usize| {
            let Interval { median, ends, count } = compared.difference(k, of);
            Interval { median: 100.0 * median, ends: ends.map(|e| 100.0 * e), count }
        }
    };
    WorkPrecision::new("palms-against-flat", "Coverage against that by flat palms, body by body")
        .subtitle("median difference with its 95 % interval; hollow palms on the left, flat ones at 0")
        .axes(
            Axis::linear("curvature of the palms times the size of the body", "1"),
            Axis::linear("coverage less that by flat palms", "points"),
        )
        .methods(band("held by both", points(COVERAGE_HELD)))
        .methods(band("all simulated", points(COVERAGE_ALL)).into_iter().take(1))
        .into()
}

fn known(compared: &Compared) -> Diagram {
    WorkPrecision::new("palms-known", "What the estimator does not know, against flat palms")
        .subtitle(format!(
            "stated deviations after {ESTIMATED} s over those on flat palms, median ratio with its 95 % interval"
        ))
        .axes(
            Axis::linear("curvature of the palms times the size of the body", "1"),
            Axis::linear("deviation over that on flat palms", "1"),
        )
        .methods(band("inertia", |k| compared.ratio(k, INERTIA)))
        .methods(band("motion", |k| compared.ratio(k, MOTION)))
        .into()
}
