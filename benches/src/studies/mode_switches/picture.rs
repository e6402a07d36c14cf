//! The reliability diagram: what was said against what is true.

use super::judge::{Judged, Way};
use std::fmt::Write as _;

/// Side of a panel and space about it, px.
const SIDE: f64 = 200.0;
const EDGE: f64 = 44.0;
/// Samples below which a bin is not drawn.
const FEW: f64 = 50.0;

pub(super) fn drawn(all: &[&Judged]) -> String {
    let (width, height) = (3.0 * (SIDE + EDGE) + EDGE, SIDE + 2.4 * EDGE);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"11\">\n<style>text{{fill:#222}}.a{{stroke:#888;fill:none}}.s{{fill:#1f77b4}}.p{{fill:#d95f02}}.ls{{stroke:#1f77b4;fill:none}}.lp{{stroke:#d95f02;fill:none}}.g{{fill:#fff}}@media(prefers-color-scheme:dark){{text{{fill:#ddd}}.g{{fill:#16181c}}.s{{fill:#6cb6ff}}.p{{fill:#ffa657}}.ls{{stroke:#6cb6ff}}.lp{{stroke:#ffa657}}}}</style>\n<rect class=\"g\" width=\"{width}\" height=\"{height}\"/>\n"
    );
    for (k, way) in Way::ALL.into_iter().enumerate() {
        panel(&mut svg, all, way, EDGE + k as f64 * (SIDE + EDGE));
    }
    let y = EDGE + SIDE + 52.0;
    let _ = writeln!(
        svg,
        "<circle class=\"s\" cx=\"{EDGE}\" cy=\"{}\" r=\"4\"/><text x=\"{}\" y=\"{y}\">scenes in space</text><circle class=\"p\" cx=\"{}\" cy=\"{}\" r=\"4\"/><text x=\"{}\" y=\"{y}\">in the plane</text><text x=\"{}\" y=\"{y}\">area of a point: samples of its bin</text>\n</svg>",
        y - 4.0,
        EDGE + 9.0,
        EDGE + 120.0,
        y - 4.0,
        EDGE + 129.0,
        EDGE + 230.0,
    );
    svg
}

fn panel(svg: &mut String, all: &[&Judged], way: Way, left: f64) {
    let place = |said: f64, is: f64| (left + SIDE * said, EDGE + SIDE * (1.0 - is));
    let _ = writeln!(
        svg,
        "<text x=\"{left}\" y=\"{}\">{}</text><rect class=\"a\" x=\"{left}\" y=\"{EDGE}\" width=\"{SIDE}\" height=\"{SIDE}\"/><path class=\"a\" stroke-dasharray=\"4 3\" d=\"M{left} {} L{} {EDGE}\"/>",
        EDGE - 10.0,
        way.words(),
        EDGE + SIDE,
        left + SIDE,
    );
    for (value, anchor) in [(0.0, "middle"), (0.5, "middle"), (1.0, "middle")] {
        let (x, y) = place(value, 0.0);
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"{}\" text-anchor=\"{anchor}\">{value}</text>", y + 20.0);
        let (x, y) = place(0.0, value);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{value}</text>", x - 4.0, y + 4.0);
    }
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">said to slide</text>",
        left + 0.5 * SIDE,
        EDGE + SIDE + 34.0
    );
    for (spatial, class) in [(true, "s"), (false, "p")] {
        let mut bins = [[0.0; 3]; 8];
        for judged in all.iter().filter(|j| j.way == way && j.spatial == spatial) {
            for (sum, bin) in bins.iter_mut().zip(&judged.tally.bins) {
                sum.iter_mut().zip(bin).for_each(|(sum, new)| *sum += new);
            }
        }
        let samples: f64 = bins.iter().map(|bin| bin[0]).sum();
        let points: Vec<_> = bins
            .iter()
            .filter(|bin| bin[0] > FEW)
            .map(|bin| (place(bin[1] / bin[0], bin[2] / bin[0]), 2.0 + 10.0 * (bin[0] / samples).sqrt()))
            .collect();
        let line: Vec<String> = points.iter().map(|((x, y), _)| format!("{x:.1},{y:.1}")).collect();
        let _ = writeln!(svg, "<polyline class=\"l{class}\" points=\"{}\"/>", line.join(" "));
        for ((x, y), radius) in points {
            let _ = writeln!(
                svg,
                "<circle class=\"{class}\" fill-opacity=\"0.8\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\"/>"
            );
        }
    }
}
