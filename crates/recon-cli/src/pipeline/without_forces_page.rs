//! The page of motion and shape without forces.

use super::sensor_words::suspects;
use super::views::views;
use super::without_forces::WithoutForces;
use glam::{DVec2, DVec3};
use recon_io::EvidenceValue::{Count, Number, Text};
use recon_io::{
    Evidence, EvidenceValue, FigureCurve, FigurePanel, FiguresPage, Level, MotionState, TriangleMesh,
    Verdict, brief, brief_to, status_in_words,
};

/// Points on an ellipsoid by which it is drawn: its outline is off by less than a thousandth of its size.
const POINTS: u32 = 4000;

/// The page of what contacts alone told.
pub(crate) fn without_forces_page(title: &str, made: &WithoutForces) -> FiguresPage {
    FiguresPage {
        kicker: "Shape and motion from contacts alone",
        title: title.to_owned(),
        verdict: verdict(made),
        warnings: made.warnings.clone(),
        facts: facts(made),
        heading: "Shape and motion",
        panels: panels(made),
        caption: "The bounds and the fitted ellipsoid as they are seen along the body axes and from all around, with the contacts and the centre of mass, \
                  and the motion over time with bands of two deviations."
            .to_owned(),
        table: FiguresPage::RESTS_ON,
        evidence: rows(made),
    }
}

fn verdict(made: &WithoutForces) -> Verdict {
    let of = &made.found.evidence;
    let text = format!(
        "An ellipsoid in its motion fits the contacts to {:.1e} m, of which noise explains {:.1e} m; the least certain is {} (standard deviation {:.1e}).",
        of.residual_rms, of.noise_explains, of.weakest, of.weakest_deviation
    );
    let level = if made.bounded.is_some() { Level::Good } else { Level::Caution };
    Verdict { level, text }
}

fn facts(made: &WithoutForces) -> Vec<(&'static str, String, &'static str)> {
    let times = made.times();
    let over = times.last().zip(times.first()).map_or(0.0, |(last, first)| last - first);
    let axes = made.found.shape.semi_axes.to_array().map(|axis| brief_to(4, axis)).join(", ");
    let mut facts = vec![("Time", brief_to(4, over), "s"), ("Semi-axes", axes, "m")];
    let names = ["Moment over mass, x", "Moment over mass, y", "Moment over mass, z"];
    facts.extend(names.into_iter().zip(made.inertia_over_mass()).map(|(name, (value, std))| {
        let std = format!("<small class=\"deviation\">± {}</small>", brief_to(2, std));
        (name, brief(value) + &std, "m²")
    }));
    if let Some(bounded) = &made.bounded {
        facts.push(("Lower bound", brief(bounded.drawn.lower.volume), "m³"));
        facts.push(match &bounded.drawn.upper {
            Some(upper) => ("Upper bound", brief(upper.volume), "m³"),
            None => ("Upper bound", "unbounded".to_owned(), ""),
        });
    }
    facts
}

fn panels(made: &WithoutForces) -> Vec<FigurePanel> {
    let bounded = made.bounded.as_ref();
    let [lower, upper] = [bounded.and_then(|b| b.lower.as_ref()), bounded.and_then(|b| b.upper.as_ref())];
    let next = bounded.and_then(|b| b.drawn.largest_gap).map(|gap| gap.outer);
    let ellipsoid = on_ellipsoid(made);
    let bodies = [("lower", corners(lower)), ("upper", corners(upper)), ("ellipsoid", &ellipsoid[..])];
    let dots = [("contacts", &made.points[..]), ("centre", &[DVec3::ZERO][..])];
    let mut panels = views(&bodies, &dots, next);
    let over_time = |title: &str, unit: &str, what: fn(&MotionState) -> DVec3, deviation: usize| {
        over_time(made, [title, unit], what, deviation)
    };
    panels.push(over_time("Centre of mass", "m", |state| state.p_WCm, 0));
    panels.push(over_time("Velocity", "m/s", |state| state.v_WCm, 1));
    panels.push(over_time("Angular velocity", "rad/s", |state| state.w_WO, 2));
    panels
}

fn corners(mesh: Option<&TriangleMesh>) -> &[DVec3] {
    mesh.map_or(&[], |mesh| &mesh.vertices)
}

/// Points all over the fitted ellipsoid, body axes, m from the centre of mass.
fn on_ellipsoid(made: &WithoutForces) -> Vec<DVec3> {
    let shape = &made.found.shape;
    let golden = std::f64::consts::PI * (3.0 - f64::sqrt(5.0));
    let point = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(POINTS);
        let across = DVec2::from_angle(golden * f64::from(k)) * (1.0 - z * z).sqrt();
        shape.centre + shape.orientation * (shape.semi_axes * across.extend(z))
    };
    (0..POINTS).map(point).collect()
}

/// The three coordinates of what moves, with bands of two deviations.
fn over_time(
    made: &WithoutForces,
    [title, unit]: [&str; 2],
    what: fn(&MotionState) -> DVec3,
    deviation: usize,
) -> FigurePanel {
    let (times, motion) = (made.times(), made.motion());
    let curve = |axis: usize| FigureCurve {
        name: ["x", "y", "z"][axis].to_owned(),
        points: times.iter().zip(&motion).map(|(t, state)| [*t, what(state)[axis]]).collect(),
        half_heights: made.found.deviations.iter().map(|of| 2.0 * of[deviation][axis]).collect(),
        ..FigureCurve::default()
    };
    FigurePanel {
        title: title.to_owned(),
        axes: ["t in s".to_owned(), unit.to_owned()],
        curves: (0..3).map(curve).collect(),
        ..FigurePanel::default()
    }
}

fn rows(made: &WithoutForces) -> Vec<Evidence> {
    let of = &made.found.evidence;
    let row = |key: &str, name: &str, value: EvidenceValue, unit: &str, meaning: &str| {
        let [key, name, unit, meaning] = [key, name, unit, meaning].map(str::to_owned);
        Evidence { key, name, value, unit, meaning, level: Level::Neutral }
    };
    let mut rows = vec![
        row("status", "Fit", Text(status_in_words(of.status)), "", "How the fit ended."),
        row("samples", "Samples", Count(of.samples as u64), "", "Those that were used."),
        row("residual_rms", "Residual", Number(of.residual_rms), "m", "Root mean square of what is left."),
        row("noise_explains", "Noise explains", Number(of.noise_explains), "m", "Of the residual."),
        row("rank", "Rank", Count(of.rank as u64), "", "Unknowns that the log determines."),
        row(
            "condition",
            "Condition",
            Number(of.condition),
            "",
            "Of the fit; large where something is hardly seen.",
        ),
        row(
            "weakest",
            "Least certain",
            Text(of.weakest.to_string()),
            "",
            "The direction that the log tells worst.",
        ),
    ];
    let products = ["product_xy", "product_xz", "product_yz"].into_iter().zip(["xy", "xz", "yz"]);
    rows.extend(products.zip(&made.inertia_over_mass()[3..]).map(|((key, axes), (value, std))| {
        let meaning = format!("Standard deviation {}.", brief_to(2, *std));
        row(key, &format!("Product over mass, {axes}"), Number(*value), "m²", &meaning)
    }));
    rows.extend(suspects(&of.suspects));
    rows
}
