//! Pictures of a planar reconstruction as one SVG file: shape, orientation, radius functions, errors.

mod draw;
mod frames;

pub use frames::FigureFrame;
pub(crate) use frames::Turn;

use crate::number::on_scale;
use draw::{draw_band, draw_curves, finite, names_of, ticks};
use std::fmt::Write as _;
use std::io::{self, Write};

/// A line of a panel, in the panel's units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigureCurve {
    /// Its name in the legend.
    pub name: String,
    /// Points; a line is broken at those that are not numbers.
    pub points: Vec<[f64; 2]>,
    /// Drawn as dots rather than as a line.
    pub dots: bool,
    /// Half the height of a band about each point; empty for none.
    pub half_heights: Vec<f64>,
    /// What it is compared with, dashed; empty for nothing.
    pub reference: Vec<[f64; 2]>,
    /// Whether what it encloses is tinted.
    pub filled: bool,
}

/// One panel of the picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FigurePanel {
    /// Title.
    pub title: String,
    /// What runs to the right and upward, with units.
    pub axes: [String; 2],
    /// Both axes at the same scale.
    pub equal: bool,
    /// Curves.
    pub curves: Vec<FigureCurve>,
    /// Stretches to the right over which the panel is shaded.
    pub shaded: Vec<[f64; 2]>,
    /// Stretches to the right of which nothing is known: marked, and lines are broken over them.
    pub missing: Vec<[f64; 2]>,
    /// Points that lie within the panel beside those of the curves.
    pub room: Vec<[f64; 2]>,
    /// What is shown in turn with the curves, which are the last of it; none of a picture that stands still.
    pub frames: Vec<FigureFrame>,
}

