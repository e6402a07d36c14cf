//! What changes in a panel, shown one after the other: by style alone, so that it runs without scripts and stands still where motion is not wanted.

use super::draw::draw_curves;
use super::{FigureCurve, Frame, MARGIN, SIZE, escape};
use std::fmt::Write as _;

/// One of the pictures that a panel shows in turn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureFrame {
    /// What it shows, below the panel's title.
    pub label: String,
    /// Curves in the colours of the panel's own, which stand for the last frame.
    pub curves: Vec<FigureCurve>,
}

/// How long a frame is shown, and the last one, s.
const SHOWN: f64 = 0.35;
const LAST: f64 = 2.5;

/// Draws `frames`, and after them the panel's own `curves`, in turn; begins with these.
pub(super) fn draw_in_turn(frames: &[FigureFrame], curves: &[FigureCurve], frame: &Frame, out: &mut String) {
    let count = frames.len();
    let all = SHOWN * count as f64 + LAST;
    let (shown, last) = (100.0 * SHOWN / all, 100.0 * LAST / all);
    let _ = writeln!(
        out,
        "<style>.turn{{visibility:hidden}}.turn.last{{visibility:visible}}@keyframes shown{count}{{0%{{visibility:visible}}{shown:.3}%{{visibility:hidden}}}}\
         @keyframes last{count}{{0%{{visibility:visible}}{last:.3}%{{visibility:hidden}}}}\
         @media print,(prefers-reduced-motion:reduce){{.turn{{animation:none!important}}}}</style>"
    );
    let within = [SIZE[0] - MARGIN[0] - MARGIN[2], SIZE[1] - MARGIN[1] - MARGIN[3]];
    let (x, y, [width, height]) = (MARGIN[0], MARGIN[1], within);
    let mut one = |class: &str, name: &str, after: f64, label: &str, curves: &[FigureCurve]| {
        let delay = after - all;
        let _ = writeln!(
            out,
            "<svg class=\"turn{class}\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\" \
             style=\"animation:{name}{count} {all:.3}s step-end {delay:.3}s infinite\">"
        );
        let _ = writeln!(
            out,
            "<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>",
            SIZE[0] - MARGIN[2] - 4.0,
            MARGIN[1] + 12.0,
            escape(label)
        );
        draw_curves(curves, frame, out);
        let _ = writeln!(out, "</svg>");
    };
    one(" last", "last", 0.0, "", curves);
    for (k, of) in frames.iter().enumerate() {
        one("", "shown", LAST + SHOWN * k as f64, &of.label, &of.curves);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{FigurePanel, draw};
    use super::*;

    /// The shares of a turn and the delays place each frame after the one before, and the last one where the others have ended.
    #[test]
    fn frames_are_shown_one_after_the_other_and_the_last_one_first() {
        let curve = |x: f64| FigureCurve { points: vec![[0.0, 0.0], [x, 1.0]], ..FigureCurve::default() };
        let frames: Vec<_> = (1..=3)
            .map(|k| FigureFrame { label: format!("<{k}>"), curves: vec![curve(f64::from(k))] })
            .collect();
        let panel = FigurePanel { curves: vec![curve(4.0)], frames, ..FigurePanel::default() };
        let drawn = draw(&panel);
        let delays: Vec<f64> = drawn
            .split("step-end ")
            .skip(1)
            .map(|rest| rest.split('s').next().unwrap().parse().unwrap())
            .collect();
        let all = 3.0 * SHOWN + LAST;
        let begins: Vec<f64> = delays.iter().map(|delay| delay + all).collect();
        let expected = [0.0, LAST, LAST + SHOWN, LAST + 2.0 * SHOWN];
        assert!(begins.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3), "{begins:?}");
        assert!((begins[3] + SHOWN - all).abs() < 2e-3, "the turn ends with the frame before the last");
        assert!(drawn.contains("&lt;2&gt;") && drawn.matches("class=\"turn last\"").count() == 1);
        assert_eq!(drawn.matches("<polyline").count(), 4, "each curve once");
    }
}
