//! What is said of pushes: the verdict, what the reader must know, the summary.

use super::Told;
use recon::observer::pushes::{OutlinePoint, PushFriction};
use recon_io::{Level, SummaryOf, Verdict, brief_to, verdict_figures};
use serde_json::{Value, json};

/// Deviations between two halves beyond which they contradict each other: once in 370 logs by chance.
const HALVES: f64 = 3.0;
/// Deviations of a clock beyond which it is told.
const CLOCK: f64 = 3.0;
/// Way from a corner to the nearest touch beyond which it is inferred, as a share of the way around.
const REACHED: f64 = 0.05;
/// Pushes that were left out, as a share, from which on the log is not what it should be.
const LEFT_OUT: f64 = 0.2;

/// By how many deviations the halves differ.
fn apart([a, b]: [PushFriction; 2]) -> f64 {
    (a.value - b.value).abs() / a.deviation.hypot(b.deviation)
}

/// Whether outline and friction can be relied on.
pub(super) fn verdict(told: &Told) -> Verdict {
    let estimate = &told.estimate;
    let outline = &estimate.outline.name;
    let all = estimate.pushes.len() + estimate.untouched.len();
    let bad = |text: String| Verdict { level: Level::Caution, text };
    let Some(friction) = estimate.friction else {
        let seen = brief_to(2, estimate.ratio_seen);
        return bad(format!(
            "The outline ({outline}) is told; too little slides to tell friction, which is no less than about {seen}."
        ));
    };
    if estimate.untouched.len() as f64 > LEFT_OUT * all as f64 {
        let left = estimate.untouched.len();
        return bad(format!(
            "{left} of {all} pushes touched nothing: look whether force and finger belong together."
        ));
    }
    if let Some(halves) = told.halves.filter(|halves| apart(*halves) > HALVES) {
        return bad(format!(
            "Both halves of the log differ in friction by {:.1} of their deviations: something changed between them.",
            apart(halves)
        ));
    }
    Verdict {
        level: Level::Good,
        text: format!(
            "Outline: {outline}, from {} pushes. Friction {:.3} ± {:.3}, from the {} that slide, at a slip of {:.1} mm/s; it changes by {:+.3} ± {:.3} per mm/s.",
            estimate.pushes.len(),
            friction.value,
            friction.deviation,
            friction.pushes,
            1e3 * friction.at_slip,
            1e-3 * friction.by_slip.0,
            1e-3 * friction.by_slip.1,
        ),
    }
}

/// What the reader must know.
pub(super) fn warnings(told: &Told) -> Vec<String> {
    let estimate = &told.estimate;
    let mut all = Vec::new();
    let around: f64 = estimate.outline.line.edges().map(|(a, b)| a.distance(b)).sum();
    for (k, corner) in estimate.outline.corners.iter().enumerate() {
        let farthest = corner.to_touch[0].max(corner.to_touch[1]);
        if farthest > REACHED * around {
            all.push(format!(
                "Corner {} is inferred: the nearest touches are {:.0} and {:.0} mm away from it.",
                k + 1,
                1e3 * corner.to_touch[0],
                1e3 * corner.to_touch[1]
            ));
        }
    }
    let [start, end] = estimate.clocks;
    if start.0.abs() > CLOCK * start.1 || end.0.abs() > CLOCK * end.1 {
        all.push(format!(
            "First and last touches lie on one outline only if the finger's record is ahead of the force by {:.2} ± {:.2} s at the first and {:.2} ± {:.2} s at the \
             last: its clock is off, or it moves on after the last sample. The outline as a whole is known no better than that.",
            start.0, start.1, end.0, end.1
        ));
    }
    for (number, why) in estimate.untouched.iter().take(3) {
        all.push(format!("Push {number} {why}: it is left out."));
    }
    if estimate.untouched.len() > 3 {
        all.push(format!("{} more pushes are left out.", estimate.untouched.len() - 3));
    }
    all
}

/// The summary of all logs.
pub(super) fn summary(told: &[Told], radius: f64) -> Value {
    let good = told.iter().all(|told| verdict(told).level == Level::Good);
    let warnings: Vec<String> = told.iter().flat_map(warnings).collect();
    SummaryOf::Pushes.named(json!({
        "method": "outline, friction and contact modes from pushes by a round finger",
        "status": "fitted",
        "verdict": {
            "level": if good { "good" } else { "caution" },
            "text": told.iter().map(|told| verdict(told).text).collect::<Vec<_>>().join(" "),
        },
        "warnings": warnings,
        "finger_radius_m": radius,
        "logs": told.iter().map(figures).collect::<Vec<_>>(),
    }))
}