const SIZE: [f64; 2] = [460.0, 330.0];
const MARGIN: [f64; 4] = [64.0, 30.0, 16.0, 44.0];
/// Colours of the curves, of text, of axes and of the ground, on a light and on a dark screen.
const STYLE: &str = "\
.ground{fill:#fff}.text{fill:#222}.tick{fill:#555;font-size:10px}.axis{stroke:#555;fill:none}.grid{stroke:#e4e4e4}.shade{fill:#888;fill-opacity:.16}.missing{fill:#888;fill-opacity:.3}
.c0{color:#1b6ca8}.c1{color:#c0392b}.c2{color:#2e8b57}.c3{color:#8e44ad}.c4{color:#8a7a12}
@media (prefers-color-scheme:dark){
.ground{fill:#15181c}.text{fill:#e6e6e6}.tick{fill:#a8a8a8}.axis{stroke:#a8a8a8}.grid{stroke:#2b3036}
.c0{color:#6cb6ef}.c1{color:#ff8a7a}.c2{color:#6fd39a}.c3{color:#cf9bea}.c4{color:#d6c456}}";
const COLOURS: usize = 5;

/// Panels as pictures of their own, for a page that sets them beside each other where it is wide enough, and has colours.
pub(crate) fn figures_in_page(panels: &[FigurePanel]) -> String {
    let one = |panel: &FigurePanel| {
        let [width, height] = SIZE;
        format!("<div><svg viewBox=\"0 0 {width} {height}\" role=\"img\">\n{}</svg></div>\n", draw(panel))
    };
    panels.iter().map(one).collect()
}

/// Writes panels two in a row.
///
/// # Errors
/// Those of `to`.
pub fn write_figures(panels: &[FigurePanel], mut to: impl Write) -> io::Result<()> {
    let rows = panels.len().div_ceil(2).max(1) as f64;
    let (width, height) = (panels.len().clamp(1, 2) as f64 * SIZE[0], rows * SIZE[1]);
    writeln!(
        to,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"12\">"
    )?;
    writeln!(to, "<style>{STYLE}</style>")?;
    writeln!(to, "<rect class=\"ground\" width=\"{width}\" height=\"{height}\"/>")?;
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
        let points = panel.curves.iter().flat_map(|c| c.points.iter().chain(&c.reference)).chain(&panel.room);
        for point in points.filter(finite) {
            for i in 0..2 {
                low[i] = low[i].min(point[i]);
                high[i] = high[i].max(point[i]);
            }
        }
        // Bands are shown whole as long as they leave the curves a third of the height.
        let bands = panel.curves.iter().flat_map(|c| &c.half_heights).filter(|h| h.is_finite());
        let room = bands.fold(0.0, |most: f64, h| most.max(*h)).min((high[1] - low[1]).max(0.0));
        (low[1], high[1]) = (low[1] - room, high[1] + room);
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
            for i in 0..2 {
                // In the middle of the axis that is longer than it needs to be.
                low[i] -= 0.5 * (inner[i] / scale[i] - (high[i] - low[i]));
            }
        }
        Self { low, scale }
    }

    /// Where a point is, moved up or down into the panel.
    fn place_within(&self, point: [f64; 2]) -> [f64; 2] {
        let [x, y] = self.place(point);
        [x, y.clamp(MARGIN[1], SIZE[1] - MARGIN[3])]
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let px = MARGIN[0] + (x - self.low[0]) * self.scale[0];
        let py = SIZE[1] - MARGIN[3] - (y - self.low[1]) * self.scale[1];
        [px, py].map(|v| on_scale(v, 100.0, 3))
    }
}

fn draw(panel: &FigurePanel) -> String {
    let frame = Frame::new(panel);
    let mut out = names_of(panel);
    let (right, bottom) = (SIZE[0] - MARGIN[2], SIZE[1] - MARGIN[3]);
    let shaded = panel.shaded.iter().map(|span| ("shade", span));
    for (class, [from, to]) in shaded.chain(panel.missing.iter().map(|span| ("missing", span))) {
        let [from, to] = [from, to].map(|x| frame.place([*x, frame.low[1]])[0].clamp(MARGIN[0], right));
        let (width, height) = (on_scale(to - from, 100.0, 3), bottom - MARGIN[1]);
        let _ = writeln!(
            out,
            "<rect class=\"{class}\" x=\"{from}\" y=\"{}\" width=\"{width}\" height=\"{height}\"/>",
            MARGIN[1]
        );
    }
    ticks(&frame, &mut out);
    let _ = writeln!(out, "<path class=\"axis\" d=\"M{} {} V{bottom} H{right}\"/>", MARGIN[0], MARGIN[1]);
    let [across, up] = [0, 1].map(|i| escape(&panel.axes[i]));
    let _ = writeln!(
        out,
        "<text class=\"text\" x=\"{right}\" y=\"{}\" text-anchor=\"end\">{across}</text>",
        bottom + 34.0
    );
    let _ = writeln!(
        out,
        "<text class=\"text\" transform=\"translate(14 {}) rotate(-90)\" text-anchor=\"end\">{up}</text>",
        MARGIN[1]
    );
    let curves: Vec<FigureCurve> =
        panel.curves.iter().map(|curve| curve.broken_over(&panel.missing)).collect();
    for (k, curve) in curves.iter().enumerate() {
        draw_band(curve, k % COLOURS, &frame, &mut out);
    }
    if panel.frames.is_empty() {
        draw_curves(&curves, &frame, &mut out);
    } else {
        frames::draw_in_turn(&panel.frames, &panel.curves, &frame, &mut out);
    }
    out
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `least`.
pub(crate) fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|step| *step >= least).unwrap_or(least)
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_curves_stand_below_a_title_that_they_would_run_into() {
        let line = |names: &[&str]| {
            let curve = |name: &&str| FigureCurve { name: (*name).to_owned(), ..FigureCurve::default() };
            let curves = names.iter().map(curve).collect();
            let drawn = names_of(&FigurePanel {
                title: "Seen from the front".into(),
                curves,
                ..FigurePanel::default()
            });
            [drawn.contains("y=\"18\""), drawn.contains("y=\"12\"") && drawn.contains("y=\"26\"")]
        };
        assert_eq!(line(&["lower", "upper", "ellipsoid"]), [true, false]);
        assert_eq!(line(&["lower", "upper", "fit", "contacts", "touch next"]), [false, true]);
    }

    #[test]
    fn lines_are_broken_where_there_is_no_number() {
        let gap = [f64::NAN, 0.0];
        let points = vec![
            gap,
            [0.0, 0.0],
            [1.0, 1.0],
            gap,
            gap,
            [3.0, 2.0],
            [4.0, f64::INFINITY],
            [5.0, 1.0],
            [6.0, 0.0],
        ];
        let curve = FigureCurve { name: "slip".to_owned(), points, ..FigureCurve::default() };
        let panel = FigurePanel {
            title: "t".to_owned(),
            axes: ["x".to_owned(), "y".to_owned()],
            curves: vec![curve],
            ..FigurePanel::default()
        };
        let drawn = draw(&panel);
        let pieces: Vec<Vec<&str>> = drawn
            .split("points=\"")
            .skip(1)
            .map(|piece| piece.split('"').next().unwrap().split(' ').collect())
            .collect();
        // Two points, one alone as a dot, two more; nothing runs across.
        assert_eq!(pieces.iter().map(Vec::len).collect::<Vec<_>>(), [2, 2, 2], "{drawn}");
        assert!(pieces[1][0] == pieces[1][1] && pieces[0][1] != pieces[1][0]);
        assert!(!drawn.contains("NaN") && !drawn.contains("inf"));
    }

    #[test]
    fn lines_and_bands_are_broken_over_what_is_missing() {
        let curve = FigureCurve {
            points: (0..6).map(|k| [f64::from(k), 0.0]).collect(),
            half_heights: vec![0.1; 6],
            reference: (0..6).map(|k| [f64::from(k), 1.0]).collect(),
            ..FigureCurve::default()
        };
        let count = |missing| {
            let drawn = draw(&FigurePanel { curves: vec![curve.clone()], missing, ..FigurePanel::default() });
            ["<polyline", "<polygon", "\"missing\""].map(|what| drawn.matches(what).count())
        };
        assert_eq!(count(vec![]), [2, 1, 0]);
        assert_eq!(count(vec![[2.0, 3.0]]), [4, 2, 1]);
    }

    #[test]
    fn bands_are_as_high_as_stated_and_stay_in_the_panel() {
        let points: Vec<[f64; 2]> = (0..3).map(|k| [f64::from(k), f64::from(k)]).collect();
        let curve = FigureCurve {
            points: points.clone(),
            half_heights: vec![0.5, f64::NAN, 1e9],
            ..FigureCurve::default()
        };
        let two = FigureCurve { half_heights: vec![0.5, 0.25, 1e9], ..curve.clone() };
        let panel =
            FigurePanel { curves: vec![curve, two], shaded: vec![[-5.0, 0.5]], ..FigurePanel::default() };
        let drawn = draw(&panel);
        // The first has a gap between single points; the second one is a polygon of six corners.
        let polygon = drawn.split("<polygon").nth(1).unwrap().split("points=\"").nth(1).unwrap();
        let corners: Vec<[f64; 2]> = polygon
            .split('"')
            .next()
            .unwrap()
            .split(' ')
            .map(|corner| {
                let (x, y) = corner.split_once(',').unwrap();
                [x.parse().unwrap(), y.parse().unwrap()]
            })
            .collect();
        assert_eq!((drawn.matches("<polygon").count(), corners.len()), (1, 6));
        let frame = Frame::new(&panel);
        let height = corners[5][1] - corners[0][1];
        assert!((height - frame.scale[1]).abs() < 0.1, "{height} for {}", frame.scale[1]);
        let (top, bottom) = (MARGIN[1], SIZE[1] - MARGIN[3]);
        assert!(corners.iter().all(|[_, y]| (top..=bottom).contains(y)), "{corners:?}");
        // The shade begins where the panel does.
        assert!(drawn.contains(&format!("<rect class=\"shade\" x=\"{}\"", MARGIN[0])), "{drawn}");
    }

    #[test]
    fn empty_flat_and_broken_curves_are_drawn_without_nan() {
        let curve = |points| FigureCurve { name: "a < b".to_owned(), points, ..FigureCurve::default() };
        let panel = |points| FigurePanel {
            title: "t & u".to_owned(),
            axes: ["x".to_owned(), "y".to_owned()],
            equal: true,
            curves: vec![curve(points)],
            ..FigurePanel::default()
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
