//! The page of an exploration.

use super::Side;
use recon::exploration::{Goal, Heading, Knowledge, Outcome, Proposal, least_gap, least_touches};
use recon_io::{
    ExplorationPage, ExplorationWords, FigureCurve, FigureFrame, FigurePanel, Level, TouchRow, Verdict,
    brief_to,
};

/// The course of an exploration.
#[derive(Default)]
pub(super) struct Course {
    /// Touches in order.
    pub(super) rows: Vec<TouchRow>,
    /// Sizes of both bounds after each.
    pub(super) sizes: Vec<[f64; 2]>,
    /// Way in all, in rad.
    pub(super) way: f64,
    /// Pictures after each, by panel.
    pub(super) pictures: Vec<Vec<FigurePanel>>,
}

/// Frames of a panel at most.
const FRAMES: usize = 40;

/// Pictures that are shown in turn: each of the last ones after those that were there before, if there are many some of them. They are told
/// apart by `what`, with their number.
pub(super) fn in_turn(
    mut last: Vec<FigurePanel>,
    before: Vec<Vec<FigurePanel>>,
    what: &str,
) -> Vec<FigurePanel> {
    let every = before.len().div_ceil(FRAMES).max(1);
    for (k, pictures) in before.into_iter().enumerate().step_by(every) {
        for (panel, picture) in last.iter_mut().zip(pictures) {
            panel.frames.push(FigureFrame { label: format!("{what} {}", k + 1), curves: picture.curves });
        }
    }
    last
}

/// Everything that the page shows.
pub(super) fn page<S: Side>(
    title: &str,
    known: &S::Known,
    ended: &Outcome<<S::Known as Knowledge>::Heading>,
    statement: &str,
    Course { mut rows, sizes, way, pictures }: Course,
    next: Option<&Proposal<S::Known>>,
) -> ExplorationPage {
    let certificate = ended.certificate();
    let level = if ended.is_reached() { Level::Good } else { Level::Caution };
    let goal = certificate.goal;
    let mut panels = vec![progress_panel(S::DIMENSION, &rows, &goal), sizes_panel(&sizes, S::UNIT)];
    let last = S::pictures(known, next.map(|p| p.along.coordinates()).as_deref());
    panels.extend(in_turn(last, pictures, "touch"));
    if let Some(next) = next {
        let along = next.along.coordinates();
        let here = rows.last().map_or(0.0, |row| {
            row.along.iter().zip(&along).map(|(a, b)| a * b).sum::<f64>().clamp(-1.0, 1.0).acos()
        });
        let why = next.reason.words().to_owned();
        let upper = known.measures().upper;
        let share = |e: f64| if matches!(goal, Goal::Gap(_)) { e / upper } else { e };
        let expected = next.expected.map(share).filter(|e| e.is_finite());
        rows.push(TouchRow {
            touch: None,
            why,
            along,
            point: None,
            turned: here,
            expected,
            gained: None,
            progress: None,
        });
    }
    ExplorationPage {
        words: ExplorationWords::TOUCHES,
        title: title.to_owned(),
        verdict: Verdict { level, text: statement.to_owned() },
        facts: facts::<S>(known, ended, way),
        progress: quantity(&goal).to_owned(),
        panels,
        caption: caption(S::DIMENSION, &goal),
        touches: rows,
    }
}

pub(super) fn quantity<H: Heading>(goal: &Goal<H>) -> &'static str {
    match goal {
        Goal::Gap(_) => "Gap",
        Goal::Hausdorff(_) => "Distance, m",
        Goal::Width { .. } => "Width open, m",
    }
}

/// A key figure that may have no end.
pub(super) fn measured(
    name: &'static str,
    value: f64,
    unit: &'static str,
) -> (&'static str, String, &'static str) {
    if value.is_finite() { (name, brief_to(4, value), unit) } else { (name, "unbounded".to_owned(), "") }
}

fn facts<S: Side>(
    known: &S::Known,
    ended: &Outcome<<S::Known as Knowledge>::Heading>,
    way: f64,
) -> Vec<(&'static str, String, &'static str)> {
    let certificate = ended.certificate();
    let measures = known.measures();
    let mut facts = vec![
        ("Touches", certificate.touches.to_string(), ""),
        measured("Proven", certificate.proven, ""),
        ("Asked for", brief_to(4, certificate.goal.value()), ""),
        measured("Lower bound", measures.lower, S::UNIT),
        measured("Upper bound", measures.upper, S::UNIT),
        measured("Largest distance", certificate.hausdorff, "m"),
        ("Way", brief_to(3, way), "rad"),
    ];
    if let Goal::Gap(gap) = certificate.goal {
        facts.push(("n* of an ellipsoid", brief_to(3, least_touches(S::DIMENSION, gap)), "touches"));
    }
    if let Some((level, _)) = certificate.confidence {
        facts.push(("Confidence", brief_to(4, 100.0 * level), "%"));
    }
    facts
}

