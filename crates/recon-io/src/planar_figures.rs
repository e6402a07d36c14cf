//! Pictures of a planar reconstruction as one SVG file: shape, orientation, radius functions, errors.

use crate::number::on_scale;
use std::fmt::Write as _;
use std::io::{self, Write};

/// A line of a panel, in the panel's units.
#[derive(Clone, Debug, PartialEq)]
pub struct FigureCurve {
    /// Its name in the legend.
    pub name: String,
    /// Points; those that are not numbers are left out.
    pub points: Vec<[f64; 2]>,
    /// Drawn as dots rather than as a line.
    pub dots: bool,
}

/// One panel of the picture.
#[derive(Clone, Debug, PartialEq)]
pub struct FigurePanel {
    /// Title.
    pub title: String,
    /// What runs to the right and upward, with units.
    pub axes: [String; 2],
    /// Both axes at the same scale.
    pub equal: bool,
    /// Curves.
    pub curves: Vec<FigureCurve>,
}

const SIZE: [f64; 2] = [460.0, 330.0];
const MARGIN: [f64; 4] = [64.0, 30.0, 16.0, 44.0];
const COLOURS: [&str; 4] = ["#1b6ca8", "#c0392b", "#2e8b57", "#8e44ad"];

/// Writes panels two in a row.
///
/// # Errors
/// Those of `to`.
pub fn write_figures(panels: &[FigurePanel], mut to: impl Write) -> io::Result<()> {
    let rows = panels.len().div_ceil(2).max(1) as f64;
    let (width, height) = (2.0 * SIZE[0], rows * SIZE[1]);
    writeln!(
        to,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">"
    )?;
    writeln!(to, "<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>")?;
    for (k, panel) in panels.iter().enumerate() {
        let (x, y) = ((k % 2) as f64 * SIZE[0], (k / 2) as f64 * SIZE[1]);
        writeln!(to, "<g transform=\"translate({x} {y})\">\n{}</g>", draw(panel))?;
    }
    writeln!(to, "</svg>")?;
    to.flush()
}

/// From data to places in a panel.
struct Frame {
    low: [f64; 2],
    scale: [f64; 2],
}

impl Frame {
    fn new(panel: &FigurePanel) -> Self {
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in panel.curves.iter().flat_map(|c| &c.points).filter(|p| p.iter().all(|v| v.is_finite())) {
            for i in 0..2 {
                low[i] = low[i].min(point[i]);
                high[i] = high[i].max(point[i]);
            }
        }
        let inner = [SIZE[0] - MARGIN[0] - MARGIN[2], SIZE[1] - MARGIN[1] - MARGIN[3]];
        let mut scale = [1.0; 2];
        for i in 0..2 {
            if low[i] > high[i] {
                (low[i], high[i]) = (0.0, 1.0);
            }
            let size = high[i].abs().max(low[i].abs());
            if high[i] - low[i] <= 1e-12 * size {
                // A flat curve gets an axis of its own size, or of one where it is zero.
                let half = if size > 0.0 { 0.5 * size } else { 0.5 };
                (low[i], high[i]) = (low[i] - half, high[i] + half);
            }
            let span = high[i] - low[i];
            (low[i], high[i]) = (low[i] - 0.05 * span, high[i] + 0.05 * span);
            scale[i] = inner[i] / (high[i] - low[i]);
        }
        if panel.equal {
            scale = [scale[0].min(scale[1]); 2];
        }
        Self { low, scale }
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let px = MARGIN[0] + (x - self.low[0]) * self.scale[0];
        let py = SIZE[1] - MARGIN[3] - (y - self.low[1]) * self.scale[1];
        [px, py].map(|v| on_scale(v, 100.0, 3))
    }
}

