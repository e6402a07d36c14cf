//! Lines, bands and ticks of a panel.

use super::{COLOURS, FigureCurve, FigurePanel, Frame, MARGIN, SIZE, escape, round_step};
use crate::number::{on_scale, push_pair};
use std::fmt::Write as _;

/// Width of a character in the legend, px: generous for a proportional font of 12 px.
const CHARACTER: f64 = 7.0;
/// The same of a title, and the space between two names.
const BOLD: f64 = 7.6;
const BETWEEN: f64 = 10.0;

pub(super) fn finite(point: &&[f64; 2]) -> bool {
    point.iter().all(|v| v.is_finite())
}

impl FigureCurve {
    /// Without the lines from before each of these stretches to after it.
    pub(super) fn broken_over(&self, missing: &[[f64; 2]]) -> Self {
        let mut curve = self.clone();
        for [from, to] in missing {
            let across = |pair: &[[f64; 2]]| pair[0][0] <= *from && pair[1][0] >= *to;
            for (points, heights) in
                [(&mut curve.points, Some(&mut curve.half_heights)), (&mut curve.reference, None)]
            {
                let Some(before) = points.windows(2).position(across) else { continue };
                points.insert(before + 1, [f64::NAN; 2]);
                if let Some(heights) = heights.filter(|heights| heights.len() > before) {
                    heights.insert(before + 1, f64::NAN);
                }
            }
        }
        curve
    }
}

/// The band about a curve, broken where it has no height.
pub(super) fn draw_band(curve: &FigureCurve, colour: usize, frame: &Frame, out: &mut String) {
    let pairs: Vec<_> = curve.points.iter().zip(&curve.half_heights).collect();
    let there = |(point, height): &(&[f64; 2], &f64)| finite(point) && height.is_finite();
    for piece in pairs.split(|pair| !there(pair)).filter(|piece| piece.len() > 1) {
        let edge = |side: f64| move |&([x, y], h): &(&[f64; 2], &f64)| frame.place_within([*x, y + side * h]);
        let around = piece.iter().map(edge(1.0)).chain(piece.iter().rev().map(edge(-1.0)));
        let corners = pairs_of(around);
        let _ = writeln!(
            out,
            "<polygon class=\"c{colour}\" points=\"{corners}\" fill=\"currentColor\" fill-opacity=\".2\"/>"
        );
    }
}

/// Each with what it is compared with.
pub(super) fn draw_curves(curves: &[FigureCurve], frame: &Frame, out: &mut String) {
    for (k, curve) in curves.iter().enumerate() {
        let dashed = (k % COLOURS, " stroke-dasharray=\"5 4\" stroke-opacity=\".75\"");
        draw_line(&curve.reference, dashed, frame, out);
        draw_curve(curve, k % COLOURS, frame, out);
    }
}

fn draw_curve(curve: &FigureCurve, colour: usize, frame: &Frame, out: &mut String) {
    if curve.dots {
        // Lines without length under round caps.
        let places = curve.points.iter().filter(finite).map(|&p| frame.place(p));
        let dots = places.fold(String::new(), |mut dots, at| {
            dots.push('M');
            push_pair(&mut dots, at, ' ');
            dots + "h0"
        });
        let _ = writeln!(
            out,
            "<path class=\"c{colour}\" d=\"{dots}\" stroke=\"currentColor\" stroke-width=\"2.4\" stroke-linecap=\"round\"/>"
        );
        return;
    }
    // As faint as two that lie over each other may be.
    let tint = if curve.filled { " style=\"fill:currentColor;fill-opacity:.1\"" } else { "" };
    draw_line(&curve.points, (colour, tint), frame, out);
}

/// A line in a colour and with further attributes.
fn draw_line(points: &[[f64; 2]], (colour, further): (usize, &str), frame: &Frame, out: &mut String) {
    for piece in points.split(|p| !finite(&p)).filter(|piece| !piece.is_empty()) {
        // Of a dot twice: a line needs two points.
        let again = piece.iter().filter(|_| piece.len() == 1);
        let path = pairs_of(piece.iter().chain(again).map(|&p| frame.place(p)));
        let _ = writeln!(
            out,
            "<polyline class=\"c{colour}\" points=\"{path}\" fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.4\" \
             stroke-linecap=\"round\"{further}/>"
        );
    }
}

/// Places as SVG lists them.
fn pairs_of(places: impl Iterator<Item = [f64; 2]>) -> String {
    let mut text = String::new();
    for at in places {
        if !text.is_empty() {
            text.push(' ');
        }
        push_pair(&mut text, at, ',');
    }
    text
}

/// Lines at round numbers, at most six an axis.
pub(super) fn ticks(frame: &Frame, out: &mut String) {
    let inner = [SIZE[0] - MARGIN[0] - MARGIN[2], SIZE[1] - MARGIN[1] - MARGIN[3]];
    let (right, bottom) = (SIZE[0] - MARGIN[2], SIZE[1] - MARGIN[3]);
    for axis in 0..2 {
        let span = inner[axis] / frame.scale[axis];
        let step = round_step(span / 6.0);
        let first = (frame.low[axis] / step).ceil();
        for k in 0..=6 {
            let value = (first + f64::from(k)) * step;
            if value > frame.low[axis] + span {
                break;
            }
            let mut point = frame.low;
            point[axis] = value;
            let [x, y] = frame.place(point);
            let text = label(value, step);
            let _ = if axis == 0 {
                writeln!(
                    out,
                    "<path class=\"grid\" d=\"M{x} {} V{bottom}\"/><text class=\"tick\" x=\"{x}\" y=\"{}\" text-anchor=\"middle\">{text}</text>",
                    MARGIN[1],
                    bottom + 16.0
                )
            } else {
                writeln!(
                    out,
                    "<path class=\"grid\" d=\"M{} {y} H{right}\"/><text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{text}</text>",
                    MARGIN[0],
                    MARGIN[0] - 5.0,
                    y + 4.0
                )
            };
        }
    }
}

/// A multiple of `step` without the digits below it.
fn label(value: f64, step: f64) -> String {
    let rounded = on_scale(value, step, 1);
    if rounded != 0.0 && !(1e-3..1e4).contains(&rounded.abs()) {
        format!("{rounded:e}")
    } else {
        format!("{rounded}")
    }
}

/// Title and names of the curves, where none of these runs: in one line if there is room for it.
pub(super) fn names_of(panel: &FigurePanel) -> String {
    let width = |text: &str, character: f64| character * text.chars().count() as f64;
    let legend: f64 = panel.curves.iter().map(|curve| width(&curve.name, CHARACTER) + BETWEEN).sum();
    let room = SIZE[0] - MARGIN[0] - MARGIN[2];
    let [title_y, legend_y] =
        if width(&panel.title, BOLD) + legend > room { [12.0, 26.0] } else { [18.0, 18.0] };
    let mut out = format!(
        "<text class=\"text\" x=\"{}\" y=\"{title_y}\" font-weight=\"bold\">{}</text>\n",
        MARGIN[0],
        escape(&panel.title)
    );
    // The last one outermost.
    let mut x = SIZE[0] - MARGIN[2];
    for (k, curve) in panel.curves.iter().enumerate().rev() {
        let (name, colour) = (escape(&curve.name), k % COLOURS);
        let _ = writeln!(
            out,
            "<text class=\"c{colour}\" fill=\"currentColor\" x=\"{x}\" y=\"{legend_y}\" text-anchor=\"end\">{name}</text>"
        );
        x -= width(&curve.name, CHARACTER) + BETWEEN;
    }
    out
}