fn caption<H: Heading>(dimension: usize, goal: &Goal<H>) -> String {
    let bounds = "The body lies between the bounds. Strokes: contacts with their outward \
                  normals; the long one: where to touch next, and in the pictures of each touch where that was.";
    let line = match goal {
        Goal::Gap(_) if dimension == 2 => {
            " Dashed: n*, the gap that no planner gets below around an ellipse of any shape (asymptotic formula)."
        }
        Goal::Gap(_) => {
            " Dashed: n*, the gap that no planner gets below around an ellipsoid of any shape (asymptotic formula). Bodies with flats and \
             corners need less."
        }
        _ => "",
    };
    format!("{bounds}{line}")
}

/// The least gap is told from here on: its formula is for many touches.
const ASYMPTOTIC: f64 = 0.5;
/// The upper bound is drawn once it is no more than so many times the last one.
const IN_SIGHT: f64 = 4.0;

/// Sizes of both bounds after each touch.
fn sizes_panel(sizes: &[[f64; 2]], unit: &str) -> FigurePanel {
    let last = sizes.last().map_or(f64::INFINITY, |s| s[1]);
    let curve = |name: &str, k: usize| FigureCurve {
        name: name.to_owned(),
        points: (1_u32..)
            .zip(sizes)
            .filter(|(_, size)| size[1] <= IN_SIGHT * last)
            .map(|(touch, size)| [f64::from(touch), size[k]])
            .collect(),
        ..FigureCurve::default()
    };
    FigurePanel {
        title: "Bounds over touches".to_owned(),
        axes: ["touch".to_owned(), format!("size in {unit}")],
        curves: vec![curve("lower", 0), curve("upper", 1)],
        ..FigurePanel::default()
    }
}

/// What is left after each touch, and what is asked for.
fn progress_panel<H: Heading>(dimension: usize, rows: &[TouchRow], goal: &Goal<H>) -> FigurePanel {
    let points: Vec<[f64; 2]> =
        rows.iter().filter_map(|row| Some([row.touch? as f64, row.progress?])).collect();
    let reference = match goal {
        Goal::Gap(_) => (dimension + 1..=rows.len())
            .map(|n| [n as f64, least_gap(dimension, n)])
            .filter(|[_, gap]| *gap <= ASYMPTOTIC)
            .collect(),
        _ => Vec::new(),
    };
    let asked = [1.0, rows.len().max(2) as f64].map(|n| [n, goal.value()]).to_vec();
    FigurePanel {
        title: format!("{} over touches", quantity(goal)),
        axes: ["touch".to_owned(), quantity(goal).to_lowercase()],
        curves: vec![
            FigureCurve { name: "proven".to_owned(), points, reference, ..FigureCurve::default() },
            FigureCurve { name: "asked for".to_owned(), points: asked, ..FigureCurve::default() },
        ],
        ..FigurePanel::default()
    }
}

/// A stroke from each contact along its normal, of length `stroke`; lines broken between.
pub(super) fn strokes(contacts: impl Iterator<Item = ([f64; 2], [f64; 2])>, stroke: f64) -> Vec<[f64; 2]> {
    contacts
        .flat_map(|([x, y], [nx, ny])| [[x, y], [x + stroke * nx, y + stroke * ny], [f64::NAN, f64::NAN]])
        .collect()
}

/// A panel of two closed outlines, strokes at contacts, and the line of the next touch.
pub(super) fn outline_panel(
    title: &str,
    axes: [&str; 2],
    outlines: [Vec<[f64; 2]>; 2],
    contacts: Vec<([f64; 2], [f64; 2])>,
    next: Option<[f64; 2]>,
) -> FigurePanel {
    let all = outlines.iter().flatten();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for p in all {
        for i in 0..2 {
            (low[i], high[i]) = (low[i].min(p[i]), high[i].max(p[i]));
        }
    }
    let size = (high[0] - low[0]).max(high[1] - low[1]);
    let closed = |name: &str, outline: &[[f64; 2]]| FigureCurve {
        name: name.to_owned(),
        points: outline.iter().chain(outline.first()).copied().collect(),
        ..FigureCurve::default()
    };
    let [lower, upper] = &outlines;
    let mut curves = vec![
        closed("lower", lower),
        closed("upper", upper),
        FigureCurve {
            name: "contacts".to_owned(),
            points: strokes(contacts.into_iter(), 0.04 * size),
            ..FigureCurve::default()
        },
    ];
    // From outside of the upper bound to its farthest corner along the next touch.
    if let Some([x, y]) = next
        && let Some(top) = upper.iter().max_by(|a, b| (a[0] * x + a[1] * y).total_cmp(&(b[0] * x + b[1] * y)))
    {
        let end = [top[0] + 0.15 * size * x, top[1] + 0.15 * size * y];
        curves.push(FigureCurve {
            name: "next".to_owned(),
            points: vec![*top, end],
            ..FigureCurve::default()
        });
    }
    FigurePanel {
        title: title.to_owned(),
        axes: axes.map(|axis| format!("{axis} in m")),
        equal: true,
        curves: curves.into_iter().filter(|c| !c.points.is_empty()).collect(),
        ..FigurePanel::default()
    }
}