fn draw(panel: &FigurePanel) -> String {
    let frame = Frame::new(panel);
    let mut out = String::new();
    let (right, bottom) = (SIZE[0] - MARGIN[2], SIZE[1] - MARGIN[3]);
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"18\" font-weight=\"bold\">{}</text>",
        MARGIN[0],
        escape(&panel.title)
    );
    let _ = writeln!(
        out,
        "<path d=\"M{} {} V{bottom} H{right}\" fill=\"none\" stroke=\"#555\"/>",
        MARGIN[0], MARGIN[1]
    );
    let _ = writeln!(
        out,
        "<text x=\"{right}\" y=\"{}\" text-anchor=\"end\">{}</text>",
        bottom + 34.0,
        escape(&panel.axes[0])
    );
    let _ = writeln!(
        out,
        "<text transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"end\">{}</text>",
        MARGIN[1],
        escape(&panel.axes[1])
    );
    ticks(&frame, &mut out);
    for (k, curve) in panel.curves.iter().enumerate() {
        let colour = COLOURS[k % COLOURS.len()];
        let places: Vec<[f64; 2]> = curve
            .points
            .iter()
            .filter(|p| p.iter().all(|v| v.is_finite()))
            .map(|&p| frame.place(p))
            .collect();
        if curve.dots {
            for [x, y] in places {
                let _ = writeln!(out, "<circle cx=\"{x}\" cy=\"{y}\" r=\"1.2\" fill=\"{colour}\"/>");
            }
        } else {
            let path: Vec<String> = places.iter().map(|[x, y]| format!("{x},{y}")).collect();
            let _ = writeln!(
                out,
                "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.4\"/>",
                path.join(" ")
            );
        }
        let y = MARGIN[1] + 4.0 + 15.0 * k as f64;
        let _ = writeln!(
            out,
            "<text x=\"{right}\" y=\"{y}\" text-anchor=\"end\" fill=\"{colour}\">{}</text>",
            escape(&curve.name)
        );
    }
    out
}

/// Five numbers along each axis.
fn ticks(frame: &Frame, out: &mut String) {
    let inner = [SIZE[0] - MARGIN[0] - MARGIN[2], SIZE[1] - MARGIN[1] - MARGIN[3]];
    for k in 0..5 {
        let share = f64::from(k) / 4.0;
        for axis in 0..2 {
            let value = frame.low[axis] + share * inner[axis] / frame.scale[axis];
            let text = label(value, inner[axis] / frame.scale[axis]);
            let (x, y) = if axis == 0 {
                (MARGIN[0] + share * inner[0], SIZE[1] - MARGIN[3] + 16.0)
            } else {
                (MARGIN[0] - 5.0, SIZE[1] - MARGIN[3] - share * inner[1] + 4.0)
            };
            let anchor = if axis == 0 { "middle" } else { "end" };
            let _ = writeln!(
                out,
                "<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" fill=\"#555\" font-size=\"10\">{text}</text>"
            );
        }
    }
}

fn label(value: f64, span: f64) -> String {
    let rounded = on_scale(value, span, 2);
    if rounded != 0.0 && !(1e-3..1e4).contains(&rounded.abs()) {
        format!("{rounded:.1e}")
    } else {
        format!("{rounded}")
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn empty_flat_and_broken_curves_are_drawn_without_nan() {
        let curve = |points| FigureCurve { name: "a < b".to_owned(), points, dots: false };
        let panel = |points| FigurePanel {
            title: "t & u".to_owned(),
            axes: ["x".to_owned(), "y".to_owned()],
            equal: true,
            curves: vec![curve(points)],
        };
        let panels = [
            panel(vec![]),
            panel(vec![[1.0, 2.0]]),
            panel(vec![[0.0, 3.0], [f64::NAN, 1.0], [1.0, 3.0]]),
            panel(vec![[0.0, 0.0], [0.0, 0.0]]),
        ];
        let mut text = Vec::new();
        write_figures(&panels, &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        assert!(text.contains("a &lt; b") && text.contains("t &amp; u"));
    }
}