/// The summary of a log; what is not known is left out.
fn figures(told: &Told) -> Value {
    let e = &told.estimate;
    let pair = |(value, std): (f64, f64)| json!({"value": value, "std": std});
    let friction = |f: &PushFriction| {
        json!({
            "coefficient": f.value,
            "std": f.deviation,
            "at_slip_m_per_s": f.at_slip,
            "by_slip_s_per_m": pair(f.by_slip),
            "pushes": f.pushes,
        })
    };
    let corners =
        e.outline.corners.iter().map(
            |c| json!({"point_m": c.point.to_array(), "std_m": c.deviation(), "to_touch_m": c.to_touch}),
        );
    let candidates = e
        .outline
        .candidates
        .iter()
        .map(|c| json!({"outline": c.name, "unknowns": c.unknowns, "log_odds_against": c.against}));
    let left_out = e.untouched.iter().map(|(n, why)| json!({"push": n, "why": why.to_string()}));
    let mut all = json!({
        "log": told.number,
        "verdict": verdict_figures(&verdict(told)),
        "warnings": warnings(told),
        "std_friction_between_pushes": e.spread[0],
        "std_ratio_within_a_push": e.spread[1],
        "ratio_seen": e.ratio_seen,
        "outline": e.outline.name,
        "area_m2": e.outline.line.area(),
        "corners": corners.collect::<Vec<_>>(),
        "candidates": candidates.collect::<Vec<_>>(),
        "pushes": e.pushes.len(),
        "left_out": left_out.collect::<Vec<_>>(),
        "std_touches_m": e.touch_deviations,
        "finger_ahead_at_first_touch_s": pair(e.clocks[0]),
        "finger_ahead_at_last_touch_s": pair(e.clocks[1]),
        "compliance_m_per_n": e.compliance,
        "table_friction_length_m": e.table_length,
    });
    for (key, value) in [
        ("friction", e.friction.as_ref().map(friction)),
        ("friction_of_halves", told.halves.map(|halves| json!(halves.each_ref().map(friction)))),
        ("force_noise_n", e.force_noise.map(Value::from)),
        ("next_push", e.outline.next_push().map(next_push)),
    ] {
        if let Some(value) = value {
            all[key] = value;
        }
    }
    all
}

/// Where a push tells most, and along which normal into the object.
fn next_push(at: &OutlinePoint) -> Value {
    json!({"point_m": at.point.to_array(), "inward": (-at.normal).to_array(), "to_touch_m": at.to_touch, "std_m": at.deviation})
}

/// A log on the console.
pub(super) fn described(told: &Told, only: bool) -> String {
    let e = &told.estimate;
    let mut text = if only { String::new() } else { format!("log {}\n", told.number) };
    text += &format!("{}\n", verdict(told).text);
    text.extend(warnings(told).iter().map(|w| format!("Warning: {w}\n")));
    if let Some([a, b]) = told.halves {
        text += &format!(
            "  friction of halves     {:.3} +- {:.3}, {:.3} +- {:.3}\n",
            a.value, a.deviation, b.value, b.deviation
        );
    }
    for (k, c) in e.outline.corners.iter().enumerate() {
        let [x, y] = c.point.to_array().map(|v| 1e3 * v);
        let name = format!("corner {}", k + 1);
        text += &format!("  {name:<22} ({x:.2}, {y:.2}) ± {:.2} mm\n", 1e3 * c.deviation());
    }
    if let Some(point) = least_known(told) {
        let [x, y] = point.point.to_array().map(|v| (1e3 * v).round() + 0.0);
        text += &format!(
            "  least known            outline at ({x:.0}, {y:.0}) ± {:.2} mm\n",
            1e3 * point.deviation
        );
    }
    text + &format!("  next                   {}\n", next(told))
}

/// Where the outline is least known.
fn least_known(told: &Told) -> Option<&OutlinePoint> {
    told.estimate.outline.points.iter().max_by(|a, b| a.deviation.total_cmp(&b.deviation))
}

/// The step that gains most.
fn next(told: &Told) -> String {
    if verdict(told).level != Level::Good {
        return if told.estimate.friction.is_none() {
            "push more obliquely: friction is told by pushes in which the finger slides".to_owned()
        } else {
            "see report.html for the pushes that do not go with the others".to_owned()
        };
    }
    match told.estimate.outline.next_push() {
        Some(point) => {
            let [x, y] = point.point.to_array().map(|v| (1e3 * v).round() + 0.0);
            let towards = (-point.normal.y).atan2(-point.normal.x).to_degrees();
            let why = match 1e3 * point.to_touch {
                far if far >= 1.0 => format!("the nearest touch is {far:.0} mm away"),
                _ => "its outline is least known there".to_owned(),
            };
            format!("push at ({x:.0}, {y:.0}) mm of the object, towards {towards:.0}°: {why}")
        }
        None => "nothing is left that pushes could tell".to_owned(),
    }
}
