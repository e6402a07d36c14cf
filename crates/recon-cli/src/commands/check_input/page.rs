//! What is understood of an input, as a page to look at.

use super::{Readings, Understood};
use crate::pipeline::views;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, LoggedPalm};
use recon_io::{Evidence, EvidenceValue, FigureCurve, FigurePanel, FiguresPage, Level, Touches, Verdict};

const KICKER: &str = "What recon understands of an input, before anything is estimated";
const OF_A_LOG: &str = "Touched: a line where a palm is. Contacts: how far they are from the mean of all. Stripes: gaps, where samples are missing.";
const OF_TOUCHES: &str = "Where the object was touched, or where it lay.";
/// Points of a curve at most.
const POINTS: usize = 2000;

pub(super) fn page(title: String, understood: &Understood) -> FiguresPage {
    let Understood { lines, warnings, readings, .. } = understood;
    let (heading, panels, caption) = match readings {
        Readings::Log(log, gaps) => ("The readings", of_log(log, gaps), OF_A_LOG),
        Readings::Touches(found) => ("The points", of_touches(found), OF_TOUCHES),
    };
    let (level, text) = match warnings.len() {
        0 => (
            Level::Good,
            "Nothing speaks against units, frames and rates as they were understood.".to_owned(),
        ),
        1 => (Level::Caution, "Something does not go together.".to_owned()),
        count => (Level::Caution, format!("{count} things do not go together.")),
    };
    let row = |(name, value): &(String, String)| Evidence {
        key: name.replace(' ', "_"),
        name: name.clone(),
        value: EvidenceValue::Text(value.clone()),
        unit: String::new(),
        meaning: String::new(),
        level: Level::Neutral,
    };
    FiguresPage {
        kicker: KICKER,
        title,
        verdict: Verdict { level, text },
        warnings: warnings.clone(),
        facts: Vec::new(),
        heading,
        panels,
        caption: caption.to_owned(),
        table: "What was understood",
        evidence: lines.iter().map(row).collect(),
    }
}

/// The readings of a log over time.
fn of_log(log: &ContactLog, gaps: &[[f64; 2]]) -> Vec<FigurePanel> {
    let times = log.times();
    let every = times.len().div_ceil(POINTS).max(1);
    let shown: Vec<usize> = (0..times.len()).step_by(every).collect();
    let mean = |k: usize| {
        let at: Vec<DVec3> = log.palms().iter().filter_map(|palm| Some(palm.touch(k)?.p_WC)).collect();
        at.iter().sum::<DVec3>() / at.len().max(1) as f64
    };
    let over_time = |title: &str, what: &str, of: &dyn Fn(usize, &LoggedPalm, usize) -> Option<f64>| {
        let curve = |(i, palm): (usize, &LoggedPalm)| FigureCurve {
            name: format!("palm {}", i + 1),
            points: shown.iter().map(|k| [times[*k], of(i, palm, *k).unwrap_or(f64::NAN)]).collect(),
            ..FigureCurve::default()
        };
        let some = |curve: &FigureCurve| curve.points.iter().any(|point| point[1].is_finite());
        FigurePanel {
            title: title.to_owned(),
            axes: ["time in s".to_owned(), what.to_owned()],
            curves: log.palms().iter().enumerate().map(curve).filter(some).collect(),
            missing: gaps.to_vec(),
            ..FigurePanel::default()
        }
    };
    let touched = |i: usize, palm: &LoggedPalm, k: usize| palm.touch(k).map(|_| i as f64 + 1.0);
    let away = |_: usize, palm: &LoggedPalm, k: usize| Some(palm.touch(k)?.p_WC.distance(mean(k)));
    let force = |_: usize, palm: &LoggedPalm, k: usize| Some(palm.force(k)?.vector.length());
    let interval = |k: &usize| [times[*k], times[*k] - times[k - 1]];
    let intervals = FigurePanel {
        title: "Time from sample to sample".to_owned(),
        axes: ["time in s".to_owned(), "in s".to_owned()],
        curves: vec![FigureCurve {
            name: "since the last".to_owned(),
            points: shown.iter().filter(|k| **k > 0).map(interval).collect(),
            ..FigureCurve::default()
        }],
        missing: gaps.to_vec(),
        room: vec![[times.first().copied().unwrap_or_default(), 0.0]],
        ..FigurePanel::default()
    };
    // Room for five palms: numbers of palms are whole ones then.
    let start = times.first().copied().unwrap_or_default();
    let touched_panel =
        FigurePanel { room: vec![[start, 0.0], [start, 5.0]], ..over_time("Touched", "palm", &touched) };
    let panels = [
        touched_panel,
        over_time("Contacts from their mean", "distance in m", &away),
        over_time("Forces", "size in N", &force),
        intervals,
    ];
    panels.into_iter().filter(|panel| !panel.curves.is_empty()).collect()
}

/// Contacts or places as they are seen.
fn of_touches(found: &Touches) -> Vec<FigurePanel> {
    match found {
        Touches::PlanarContacts { curves, .. } => {
            let points = curves.iter().flatten().map(|contact| contact.point.to_array()).collect();
            vec![FigurePanel {
                title: "Contacts".to_owned(),
                axes: ["x in m".to_owned(), "y in m".to_owned()],
                equal: true,
                curves: vec![FigureCurve {
                    name: "contacts".to_owned(),
                    points,
                    dots: true,
                    ..FigureCurve::default()
                }],
                ..FigurePanel::default()
            }]
        }
        Touches::Contacts { curves, .. } => {
            let points: Vec<DVec3> = curves.iter().flatten().map(|contact| contact.point).collect();
            views(&[], &[("contacts", &points)], None)
        }
        Touches::Poses(runs) => {
            let points: Vec<DVec3> = runs.iter().flatten().map(|pose| pose.p_WO).collect();
            views(&[], &[("places of the body's origin", &points)], None)
        }
    }
}
