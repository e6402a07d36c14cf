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

/// How long a picture of a panel is shown, and the last one of all pictures in turn, s.
const SHOWN: f64 = 0.35;
const LAST: f64 = 2.5;

/// Pictures that are shown one after the other for `shown` s each, after the `last` one, which is what stands still.
#[derive(Clone, Copy)]
pub(crate) struct Turn {
    last: usize,
    shown: f64,
}

impl Turn {
    pub(crate) fn new(pictures: usize, shown: f64) -> Self {
        Self { last: pictures.saturating_sub(1), shown }
    }

    /// How long all of them take, s.
    fn all(&self) -> f64 {
        self.shown * self.last as f64 + LAST
    }

    /// What tells apart the rules of turns of different lengths.
    fn name(&self) -> String {
        format!("{}-{:.0}", self.last, 1e3 * self.shown)
    }

    /// The rules by which they are shown.
    pub(crate) fn style(&self) -> String {
        let (all, name) = (self.all(), self.name());
        let (shown, last) = (100.0 * self.shown / all, 100.0 * LAST / all);
        format!(
            "<style>.turn{{visibility:hidden}}.turn.last{{visibility:visible}}@keyframes shown{name}{{0%{{visibility:visible}}{shown:.3}%{{visibility:hidden}}}}\
             @keyframes last{name}{{0%{{visibility:visible}}{last:.3}%{{visibility:hidden}}}}\
             @media print,(prefers-reduced-motion:reduce){{.turn{{animation:none!important}}}}</style>"
        )
    }

    /// What makes an element the picture `k` of them.
    pub(crate) fn attributes(&self, k: usize) -> String {
        let (class, rule, after) =
            if k == self.last { (" last", "last", 0.0) } else { ("", "shown", LAST + self.shown * k as f64) };
        let (name, all) = (self.name(), self.all());
        format!(
            "class=\"turn{class}\" data-pace=\"{:.3}\" style=\"animation:{rule}{name} {all:.3}s step-end {:.3}s infinite\"",
            self.shown,
            after - all
        )
    }
}

/// Draws `frames` in turn, and after them the panel's own `curves`, which stand still.
pub(super) fn draw_in_turn(frames: &[FigureFrame], curves: &[FigureCurve], frame: &Frame, out: &mut String) {
    let turn = Turn::new(frames.len() + 1, SHOWN);
    let _ = writeln!(out, "{}", turn.style());
    let within = [SIZE[0] - MARGIN[0] - MARGIN[2], SIZE[1] - MARGIN[1] - MARGIN[3]];
    let (x, y, [width, height]) = (MARGIN[0], MARGIN[1], within);
    let own = ("", curves);
    let all = frames.iter().map(|of| (of.label.as_str(), &of.curves[..])).chain([own]);
    for (k, (label, curves)) in all.enumerate() {
        let _ = writeln!(
            out,
            "<svg {} x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" viewBox=\"{x} {y} {width} {height}\">",
            turn.attributes(k)
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
        let expected = [LAST, LAST + SHOWN, LAST + 2.0 * SHOWN, 0.0];
        assert!(begins.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-3), "{begins:?}");
        assert!((begins[2] + SHOWN - all).abs() < 2e-3, "the turn ends with the frame before the last");
        assert!(drawn.contains("&lt;2&gt;") && drawn.matches("class=\"turn last\"").count() == 1);
        assert_eq!(drawn.matches("<polyline").count(), 4, "each curve once");
    }
}
