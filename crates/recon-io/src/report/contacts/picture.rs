//! Pictures of object and palms at a few instants.

use crate::number::on_scale;
use glam::DVec2;
use recon::object_dynamics::ContactMode;
use std::fmt::Write as _;

/// Width of a picture and largest height, px.
const WIDTH: f64 = 290.0;
const HIGHEST: f64 = 1.5 * WIDTH;
const MARGIN: f64 = 6.0;

/// A line of a picture, in m on the plane of view.
pub(super) struct Line {
    pub(super) class: String,
    pub(super) points: Vec<DVec2>,
}

impl Line {
    pub(super) fn new(class: &str, points: Vec<DVec2>) -> Self {
        Self { class: class.to_owned(), points }
    }

    /// The palm `i` (from 0); lines that enclose nothing are `open`.
    pub(super) fn palm(i: usize, open: bool, points: Vec<DVec2>) -> Self {
        Self { class: format!("palm p{}{}", i + 1, if open { " open" } else { "" }), points }
    }

    /// A contact.
    pub(super) fn touch(mode: ContactMode, at: DVec2) -> Self {
        // A line without length under a round cap is a dot.
        Self { class: format!("touch m{}", mode.number()), points: vec![at, at] }
    }
}

/// What is seen at a time in s, from back to front.
pub(super) struct Picture {
    pub(super) t: f64,
    pub(super) lines: Vec<Line>,
}

/// Pictures beside each other, all to one scale, as SVG elements.
pub(super) fn drawn(pictures: &[Picture]) -> String {
    let points = || pictures.iter().flat_map(|picture| &picture.lines).flat_map(|line| &line.points);
    let low = points().fold(DVec2::INFINITY, |low, p| low.min(*p));
    let high = points().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
    let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
    let scale = ((WIDTH - 2.0 * MARGIN) / size.x).min((HIGHEST - 2.0 * MARGIN) / size.y);
    let (height, left) = (scale * size.y + 2.0 * MARGIN, 0.5 * (WIDTH - scale * size.x));
    let place = |p: DVec2| {
        let at = [left + scale * (p.x - low.x), MARGIN + scale * (high.y - p.y)];
        at.map(|v| on_scale(v, 100.0, 3))
    };
    let mut out = String::new();
    for Picture { t, lines } in pictures {
        let _ = writeln!(
            out,
            "<figure class=\"instant\"><svg viewBox=\"0 0 {WIDTH} {}\" role=\"img\">",
            on_scale(height, 100.0, 3)
        );
        for line in lines {
            let places: Vec<String> =
                line.points.iter().map(|p| place(*p)).map(|[x, y]| format!("{x} {y}")).collect();
            let _ = writeln!(out, "<path class=\"{}\" d=\"M{}\"/>", line.class, places.join(" L"));
        }
        let _ = writeln!(out, "</svg><figcaption>t = {} s</figcaption></figure>", on_scale(*t, 1.0, 3));
    }
    out
}
